//! Unsupported archives and compression formats.

use super::UnsupportedFormat;
use super::mark::Mark;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a ZIP archive of an OME-Zarr image",
        marks: &[
            Mark::Holding(0, b"PK\x03\x04", b".zattrs"),
            Mark::Holding(0, b"PK\x03\x04", b".zarray"),
            Mark::Holding(0, b"PK\x03\x04", b".zgroup"),
            Mark::Holding(0, b"PK\x03\x04", b"zarr.json"),
            Mark::Named(0, b"PK", &[".zarr.zip", ".ozx"]),
        ],
        endings: &[],
        help: "save an array of it: python -c \"import zarr, numpy; \
               numpy.save('OUT.npy', zarr.open(zarr.storage.ZipStore('IN.zip', mode='r'), mode='r')['0'][:])\"",
    },
    UnsupportedFormat {
        what: "a ZIP archive",
        marks: &[Mark::Bytes(0, b"PK\x03\x04"), Mark::Bytes(0, b"PK\x05\x06")],
        endings: &[],
        help: "unpack it (unzip IN.zip -d FOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        what: "a tar archive",
        marks: &[Mark::Bytes(257, b"ustar")],
        endings: &[".tar", ".tar.gz", ".tgz"],
        help: "unpack it (mkdir FOLDER; tar -xf IN.tar -C FOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        what: "a 7-Zip archive",
        marks: &[Mark::Bytes(0, b"7z\xbc\xaf\x27\x1c")],
        endings: &[],
        help: "unpack it (7z x IN.7z -oFOLDER), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        what: "a RAR archive",
        marks: &[Mark::Bytes(0, b"Rar!\x1a\x07")],
        endings: &[],
        help: "unpack it (unrar x IN.rar FOLDER/), and open what is in it: a file, or the folder of slices",
    },
    UnsupportedFormat {
        what: "packed with xz",
        marks: &[Mark::Bytes(0, b"\xfd7zXZ\0")],
        endings: &[],
        help: "unpack it: xz -dk IN.xz",
    },
    UnsupportedFormat {
        what: "packed with Zstandard",
        marks: &[Mark::Bytes(0, b"\x28\xb5\x2f\xfd")],
        endings: &[],
        help: "unpack it: zstd -d IN.zst",
    },
    UnsupportedFormat {
        what: "packed with bzip2",
        // Magic of the first block: the digits of pi.
        marks: &[Mark::Test(|look| look.has(0, b"BZh") && look.has(4, b"\x31\x41\x59\x26\x53\x59"))],
        endings: &[],
        help: "unpack it: bunzip2 -k IN.bz2",
    },
    UnsupportedFormat {
        what: "packed with LZ4",
        marks: &[Mark::Bytes(0, b"\x04\x22\x4d\x18")],
        endings: &[],
        help: "unpack it: lz4 -d IN.lz4 OUT",
    },
    UnsupportedFormat {
        what: "packed with compress",
        marks: &[Mark::Named(0, b"\x1f\x9d", &[".z"])],
        endings: &[],
        help: "unpack it: uncompress IN.Z, or gunzip IN.Z",
    },
];
