//! Tests that the layout of built-in volumes is detected however they are written, and that noise is not taken for a
//! volume.

use rayon::prelude::*;

use super::*;
use crate::Endian;
use crate::formats::raw::RawLayout;
use chiaroscuro_volume::{
    Volume, VoxelType,
    synthetic::{BUILTIN_NAMES, builtin},
};

/// Volume to write, and the layout to write it in.
#[derive(Debug, Clone, Copy)]
struct DetectionCase {
    name: &'static str,
    dims: [usize; 3],
    voxel_type: VoxelType,
    endian: Endian,
    header: usize,
}

/// Grid shapes without common edges.
const SHAPES: [[usize; 3]; 5] = [[96, 75, 70], [65, 90, 83], [80, 72, 98], [102, 102, 77], [105, 78, 83]];

/// Length of a header that no format has, in bytes.
const UNUSUAL_HEADER_BYTES: usize = 1000;

/// Lengths of headers: none, usual ones, and the unusual one.
const HEADERS: [usize; 6] = [0, 352, 0, 512, 1024, UNUSUAL_HEADER_BYTES];

/// Returns the built-in volumes of measured values: layouts are found by how alike neighbours are, which says little of
/// labels.
fn measured_names() -> impl Iterator<Item = &'static str> {
    BUILTIN_NAMES.into_iter().filter(|name| *name != "stained_glass")
}

/// Test cases: every built-in volume in every type, with byte orders, headers and shapes in turn.
fn cases() -> Vec<DetectionCase> {
    let mut cases = Vec::new();
    for name in measured_names() {
        for voxel_type in VoxelType::ALL {
            for _ in 0..2 {
                let at = cases.len();
                let endian = if at % 3 == 1 { Endian::Big } else { Endian::Little };
                let dims = SHAPES[at % SHAPES.len()];
                cases.push(DetectionCase {
                    name,
                    dims,
                    voxel_type,
                    endian,
                    header: HEADERS[at % HEADERS.len()],
                });
            }
        }
    }
    cases
}

/// Writes the middle of a volume, with a little measurement noise, after a header of text.
fn write_case(volume: &Volume, case: &DetectionCase) -> Vec<u8> {
    let mut bytes: Vec<u8> =
        b"# what follows are voxels\n".iter().copied().cycle().take(case.header).collect();
    let all = volume.dims();
    let from = [0, 1, 2].map(|axis| (all[axis] - case.dims[axis]) / 2);
    for z in 0..case.dims[2] {
        for y in 0..case.dims[1] {
            for x in 0..case.dims[0] {
                let density = volume.density_at([from[0] + x, from[1] + y, from[2] + z]).unwrap_or_default();
                let random = ((x + 131 * (y + 137 * z)) as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let noise = ((random ^ (random >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) as f64
                    / 2f64.powi(24);
                let density = (0.05 + 0.9 * density + 0.04 * (noise - 0.5)).clamp(0.0, 1.0);
                macro_rules! put {
                    ($number:ty, $value:expr) => {{
                        let number: $number = $value;
                        match case.endian {
                            Endian::Little => bytes.extend(number.to_le_bytes()),
                            Endian::Big => bytes.extend(number.to_be_bytes()),
                        }
                    }};
                }
                match case.voxel_type {
                    VoxelType::U8 => put!(u8, (density * 255.0).round() as u8),
                    VoxelType::I8 => put!(i8, (density * 250.0 - 120.0).round() as i8),
                    VoxelType::U16 => put!(u16, (density * 4000.0).round() as u16),
                    VoxelType::I16 => put!(i16, (density * 3000.0 - 1000.0).round() as i16),
                    VoxelType::U32 => put!(u32, (density * 1e6).round() as u32),
                    VoxelType::I32 => put!(i32, (density * 1e5 - 3e4).round() as i32),
                    VoxelType::F32 => put!(f32, (density * 3.0 - 0.5) as f32),
                    VoxelType::F64 => put!(f64, density * 1000.0),
                }
            }
        }
    }
    bytes
}

fn found(bytes: Vec<u8>, said: RawNameHints) -> Vec<LayoutProposal> {
    propose_layouts(&mut RawBytes::from(bytes), said, &CancelToken::new()).expect("bytes in memory")
}

fn is_true(layout: &RawLayout, case: &DetectionCase) -> bool {
    let order = layout.endian == case.endian || case.voxel_type.bytes() == 1;
    layout.dims == case.dims
        && layout.voxel_type == case.voxel_type
        && order
        && layout.offset == case.header as u64
}

/// Writes volumes, detects their layouts, and checks how many are right.
fn check(cases: Vec<DetectionCase>) {
    // Each volume is as large as its shape needs.
    let edges = SHAPES.map(|dims| dims.into_iter().max().unwrap_or_default());
    let volume = |name: &'static str, n: usize| (name, n, builtin(name, Some(n)).expect("a built-in volume"));
    let volumes: Vec<(&str, usize, Volume)> =
        measured_names().flat_map(|name| edges.map(|n| volume(name, n))).collect();
    let places: Vec<(DetectionCase, Option<usize>, bool)> = cases
        .into_par_iter()
        .map(|case| {
            let n = case.dims.into_iter().max().unwrap_or_default();
            let fits = |(name, edge, _): &&(&str, usize, Volume)| *name == case.name && *edge == n;
            let volume = volumes.iter().find(fits).expect("made");
            let found = found(write_case(&volume.2, &case), RawNameHints::default());
            let place = found.iter().position(|proposal| is_true(&proposal.layout, &case));
            (case, place, found.first().is_some_and(|first| first.evidence.is_clear))
        })
        .collect();
    // A header of unusual length can be part of many shapes, and is only guessed.
    let (usual, unusual): (Vec<_>, Vec<_>) =
        places.iter().partition(|(case, _, _)| case.header != UNUSUAL_HEADER_BYTES);
    let guessed = unusual.iter().filter(|(_, place, _)| *place == Some(0)).count();
    let missed: Vec<_> = usual.iter().filter(|(_, place, _)| place.is_none_or(|place| place > 2)).collect();
    let not_first: Vec<_> = usual.iter().filter(|(_, place, _)| *place != Some(0)).collect();
    // Whatever is reported as clear must be right.
    let is_claimed =
        |(_, place, is_clear): &&(DetectionCase, Option<usize>, bool)| *is_clear && *place != Some(0);
    let wrong: Vec<_> = places.iter().filter(is_claimed).collect();
    let clear = places.iter().filter(|(_, _, is_clear)| *is_clear).count();
    let summary = format!(
        "of {} {} first, {} not among three, of {} with an unusual header {guessed}; {clear} clear, {} wrong: {not_first:?}",
        usual.len(),
        usual.len() - not_first.len(),
        missed.len(),
        unusual.len(),
        wrong.len()
    );
    println!("{summary}");
    assert!(missed.is_empty(), "{summary}");
    assert!(not_first.len() * 20 <= usual.len(), "{summary}");
    assert!(guessed * 2 >= unusual.len(), "{summary}");
    // One of signed and unsigned 16-bit numbers must be reported for a mask, and either can be wrong.
    assert!(wrong.len() * 20 <= places.len(), "{summary}");
}

#[test]
fn volumes_are_found_whatever_way_they_are_written() {
    // Every third case covers each volume, type, byte order, header and shape.
    check(cases().into_iter().step_by(3).collect());
}

#[test]
#[ignore = "all of them: a minute"]
fn all_volumes_are_found_whatever_way_they_are_written() {
    check(cases());
}

/// Pseudo-random bytes without any correlation.
fn noise(count: usize, seed: u64) -> Vec<u8> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 24) as u8
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn nothing_is_claimed_of_noise() {
    for (seed, count) in
        [64 * 64 * 64, 100 * 80 * 60, 512 * 512 * 3, 123_457, 50 * 60 * 70 * 4].into_iter().enumerate()
    {
        let found = found(noise(count, seed as u64 + 1), RawNameHints::default());
        let sure = |proposal: &&LayoutProposal| {
            let LayoutEvidence { rows_agree, slices_agree, is_clear, .. } = proposal.evidence;
            is_clear || rows_agree && slices_agree
        };
        assert_eq!(found.iter().find(sure), None, "{count} bytes of noise");
    }
}

#[test]
fn small_empty_and_constant_files_work() {
    assert_eq!(found(Vec::new(), RawNameHints::default()), []);
    for count in (1..70).chain([255, 1000, 4096]) {
        for fill in [0, 7] {
            let found = found(vec![fill; count], RawNameHints::default());
            assert!(found.iter().all(|proposal| !proposal.evidence.is_clear), "{count} times {fill}");
        }
        found(noise(count, 5), RawNameHints::default());
    }
}

#[test]
fn name_hints_take_precedence() {
    let said = RawNameHints {
        dims: Some([40, 30, 20]),
        voxel_type: Some(VoxelType::I16),
        endian: Some(Endian::Big),
    };
    for bytes in [vec![0; 48_000], noise(48_000, 3)] {
        let layout = found(bytes, said)[0].layout;
        assert_eq!(
            (layout.dims, layout.voxel_type, layout.endian),
            ([40, 30, 20], VoxelType::I16, Endian::Big)
        );
        assert_eq!(layout.offset, 0);
    }
}

#[test]
fn long_files_are_only_looked_into() {
    let file = tempfile::NamedTempFile::new().unwrap();
    // A sparse file: nothing is written.
    file.as_file().set_len(2048 * 2048 * 1024 * 2).unwrap();
    let mut bytes = RawBytes::open(file.path()).unwrap();
    assert_eq!((bytes.length(), bytes.is_exact(), bytes.is_in_memory()), (8 << 30, true, false));
    let found = propose_layouts(&mut bytes, RawNameHints::default(), &CancelToken::new()).unwrap();
    assert!(found.iter().all(|proposal| proposal.layout.file_bytes() == Some(8 << 30)));
    let cancel = CancelToken::new();
    cancel.cancel();
    assert_eq!(propose_layouts(&mut bytes, RawNameHints::default(), &cancel).unwrap(), []);
}

#[test]
fn of_compressed_files_the_start_is_looked_at() {
    use std::io::Write as _;
    let case = DetectionCase {
        name: "chair",
        dims: [48, 40, 36],
        voxel_type: VoxelType::U16,
        endian: Endian::Little,
        header: 0,
    };
    let volume = builtin(case.name, Some(64)).unwrap();
    let mut file = tempfile::NamedTempFile::new().unwrap();
    let mut encoder = flate2::write::GzEncoder::new(&mut file, flate2::Compression::fast());
    encoder.write_all(&write_case(&volume, &case)).unwrap();
    encoder.finish().unwrap();
    let mut bytes = RawBytes::open(file.path()).unwrap();
    assert_eq!((bytes.length(), bytes.is_exact()), (48 * 40 * 36 * 2, true));
    let found = propose_layouts(&mut bytes, RawNameHints::default(), &CancelToken::new()).unwrap();
    assert!(is_true(&found[0].layout, &case), "{found:#?}");
    // Longer than the part that is inflated: its trailer gives the length.
    let mut file = tempfile::NamedTempFile::new().unwrap();
    let mut encoder = flate2::write::GzEncoder::new(&mut file, flate2::Compression::fast());
    encoder.write_all(&vec![0; 40 << 20]).unwrap();
    encoder.finish().unwrap();
    let bytes = RawBytes::open(file.path()).unwrap();
    assert_eq!((bytes.length(), bytes.is_exact()), (40 << 20, false));
    assert!(bytes.readable() < bytes.length());
    // Also with zero padding.
    std::io::Write::write_all(&mut file, &[0; 4096]).unwrap();
    assert_eq!(RawBytes::open(file.path()).unwrap().length(), 40 << 20);
}
