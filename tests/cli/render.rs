//! Tests of the command `render`: pictures, their reports, and the settings that they are made with.

use chiaroscuro_media::read_record;
use serde_json::Value;

use crate::checks::{assert_has_keys, assert_shows_something, keys, pixels};
use crate::program::ProgramFolder;
use crate::volumes::{gzipped, small_ball};

#[test]
fn a_picture_and_its_report_are_written() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:sphere:24 -o out.png --size 64x48 --report r.json");
    assert_eq!(folder.names(), ["out.png", "r.json"], "and nothing else");
    assert_shows_something(&folder.path("out.png"), [64, 48]);

    let report = folder.json("r.json");
    assert_has_keys(
        &report,
        &[
            "adapter",
            "image_size",
            "volume_dims",
            "stages_ms",
            "light_rebuilds",
            "slabs",
            "peak_gpu_bytes",
            "settings_hash",
            "settings",
        ],
    );
    assert_eq!(
        keys(&report["stages_ms"]),
        ["bricks", "eye", "light_backproject", "light_march", "light_raycast", "readback", "upload"]
    );
    for (stage, took) in report["stages_ms"].as_object().expect("an object") {
        assert!(took.as_f64().is_some_and(|ms| (0.0..60_000.0).contains(&ms)), "{stage}: {took}");
    }
    assert!(report["adapter"].as_str().is_some_and(|name| !name.is_empty()));
    assert_eq!(report["image_size"], serde_json::json!([64, 48]));
    assert_eq!(report["volume_dims"], serde_json::json!([24, 24, 24]));
    // The key light casts shadows, so its volume was filled for the picture; the fill light casts none.
    assert_eq!(report["light_rebuilds"][0], 1, "{}", report["light_rebuilds"]);
    assert!(report["slabs"].as_u64().is_some_and(|slabs| slabs >= 24), "{}", report["slabs"]);
    assert!(report["peak_gpu_bytes"].as_u64().is_some_and(|bytes| bytes > 2 * 24 * 24 * 24));
    assert_eq!(report["settings_hash"].as_str().map(str::len), Some(16));
}

#[test]
fn blocks_of_voxels_are_averaged_when_that_is_asked_for() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:sphere:48 --reduce 2 -o out.png --size 64x48 --report r.json");
    assert_shows_something(&folder.path("out.png"), [64, 48]);
    let report = folder.json("r.json");
    assert_eq!(report["volume_dims"], serde_json::json!([24, 24, 24]));
    assert_eq!(report["volume_file_dims"], serde_json::json!([48, 48, 48]));
    let replayed = folder.run("replay out.png --check --reduce 1");
    assert_eq!(replayed.code, Some(3), "other voxels must be detected: {replayed:?}");
    // The picture records which portion of the volume it shows.
    folder.run_successfully("replay out.png --check");
    folder.run_failing("render builtin:sphere:48 --reduce 0 -o none.png", 2);
}

#[test]
fn a_part_of_a_file_is_shown_and_found_again() {
    let folder = ProgramFolder::new();
    let values = (0..24 * 20 * 16).map(|at| (at % 24 * 5 + at / 480 * 8) as u8);
    folder.write("ramp_24x20x16_uint8.raw", values.collect::<Vec<u8>>());
    let part =
        "render ramp_24x20x16_uint8.raw --region 4:,:,0:10 --every 2 -o out.png --size 32x24 --report r.json";
    folder.run_successfully(part);
    let report = folder.json("r.json");
    assert_eq!(report["volume_dims"], serde_json::json!([10, 10, 5]));
    assert_eq!(report["volume_file_dims"], serde_json::json!([20, 20, 10]), "the region's");
    folder.run_successfully("replay out.png --check");
    let said = folder.run_successfully("info ramp_24x20x16_uint8.raw --region 4:,:,0:10 --every 2");
    assert!(said.contains("every second voxel of the region 4:,0:,0:10 of 24 × 20 × 16"), "{said}");
    folder.run_failing("info ramp_24x20x16_uint8.raw --every 2 --reduce 2", 2);
    let outside = folder.run_failing("render ramp_24x20x16_uint8.raw --region 0:25,:,: -o none.png", 2);
    assert!(outside.contains("24 x 20 x 16"), "{outside}");
}

#[test]
fn volumes_beyond_the_adapter_are_shown_with_fewer_voxels() {
    let folder = ProgramFolder::new();
    // Longer than the largest texture of any adapter.
    folder.write("long_20000x3x3_uint8.raw", vec![200; 20000 * 9]);
    let outcome = folder.run("render long_20000x3x3_uint8.raw -o out.png --size 64x48 --report r.json");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("20000 × 3 × 3 voxels were averaged to"), "{outcome:?}");
    let report = folder.json("r.json");
    assert_eq!(report["volume_file_dims"], serde_json::json!([20000, 3, 3]));
    assert!(report["volume_dims"][0].as_u64().is_some_and(|n| n < 20000), "{}", report["volume_dims"]);
    assert_eq!(report["volume_dims"][1], 3, "the other axes are short enough");
    // A benchmark of it is refused, because it would not be of the whole volume.
    let bench = "bench --volume long_20000x3x3_uint8.raw --only orbit --frames 1 --size 16x16";
    let said = folder.run_failing(bench, 2);
    assert!(said.contains("full resolution"), "{said}");
}

#[test]
fn the_same_command_gives_the_same_bytes() {
    let folder = ProgramFolder::new();
    for name in ["a", "b"] {
        folder.run_successfully(&format!("render builtin:cloud:24 -o {name}.png --size 64x48"));
        folder.run_successfully(&format!("light-volume builtin:cloud:24 -o {name}.nrrd"));
    }
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_eq!(folder.read("a.nrrd"), folder.read("b.nrrd"));
    // An older result is replaced.
    folder.run_successfully("render builtin:cloud:24 -o b.png --size 32x24");
    folder.run_successfully("render builtin:cloud:24 -o b.png --size 64x48");
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
}

#[test]
fn a_transparent_picture_has_nothing_in_its_corner() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:sphere:24 -o clear.png --size 64x48 --transparent");
    let image = image::open(folder.path("clear.png")).expect("a PNG that can be decoded");
    assert_eq!(image.color(), image::ColorType::Rgba8);
    let (_, _, clear) = pixels(&folder.path("clear.png"));
    assert_eq!(clear[0][3], 0, "the corner");
    assert!(clear.iter().any(|pixel| pixel[3] > 200), "the object");

    folder.run_successfully("render builtin:sphere:24 -o solid.png --size 64x48");
    let image = image::open(folder.path("solid.png")).expect("a PNG that can be decoded");
    assert_eq!(image.color(), image::ColorType::Rgb8);
}

#[test]
fn shadows_change_the_picture() {
    let folder = ProgramFolder::new();
    let render = "render builtin:sphere:24 --size 64x48 -o";
    folder.run_successfully(&format!("{render} with.png"));
    folder.run_successfully(&format!("{render} off.png --shadows off"));
    folder.run_successfully(&format!("{render} none.png --set shadows.algorithm=off"));
    folder.run_successfully(&format!("{render} splat.png --shadows splat"));
    assert_ne!(folder.read("with.png"), folder.read("off.png"));
    assert_eq!(folder.read("off.png"), folder.read("none.png"), "both options have the same effect");
    assert_eq!(folder.read("with.png"), folder.read("splat.png"), "splatting is the default");
}

#[test]
fn presets_that_come_with_the_program_are_known_by_name() {
    let folder = ProgramFolder::new();
    let outcome = folder.run("render builtin:chair:24 -o out.png --size 32x32 --preset bench/creature");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!outcome.stderr.contains("warning: preset"), "{outcome:?}");
}

#[test]
fn presets_of_the_library_can_be_named() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:chair:16 -o own.png --size 40x30");
    folder.run_successfully("render builtin:chair:16 -o paper.png --size 40x30 --preset paper/chair");
    assert_shows_something(&folder.path("paper.png"), [40, 30]);
    assert!(folder.read("own.png") != folder.read("paper.png"));
}

#[test]
fn unknown_names_in_a_preset_are_warnings() {
    let folder = ProgramFolder::new();
    folder.write("typo.json", r#"{"shadows": {"strenght": 0.5}, "_remark": "free"}"#);
    let outcome = folder.run("render builtin:sphere:16 -o out.png --size 16x16 --preset typo.json");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("shadows.strenght"), "{outcome:?}");
    assert!(!outcome.stderr.contains("_remark"), "{outcome:?}");
}

#[test]
fn raw_files_say_their_format_in_the_name_or_in_options() {
    let folder = ProgramFolder::new();
    folder.write("x_8x8x8_uint8.raw", small_ball());
    folder.write("x.bin", small_ball());
    folder.write("padded.bin", [vec![9; 10], small_ball()].concat());
    folder.write("x_8x8x8_uint8.raw.gz", gzipped(&small_ball()));
    let render = |file: &str, out: &str| {
        folder.run_successfully(&format!("render {file} -o {out} --size 32x24"));
        assert_shows_something(&folder.path(out), [32, 24]);
        // Pixels only: the metadata of a picture name its volume file.
        image::open(folder.path(out)).expect("a picture").to_rgba8().into_raw()
    };
    let named = render("x_8x8x8_uint8.raw", "named.png");
    assert!(named == render("x.bin --dims 8x8x8 --type uint8", "options.png"));
    assert!(named == render("padded.bin --dims 8x8x8 --type uint8 --offset 10", "offset.png"));
    assert!(named == render("x_8x8x8_uint8.raw.gz", "zipped.png"));
    assert!(named != render("x_8x8x8_uint8.raw --spacing 1x1x3", "stretched.png"), "spacing counts");

    let facts = |args: &str| -> Value {
        serde_json::from_str(&folder.run_successfully(&format!("info --json {args}"))).expect("valid JSON")
    };
    folder.write("wide.bin", [1, 0, 0, 2].repeat(4));
    let little = facts("wide.bin --dims 2x2x2 --type uint16 --endian little");
    let big = facts("wide.bin --dims 2x2x2 --type uint16 --endian big");
    assert_eq!(little["range"], serde_json::json!([1.0, 512.0]));
    assert_eq!(big["range"], serde_json::json!([2.0, 256.0]));
}

#[test]
fn looks_stand_side_by_side_with_their_distances() {
    let folder = ProgramFolder::new();
    let text =
        folder.run_successfully("compare builtin:sphere:16 -o row.png --size 40x30 --looks splat,splat,off");
    let row = image::open(folder.path("row.png")).expect("a picture").to_rgba8();
    assert_eq!(row.dimensions(), (3 * 40 + 2 * 4, 30));
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[1].starts_with("splat") && lines[1].contains("RMSE   0.00"), "{text}");
    assert!(lines[2].starts_with("off") && !lines[2].contains("RMSE   0.00"), "{text}");
}

#[test]
fn a_volume_is_shown_as_the_kind_of_data_that_is_named() {
    let folder = ProgramFolder::new();
    let settings = |kind: &str| {
        folder.run_successfully(&format!(
            "render builtin:sphere:24 -o {kind}.png --size 32x24 --report {kind}.json --as {kind}"
        ));
        folder.json(&format!("{kind}.json"))["settings"]["layers"][0]["transfer"].clone()
    };
    let points = |function: &Value| function["points"].as_array().map_or(0, Vec::len);
    let (scalar, mask, labels) = (settings("scalar"), settings("mask"), settings("labels"));
    assert!(scalar != mask && mask != labels);
    assert!(points(&labels) > points(&mask), "a colour for every number");
    folder.run_successfully("render builtin:sphere:24 -o own.png --size 32x24 --report own.json");
    assert_eq!(
        folder.json("own.json")["settings"]["layers"][0]["transfer"],
        scalar,
        "a scalar field is detected"
    );
    folder.run_failing("render builtin:sphere:24 -o no.png --as something", 2);
}

/// The sphere alone, without the plate below it, over which it floats.
#[test]
fn the_floor_lies_under_what_is_shown() {
    let folder = ProgramFolder::new();
    let height = |arguments: &str| {
        folder.run_successfully(&format!(
            "render builtin:sphere:24 -o p.png --size 32x24 --report r.json {arguments}"
        ));
        folder.json("r.json")["settings"]["floor"]["height"].as_f64().expect("a number")
    };
    let points = r#"[{"value": 150, "opacity": 0}, {"value": 190, "opacity": 0.9}]"#;
    folder.write("sphere.json", format!(r#"{{"transfer": {{"points": {points}}}}}"#));
    let [under_plate, under_sphere] = ["", "--preset sphere.json"].map(height);
    assert!(under_plate < -0.6, "{under_plate}");
    // The sphere's lowest point is a third below its centre, at a quarter; there are twelve voxels to a scene unit.
    assert!((under_sphere + 1.0 / 12.0).abs() < 0.1, "{under_sphere}");
    assert_eq!(height("--preset sphere.json --set floor.height=-0.9"), -0.9);
}

/// Setting the up axis turns the object: the report shows that it is lit and framed in that orientation, whichever
/// option set it.
#[test]
fn setting_the_up_axis_turns_the_object() {
    let folder = ProgramFolder::new();
    let render = "render builtin:chair:24 -o p.png --size 32x24 --report r.json";
    folder.run_successfully(render);
    let upright = folder.json("r.json")["settings"].clone();
    folder.run_successfully(&format!("{render} --set camera.up=minus_z"));
    let on_its_head = folder.json("r.json")["settings"].clone();
    let height =
        |settings: &serde_json::Value| settings["lights"][0]["position"][2].as_f64().expect("a number");
    assert!(height(&upright) > 0.0 && height(&on_its_head) < 0.0, "the light comes from above");
    assert_ne!(upright["floor"]["height"], on_its_head["floor"]["height"]);
    folder.write("up.json", r#"{"camera": {"up": "minus_z"}}"#);
    // Without a space, which would end the argument.
    let camera = format!("--set camera={}", on_its_head["camera"]);
    for how in ["--preset up.json", "--session up.json", &camera] {
        folder.run_successfully(&format!("{render} {how}"));
        assert_eq!(folder.json("r.json")["settings"], on_its_head, "{how}");
    }
    assert!(folder.run_failing(&format!("{render} --set camera.up=sideways"), 2).contains("camera.up"));
}

/// Renders a picture without its background; returns whether it shows anything, and whether the program warns that it
/// does not.
fn is_visible_and_warned(folder: &ProgramFolder, args: &str) -> (bool, bool) {
    let done = folder.run(&format!("render {args} --set floor.on=false -o out.png --transparent"));
    assert_eq!(done.code, Some(0), "{done:?}");
    let shows = pixels(&folder.path("out.png")).2.iter().any(|pixel| pixel[3] > 4);
    (shows, done.stderr.contains("nothing of the volume is visible"))
}

/// 20 single voxels of 64³ are smaller than a first look is made for.
#[test]
fn a_picture_that_shows_nothing_is_not_written_without_a_word() {
    let folder = ProgramFolder::new();
    let specks = |n: usize| {
        let mut voxels = vec![0; n * n * n];
        (0..20).for_each(|speck| voxels[(speck * 7919 + 12_345) * 31 % (n * n * n)] = 1);
        let header = format!("NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: {n} {n} {n}\n\n");
        [header.into_bytes(), voxels].concat()
    };
    folder.write("specks.nrrd", specks(64));
    folder.write("fewer.nrrd", specks(128));
    for size in ["320x240", "64x48"] {
        for file in ["specks.nrrd", "fewer.nrrd"] {
            let (shows, warned) = is_visible_and_warned(&folder, &format!("{file} --size {size}"));
            assert!(shows != warned, "{file} at {size}: shows {shows}, warned {warned}");
        }
    }
    // The camera looks past the volume, so the picture is empty; or everything is transparent.
    let away = "builtin:sphere:16 --size 64x48 --set camera.target=[90,0,0]";
    assert_eq!(is_visible_and_warned(&folder, away), (false, true));
    let sphere = "builtin:sphere:16 --size 64x48";
    assert_eq!(is_visible_and_warned(&folder, sphere), (true, false));
}

#[test]
fn all_channels_of_a_file_are_shown_together() {
    let folder = ProgramFolder::new();
    let lines =
        "type: uint8\ndimension: 4\nsizes: 2 8 8 8\nkinds: vector domain domain domain\nencoding: raw";
    // Rises along x, and along y.
    let values = (0..1024).map(|at: usize| ([at / 2, at / 16][at % 2] % 8 * (30 - at / 128)) as u8);
    folder.write(
        "two.nrrd",
        [format!("NRRD0004\n{lines}\nspacings: nan 1 1 1\n\n").into_bytes(), values.collect()].concat(),
    );
    let options = "--size 32x24 --set layers.0.opacity_unit.voxels=4";
    folder.run_successfully(&format!("render two.nrrd --component 0 -o one.png {options}"));
    let both = format!("render two.nrrd --component 0 --all-channels -o both.png --report r.json {options}");
    folder.run_successfully(&both);
    assert_eq!(folder.json("r.json")["settings"]["layers"].as_array().map(Vec::len), Some(2));
    assert!(pixels(&folder.path("one.png")) != pixels(&folder.path("both.png")));
    assert!(folder.run_successfully("replay both.png --check").contains("identical"));
    let said = folder.run_failing("render builtin:sphere:16 --all-channels -o no.png --size 32x24", 2);
    assert!(said.contains("has a single channel"), "{said}");
}

/// A volume that fits is drawn through pages of its finest level, with a coarse one in memory, and looks the same.
#[test]
fn finer_levels_are_read_where_pixels_are_finer_than_voxels() {
    let folder = ProgramFolder::new();
    folder.run_successfully("convert builtin:chair:256 chair.ome.zarr");
    let look = "--size 200x150 --shadows off --set sky.intensity=0 --set sampling.kernel=prefiltered \
                --set camera.distance=1.5 --set opacity_unit={\"extent\":0.004}";
    folder.run_successfully(&format!("render chair.ome.zarr -o whole.png --level 0 {look}"));
    let again = "--session whole.png --size 200x150";
    folder.run_successfully(&format!("render chair.ome.zarr -o coarse.png --level 1 {again}"));
    folder.run_successfully(&format!("render chair.ome.zarr -o paged.png --pool 256MiB {again}"));
    let [whole, coarse, paged] = ["whole.png", "coarse.png", "paged.png"]
        .map(|name| image::open(folder.path(name)).expect("a picture").to_rgb8().into_raw());
    let distance = |picture: &[u8]| {
        let squares = picture.iter().zip(&whole).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
        (squares.sum::<f64>() / whole.len() as f64).sqrt()
    };
    let [coarse, paged] = [distance(&coarse), distance(&paged)];
    assert!(paged < 0.2 * coarse, "pages {paged:.2}, the coarse level alone {coarse:.2} of 255");
    let record = read_record(&folder.path("paged.png")).expect("a picture").expect("a record");
    assert!(record.contains(r#""finest": "0""#), "{record}");
    assert!(folder.run_successfully("replay paged.png --check --pool 256MiB").contains("identical"));
}

#[test]
fn a_level_that_does_not_fit_is_said() {
    let folder = ProgramFolder::new();
    folder.run_successfully("convert builtin:chair:256 chair.ome.zarr");
    let picture = "render chair.ome.zarr -o small.png --size 200x150 --pool 1MiB --set camera.distance=1.5";
    let outcome = folder.run(picture);
    assert!(
        outcome.code == Some(0) && outcome.stderr.contains("takes the place of a finer one"),
        "{outcome:?}"
    );
    // All of it, in parts, in memory for 27 of the pages; and again as it is recorded.
    let whole = "render chair.ome.zarr -o whole.png --size 200x150 --pool 64MiB --set camera.distance=1.5";
    folder.run_successfully(&format!("{whole} --require-full"));
    let parts = picture.replace("small.png", "parts.png").replace("1MiB", "32MiB");
    folder.run_successfully(&format!("{parts} --out-of-core --require-full"));
    assert!(pixels(&folder.path("parts.png")) == pixels(&folder.path("whole.png")));
    assert!(pixels(&folder.path("small.png")) != pixels(&folder.path("whole.png")));
    assert!(folder.run_successfully("replay parts.png --check --pool 32MiB").contains("identical"));
    let said = folder.run_failing(&format!("{picture} --force --out-of-core"), 5);
    assert!(said.contains("--pool allows more"), "{said}");
    let said = folder.run_failing(&format!("{picture} --force --require-full"), 1);
    assert!(said.contains("--pool"), "{said}");
    let said = folder.run_failing("render chair.ome.zarr -o small.png --force --pool lots", 2);
    assert!(said.contains("512MiB"), "{said}");
}
