//! Unsupported archives and compression formats.

use super::UnsupportedFormat;
use super::signature::FormatSignature;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "a ZIP archive of an OME-Zarr image",
        signatures: &[
            FormatSignature::Container(0, b"PK\x03\x04", b".zattrs"),
            FormatSignature::Container(0, b"PK\x03\x04", b".zarray"),
            FormatSignature::Container(0, b"PK\x03\x04", b".zgroup"),
            FormatSignature::Container(0, b"PK\x03\x04", b"zarr.json"),
        ],
        extensions: &[],
        advice: "rename it to IN.zarr.zip, by which it is recognised, or unpack it and open the folder",
    },
    UnsupportedFormat {
        description: "a ZIP archive",
        signatures: &[FormatSignature::Bytes(0, b"PK\x03\x04"), FormatSignature::Bytes(0, b"PK\x05\x06")],
        extensions: &[],
        advice: "unpack it (unzip IN.zip -d FOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        description: "a tar archive",
        signatures: &[FormatSignature::Bytes(257, b"ustar")],
        extensions: &[".tar", ".tar.gz", ".tgz"],
        advice: "unpack it (mkdir FOLDER; tar -xf IN.tar -C FOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        description: "a 7-Zip archive",
        signatures: &[FormatSignature::Bytes(0, b"7z\xbc\xaf\x27\x1c")],
        extensions: &[],
        advice: "unpack it (7z x IN.7z -oFOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        description: "a RAR archive",
        signatures: &[FormatSignature::Bytes(0, b"Rar!\x1a\x07")],
        extensions: &[],
        advice: "unpack it (unrar x IN.rar FOLDER/), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        description: "packed with xz",
        signatures: &[FormatSignature::Bytes(0, b"\xfd7zXZ\0")],
        extensions: &[],
        advice: "unpack it: xz -dk IN.xz",
    },
    UnsupportedFormat {
        description: "packed with Zstandard",
        signatures: &[FormatSignature::Bytes(0, b"\x28\xb5\x2f\xfd")],
        extensions: &[],
        advice: "unpack it: zstd -d IN.zst",
    },
    UnsupportedFormat {
        description: "packed with bzip2",
        // Magic of the first block: the digits of pi.
        signatures: &[FormatSignature::Test(|look| {
            look.has_at(0, b"BZh") && look.has_at(4, b"\x31\x41\x59\x26\x53\x59")
        })],
        extensions: &[],
        advice: "unpack it: bunzip2 -k IN.bz2",
    },
    UnsupportedFormat {
        description: "packed with LZ4",
        signatures: &[FormatSignature::Bytes(0, b"\x04\x22\x4d\x18")],
        extensions: &[],
        advice: "unpack it: lz4 -d IN.lz4 OUT",
    },
    UnsupportedFormat {
        description: "packed with compress",
        signatures: &[FormatSignature::BytesWithExtension(0, b"\x1f\x9d", &[".z"])],
        extensions: &[],
        advice: "unpack it: uncompress IN.Z, or gunzip IN.Z",
    },
];
