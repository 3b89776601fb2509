//! Tests of the command `info`: facts about a volume, proposed looks, and automatic decisions.

use serde_json::Value;

use crate::checks::{assert_has_keys, keys};
use crate::program::ProgramFolder;

#[test]
fn info_says_what_is_in_a_volume() {
    let folder = ProgramFolder::new();
    let facts: Value =
        serde_json::from_str(&folder.run_successfully("info builtin:chair:16 --json")).expect("valid JSON");
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

    let text = folder.run_successfully("info builtin:chair:16");
    assert!(text.contains("16 × 16 × 16") && text.contains("uint8"), "{text}");
}

#[test]
fn info_says_what_kind_of_data_it_is_and_what_the_file_says_of_it() {
    let folder = ProgramFolder::new();
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nsample units: HU\n\
                  modality:=CT\nPaddingValue:=7\nSegment0_Name:=a \u{1b}b\nSegment0_LabelValue:=3\n\n";
    let file = [header.as_bytes(), &[0, 3, 3, 0, 3, 3, 0, 7]].concat();
    std::fs::write(folder.path("s.nrrd"), file).expect("a file");
    let facts: Value =
        serde_json::from_str(&folder.run_successfully("info s.nrrd --json")).expect("valid JSON");
    assert_eq!(facts["kind"], serde_json::json!({ "name": "labels", "labels": 1 }), "without padding");
    assert!(facts["kind_why"].as_str().is_some_and(|why| why.contains("the file says")));
    let hints = &facts["hints"];
    assert_eq!(
        (&hints["modality"], &hints["meaning"], &hints["unit"]),
        (&"ct".into(), &"labels".into(), &"HU".into())
    );
    assert_eq!(hints["padding"], 7.0);
    assert_eq!(hints["labels"][0]["name"], "a ·b");
    let labels = serde_json::json!([
        { "number": 0, "name": "", "voxels": 3 }, { "number": 3, "name": "a ·b", "voxels": 4 },
    ]);
    assert_eq!(facts["labels"], labels);
    let text = folder.run_successfully("info s.nrrd");
    for line in
        ["kind         labels: ", "modality     ct", "label        3: a ·b, 4 voxels", "padding      7"]
    {
        assert!(text.contains(line), "{line:?} is not in {text}");
    }
    let ball: Value =
        serde_json::from_str(&folder.run_successfully("info builtin:sphere:24 --json")).expect("valid JSON");
    assert_eq!((&ball["kind"]["name"], &ball["labels"]), (&"scalar".into(), &serde_json::json!([])));
    assert_eq!(ball["hints"]["modality"], Value::Null);
}

/// Writes a label map of 16³ voxels with slabs along x: labels 0, 3, 9, 200 and so on.
fn write_label_slabs(folder: &ProgramFolder, name: &str, labels: &[u8]) {
    let n = 16;
    let header = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: {n} {n} {n}\nencoding: raw\nmodality:=SEG\n\
         Segment0_Name:=Lung\nSegment0_LabelValue:=9\n\n"
    );
    let voxels = (0..n * n * n).map(|at| labels[at % n * labels.len() / n]);
    let file: Vec<u8> = header.bytes().chain(voxels).collect();
    std::fs::write(folder.path(name), file).expect("a file");
}

#[test]
fn many_labels_are_cut_short_for_people() {
    let folder = ProgramFolder::new();
    let text_of = |count: u8| {
        let header = format!(
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: {count} 2 2\nencoding: raw\n\
             Segment0_Name:=a\nSegment0_LabelValue:=1\n\n"
        );
        let voxels = (0..4).flat_map(|_| 0..count);
        std::fs::write(folder.path("m.nrrd"), header.bytes().chain(voxels).collect::<Vec<_>>())
            .expect("a file");
        folder.run_successfully("info m.nrrd")
    };
    let listed = |text: &str| text.lines().filter(|line| line.starts_with("  label ")).count();
    let text = text_of(20);
    assert!(listed(&text) == 20 && !text.contains(" more"), "{text}");
    let text = text_of(90);
    assert!(listed(&text) == 21 && text.contains("label        and 70 more"), "{text}");
}

#[test]
fn labels_are_set_by_their_numbers() {
    let folder = ProgramFolder::new();
    write_label_slabs(&folder, "l.nrrd", &[0, 3, 9, 200]);
    let render = |arguments: &str| {
        folder.run_successfully(&format!("render l.nrrd --size 64x48 -o p.png --report r.json {arguments}"));
        (folder.read("p.png"), folder.json("r.json")["settings"]["layers"][0]["labels"].clone())
    };
    let (first, labels) = render("");
    assert_eq!(labels.as_object().expect("an object").len(), 4);
    assert_eq!((&labels["9"]["name"], &labels["9"]["visible"]), (&"Lung".into(), &true.into()));
    assert_eq!(labels["0"]["visible"], false);
    let (hidden, labels) = render("--set labels.9.visible=false");
    assert_eq!((&labels["9"]["name"], &labels["9"]["visible"]), (&"Lung".into(), &false.into()));
    assert!(hidden != first);
    // As another kind of data it has no table of labels.
    assert_eq!(render("--as scalar").1, serde_json::json!({}));
}

const RENDER: &str = "render builtin:chair:24 --size 64x48 -o p.png --report r.json";

#[test]
fn looks_are_listed_and_taken_by_their_numbers() {
    let folder = ProgramFolder::new();
    let facts: serde_json::Value =
        serde_json::from_str(&folder.run_successfully("info builtin:chair:24 --json")).expect("JSON");
    let looks = facts["looks"].as_array().expect("a list");
    assert!([12, 14].contains(&looks.len()), "{looks:?}");
    let number = |name: &str| {
        let look = looks.iter().find(|look| look["name"] == name).expect("a look");
        look["number"].as_u64().expect("a number")
    };
    let settings = |arguments: &str| {
        folder.run_successfully(&format!("{RENDER} {arguments}"));
        folder.json("r.json")["settings"].clone()
    };
    let first = settings("");
    assert_eq!(settings("--look 1"), first);
    let rim = settings(&format!("--look {}", number("Rim light")));
    assert_eq!(rim["lights"][0]["name"], "Rim left");
    assert_eq!(rim["camera"], first["camera"]);
    let above = settings(&format!("--look {} --set shading.ambient=0.3", number("From above")));
    assert_eq!((&above["floor"]["on"], &above["shading"]["ambient"]), (&true.into(), &0.3.into()));
    for wrong in ["0", "15"] {
        let outcome = folder.run(&format!("{RENDER} --look {wrong}"));
        assert!(outcome.code == Some(2) && outcome.stderr.contains("expected 1 to"), "{outcome:?}");
    }
}

#[test]
fn explicit_settings_are_kept() {
    let folder = ProgramFolder::new();
    let settings = |arguments: &str| {
        folder.run_successfully(&format!("{RENDER} {arguments}"));
        folder.json("r.json")["settings"].clone()
    };
    let first = settings("");
    assert!(first["output"]["exposure"].as_f64().expect("a number") > 0.0);
    assert_eq!(settings("--set output.exposure=3")["output"]["exposure"], 3.0);
    assert_eq!(settings("--set floor.on=true")["floor"]["on"], true);
    // Lights that are set explicitly stay, and everything else is unchanged.
    let moved = settings("--set lights.0.position=[0,0,3]");
    assert_eq!(moved["lights"][0]["position"], serde_json::json!([0.0, 0.0, 3.0]));
    // A picture without shadows has otherwise the same look.
    let mut flat = settings("--shadows off");
    assert_eq!(flat["shadows"]["algorithm"], "off");
    flat["shadows"]["algorithm"] = first["shadows"]["algorithm"].clone();
    assert_eq!(flat, first, "lights, balance and exposure do not depend on it");
}

#[test]
fn a_floor_is_as_dark_as_the_exposure_asks() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:box:24 -o p.png --size 48x36 --report r.json");
    let settings = folder.json("r.json")["settings"].clone();
    assert_eq!(settings["floor"]["on"], true, "a box gets a floor");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let shown = number(&settings["floor"]["color"][0]) * number(&settings["output"]["exposure"]);
    assert!((shown - 0.30).abs() < 1e-5, "{shown}");
}

#[test]
fn exposed_pictures_are_made_again_from_themselves() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:chair:16 -o p.png --size 48x36 --set output.exposure=1.7");
    assert!(folder.run_successfully("replay p.png --check").contains("identical"));
    folder.run_successfully("render builtin:chair:16 -o q.png --size 48x36 --session p.png");
    assert!(folder.read("p.png") == folder.read("q.png"));
}

#[test]
fn few_slices_are_shown_as_bright_as_their_values() {
    let folder = ProgramFolder::new();
    let mut slices = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 40 32 2\nencoding: raw\n\n".to_vec();
    // Mostly dark, so that an automatic exposure would be far above 1.
    slices.extend((0..40 * 32 * 2_u32).map(|at| if at % 17 == 0 { 230 } else { 10 + (at % 23) as u8 }));
    folder.write("slices.nrrd", slices);
    folder.run_successfully("render slices.nrrd -o p.png --size 48x36 --report r.json");
    let settings = folder.json("r.json")["settings"].clone();
    assert_eq!(settings["output"]["exposure"], 1.0, "{settings}");
    assert_eq!(settings["shading"]["diffuse"], 0.0, "{settings}");
}
