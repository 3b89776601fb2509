//! Files that are truncated, under a wrong extension, or empty.

use super::BrokenVolumeMaker;
use crate::samples::stored_samples;

/// Extensions of the formats.
const EXTENSIONS: [&str; 19] = [
    "nrrd", "nhdr", "nii", "nii.gz", "hdr", "dcm", "mha", "mhd", "tif", "png", "vti", "vtk", "mrc", "npy",
    "npz", "cube", "pvm", "mgz", "fits",
];

pub(super) fn add_truncations(made: &mut BrokenVolumeMaker) {
    for (name, bytes) in stored_samples() {
        // Within the header, between header and data, and within the data.
        let length = bytes.len();
        for cut in [1, 2, 5, 12, length / 4, length / 2, length * 7 / 8, length - 1] {
            made.add(format!("cut after {cut} bytes"), name, &bytes[..cut.min(length)]);
        }
        let own = name.split_once('.').map_or("", |(_, ending)| ending);
        for ending in EXTENSIONS.into_iter().filter(|ending| *ending != own) {
            made.add(format!("{name} under another ending"), &format!("other.{ending}"), &bytes);
        }
        let twice = [bytes.as_slice(), bytes.as_slice()].concat();
        made.add("twice", name, &twice);
        // With the line endings of a transfer as text.
        let as_text: Vec<u8> = bytes
            .iter()
            .flat_map(|&byte| if byte == b'\n' { vec![b'\r', b'\n'] } else { vec![byte] })
            .collect();
        made.add("with other ends of lines", name, &as_text);
        let zeros: Vec<u8> =
            bytes.iter().enumerate().map(|(at, &b)| if at < length / 2 { b } else { 0 }).collect();
        made.add("of zeros from its middle on", name, &zeros);
    }
    for ending in EXTENSIONS.into_iter().chain(["raw", "dat", "ini", "ivf", "jpg", "bmp", "map", "x", "gz"]) {
        let name = format!("nothing.{ending}");
        made.add("empty", &name, b"");
        made.add("one byte", &name, b"N");
        made.add("zeros", &name, &[0; 2048]);
        made.add("ones", &name, &[0xff; 2048]);
        made.add("lines without an end", &name, &vec![b'a'; 1 << 18]);
    }
}
