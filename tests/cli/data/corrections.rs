//! Tests of corrections of a volume's metadata on the command line.

use serde_json::{Value, json};

use crate::program::ProgramFolder;
use crate::volumes::{header, small_ball};

/// NRRD file of a ball with a given spacing.
fn ball(spacings: &str) -> Vec<u8> {
    [header(&format!("sizes: 8 8 8\nspacings: {spacings}")).as_bytes(), &small_ball()].concat()
}

fn pixels(folder: &ProgramFolder, name: &str) -> Vec<u8> {
    image::open(folder.path(name)).expect("a picture").to_rgba8().into_raw()
}

#[test]
fn a_corrected_volume_makes_the_picture_of_a_file_that_says_so() {
    let folder = ProgramFolder::new();
    folder.write("said.nrrd", ball("1 1 1"));
    folder.write("meant.nrrd", ball("0.5 0.5 2"));
    folder.write("small.nrrd", ball("0.0005 0.0005 0.002"));
    folder.run_successfully("render said.nrrd -o said.png --size 48x36");
    folder.run_successfully("render meant.nrrd -o meant.png --size 48x36");
    folder.run_successfully("render said.nrrd -o corrected.png --size 48x36 --set volume.spacing=0.5,0.5,2");
    assert!(pixels(&folder, "corrected.png") == pixels(&folder, "meant.png"), "the pictures differ");
    assert!(pixels(&folder, "corrected.png") != pixels(&folder, "said.png"), "the correction had no effect");
    folder.run_successfully("render small.nrrd -o small.png --size 48x36");
    folder.run_successfully(
        "render said.nrrd -o in_um.png --size 48x36 --set volume.spacing=0.5,0.5,2 --set volume.unit=um",
    );
    assert!(pixels(&folder, "in_um.png") == pixels(&folder, "small.png"), "units are lengths");

    // The picture records the corrections and the file; they apply to that file only.
    assert!(folder.run_successfully("replay corrected.png --check").contains("identical"));
    folder.run_successfully("render said.nrrd -o again.png --size 48x36 --session corrected.png");
    assert!(pixels(&folder, "again.png") == pixels(&folder, "corrected.png"), "a session restores it");
    folder.run_successfully(
        "render small.nrrd -o other.png --size 48x36 --session corrected.png --report other.json",
    );
    assert_eq!(folder.json("other.json")["settings"]["volume"]["spacing"], Value::Null);
    folder.run_successfully(
        "render said.nrrd -o undone.png --size 48x36 --session corrected.png --set volume.spacing=null",
    );
    folder.run_successfully(
        "render said.nrrd -o a.png --size 48x36 --session corrected.png --report report.json",
    );
    assert_eq!(folder.json("report.json")["settings"]["volume"]["spacing"], json!([0.5, 0.5, 2.0]));
    assert!(
        pixels(&folder, "undone.png") != pixels(&folder, "corrected.png"),
        "the command line takes precedence"
    );
}

#[test]
fn corrections_that_cannot_be_are_refused() {
    let folder = ProgramFolder::new();
    for wrong in ["spacing=-1,0,2", "spacing=1e12,1,1", "value_scale.slope=0", "value_scale.slope=nan"] {
        let said = folder.run_failing(&format!("info builtin:chair:8 --set volume.{wrong}"), 2);
        assert!(said.contains("expected"), "{said}");
    }
    folder
        .run_successfully("info builtin:chair:8 --set volume.spacing=1,2,3 --set volume.value_scale.slope=2");
}

#[test]
fn info_says_what_is_corrected() {
    let folder = ProgramFolder::new();
    folder.write("a_8x8x8_uint8.raw", small_ball());
    let info = |set: &str| -> Value {
        serde_json::from_str(&folder.run_successfully(&format!("info a_8x8x8_uint8.raw --json {set}")))
            .expect("JSON")
    };
    let plain = info("");
    assert_eq!((&plain["has_unknown_scale"], &plain["corrections"]["spacing"]), (&json!(true), &Value::Null));
    let spaced = info("--set volume.spacing=2x2x3 --set volume.unit=nm");
    assert_eq!(spaced["has_unknown_scale"], false);
    let along_z = spaced["spacing_mm"][2].as_f64().expect("a number");
    assert!((along_z / 3e-6 - 1.0).abs() < 1e-12, "{along_z}");
    let scaled = info("--set volume.value_scale.slope=10 --set volume.value_scale.intercept=-1000");
    assert_eq!(scaled["range"], json!([-1000.0, 1000.0]));
    let padded = info("--set volume.padding_value=0");
    assert_eq!(padded["range"], json!([200.0, 200.0]));
    let lying = info("--set volume.orientation=PSL --set volume.flip.y=true");
    assert_eq!(lying["is_anatomical"], true);
    let words = folder
        .run_successfully("info a_8x8x8_uint8.raw --set volume.flip.y=true --set volume.axis_order=zyx");
    assert!(words.contains("corrected    flipped along y") && words.contains("order z y x"), "{words}");
    let bare = folder.run_successfully("info a_8x8x8_uint8.raw --set volume.hidden_table=100");
    assert!(bare.contains("no table was found"), "{bare}");

    for (set, code, said) in [
        ("camera.distance=2", 2, "volume.spacing="),
        ("volume.spacing", 2, "volume.spacing="),
        ("volume.spacings=2", 2, "spacing"),
        ("volume.spacing=wide", 2, "0.5,0.5,2"),
        ("volume.orientation=RAR", 2, "RAS"),
        ("volume.padding_value=some", 2, "none"),
    ] {
        let outcome = folder.run(&format!("info a_8x8x8_uint8.raw --set {set}"));
        assert_eq!(outcome.code, Some(code), "{set}: {outcome:?}");
        assert!(outcome.error_message().is_some_and(|message| message.contains(said)), "{set}: {outcome:?}");
    }
    folder.write("b_8x8x8_uint8.raw", vec![5; 512]);
    let outcome = folder.run("info b_8x8x8_uint8.raw --set volume.padding_value=5");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.error_message().is_some_and(|message| message.contains("padding 5")), "{outcome:?}");
}
