//! Files that contain no volume: documents, films, web pages, and placeholders of data that were not fetched.

use super::UnsupportedFormat;
use super::signature::FormatSignature;

/// Command that extracts the frames of a film.
const FRAMES: &str = "extract its frames (mkdir slices; ffmpeg -i IN slices/%04d.png), and open their folder";

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "a pointer of Git LFS in place of the data",
        signatures: &[FormatSignature::Text("version https://git-lfs.github.com/spec/")],
        extensions: &[],
        advice: "fetch the data: git lfs pull",
    },
    UnsupportedFormat {
        description: "a pointer of git-annex in place of the data",
        signatures: &[FormatSignature::Text("/annex/objects/")],
        extensions: &[],
        advice: "fetch the data: datalad get FILE, or git annex get FILE",
    },
    UnsupportedFormat {
        description: "a web page in place of the data",
        signatures: &[FormatSignature::Text("<!doctype html"), FormatSignature::Text("<html")],
        extensions: &[],
        advice: "download the file again: the page around it was saved, or an error message",
    },
    UnsupportedFormat {
        description: "a PDF document",
        signatures: &[FormatSignature::Bytes(0, b"%PDF-")],
        extensions: &[],
        advice: "it is not a volume: open the data that it describes; pdfimages -png IN.pdf OUT saves its pictures",
    },
    UnsupportedFormat {
        description: "an Office document",
        signatures: &[
            FormatSignature::Container(0, b"PK\x03\x04", b"[Content_Types].xml"),
            FormatSignature::Container(0, b"PK\x03\x04", b"vnd.oasis"),
        ],
        extensions: &[".docx", ".xlsx", ".pptx"],
        advice: "it is not a volume: open the data that it describes",
    },
    UnsupportedFormat {
        description: "an animation or picture (GIF)",
        signatures: &[FormatSignature::Bytes(0, b"GIF87a"), FormatSignature::Bytes(0, b"GIF89a")],
        extensions: &[],
        advice: FRAMES,
    },
    UnsupportedFormat {
        description: "a video or picture (MPEG-4, HEIF, AVIF)",
        signatures: &[FormatSignature::Bytes(4, b"ftyp")],
        extensions: &[],
        advice: FRAMES,
    },
    UnsupportedFormat {
        description: "a video (AVI)",
        signatures: &[FormatSignature::Test(|look| look.has_at(0, b"RIFF") && look.has_at(8, b"AVI "))],
        extensions: &[],
        advice: FRAMES,
    },
    UnsupportedFormat {
        description: "a picture (WebP)",
        signatures: &[FormatSignature::Test(|look| look.has_at(0, b"RIFF") && look.has_at(8, b"WEBP"))],
        extensions: &[],
        advice: "convert it, and the others of its series: dwebp IN.webp -o OUT.png, then open their folder",
    },
];
