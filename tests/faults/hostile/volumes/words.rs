//! Formats with text headers: each value is replaced by impossible ones, and each line is left out or repeated.

use super::Maker;
use crate::samples::kept;

/// Values that replace a value in a header.
const VALUES: [&str; 14] = [
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
struct Field {
    file: &'static str,
    after: &'static str,
    until: char,
}

const fn field(file: &'static str, after: &'static str, until: char) -> Field {
    Field { file, after, until }
}

const FIELDS: [Field; 49] = [
    field("digits.nrrd", "type: ", '\n'),
    field("digits.nrrd", "dimension: ", '\n'),
    field("digits.nrrd", "sizes: ", '\n'),
    field("digits.nrrd", "space: ", '\n'),
    field("digits.nrrd", "space directions: ", '\n'),
    field("digits.nrrd", "encoding: ", '\n'),
    field("packed.nrrd", "kinds: ", '\n'),
    field("packed.nrrd", "sizes: ", '\n'),
    field("plain.mha", "NDims = ", '\n'),
    field("plain.mha", "DimSize = ", '\n'),
    field("plain.mha", "ElementSpacing = ", '\n'),
    field("plain.mha", "ElementType = ", '\n'),
    field("plain.mha", "HeaderSize = ", '\n'),
    field("plain.mha", "ElementDataFile = ", '\n'),
    field("zipped.mha", "DimSize = ", '\n'),
    field("list.mhd", "TransformMatrix = ", '\n'),
    field("list.mhd", "Offset = ", '\n'),
    field("list.mhd", "ElementDataFile = ", '\n'),
    field("coded.vti", "header_type=\"", '"'),
    field("coded.vti", "compressor=\"", '"'),
    field("coded.vti", "WholeExtent=\"", '"'),
    field("coded.vti", "Piece Extent=\"", '"'),
    field("coded.vti", "Spacing=\"", '"'),
    field("coded.vti", "Direction=\"", '"'),
    field("coded.vti", "NumberOfComponents=\"", '"'),
    field("coded.vti", "offset=\"", '"'),
    field("coded.vti", "encoding=\"", '"'),
    field("appended.vti", "WholeExtent=\"", '"'),
    field("text.vtk", "DIMENSIONS ", '\n'),
    field("bytes.vtk", "DIMENSIONS ", '\n'),
    field("bytes.vtk", "SPACING ", '\n'),
    field("bytes.vtk", "ORIGIN ", '\n'),
    field("bytes.vtk", "POINT_DATA ", '\n'),
    field("bytes.vtk", "SCALARS values ", '\n'),
    field("density.cube", "density\n", '\n'),
    field("density.cube", "1 0 0 0\n", '\n'),
    field("described.dat", "Resolution: ", '\n'),
    field("described.dat", "Format: ", '\n'),
    field("described.dat", "ByteOffset: ", '\n'),
    field("described.dat", "Sequences: ", '\n'),
    field("described.ini", "dimx:", '\n'),
    field("described.ivf", "Dimension x=\"", '"'),
    field("cube.fits", "BITPIX  = ", '/'),
    field("cube.fits", "NAXIS   = ", '/'),
    field("cube.fits", "NAXIS3  = ", '/'),
    field("cube.fits", "BLANK   = ", ' '),
    field("cube.fits", "CDELT1  = ", ' '),
    field("array.npy", "'shape': (", ')'),
    field("array.npy", "'descr': '", '\''),
];

/// Index of some bytes within others.
pub(super) fn find(bytes: &[u8], wanted: &[u8]) -> Option<usize> {
    bytes.windows(wanted.len()).position(|found| found == wanted)
}

pub(super) fn add(made: &mut Maker) {
    let kept = kept();
    let of = |name: &str| kept.iter().find(|(kept, _)| *kept == name).expect("it is kept").1.clone();
    for Field { file, after, until } in &FIELDS {
        let bytes = of(file);
        let start =
            find(&bytes, after.as_bytes()).unwrap_or_else(|| panic!("{after} in {file}")) + after.len();
        let length = bytes[start..].iter().position(|&byte| byte == *until as u8).expect("an end");
        for value in VALUES {
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
