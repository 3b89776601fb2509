//! Unsupported formats of microscopes and their software.

use super::UnsupportedFormat;
use super::signature::FormatSignature;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "a CZI file of Zeiss microscopes",
        signatures: &[FormatSignature::Bytes(0, b"ZISRAWFILE")],
        extensions: &[".czi"],
        advice: "convert it with Bio-Formats: bfconvert IN.czi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a LIF file of Leica microscopes",
        // A block of XML: its magic, its length, an asterisk, the number of characters, UTF-16.
        signatures: &[FormatSignature::Test(|look| {
            look.has_at(0, b"\x70\0\0\0") && look.has_at(8, b"\x2a") && look.has_at(13, b"<\0")
        })],
        extensions: &[".lif", ".lof", ".xlef", ".xllf"],
        advice: "convert it with Bio-Formats: bfconvert IN.lif OUT_%s.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "an ND2 file of Nikon microscopes",
        signatures: &[
            FormatSignature::Bytes(0, b"\xda\xce\xbe\x0a"),
            FormatSignature::BytesWithExtension(0, b"\0\0\0\x0cjP  ", &[".nd2"]),
        ],
        extensions: &[".nd2"],
        advice: "convert it with Bio-Formats: bfconvert IN.nd2 OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "an OIF description of Olympus microscopes",
        signatures: &[FormatSignature::BytesWithExtension(0, b"\xff\xfe[\0", &[".oif"])],
        extensions: &[".oif"],
        advice: "convert it with Bio-Formats: bfconvert IN.oif OUT.ome.tif; or open the folder IN.oif.files, whose TIFF files \
               are its slices",
    },
    UnsupportedFormat {
        description: "a VSI file of Olympus microscopes",
        // The file itself is TIFF without the images, which lie in a folder beside it.
        signatures: &[],
        extensions: &[".vsi", ".ets"],
        advice: "convert it with Bio-Formats: bfconvert IN.vsi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a Digital Micrograph file of Gatan",
        // Only the version number, which is not specific enough without the extension.
        signatures: &[
            FormatSignature::BytesWithExtension(0, b"\0\0\0\x03", &[".dm3"]),
            FormatSignature::BytesWithExtension(0, b"\0\0\0\x04", &[".dm4"]),
        ],
        extensions: &[".dm3", ".dm4"],
        advice: "convert it with IMOD: dm2mrc IN.dm4 OUT.mrc, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a JPEG 2000 picture",
        signatures: &[
            FormatSignature::Bytes(0, b"\0\0\0\x0cjP  \r\n\x87\n"),
            FormatSignature::Bytes(0, b"\xff\x4f\xff\x51\0"),
        ],
        extensions: &[],
        advice: "convert it, and the others of its series: opj_decompress -i IN.jp2 -o OUT.tif, then open their folder",
    },
];
