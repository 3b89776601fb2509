//! What is said of a volume.

use serde_json::Value;

use crate::checks::{assert_has_keys, keys};
use crate::program::Folder;

#[test]
fn info_says_what_is_in_a_volume() {
    let folder = Folder::new();
    let facts: Value =
        serde_json::from_str(&folder.succeed("info builtin:chair:16 --json")).expect("valid JSON");
    assert_has_keys(&facts, &["name", "dims", "type", "spacing_mm", "range", "percentiles"]);
    assert!(keys(&facts).iter().any(|key| key.ends_with("bytes") || key.contains("bytes_")), "memory");
    assert_eq!(facts["dims"], serde_json::json!([16, 16, 16]));
    assert_eq!(facts["type"], "uint8");
    assert_eq!(facts["spacing_mm"], serde_json::json!([8.0, 8.0, 8.0]));
    let percentiles: Vec<f64> = ["p1", "p5", "p25", "p50", "p75", "p95", "p99"]
        .iter()
        .map(|name| facts["percentiles"][name].as_f64().unwrap_or_else(|| panic!("{name} is missing")))
        .collect();
    assert!(percentiles.is_sorted(), "{percentiles:?}");

    let text = folder.succeed("info builtin:chair:16");
    assert!(text.contains("16 × 16 × 16") && text.contains("uint8"), "{text}");
}

#[test]
fn info_says_what_kind_of_data_it_is_and_what_the_file_says_of_it() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nsample units: HU\n\
                  modality:=CT\nPaddingValue:=7\nSegment0_Name:=a \u{1b}b\nSegment0_LabelValue:=3\n\n";
    let file = [header.as_bytes(), &[0, 3, 3, 0, 3, 3, 0, 7]].concat();
    std::fs::write(folder.path("s.nrrd"), file).expect("a file");
    let facts: Value = serde_json::from_str(&folder.succeed("info s.nrrd --json")).expect("valid JSON");
    assert_eq!(facts["kind"], serde_json::json!({ "name": "labels", "labels": 2 }));
    assert!(facts["kind_why"].as_str().is_some_and(|why| why.contains("the file says")));
    let hints = &facts["hints"];
    assert_eq!(
        (&hints["modality"], &hints["meaning"], &hints["unit"]),
        (&"ct".into(), &"labels".into(), &"HU".into())
    );
    assert_eq!(hints["padding"], 7.0);
    assert_eq!(hints["labels"][0]["name"], "a ·b");
    let text = folder.succeed("info s.nrrd");
    for line in ["kind         labels: ", "modality     ct", "label        3: a ·b", "padding      7"] {
        assert!(text.contains(line), "{line:?} is not in {text}");
    }
    let ball: Value =
        serde_json::from_str(&folder.succeed("info builtin:sphere:24 --json")).expect("valid JSON");
    assert_eq!(ball["kind"]["name"], "scalar");
    assert_eq!(ball["hints"]["modality"], Value::Null);
}
