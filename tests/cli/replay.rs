//! Tests of the command `replay`: pictures rendered again from their own metadata or from a report.

use chiaroscuro_media::{ExportError, PicturePixels, export_png, read_picture, read_record, write_picture};
use chiaroscuro_scene::{ImageSpec, PixelFormat};

use crate::program::ProgramFolder;
use crate::volumes::small_ball;

#[test]
fn settings_of_a_report_restore_the_picture() {
    let folder = ProgramFolder::new();
    folder.run_successfully(
        "render builtin:chair:24 -o first.png --size 64x48 --report first.json --set camera.azimuth_deg=77.7 \
         --set shadows.strength=0.7 --set sampling.kernel={\"gaussian\":{\"sigma\":0.55}}",
    );
    // Compared as text: parsing and formatting a number may change its last digit.
    let settings = |name: &str| {
        let text = String::from_utf8(folder.read(name)).expect("JSON is UTF-8");
        let (_, after) = text.split_once("\"settings\": ").expect("the report has the settings");
        after.trim_end().strip_suffix('}').expect("they are its last part").trim_end().to_owned()
    };
    let first = folder.json("first.json");
    assert_eq!(first["settings"]["camera"]["azimuth_deg"], 77.7);
    folder.write("session.json", settings("first.json"));
    for option in ["--session", "--preset"] {
        folder.run_successfully(&format!(
            "render builtin:chair:24 -o second.png --size 64x48 --report second.json {option} session.json"
        ));
        assert!(folder.read("first.png") == folder.read("second.png"), "{option}: the pictures differ");
        let changed: Vec<_> = std::iter::zip(settings("first.json").lines(), settings("second.json").lines())
            .filter(|(before, after)| before != after)
            .map(|(before, after)| format!("{} became {}", before.trim(), after.trim()))
            .collect();
        assert!(changed.is_empty(), "{option}: {changed:?}");
        assert_eq!(first["settings_hash"], folder.json("second.json")["settings_hash"], "{option}");
    }
}

#[test]
fn pictures_can_be_made_again_from_themselves() {
    let folder = ProgramFolder::new();
    folder.write("x_8x8x8_uint8.raw", small_ball());
    folder.run_successfully(
        "render x_8x8x8_uint8.raw -o shot.png --size 48x36 --transparent --set shadows.gain=1.3",
    );
    assert!(folder.run_successfully("replay shot.png --check").contains("identical"));
    folder.run_successfully("replay shot.png -o again.png");
    assert!(folder.read("again.png") == folder.read("shot.png"), "all bytes, the record included");

    // A different look is detected, and is an error only with `--check`.
    let text = read_record(&folder.path("shot.png")).expect("a picture").expect("a record");
    let changed = text.replace("\"gain\": 1.3", "\"gain\": 0.4");
    assert_ne!(changed, text);
    let pixels = image::open(folder.path("shot.png")).expect("a picture").to_rgba8().into_raw();
    export_png([48, 36], &pixels, true, Some(&changed), &folder.path("changed.png")).expect("written");
    assert!(folder.run_successfully("replay changed.png").contains("different"));
    let outcome = folder.run("replay changed.png --check");
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stderr.contains("RMSE"), "{outcome:?}");
    assert!(!outcome.stderr.contains("earlier version"), "{outcome:?}");

    // A picture of an earlier version may differ, which the message states.
    let earlier = changed.replace("\"schema\": 3", "\"schema\": 1");
    assert_ne!(earlier, changed);
    export_png([48, 36], &pixels, true, Some(&earlier), &folder.path("earlier.png")).expect("written");
    let said = folder.run_successfully("replay earlier.png");
    assert!(said.contains("made by an earlier version") && said.contains("RMSE"), "{said}");

    // Another volume, a moved one, and pictures without metadata.
    folder.write(
        "y_8x8x8_uint8.raw",
        vec![7; 512].iter().zip(0..).map(|(a, b): (&u8, i32)| a ^ b as u8).collect::<Vec<_>>(),
    );
    let outcome = folder.run("replay shot.png --volume y_8x8x8_uint8.raw");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("another volume"), "{outcome:?}");
    std::fs::rename(folder.path("x_8x8x8_uint8.raw"), folder.path("z_8x8x8_uint8.raw")).expect("moved");
    assert_ne!(folder.run("replay shot.png").code, Some(0));
    assert!(
        folder.run_successfully("replay shot.png --check --volume z_8x8x8_uint8.raw").contains("identical")
    );
    export_png([48, 36], &pixels, true, None, &folder.path("plain.png")).expect("written");
    let outcome = folder.run("replay plain.png");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("carries no settings"), "{outcome:?}");
    assert_eq!(folder.run("replay nothing.png").code, Some(6));
}

#[test]
fn fine_pictures_can_be_made_again_from_themselves() {
    let folder = ProgramFolder::new();
    for (name, options) in [
        ("deep.png", "--bits 16 --samples 2"),
        ("deep_alpha.png", "--bits 16 --transparent"),
        ("light.exr", "--samples 3"),
        ("light_alpha.exr", "--transparent"),
    ] {
        folder.run_successfully(&format!("render builtin:chair:16 -o {name} --size 48x36 {options}"));
        assert!(folder.run_successfully(&format!("replay {name} --check")).contains("identical"), "{name}");
        folder.run_successfully(&format!("replay {name} -o again_{name}"));
        let [found, again] = [name.to_owned(), format!("again_{name}")].map(|name| folder.path(&name));
        assert!(
            read_picture(&found).expect("a picture") == read_picture(&again).expect("a picture"),
            "{name}"
        );
        assert_eq!(read_record(&found).expect("a record"), read_record(&again).expect("a record"), "{name}");
    }
    let deep = image::open(folder.path("deep.png")).expect("a picture");
    assert_eq!(deep.color(), image::ColorType::Rgb16);
    let words = deep.to_rgb16().into_raw();
    assert!(words.iter().filter(|&&word| word % 257 != 0).count() > words.len() / 4, "more than bytes");
    // A different look is detected in these formats as well.
    let text = read_record(&folder.path("light.exr")).expect("a picture").expect("a record");
    let PicturePixels { size, rows } = read_picture(&folder.path("light.exr")).expect("a picture");
    let changed = text.replace("\"gain\": 1.0", "\"gain\": 0.4");
    assert_ne!(changed, text);
    let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new(size) };
    let mut rows = Some(rows);
    let mut next = || Ok::<_, ExportError>(rows.take());
    write_picture(&folder.path("changed.exr"), &image_spec, Some(&changed), &mut next).expect("written");
    assert_eq!(folder.run("replay changed.exr --check").code, Some(1));
    // A look can be loaded from any of them.
    folder.run_successfully("render builtin:chair:16 -o from.png --size 48x36 --session light.exr");
    export_png([1, 1], &[0; 4], false, None, &folder.path("bare.png")).expect("written");
    let outcome = folder.run("render builtin:chair:16 -o x.png --session bare.png");
    assert!(outcome.code == Some(3) && outcome.stderr.contains("carries no settings"), "{outcome:?}");
    let outcome = folder.run("render builtin:chair:16 -o x.gif --size 48x36");
    assert!(outcome.code == Some(6) && outcome.stderr.contains(".png or .exr"), "{outcome:?}");
    assert_ne!(folder.run("render builtin:chair:16 -o x.png --samples 5").code, Some(0));
    assert_ne!(folder.run("render builtin:chair:16 -o x.png --bits 12").code, Some(0));
}

#[test]
fn pictures_may_be_larger_than_textures() {
    let folder = ProgramFolder::new();
    // Wider than the largest texture of adapters (16384 here and on most).
    let said =
        folder.run_successfully("render builtin:chair:16 -o wide.png --size 20000x3 --set sampling.slab=4");
    assert!(said.contains("wide.png"));
    let wide = image::open(folder.path("wide.png")).expect("a picture").to_rgb8();
    assert_eq!((wide.width(), wide.height()), (20000, 3));
    assert!(folder.run_successfully("replay wide.png --check").contains("identical"));
}

#[test]
fn replay_warns_of_a_picture_that_shows_nothing() {
    let folder = ProgramFolder::new();
    let warned = |name: &str, options: &str| {
        folder.run_successfully(&format!("render builtin:sphere:16 --size 64x48 -o {name} {options}"));
        folder.run(&format!("replay {name}")).stderr.contains("nothing of the volume is visible")
    };
    assert!(warned("away.png", "--set camera.target=[90,0,0] --set floor.on=false"));
    assert!(!warned("sphere.png", ""));
}

#[test]
fn volumes_outside_the_pictures_folder_are_opened_only_when_the_user_says_so() {
    let folder = ProgramFolder::new();
    folder.write("x_8x8x8_uint8.raw", small_ball());
    std::fs::create_dir(folder.path("pictures")).expect("the folder can be written to");
    folder.run_successfully("render x_8x8x8_uint8.raw -o pictures/shot.png --size 16x16");
    let said = folder.run_failing("replay pictures/shot.png", 3);
    assert!(said.contains("--volume FILE") && said.contains("--trust-paths"), "the options: {said}");
    assert!(said.contains("x_8x8x8_uint8.raw") && said.contains("shot.png"), "both files: {said}");
    for trust in ["--trust-paths", "--volume x_8x8x8_uint8.raw"] {
        let said = folder.run_successfully(&format!("replay pictures/shot.png --check {trust}"));
        assert!(said.contains("identical"), "{trust}: {said}");
    }
    // Names that are no regular file are never looked up.
    let text = read_record(&folder.path("pictures/shot.png")).expect("a picture").expect("a record");
    let record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for source in ["\\\\host\\share\\x.nrrd", "//host/share/x.nrrd", "/dev/zero", "nul.raw", "http://host/x"]
    {
        let mut record = record.clone();
        record["_volume"]["source"] = source.into();
        let text = record.to_string();
        export_png([16, 16], &[0; 1024], false, Some(&text), &folder.path("bad.png")).expect("written");
        for trust in ["", "--trust-paths"] {
            let said = folder.run_failing(&format!("replay bad.png {trust}"), 3);
            assert!(
                said.contains("is not opened: it") && !said.contains("--trust-paths"),
                "{source}: {said}"
            );
        }
    }
    let said = folder.run_failing("x_8x8x8_uint8.raw --volume x_8x8x8_uint8.raw", 2);
    assert!(said.contains("is a volume itself"), "{said}");
}

#[test]
fn cuts_by_shapes_are_made_again() {
    let folder = ProgramFolder::new();
    let camera = r#"{"projection":"perspective","azimuth_deg":30,"elevation_deg":20,"roll_deg":0,"target":[0,0,0],"distance":5,"fov_y_deg":30}"#;
    let outline = format!(
        r#"{{"shape":{{"outline":{{"camera":{camera},"aspect":1.5,"points":[[0.4,0.3],[0.6,0.3],[0.5,0.7]]}}}}}}"#
    );
    let sphere = r#"{"action":"restore","shape":{"sphere":{"center":[0.1,0,0.2],"radius":0.3}}}"#;
    let part = r#"{"on":false,"action":"keep","shape":{"component":{"seed":[0,0,0],"values":[50,255]}}}"#;
    folder.write("look.json", format!(r#"{{"cuts":{{"shapes":[{outline},{sphere},{part}]}}}}"#));
    folder.run_successfully("render builtin:chair:24 -o whole.png --size 64x48");
    folder.run_successfully(
        "render builtin:chair:24 -o cut.png --size 64x48 --preset look.json --report cut.json",
    );
    assert!(folder.read("whole.png") != folder.read("cut.png"));
    let shapes = &folder.json("cut.json")["settings"]["cuts"]["shapes"];
    assert_eq!(shapes.as_array().map(Vec::len), Some(3), "{shapes}");
    assert!(folder.run_successfully("replay cut.png --check").contains("identical"));
}
