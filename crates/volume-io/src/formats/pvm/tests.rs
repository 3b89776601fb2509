//! Tests of PVM volumes, packed and unpacked, and of packings with false sizes.

use glam::DVec3;
use tempfile::TempDir;

use super::*;
use crate::{LoadOptions, load as load_file};
use chiaroscuro_volume::{LoadControl, LoadErrorKind, Modality, Samples, VolumeChoice};

fn loaded_with(bytes: &[u8], budget: u64) -> Result<Volume, LoadError> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.pvm");
    std::fs::write(&path, bytes).unwrap();
    let options = LoadOptions {
        choice: VolumeChoice::default(),
        memory_budget_bytes: budget,
        ..LoadOptions::default()
    };
    load_file(&path, &options, &LoadControl::new())
}

fn loaded(bytes: &[u8]) -> Result<Volume, LoadError> {
    loaded_with(bytes, 1 << 20)
}

/// Bit writer, most significant bit first.
#[derive(Default)]
struct DdsBitWriter(Vec<bool>);

impl DdsBitWriter {
    fn put(&mut self, value: u32, width: u32) {
        self.0.extend((0..width).rev().map(|bit| value >> bit & 1 == 1));
    }

    fn bytes(&self) -> Vec<u8> {
        let mut padded = self.0.clone();
        padded.resize(padded.len().next_multiple_of(32), false);
        padded.chunks(8).map(|bits| bits.iter().fold(0, |byte, &bit| byte << 1 | u8::from(bit))).collect()
    }
}

/// Packs content as the format description has it: runs of up to 100 differences, each run with the bits that it
/// needs.
fn pack_dds(content: &[u8], interleaved: usize, line: usize, block: usize) -> Vec<u8> {
    let mark: &[u8] = if block == usize::MAX { b"DDS v3d\n" } else { b"DDS v3e\n" };
    let apart: Vec<u8> = content
        .chunks(block.min(content.len()))
        .flat_map(|block| (0..interleaved).flat_map(|at| block.iter().skip(at).step_by(interleaved)))
        .copied()
        .collect();
    let mut bits = DdsBitWriter::default();
    bits.put(interleaved as u32 - 1, 2);
    bits.put(line as u32 - 1, 16);
    let difference = |at: usize| {
        let last = if at > 0 { apart[at - 1] } else { 0 };
        let slope =
            if line > 1 && at > line { apart[at - line].wrapping_sub(apart[at - line - 1]) } else { 0 };
        apart[at].wrapping_sub(last).wrapping_sub(slope) as i8
    };
    let all: Vec<i8> = (0..apart.len()).map(difference).collect();
    for run in all.chunks(100) {
        let fits = |width: u32| {
            let half = (1i32 << width) / 2;
            run.iter().all(|&d| (-half..(1 << width) - half).contains(&i32::from(d)))
        };
        let width = [0, 2, 3, 4, 5, 6, 7, 8].into_iter().find(|&width| fits(width)).unwrap();
        bits.put(run.len() as u32, 7);
        bits.put(width.saturating_sub(1), 3);
        let half = (1i32 << width) / 2;
        for &d in run {
            bits.put((i32::from(d) + half) as u32, width);
        }
    }
    bits.put(0, 7);
    [mark, &bits.bytes()].concat()
}

#[test]
fn every_version_is_read_packed_or_not() {
    let bytes: Vec<u8> = (0..4 * 3 * 2 * 4).map(|n: u32| (n * n % 251) as u8).collect();
    let words: Vec<u16> = bytes.chunks(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
    let scale = DVec3::new(1.0, 1.0, 1.5);
    for (header, samples, spacing) in [
        ("PVM\n# a\n# b\n4 3 2\n1\n", Samples::U8(bytes[..24].to_vec()), DVec3::ONE),
        ("PVM2\n4 3 2\n1 1 1.5\n1\n", Samples::U8(bytes[..24].to_vec()), scale),
        ("PVM2\n4 3 2\n1 1 1.5\n2\n", Samples::U16(words[..24].to_vec()), scale),
        ("PVM3\n4 3 2\n1 1 1.5\n2\n", Samples::U16(words[..24].to_vec()), scale),
    ] {
        let count = samples.len() * if matches!(samples, Samples::U8(_)) { 1 } else { 2 };
        let plain = [header.as_bytes(), &bytes[..count], b"\0A CT scan\0somebody\0\0"].concat();
        let mut files = vec![plain.clone()];
        for (interleaved, line) in [(1, 1), (1, 4), (2, 4), (4, 7), (2, 65536)] {
            files.push(pack_dds(&plain, interleaved, line, usize::MAX));
            files.push(pack_dds(&plain, interleaved, line, interleaved << 24));
        }
        for file in files {
            let volume = loaded(&file).unwrap();
            assert_eq!((volume.dims(), volume.samples()), ([4, 3, 2], &samples), "{header}");
            assert_eq!((volume.spacing_mm(), volume.has_unknown_scale()), (spacing, true));
            let is_told = header.starts_with("PVM3") && file.starts_with(b"DDS");
            assert_eq!(volume.metadata().acquisition().is_some(), is_told);
            assert_eq!(volume.metadata().modality == Modality::Ct, is_told);
        }
    }
    // Without the run that ends the data: 7 bits, and the padding of the last 32.
    let whole = [b"PVM\n4 3 2\n1\n", &bytes[..24]].concat();
    let endless = pack_dds(&whole, 1, 4, usize::MAX);
    let cut = endless.iter().rposition(|&byte| byte != 0).unwrap() + 1;
    assert_eq!(*loaded(&endless[..cut]).unwrap().samples(), Samples::U8(bytes[..24].to_vec()));
    let colors = loaded(b"PVM\n1 2 1\n3\n\x09\x09\x09\x00\xff\x00").unwrap();
    assert_eq!(*colors.samples(), Samples::U8(vec![9, 182]));
    assert_eq!(colors.remarks().len(), 1);
}

#[test]
fn inconsistent_files_are_refused() {
    let good = b"PVM2\n4 3 2\n1 1 1\n1\n".to_vec();
    let whole = [good.clone(), (0..24u8).map(|n| n.wrapping_mul(37)).collect()].concat();
    let pack = pack_dds(&whole, 1, 4, usize::MAX);
    let zeros = [b"PVM\n1000 1000 1\n1\n".to_vec(), vec![0; 1_000_000]].concat();
    for (bytes, kind, words) in [
        (good.clone(), LoadErrorKind::BadInput, "24 bytes expected"),
        (pack[..pack.len() - 12].to_vec(), LoadErrorKind::BadInput, "truncated"),
        (pack[..9].to_vec(), LoadErrorKind::BadInput, "truncated"),
        (b"DDS v3d\n".to_vec(), LoadErrorKind::BadInput, "truncated"),
        (pack_dds(b"hello\n", 1, 1, usize::MAX), LoadErrorKind::BadInput, "\"hello\""),
        (b"PVM2\n4 x 2\n1 1 1\n1\n".to_vec(), LoadErrorKind::BadInput, "dimensions"),
        (b"PVM2\n4 3 2\n1 1\n1\n".to_vec(), LoadErrorKind::BadInput, "scale"),
        (b"PVM2\n4 3 2\n1 1 1\n5\n".to_vec(), LoadErrorKind::BadInput, "components"),
        (b"PVM\n0 3 2\n1\n".to_vec(), LoadErrorKind::BadInput, "empty"),
        (b"PVM\n-4 3 2\n1\n".to_vec(), LoadErrorKind::BadInput, "-4"),
        (b"PVM\n99999999 99999999 9\n1\n".to_vec(), LoadErrorKind::Limit, "allowed"),
        (b"PVM\n".to_vec(), LoadErrorKind::BadInput, "dimensions"),
    ] {
        let error = loaded(&bytes).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
    let error = loaded_with(&pack_dds(&zeros, 1, 1, usize::MAX), 10_000).unwrap_err();
    assert_eq!(error.kind(), LoadErrorKind::Limit, "{error}");
}
