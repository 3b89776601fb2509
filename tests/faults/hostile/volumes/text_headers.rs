//! Formats with text headers: each value is replaced by impossible ones, and each line is left out or repeated.

use super::BrokenVolumeMaker;
use crate::samples::stored_samples;

/// Values that replace a value in a header.
const IMPOSSIBLE_TEXTS: [&str; 14] = [
    "",
    "-1",
    "0",
    "0 0 0",
    "-3 -3 -3",
    "nan nan nan",
    "inf 1 1",
    "1e999",
    "4294967296 4294967296 1",
    "18446744073709551616",
    "99999999 99999999 99999999",
    "99999999999999999999999999999999 1 1",
    "eight",
    "\u{202e}\u{7}\u{0}",
];

/// Position of a value in a header: after one mark, up to another.
struct TextField {
    file: &'static str,
    after: &'static str,
    until: char,
}

const fn text_field(file: &'static str, after: &'static str, until: char) -> TextField {
    TextField { file, after, until }
}

const TEXT_FIELDS: [TextField; 49] = [
    text_field("digits.nrrd", "type: ", '\n'),
    text_field("digits.nrrd", "dimension: ", '\n'),
    text_field("digits.nrrd", "sizes: ", '\n'),
    text_field("digits.nrrd", "space: ", '\n'),
    text_field("digits.nrrd", "space directions: ", '\n'),
    text_field("digits.nrrd", "encoding: ", '\n'),
    text_field("packed.nrrd", "kinds: ", '\n'),
    text_field("packed.nrrd", "sizes: ", '\n'),
    text_field("plain.mha", "NDims = ", '\n'),
    text_field("plain.mha", "DimSize = ", '\n'),
    text_field("plain.mha", "ElementSpacing = ", '\n'),
    text_field("plain.mha", "ElementType = ", '\n'),
    text_field("plain.mha", "HeaderSize = ", '\n'),
    text_field("plain.mha", "ElementDataFile = ", '\n'),
    text_field("zipped.mha", "DimSize = ", '\n'),
    text_field("list.mhd", "TransformMatrix = ", '\n'),
    text_field("list.mhd", "Offset = ", '\n'),
    text_field("list.mhd", "ElementDataFile = ", '\n'),
    text_field("coded.vti", "header_type=\"", '"'),
    text_field("coded.vti", "compressor=\"", '"'),
    text_field("coded.vti", "WholeExtent=\"", '"'),
    text_field("coded.vti", "Piece Extent=\"", '"'),
    text_field("coded.vti", "Spacing=\"", '"'),
    text_field("coded.vti", "Direction=\"", '"'),
    text_field("coded.vti", "NumberOfComponents=\"", '"'),
    text_field("coded.vti", "offset=\"", '"'),
    text_field("coded.vti", "encoding=\"", '"'),
    text_field("appended.vti", "WholeExtent=\"", '"'),
    text_field("text.vtk", "DIMENSIONS ", '\n'),
    text_field("bytes.vtk", "DIMENSIONS ", '\n'),
    text_field("bytes.vtk", "SPACING ", '\n'),
    text_field("bytes.vtk", "ORIGIN ", '\n'),
    text_field("bytes.vtk", "POINT_DATA ", '\n'),
    text_field("bytes.vtk", "SCALARS values ", '\n'),
    text_field("density.cube", "density\n", '\n'),
    text_field("density.cube", "1 0 0 0\n", '\n'),
    text_field("described.dat", "Resolution: ", '\n'),
    text_field("described.dat", "Format: ", '\n'),
    text_field("described.dat", "ByteOffset: ", '\n'),
    text_field("described.dat", "Sequences: ", '\n'),
    text_field("described.ini", "dimx:", '\n'),
    text_field("described.ivf", "Dimension x=\"", '"'),
    text_field("cube.fits", "BITPIX  = ", '/'),
    text_field("cube.fits", "NAXIS   = ", '/'),
    text_field("cube.fits", "NAXIS3  = ", '/'),
    text_field("cube.fits", "BLANK   = ", ' '),
    text_field("cube.fits", "CDELT1  = ", ' '),
    text_field("array.npy", "'shape': (", ')'),
    text_field("array.npy", "'descr': '", '\''),
];

/// Index of some bytes within others.
pub(super) fn find_bytes(bytes: &[u8], wanted: &[u8]) -> Option<usize> {
    bytes.windows(wanted.len()).position(|found| found == wanted)
}

pub(super) fn add_text_headers(made: &mut BrokenVolumeMaker) {
    let kept = stored_samples();
    let of = |name: &str| kept.iter().find(|(kept, _)| *kept == name).expect("it is kept").1.clone();
    for TextField { file, after, until } in &TEXT_FIELDS {
        let bytes = of(file);
        let start =
            find_bytes(&bytes, after.as_bytes()).unwrap_or_else(|| panic!("{after} in {file}")) + after.len();
        let length = bytes[start..].iter().position(|&byte| byte == *until as u8).expect("an end");
        for value in IMPOSSIBLE_TEXTS {
            let changed = [&bytes[..start], value.as_bytes(), &bytes[start + length..]].concat();
            made.add(format!("{after:?} is {value:?}"), file, &changed);
        }
        let long = [&bytes[..start], "7 ".repeat(50_000).as_bytes(), &bytes[start + length..]].concat();
        made.add(format!("{after:?} is endless"), file, &long);
    }
    for file in [
        "digits.nrrd",
        "plain.mha",
        "list.mhd",
        "bytes.vtk",
        "described.dat",
        "described.ini",
        "density.cube",
    ] {
        let bytes = of(file);
        let ends: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b'\n').take(9).collect();
        for lines in ends.windows(2) {
            let (start, end) = (lines[0] + 1, lines[1] + 1);
            made.add(
                format!("without bytes {start} to {end}"),
                file,
                &[&bytes[..start], &bytes[end..]].concat(),
            );
            made.add(
                format!("bytes {start} to {end} are there twice"),
                file,
                &[&bytes[..end], &bytes[start..]].concat(),
            );
        }
    }
}
