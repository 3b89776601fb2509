//! Tests of light on the command line: attenuation as a volume and as slices, and environment maps.

use image::{Rgb, Rgb32FImage};
use serde_json::Value;

use crate::program::ProgramFolder;

#[test]
fn an_attenuation_volume_can_be_loaded_back() {
    let folder = ProgramFolder::new();
    folder.run_successfully("light-volume builtin:box:16 -o l.nrrd");
    assert_eq!(folder.names(), ["l.nrrd"]);
    let facts: Value =
        serde_json::from_str(&folder.run_successfully("info l.nrrd --json")).expect("valid JSON");
    let source: Value =
        serde_json::from_str(&folder.run_successfully("info builtin:box:16 --json")).expect("valid JSON");
    assert_eq!(facts["type"], "float32");
    assert_eq!(facts["dims"], source["dims"]);
    assert_eq!(facts["spacing_mm"], source["spacing_mm"]);
    assert_eq!(facts["non_finite_voxels"], 0);
    let (low, high) = (facts["range"][0].as_f64(), facts["range"][1].as_f64());
    let (low, high) = (low.expect("a number"), high.expect("a number"));
    assert!(0.0 <= low && high <= 1.0, "attenuation lies between 0 and 1: {low} … {high}");
    assert!(low < 0.5 && high > 0.9, "the box casts a shadow: {low} … {high}");
}

#[test]
fn a_slice_of_light_is_a_picture_in_false_colours() {
    let folder = ProgramFolder::new();
    folder.run_successfully(
        "light-volume builtin:sphere:16 -o slice.png --slice y:4 --set shadows.resolution=half",
    );
    let slice = image::open(folder.path("slice.png")).expect("a picture").to_rgb8();
    assert_eq!(slice.dimensions(), (8, 8));
    let luma = |pixel: &image::Rgb<u8>| pixel.0.iter().map(|&c| u32::from(c)).sum::<u32>();
    let (dark, bright) = slice.pixels().map(luma).fold((u32::MAX, 0), |(a, b), l| (a.min(l), b.max(l)));
    assert!(dark < 300 && bright > 500, "a ball has a lit and a dark side: {dark} … {bright}");
}

/// Environment map with a grey sky over brown ground, and a lamp on the right.
fn panorama() -> Rgb32FImage {
    Rgb32FImage::from_fn(128, 64, |x, y| match (x, y) {
        (94..=97, 20..=23) => Rgb([900.0, 800.0, 500.0]),
        (_, 0..32) => Rgb([0.6, 0.7, 0.9]),
        _ => Rgb([0.3, 0.2, 0.1]),
    })
}

#[test]
fn a_panorama_lights_the_scene_by_its_gradient_and_its_brightest_light() {
    let folder = ProgramFolder::new();
    panorama().save(folder.path("room.hdr")).expect("the folder can be written to");
    folder.run_successfully(
        "render builtin:chair:32 -o out.png --size 64x48 --surroundings room.hdr --report out.json --set sky.tilt_deg=5",
    );
    let report = folder.json("out.json");
    let settings = &report["settings"];
    let number = |path: &str| settings.pointer(path).and_then(Value::as_f64).unwrap_or(f64::NAN);
    assert_eq!(settings["sky"]["mode"], "picture");
    assert_eq!(settings["sky"]["picture"]["name"], "room.hdr");
    assert_eq!(number("/sky/tilt_deg"), 5.0, "single settings are laid over it");
    assert!(number("/sky/picture/slope/2/2") > 0.0, "brighter from above: {settings}");
    let lights = settings["lights"].as_array().expect("lights");
    assert_eq!(lights[0]["name"], "Surroundings");
    assert!(number("/lights/0/color/0") > number("/lights/0/color/2"), "a warm lamp: {settings}");
    assert!(lights[1..].iter().all(|light| light["on"] == false), "others are switched off");
    // The picture alone is enough to render it again.
    std::fs::remove_file(folder.path("room.hdr")).expect("it is ours");
    folder.run_successfully("replay out.png -o again.png");
    assert!(folder.read("out.png") == folder.read("again.png"), "the same picture");
}

#[test]
fn other_pictures_are_refused_before_anything_is_drawn() {
    let folder = ProgramFolder::new();
    image::RgbImage::new(8, 8).save(folder.path("square.png")).expect("the folder can be written to");
    folder.write("text.hdr", "no picture");
    let render = |file: &str| format!("render builtin:chair:16 -o out.png --size 8x8 --surroundings {file}");
    assert!(folder.run_failing(&render("square.png"), 3).contains("twice as wide as high"));
    assert!(folder.run_failing(&render("text.hdr"), 3).contains("text.hdr"));
    folder.run_failing(&render("missing.hdr"), 6);
    panorama().save(folder.path("room.hdr")).expect("the folder can be written to");
    let said = folder
        .run_failing("render builtin:chair:16 -o room.hdr --size 8x8 --surroundings room.hdr --force", 2);
    assert!(said.contains("room.hdr"), "{said}");
}
