//! Reading of saved views and looks: an unreadable entry does not affect the others.

use serde_json::Value;

use crate::SavedEntry;

/// Removes the saved views and looks that this version cannot read, and returns a warning for each.
pub(super) fn remove_unreadable_entries(overlay: &mut Value) -> Vec<String> {
    let Some(Value::Array(kept)) = overlay.get_mut("kept") else { return Vec::new() };
    let mut warnings = Vec::new();
    let mut at = 0;
    kept.retain(|entry| {
        at += 1;
        match serde_json::from_value::<SavedEntry>(entry.clone()) {
            Ok(_) => true,
            Err(err) => {
                warnings.push(format!("the saved view or look {at} was left out: {err}"));
                false
            }
        }
    });
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AppliedSettings, Settings, load_json};

    #[test]
    fn of_what_is_kept_only_the_unreadable_is_left_out() {
        let mut kept = Settings::default();
        assert!(kept.save_view_for_digit(3, "front"));
        let look = SavedEntry::look("bone", &kept);
        assert!(kept.save_entry(look));
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
        let AppliedSettings { settings: read, warnings } =
            load_json(&Settings::default(), &tree.to_string()).unwrap();
        assert_eq!(read, kept);
        let told = warnings.iter().filter(|warning| warning.contains("was left out")).count();
        assert_eq!(told, odd.len(), "{warnings:?}");
    }
}
