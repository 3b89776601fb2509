//! Tests of the command `time-series`: steps of a file and of numbered files, their look, their records, and failures.

use serde_json::Value;

use crate::program::ProgramFolder;

/// Options of small pictures.
const SMALL: &str = "--size 40x30";

/// Ball in a grid of 8³ voxels that is brightest in its middle.
fn fading_ball(brightness: f64) -> Vec<u8> {
    let distance = |at: usize| {
        let p = [at % 8, at / 8 % 8, at / 64].map(|c| c as f64 - 3.5);
        p.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    (0..512).map(|at| (brightness * (1.0 - distance(at) / 6.5)).max(0.0) as u8).collect()
}

/// NRRD file with these lines in its header.
fn nrrd(lines: &str, voxels: &[u8]) -> Vec<u8> {
    let header = format!("NRRD0004\ntype: uint8\nencoding: raw\n{lines}\n\n");
    [header.as_bytes(), voxels].concat()
}

/// File of time steps, balls of these brightnesses.
fn series(brightnesses: &[f64]) -> Vec<u8> {
    let lines = format!(
        "dimension: 4\nsizes: 8 8 8 {}\nkinds: domain domain domain time\nspacings: 1 1 1 nan",
        brightnesses.len()
    );
    nrrd(&lines, &brightnesses.iter().flat_map(|&brightness| fading_ball(brightness)).collect::<Vec<_>>())
}

/// File with one ball.
fn single(brightness: f64) -> Vec<u8> {
    nrrd("dimension: 3\nsizes: 8 8 8\nspacings: 1 1 1", &fading_ball(brightness))
}

/// Record of a picture.
fn record(folder: &ProgramFolder, picture: &str) -> Value {
    let text = chiaroscuro_media::read_record(&folder.path(picture)).expect("a picture").expect("a record");
    serde_json::from_str(&text).expect("valid JSON")
}

/// Time steps that the records of pictures name.
fn recorded_steps(folder: &ProgramFolder, pictures: &[&str]) -> Vec<u64> {
    let step = |picture: &&str| record(folder, picture)["_volume"]["choice"]["frame"].as_u64();
    pictures.iter().map(|picture| step(picture).expect("a time step")).collect()
}

/// Pixels of the frames of an animated PNG.
fn apng_frames(folder: &ProgramFolder, name: &str) -> Vec<Vec<u8>> {
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(folder.read(name)));
    let moving = decoder.expect("a PNG file").apng().expect("it can be read");
    let frames = image::AnimationDecoder::into_frames(moving);
    frames.map(|frame| frame.expect("a frame").into_buffer().into_raw()).collect()
}

#[test]
fn steps_of_a_file_become_pictures() {
    let folder = ProgramFolder::new();
    folder.write("steps.nrrd", series(&[60.0, 120.0, 240.0]));
    assert!(folder.run_failing("render steps.nrrd -o a.png", 3).contains("--frame"), "a picture shows one");
    let outcome = folder.run(&format!("time-series steps.nrrd -o all {SMALL} --progress"));
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    for progress in ["range of values: step 3 of 3", "step 1 of 3", "step 3 of 3"] {
        assert!(outcome.stderr.lines().any(|line| line == progress), "{progress}: {outcome:?}");
    }
    let names = ["all/0000.png", "all/0001.png", "all/0002.png"];
    assert!(!folder.path("all/0003.png").exists());
    assert_eq!(recorded_steps(&folder, &names), [0, 1, 2]);
    let pixels = names.map(|name| image::open(folder.path(name)).expect("a picture").to_rgb8());
    assert!(pixels[0] != pixels[1] && pixels[1] != pixels[2], "each step is another");
    // A step alone has other ranges of values, which must not matter.
    for name in names {
        let said = folder.run_successfully(&format!("replay {name} --trust-paths --check"));
        assert!(said.contains("identical"), "{name}: {said}");
    }

    folder.run_successfully(&format!("time-series steps.nrrd -o t.png {SMALL} --rate 4"));
    let frames = apng_frames(&folder, "t.png");
    assert_eq!(frames.len(), 3);
    assert!(frames.iter().zip(&pixels).all(|(frame, picture)| frame.len() * 3 == picture.len() * 4));
    folder.run_successfully(&format!("time-series steps.nrrd -o one.png {SMALL} --steps 1..1"));
    assert_eq!(apng_frames(&folder, "one.png").len(), 1);
}

#[test]
fn some_steps_alone_are_an_animation() {
    let folder = ProgramFolder::new();
    folder.write("steps.nrrd", series(&[60.0, 120.0, 240.0]));
    folder.run_successfully(&format!("time-series steps.nrrd -o two {SMALL} --steps 1..2 --turn -90"));
    assert_eq!(recorded_steps(&folder, &["two/0000.png", "two/0001.png"]), [1, 2]);
    assert!(!folder.path("two/0002.png").exists());
    let azimuth = |name: &str| record(&folder, name)["camera"]["azimuth_deg"].as_f64().expect("an angle");
    let turned = azimuth("two/0001.png") - azimuth("two/0000.png");
    assert!((turned.rem_euclid(360.0) - 270.0).abs() < 1e-9, "{turned}");
    for (wrong, why) in [
        ("--steps 1..3", "0 to 2, and no step 3"),
        ("--steps 4..5", "no step 4"),
        ("--steps 2..1", "the first number is after the last"),
        ("--turn round", "degrees"),
        ("--all-channels", "single channel"),
        ("-o b.gif --part 1/2", "into a folder"),
        ("-o -", "a file or a folder"),
    ] {
        let output = if wrong.contains("-o") { "" } else { "-o b" };
        let said = folder.run_failing(&format!("time-series steps.nrrd {output} {SMALL} {wrong}"), 2);
        assert!(said.contains(why), "{wrong}: {said}");
    }
}

#[test]
fn numbered_files_are_steps() {
    let folder = ProgramFolder::new();
    for (name, brightness) in [("t1", 60.0), ("t2", 120.0), ("t10", 240.0), ("u1", 30.0)] {
        folder.write(&format!("{name}.nrrd"), single(brightness));
    }
    folder.run_successfully(&format!("time-series t2.nrrd -o out {SMALL} --set volume.spacing=1,1,2"));
    for (frame, file) in ["t1.nrrd", "t2.nrrd", "t10.nrrd"].into_iter().enumerate() {
        let picture = format!("out/000{frame}.png");
        let stated = record(&folder, &picture);
        assert!(stated["_volume"]["source"].as_str().is_some_and(|path| path.ends_with(file)), "{stated}");
        assert_eq!(stated["volume"]["spacing"], serde_json::json!([1.0, 1.0, 2.0]), "as the open one");
        let said = folder.run_successfully(&format!("replay {picture} --trust-paths --check"));
        assert!(said.contains("identical"), "{picture}: {said}");
    }
    assert!(!folder.path("out/0003.png").exists());
    folder.run_successfully(&format!("time-series t1.nrrd -o two {SMALL} --steps 1..2"));
    assert!(folder.path("two/0001.png").exists() && !folder.path("two/0002.png").exists());
    // Inputs are no outputs, even where files of other programs are replaced.
    folder.write("0000.png", "none");
    assert!(folder.run_failing("time-series t1.nrrd -o .", 2).contains("--force"));
    for alone in ["u1.nrrd", "builtin:sphere:16"] {
        let said = folder.run_failing(&format!("time-series {alone} -o out.png {SMALL}"), 2);
        assert!(said.contains("one time step") && said.contains(alone), "{said}");
    }
}

#[test]
fn ranges_are_those_of_all_steps_or_of_the_open_one() {
    let folder = ProgramFolder::new();
    folder.write("steps.nrrd", series(&[60.0, 120.0, 240.0]));
    for range in ["all", "open"] {
        folder.run_successfully(&format!("time-series steps.nrrd -o {range} {SMALL} --range {range}"));
    }
    let highest = |picture: &str| {
        let stated = record(&folder, picture);
        let range = stated["layers"][0]["range"]["typed"][1].as_f64();
        range.unwrap_or_else(|| panic!("a typed range: {}", stated["layers"][0]["range"]))
    };
    assert!(highest("open/0002.png") < 100.0, "{}", highest("open/0002.png"));
    assert!(highest("all/0000.png") > 150.0, "{}", highest("all/0000.png"));
    assert_eq!(highest("all/0000.png"), highest("all/0002.png"));
    assert_ne!(folder.read("open/0001.png"), folder.read("all/0001.png"));
    folder.run_successfully(&format!("time-series steps.nrrd -o last {SMALL} --range open --frame 2"));
    assert!(highest("last/0000.png") > 150.0, "the step that is named is opened");
}

#[test]
fn channels_show_the_same_step() {
    let folder = ProgramFolder::new();
    let lines = "dimension: 5\nsizes: 2 8 8 8 3\nkinds: list domain domain domain time\n\
                 spacings: nan 1 1 1 nan";
    let channels = |brightness: f64| {
        let voxels = fading_ball(brightness).into_iter();
        voxels.enumerate().flat_map(|(at, voxel)| [voxel, if at % 8 < 4 { voxel / 2 } else { 0 }])
    };
    folder.write(
        "c.nrrd",
        nrrd(lines, &[60.0, 120.0, 240.0].into_iter().flat_map(channels).collect::<Vec<_>>()),
    );
    assert!(folder.run_failing(&format!("time-series c.nrrd -o a {SMALL}"), 3).contains("--channel"));
    for (name, args) in [
        ("together", "--all-channels"),
        ("layer", "--channel 0 --layer c.nrrd:channel=1"),
        ("still", "--channel 0 --layer c.nrrd:channel=1,frame=2"),
        ("late", "--all-channels --steps 1..2"),
    ] {
        folder.run_successfully(&format!("time-series c.nrrd -o {name} {SMALL} {args}"));
    }
    let layer = |picture: &str| {
        let stated = record(&folder, picture)["_volume"].clone();
        let frame = |volume: &Value| volume["choice"]["frame"].as_u64().expect("a time step");
        assert_eq!(stated["layers"][0]["choice"]["channel"], 1, "{stated}");
        [frame(&stated), frame(&stated["layers"][0])]
    };
    for name in ["together", "layer"] {
        assert_eq!([0, 1, 2].map(|at| layer(&format!("{name}/000{at}.png"))), [[0, 0], [1, 1], [2, 2]]);
        let said = folder.run_successfully(&format!("replay {name}/0001.png --trust-paths --check"));
        assert!(said.contains("identical"), "{said}");
    }
    assert_eq!(layer("still/0000.png"), [0, 2]);
    assert_eq!(layer("still/0001.png"), [1, 2], "another time is a still picture");
    assert_eq!(layer("late/0000.png"), [1, 1]);
    let said = folder.run_failing(&format!("time-series c.nrrd -o b {SMALL} --all-channels --steps 7..8"), 2);
    assert!(said.contains("no step 7"), "{said}");
}

#[test]
fn steps_that_cannot_be_read_end_the_command() {
    let folder = ProgramFolder::new();
    for name in ["t1", "t2", "t3"] {
        folder.write(&format!("{name}.nrrd"), single(200.0));
    }
    let whole = folder.read("t3.nrrd");
    folder.write("t3.nrrd", &whole[..whole.len() - 1]);
    for args in ["-o t.png --range open", "-o t.gif --range open", "-o t.png"] {
        let said = folder.run_failing(&format!("time-series t1.nrrd {SMALL} {args}"), 3);
        assert!(said.contains("time step 2 (t3.nrrd)") && said.contains("/t3.nrrd"), "{said}");
    }
    // Steps that are not drawn need not be whole.
    folder.run_successfully(&format!("time-series t1.nrrd -o t.png {SMALL} --range open --steps 0..1"));
    assert_eq!(apng_frames(&folder, "t.png").len(), 2);
}

#[test]
fn parts_of_a_series_are_drawn_by_several_programs() {
    let folder = ProgramFolder::new();
    folder.write("steps.nrrd", series(&[60.0, 120.0, 180.0, 240.0]));
    let all = format!("time-series steps.nrrd {SMALL} --turn 30");
    folder.run_successfully(&format!("{all} -o whole"));
    folder.run_successfully(&format!("{all} -o parts --part 2/2"));
    assert!(!folder.path("parts/0001.png").exists() && folder.path("parts/0002.png").exists());
    folder.run_successfully(&format!("{all} -o parts --part 1/2"));
    let is_same =
        |at: u32| folder.read(&format!("whole/000{at}.png")) == folder.read(&format!("parts/000{at}.png"));
    assert!((0..4).all(is_same));
    // Pictures of other steps are drawn again, others stay as they are.
    let written_at = |at: u32| {
        let path = folder.path(&format!("parts/000{at}.png"));
        std::fs::metadata(path).and_then(|file| file.modified()).expect("a file")
    };
    let before = written_at(1);
    std::fs::copy(folder.path("parts/0001.png"), folder.path("parts/0000.png")).expect("another picture");
    folder.run_successfully(&format!("{all} -o parts --part 1/2"));
    assert!((0..4).all(is_same));
    assert_eq!(written_at(1), before, "it was there");
}
