//! Small test volumes, as bytes of a file.

use std::io::Write as _;

/// NRRD header of 8-bit voxels with these additional lines; spacing 1 mm unless they state it.
pub(crate) fn header(lines: &str) -> String {
    let spacings = if lines.contains("spac") { "" } else { "\nspacings: 1 1 1" };
    format!("NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\n{lines}{spacings}\n\n")
}

pub(crate) fn attached(lines: &str, voxels: usize) -> Vec<u8> {
    let mut bytes = header(lines).into_bytes();
    bytes.extend((0..voxels).map(|i| i as u8));
    bytes
}

pub(crate) fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("memory can be written to");
    encoder.finish().expect("memory can be written to")
}

/// Ball in a grid of 8³ voxels.
pub(crate) fn small_ball() -> Vec<u8> {
    let distance = |at: usize| {
        let p = [at % 8, at / 8 % 8, at / 64].map(|c| c as f64 - 3.5);
        p.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    (0..512).map(|at| if distance(at) < 3.0 { 200 } else { 0 }).collect()
}
