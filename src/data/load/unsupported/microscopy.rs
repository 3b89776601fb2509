//! Unsupported formats of microscopes and their software.

use super::UnsupportedFormat;
use super::mark::Mark;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a CZI file of Zeiss microscopes",
        marks: &[Mark::Bytes(0, b"ZISRAWFILE")],
        endings: &[".czi"],
        help: "convert it with Bio-Formats: bfconvert IN.czi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a LIF file of Leica microscopes",
        // A block of XML: its magic, its length, an asterisk, the number of characters, UTF-16.
        marks: &[Mark::Test(|look| {
            look.has(0, b"\x70\0\0\0") && look.has(8, b"\x2a") && look.has(13, b"<\0")
        })],
        endings: &[".lif", ".lof", ".xlef", ".xllf"],
        help: "convert it with Bio-Formats: bfconvert IN.lif OUT_%s.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "an ND2 file of Nikon microscopes",
        marks: &[Mark::Bytes(0, b"\xda\xce\xbe\x0a"), Mark::Named(0, b"\0\0\0\x0cjP  ", &[".nd2"])],
        endings: &[".nd2"],
        help: "convert it with Bio-Formats: bfconvert IN.nd2 OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "an OIF description of Olympus microscopes",
        marks: &[Mark::Named(0, b"\xff\xfe[\0", &[".oif"])],
        endings: &[".oif"],
        help: "convert it with Bio-Formats: bfconvert IN.oif OUT.ome.tif; or open the folder IN.oif.files, whose TIFF files \
               are its slices",
    },
    UnsupportedFormat {
        what: "a VSI file of Olympus microscopes",
        // The file itself is TIFF without the images, which lie in a folder beside it.
        marks: &[],
        endings: &[".vsi", ".ets"],
        help: "convert it with Bio-Formats: bfconvert IN.vsi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a Digital Micrograph file of Gatan",
        // Only the version number, which is not specific enough without the extension.
        marks: &[Mark::Named(0, b"\0\0\0\x03", &[".dm3"]), Mark::Named(0, b"\0\0\0\x04", &[".dm4"])],
        endings: &[".dm3", ".dm4"],
        help: "convert it with IMOD: dm2mrc IN.dm4 OUT.mrc, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a JPEG 2000 picture",
        marks: &[Mark::Bytes(0, b"\0\0\0\x0cjP  \r\n\x87\n"), Mark::Bytes(0, b"\xff\x4f\xff\x51\0")],
        endings: &[],
        help: "convert it, and the others of its series: opj_decompress -i IN.jp2 -o OUT.tif, then open their folder",
    },
];
