//! Checks of exported pictures and of JSON reports.

use std::path::Path;

use serde_json::Value;

/// Width, height and RGBA pixels of a PNG.
pub(crate) fn pixels(path: &Path) -> (u32, u32, Vec<[u8; 4]>) {
    let image = image::open(path).expect("a PNG that can be decoded").to_rgba8();
    (image.width(), image.height(), image.pixels().map(|pixel| pixel.0).collect())
}

pub(crate) fn assert_shows_something(path: &Path, size: [u32; 2]) {
    let (width, height, pixels) = pixels(path);
    assert_eq!([width, height], size);
    let middle = pixels[(height / 2 * width + width / 2) as usize];
    assert_ne!(middle, pixels[0], "the middle of the picture must differ from its corner");
}

pub(crate) fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<_> = value.as_object().expect("an object").keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

pub(crate) fn assert_has_keys(value: &Value, expected: &[&str]) {
    for key in expected {
        assert!(keys(value).contains(key), "{key} is missing in {:?}", keys(value));
    }
}
