//! What is kept beside a look, as files have it: one entry that is not understood costs no other.

use serde_json::Value;

use crate::model::Kept;

/// Leaves out of what is kept beside a look whatever is none of this version's views and looks: the rest stands. A warning
/// for each.
pub(super) fn leave_out_unreadable(overlay: &mut Value) -> Vec<String> {
    let Some(Value::Array(kept)) = overlay.get_mut("kept") else { return Vec::new() };
    let mut warnings = Vec::new();
    let mut at = 0;
    kept.retain(|entry| {
        at += 1;
        match serde_json::from_value::<Kept>(entry.clone()) {
            Ok(_) => true,
            Err(err) => {
                warnings.push(format!("the kept view or look {at} was left out: {err}"));
                false
            }
        }
    });
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Settings, load_json};

    #[test]
    fn of_what_is_kept_only_the_unreadable_is_left_out() {
        let mut kept = Settings::default();
        assert!(kept.keep_view_under(3, "front"));
        let look = Kept::look("bone", &kept);
        assert!(kept.keep(look));
        let mut tree = serde_json::to_value(&kept).unwrap();
        let odd = [
            r#"{"name": "a", "digit": 300, "what": {"view": {}}}"#,
            r#"{"what": 3}"#,
            r#"{"name": "b", "what": {"film": {}}}"#,
        ];
        let mut list = tree["kept"].as_array().unwrap().clone();
        for text in odd {
            list.insert(1, serde_json::from_str(text).unwrap());
        }
        tree["kept"] = Value::Array(list);
        let (read, warnings) = load_json(&Settings::default(), &tree.to_string()).unwrap();
        assert_eq!(read, kept);
        let told = warnings.iter().filter(|warning| warning.contains("was left out")).count();
        assert_eq!(told, odd.len(), "{warnings:?}");
    }
}
