//! Names and colours of the labels of an image.

use std::collections::BTreeMap;

use serde_json::Value;

use chiaroscuro_volume::{FileLabelTable, MAX_LABELS};

/// Fields that writers use for the name of a label, best first.
const NAMES: [&str; 4] = ["label-name", "name", "label", "class"];

/// Parses the metadata `image-label`.
pub(super) fn parse_labels(label: &Value) -> FileLabelTable {
    let entries = |name: &str| {
        let list = label[name].as_array().into_iter().flatten();
        list.filter_map(|entry| Some((entry["label-value"].as_i64()?, entry))).take(MAX_LABELS)
    };
    let name =
        |properties: &Value| NAMES.iter().find_map(|name| properties[*name].as_str().map(str::to_owned));
    let names: BTreeMap<i64, String> =
        entries("properties").filter_map(|(number, properties)| Some((number, name(properties)?))).collect();
    let part = |value: &Value| value.as_f64().map(|value| (value / 255.0) as f32);
    let mut table = FileLabelTable::default();
    for (number, name) in &names {
        table.insert(*number, name, None);
    }
    for (number, entry) in entries("colors") {
        let rgba = &entry["rgba"];
        let color = match [0, 1, 2].map(|at| part(&rgba[at])) {
            [Some(red), Some(green), Some(blue)] => Some([red, green, blue]),
            _ => None,
        };
        table.insert(number, names.get(&number).map_or("", String::as_str), color);
    }
    table
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn labels_have_names_and_colors() {
        let table = parse_labels(&json!({
            "colors": [{"label-value": 1, "rgba": [255, 0, 51, 255]}, {"label-value": 2}],
            "properties": [{"label-value": 1, "name": "nucleus"}, {"label-value": 4, "class": "cell"}, {"name": "x"}],
        }));
        let one = table.get(1).unwrap();
        assert_eq!((one.name.as_str(), one.color), ("nucleus", Some([1.0, 0.0, 0.2])));
        assert_eq!(table.get(2).unwrap().color, None);
        assert_eq!(table.get(4).unwrap().name, "cell");
        assert_eq!(table.len(), 3);
    }
}
