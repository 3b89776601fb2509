//! Files that contain no volume: documents, films, web pages, and placeholders of data that were not fetched.

use super::UnsupportedFormat;
use super::mark::Mark;

/// Command that extracts the frames of a film.
const FRAMES: &str = "make slices of its pictures: ffmpeg -i IN slices/%04d.png, and open their folder";

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a pointer of Git LFS in place of the data",
        marks: &[Mark::Words("version https://git-lfs.github.com/spec/")],
        endings: &[],
        help: "fetch the data: git lfs pull",
    },
    UnsupportedFormat {
        what: "a pointer of git-annex in place of the data",
        marks: &[Mark::Words("/annex/objects/")],
        endings: &[],
        help: "fetch the data: datalad get FILE, or git annex get FILE",
    },
    UnsupportedFormat {
        what: "a web page in place of the data",
        marks: &[Mark::Words("<!doctype html"), Mark::Words("<html")],
        endings: &[],
        help: "download the file again: what was saved is the page around it, or a message that it is not there",
    },
    UnsupportedFormat {
        what: "a PDF document",
        marks: &[Mark::Bytes(0, b"%PDF-")],
        endings: &[],
        help: "it is no volume: open the data that it is about; pictures in it are saved by pdfimages -png IN.pdf OUT",
    },
    UnsupportedFormat {
        what: "an Office document",
        marks: &[
            Mark::Holding(0, b"PK\x03\x04", b"[Content_Types].xml"),
            Mark::Holding(0, b"PK\x03\x04", b"vnd.oasis"),
        ],
        endings: &[".docx", ".xlsx", ".pptx"],
        help: "it is no volume: open the data that it is about",
    },
    UnsupportedFormat {
        what: "a film or picture of several (GIF)",
        marks: &[Mark::Bytes(0, b"GIF87a"), Mark::Bytes(0, b"GIF89a")],
        endings: &[],
        help: FRAMES,
    },
    UnsupportedFormat {
        what: "a film or picture (MPEG-4, HEIF, AVIF)",
        marks: &[Mark::Bytes(4, b"ftyp")],
        endings: &[],
        help: FRAMES,
    },
    UnsupportedFormat {
        what: "a film (AVI)",
        marks: &[Mark::Test(|look| look.has(0, b"RIFF") && look.has(8, b"AVI "))],
        endings: &[],
        help: FRAMES,
    },
    UnsupportedFormat {
        what: "a picture (WebP)",
        marks: &[Mark::Test(|look| look.has(0, b"RIFF") && look.has(8, b"WEBP"))],
        endings: &[],
        help: "convert it, and the others of its series: dwebp IN.webp -o OUT.png, then open their folder",
    },
];
