//! The attenuation of light as a volume, and slices of it.

use serde_json::Value;

use crate::program::Folder;

#[test]
fn an_attenuation_volume_can_be_loaded_back() {
    let folder = Folder::new();
    folder.succeed("light-volume builtin:box:16 -o l.nrrd");
    assert_eq!(folder.names(), ["l.nrrd"]);
    let facts: Value = serde_json::from_str(&folder.succeed("info l.nrrd --json")).expect("valid JSON");
    let source: Value =
        serde_json::from_str(&folder.succeed("info builtin:box:16 --json")).expect("valid JSON");
    assert_eq!(facts["type"], "float32");
    assert_eq!(facts["dims"], source["dims"]);
    assert_eq!(facts["spacing_mm"], source["spacing_mm"]);
    assert_eq!(facts["non_finite_voxels"], 0);
    let (low, high) = (facts["range"][0].as_f64(), facts["range"][1].as_f64());
    let (low, high) = (low.expect("a number"), high.expect("a number"));
    assert!(0.0 <= low && high <= 1.0, "light is never more than all of it: {low} … {high}");
    assert!(low < 0.5 && high > 0.9, "the box casts a shadow: {low} … {high}");
}

#[test]
fn a_slice_of_light_is_a_picture_in_false_colours() {
    let folder = Folder::new();
    folder.succeed("light-volume builtin:sphere:16 -o slice.png --slice y:4 --set shadows.resolution=half");
    let slice = image::open(folder.path("slice.png")).expect("a picture").to_rgb8();
    assert_eq!(slice.dimensions(), (8, 8));
    let luma = |pixel: &image::Rgb<u8>| pixel.0.iter().map(|&c| u32::from(c)).sum::<u32>();
    let (dark, bright) = slice.pixels().map(luma).fold((u32::MAX, 0), |(a, b), l| (a.min(l), b.max(l)));
    assert!(dark < 300 && bright > 500, "a ball has a lit and a dark side: {dark} … {bright}");
}
