//! Tests of TIFF files that are truncated, inconsistent, or of unsupported kinds.

use super::writer::{LITTLE, LONG, SHORT, TiffLeaf, TiffWriter};
use super::{assert_refused, load_bytes};
use crate::formats::pictures::tiff::file::page::tag;
use crate::{Endian, LoadOptions, load};
use chiaroscuro_volume::{LoadControl, LoadErrorKind};

fn leaf() -> TiffLeaf {
    LITTLE.leaf([2, 2], 8, &[1, 2, 3, 4])
}

#[test]
fn files_that_end_anywhere_are_refused() {
    for writer in [LITTLE, TiffWriter { endian: Endian::Big, is_big: true }] {
        let page = writer.leaf([2, 2], 8, &[1, 2, 3, 4]);
        let whole = writer.file(&[page.clone().with_text(tag::DESCRIPTION, "some words"), page]);
        load_bytes(&whole).unwrap();
        for len in 8..whole.len() {
            assert_refused(load_bytes(&whole[..len]), LoadErrorKind::BadInput, &["copy the file again"]);
        }
    }
}

#[test]
fn lists_of_pages_that_lead_nowhere() {
    let mut circle = LITTLE.file(&[leaf(), leaf()]);
    let first = circle[4..8].to_vec();
    let end = circle.len() - 4;
    circle[end..].copy_from_slice(&first);
    assert_refused(load_bytes(&circle), LoadErrorKind::BadInput, &["leads back"]);
    assert_refused(load_bytes(b"II*\0\0\0\0\0"), LoadErrorKind::BadInput, &["no pages"]);
    assert_refused(load_bytes(b"II*\0\xff\xff\xff\xff"), LoadErrorKind::BadInput, &["truncated"]);
    let many = [b"II*\0\x08\0\0\0".to_vec(), vec![0xFF; 2], vec![0; 100]].concat();
    assert_refused(load_bytes(&many), LoadErrorKind::BadInput, &["invalid values"]);
}

#[test]
fn sizes_that_cannot_be_are_refused_before_anything_is_allocated() {
    let huge = |[width, height]: [u64; 2]| {
        leaf().with(tag::WIDTH, LONG, &[width]).with(tag::HEIGHT, LONG, &[height])
    };
    for (leaf, kind, words) in [
        (huge([1 << 31, 1 << 31]), LoadErrorKind::Limit, "allowed"),
        (huge([0, 2]), LoadErrorKind::BadInput, "invalid values"),
        (huge([1000, 1000]), LoadErrorKind::BadInput, "truncated"),
        (leaf().with(tag::SAMPLES, LONG, &[1 << 30]), LoadErrorKind::BadInput, "invalid values"),
        (leaf().with(tag::SAMPLES, SHORT, &[60_000]), LoadErrorKind::BadInput, "60000 channels"),
        (
            leaf().with_tiles([1 << 15, 1 << 15], vec![vec![0; 4]]),
            LoadErrorKind::BadInput,
            "tile size of 32768 x 32768",
        ),
        (
            leaf().with(tag::ROWS_PER_STRIP, SHORT, &[1]),
            LoadErrorKind::BadInput,
            "2 strips or tiles are needed",
        ),
        (leaf().with(tag::DEPTH, SHORT, &[2]), LoadErrorKind::BadInput, "ImageDepth"),
        (leaf().with(tag::ROWS_PER_STRIP, SHORT, &[0]), LoadErrorKind::BadInput, "invalid values"),
    ] {
        assert_refused(load_bytes(&LITTLE.file(&[leaf])), kind, &[words]);
    }
}

#[test]
fn kinds_that_are_not_read_are_named() {
    for (leaf, words) in [
        (leaf().with(tag::COMPRESSION, SHORT, &[7]).with(tag::BITS, SHORT, &[12]), "these have 12"),
        (leaf().with(tag::COMPRESSION, SHORT, &[34712]), "JPEG 2000"),
        (leaf().with(tag::COMPRESSION, SHORT, &[34925]), "LZMA"),
        (leaf().with(tag::COMPRESSION, SHORT, &[4]), "fax"),
        (leaf().with(tag::COMPRESSION, SHORT, &[999]), "number 999"),
        (leaf().with(tag::PHOTOMETRIC, SHORT, &[5]), "CMYK"),
        (leaf().with(tag::SAMPLE_FORMAT, SHORT, &[6]), "complex"),
        (leaf().with(tag::BITS, SHORT, &[24]), "24 bits"),
        (leaf().with(tag::PREDICTOR, SHORT, &[3]), "predictor 3"),
        (leaf().with(tag::PREDICTOR, SHORT, &[9]), "predictor 9"),
    ] {
        assert_refused(load_bytes(&LITTLE.file(&[leaf])), LoadErrorKind::BadInput, &[words]);
    }
    let mixed = leaf().with(tag::SAMPLES, SHORT, &[2]).with(tag::BITS, SHORT, &[8, 16]);
    assert_refused(load_bytes(&LITTLE.file(&[mixed])), LoadErrorKind::BadInput, &["invalid values"]);
}

#[test]
fn compressed_parts_that_are_broken_or_short() {
    for compression in [5, 7, 8, 32773, 50000] {
        for part in [vec![0x55; 30], vec![0]] {
            let leaf = LITTLE.leaf([9, 9], 8, &part).with(tag::COMPRESSION, SHORT, &[compression]);
            let refused = load_bytes(&LITTLE.file(&[leaf]));
            assert_refused(refused, LoadErrorKind::BadInput, &["page 0", "strip or tile"]);
        }
    }
}

#[test]
fn a_part_that_was_never_written_is_empty() {
    let leaf = leaf().with_rows_per_strip(1, vec![vec![5, 6], Vec::new()]);
    let volume = load_bytes(&LITTLE.file(&[leaf])).unwrap();
    assert_eq!(*volume.samples(), chiaroscuro_volume::Samples::U8(vec![5, 6, 0, 0]));
}

#[test]
fn the_same_bytes_over_and_over_are_no_strips() {
    // 4 MiB that all of 64 strips share: 128 MiB to read, for a page of 64 MiB.
    let bytes = vec![0x55; 4 << 20];
    let file = {
        let leaf = LITTLE.leaf([1 << 20, 64], 8, &bytes).with(tag::COMPRESSION, SHORT, &[8]);
        let counts = vec![bytes.len() as u64 / 2; 64];
        let leaf = leaf.with(tag::ROWS_PER_STRIP, SHORT, &[1]).with(tag::STRIP_OFFSETS, LONG, &[8; 64]);
        LITTLE.file(&[leaf.with(tag::STRIP_COUNTS, LONG, &counts)])
    };
    let options = LoadOptions::default();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("same.tif");
    std::fs::write(&path, file).unwrap();
    let refused = load(&path, &options, &LoadControl::new());
    assert_refused(refused, LoadErrorKind::BadInput, &["page 0", "share the same bytes"]);
}
