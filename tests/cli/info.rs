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
