//! Tests of the command `bench`: timings as JSON and as tables.

use serde_json::Value;

use crate::checks::{assert_has_keys, keys};
use crate::program::ProgramFolder;
use crate::volumes::small_ball;

#[test]
fn orbiting_is_timed_and_rebuilds_no_light_volume() {
    let folder = ProgramFolder::new();
    let text = folder.run_successfully(
        "bench --json --volume builtin:sphere:16 --size 32x32 --frames 1 --only orbit --set sampling.slab=1",
    );
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    assert_has_keys(&result, &["adapter", "driver", "cases"]);
    let cases = result["cases"].as_array().expect("a list");
    let orbit = cases.iter().find(|case| case["name"] == "orbit").expect("the case that was asked for");
    assert_has_keys(
        orbit,
        &["name", "volume", "dims", "size", "frames", "wall_ms", "cpu_ms", "stages", "light_rebuilds"],
    );
    assert_eq!(orbit["light_rebuilds"], 0);
    assert_eq!(orbit["frames"], 1);
    assert_eq!(orbit["size"], serde_json::json!([32, 32]));
    assert_eq!(orbit["dims"], serde_json::json!([16, 16, 16]));
    assert_eq!(keys(&orbit["wall_ms"]), ["max", "median", "min"]);
    assert_has_keys(&orbit["stages"], &["eye", "light_march", "light_raycast", "light_backproject"]);
    assert!(orbit["wall_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{orbit}");
    assert!(cases.iter().all(|case| case["name"] != "light-drag"), "only what was asked for");

    let text = folder.run_successfully(
        "bench --json --volume builtin:sphere:16 --size 32x32 --frames 2 --only light-drag",
    );
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let cases = result["cases"].as_array().expect("a list");
    let drag = cases.iter().find(|case| case["name"] == "light-drag").expect("the case that was asked for");
    assert_eq!(drag["light_rebuilds"], 2, "one for every frame");
}

#[test]
fn the_table_of_the_paper_has_its_three_variants() {
    let folder = ProgramFolder::new();
    let text = folder
        .run_successfully("bench --json --volume builtin:sphere:16 --size 32x32 --frames 1 --only paper");
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let cases = result["cases"].as_array().expect("a list");
    let names: Vec<_> = cases.iter().filter_map(|case| case["name"].as_str()).collect();
    assert_eq!(names, ["paper-1-direct", "paper-2-raycast", "paper-3-splat"]);
    let light = |at: usize| cases[at]["light_volume_ms"].as_f64().expect("a number");
    assert_eq!((light(0), &cases[0]["light_rebuilds"]), (0.0, &serde_json::json!(0)), "no light volume");
    assert!(light(1) > 0.0 && light(2) > 0.0, "{cases:?}");
    let ratio = &result["ratios"]["light_volume_raycast_over_splat"];
    assert_eq!(keys(ratio), ["measured", "paper"]);
}

#[test]
fn loading_is_timed_stage_by_stage() {
    const STAGES: [&str; 11] = [
        "device",
        "encoding",
        "file",
        "first_look",
        "instance",
        "light_search",
        "picture",
        "read",
        "shaders",
        "statistics",
        "upload",
    ];
    let folder = ProgramFolder::new();
    folder.write("ball_8x8x8_uint8.raw", small_ball());
    let loading = "bench --volume ball_8x8x8_uint8.raw --size 32x32 --frames 1 --reduced";
    let text = folder.run_successfully(&format!("{loading} --json --only load"));
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let load = &result["cases"][0];
    assert_eq!((&load["name"], &load["frames"]), (&"load".into(), &1.into()));
    assert_eq!(keys(&load["load_ms"]), STAGES);
    let median = |stage: &str| load["load_ms"][stage]["median"].as_f64().expect("a number");
    assert!(STAGES.iter().all(|stage| median(stage) > 0.0), "{load}");
    let together = STAGES.iter().map(|stage| median(stage)).sum::<f64>();
    let wall = load["wall_ms"]["median"].as_f64().expect("a number");
    assert!(
        (0.95 * wall..=wall).contains(&together),
        "stages have names for {together} of {wall} ms: {load}"
    );
    let table = folder.run_successfully(&format!("{loading} --only load"));
    for words in ["instance", "read", "first look", "light search", "file", "ball 8 x 8 x 8"] {
        assert!(table.contains(words), "{words}: {table}");
    }

    let text = folder.run_successfully(&format!("{loading} --json --only read"));
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let read = &result["cases"][0];
    assert!(result.get("adapter").is_none(), "nothing is drawn");
    assert_eq!((&read["name"], &read["type"]), (&"read".into(), &"uint8".into()));
    assert!(read["load_ms"]["read"]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{read}");
    assert!(read["load_ms"]["upload"].is_null(), "{read}");
    folder.run_failing("bench --only read --volume elsewhere.raw", 6);
}
