//! Candidate shapes: rows, slices and headers that match a file's length, scored by the agreement of neighbours.

use std::collections::HashMap;
use std::io;

use super::super::bytes::RawBytes;
use super::super::name_hints::RawNameHints;
use super::autocorrelation::{LagDifferences, LagDip, MIN_ROW};
use super::number_candidates::NumberCandidate;

/// Lengths of headers in use, in bytes: none, the smallest of MRC and others, Analyze and `NIfTI`, whole disk blocks.
pub(super) const HEADERS: [u64; 14] = [0, 16, 32, 64, 80, 128, 256, 348, 352, 512, 1024, 2048, 4096, 8192];

/// Maximum length of a header that is guessed where voxels do not fill the file, in bytes.
const MAX_HEADER: u64 = 64 << 10;

/// Maximum edge length that is guessed, in voxels.
const MAX_EDGE: usize = 1 << 16;

/// Number of row lengths that are examined more closely.
const MAX_ROW_CANDIDATES: usize = 8;

/// Maximum deficit of a row's score against the best: agreeing slices cannot make up for more.
const MAX_SCORE_DEFICIT: f64 = 1.2;

/// Number of slice heights that are examined for each row length.
const MAX_SLICE_CANDIDATES: usize = 32;

/// Length of a file of numbers of one interpretation.
#[derive(Debug, Clone, Copy)]
pub(super) struct RawFileLength {
    bytes: u64,
    voxel: u64,
    phase: u64,
}

impl RawFileLength {
    pub(super) fn new(bytes: &RawBytes, code: &NumberCandidate) -> Self {
        Self { bytes: bytes.length(), voxel: code.voxel_type.bytes() as u64, phase: code.phase as u64 }
    }

    /// Number of voxels after a header; `None` if it is not an integer.
    fn voxels_after(&self, header: u64) -> Option<u64> {
        let rest = self.bytes.checked_sub(header)?;
        (header % self.voxel == self.phase && rest.is_multiple_of(self.voxel)).then_some(rest / self.voxel)
    }

    /// Returns true if a header of usual length leaves an integer number of voxels.
    pub(super) fn fits_usual_header(&self) -> bool {
        self.usual_headers().next().is_some()
    }

    /// Usual headers that leave an integer number of voxels, with that number.
    fn usual_headers(&self) -> impl Iterator<Item = (u64, u64)> {
        HEADERS.into_iter().filter_map(|header| Some((header, self.voxels_after(header)?)))
    }
}

/// Candidate length of rows, in voxels.
#[derive(Debug, Clone, Copy)]
pub(super) struct RowCandidate {
    length: usize,
    dip: LagDip,
    score: f64,
}

/// Candidate shape before its slices are scored.
#[derive(Debug, Clone, Copy)]
struct ShapeCandidate {
    dims: [usize; 3],
    header: u64,
    /// Score of the shape alone, before its voxels are examined.
    prior: f64,
}

impl ShapeCandidate {
    fn new(dims: [usize; 3], header: u64, said: RawNameHints) -> Self {
        Self { dims, header, prior: shape_prior(dims, header, said) }
    }
}

/// Scored shape, with the agreement of neighbouring rows and slices.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScoredShape {
    pub(super) dims: [usize; 3],
    pub(super) header: u64,
    pub(super) row: LagDip,
    pub(super) slice: LagDip,
    /// Mean difference of neighbours along x.
    pub(super) neighbour_difference: f64,
    /// Mean difference of unrelated voxels.
    pub(super) unrelated_difference: f64,
    pub(super) score: f64,
}

/// Weight of a dip in the score: its depth, reduced where it may be chance.
fn dip_weight(dip: LagDip) -> f64 {
    // Four standard deviations rule out chance, whatever the number of lags that were tried.
    dip.depth * (dip.sigmas / 4.0).clamp(0.0, 1.0)
}

/// Penalty for an unusual edge length.
fn edge_penalty(edge: usize) -> f64 {
    if edge.is_power_of_two() || edge.is_multiple_of(128) {
        0.0
    } else if edge.is_multiple_of(16) || edge.is_multiple_of(50) {
        0.03
    } else if edge.is_multiple_of(2) {
        0.05
    } else {
        0.06
    }
}

/// Candidate row lengths, most likely first.
pub(super) fn rows(size: &RawFileLength, lags: &LagDifferences, said: RawNameHints) -> Vec<RowCandidate> {
    let differences = &lags.differences;
    let depth = |length: usize| {
        let around = 0.5 * (differences.get(length - 1)? + differences.get(length + 1)?);
        (around > 0.0).then(|| 1.0 - differences[length] / around)
    };
    // By the autocorrelation, and by divisibility of the file's length.
    let mut promising: Vec<(usize, f64)> = (MIN_ROW..differences.len().saturating_sub(1))
        .filter_map(|length| Some((length, depth(length)?)))
        .map(|(length, depth)| {
            let fits = size.usual_headers().any(|(_, voxels)| voxels.is_multiple_of(length as u64));
            let closeness = 1.0 - differences[length] / lags.unrelated.max(f64::MIN_POSITIVE);
            (length, depth + 0.3 * closeness.max(0.0) + if fits { 0.1 } else { 0.0 })
        })
        .collect();
    promising.sort_by(|a, b| b.1.total_cmp(&a.1));
    promising.truncate(3 * MAX_ROW_CANDIDATES);
    let mut lengths: Vec<usize> = promising.into_iter().map(|(length, _)| length).collect();
    lengths.extend(said.dims.map(|dims| dims[0]));
    lengths.extend(size.usual_headers().filter_map(|(_, voxels)| cube_edge(voxels)));
    lengths.sort_unstable();
    lengths.dedup();
    let mut rows: Vec<RowCandidate> = lengths
        .into_iter()
        .filter(|length| (1..=MAX_EDGE).contains(length))
        .map(|length| {
            let dip = lags.row_dip(length);
            let nearness =
                (lags.unrelated / dip.difference.max(1e-6 * lags.unrelated).max(f64::MIN_POSITIVE)).ln();
            RowCandidate { length, dip, score: dip_weight(dip) + 0.2 * nearness.clamp(-1.0, 2.5) }
        })
        .collect();
    rows.sort_by(|a, b| b.score.total_cmp(&a.score));
    let best = rows.first().map_or(0.0, |row| row.score);
    let mut at = 0;
    rows.retain(|row| {
        at += 1;
        let is_said = said.dims.is_some_and(|dims| dims[0] == row.length);
        is_said || at <= MAX_ROW_CANDIDATES && row.score > best - MAX_SCORE_DEFICIT
    });
    rows
}

/// Edge of a cube of `voxels` voxels; `None` if there is none.
fn cube_edge(voxels: u64) -> Option<usize> {
    let edge = (voxels as f64).cbrt().round() as u64;
    (edge.checked_pow(3)? == voxels).then_some(edge as usize)
}

/// Scored shapes for a row length: numbers of rows in a slice, and of slices.
pub(super) fn slices(
    bytes: &mut RawBytes,
    size: &RawFileLength,
    lags: &LagDifferences,
    row: RowCandidate,
    agreeing: &[usize],
    said: RawNameHints,
) -> io::Result<Vec<ScoredShape>> {
    let mut tried: Vec<ShapeCandidate> = Vec::new();
    for (header, voxels) in size.usual_headers() {
        let Some(rest) = exact_quotient(voxels, row.length as u64) else { continue };
        for y in (MIN_ROW..=MAX_EDGE.min(rest as usize)).filter(|y| rest.is_multiple_of(*y as u64)) {
            let z = rest / y as u64;
            if z <= MAX_EDGE as u64 {
                let dims = [row.length, y, z as usize];
                tried.push(ShapeCandidate::new(dims, header, said));
            }
        }
    }
    if let Some(dims) = said.dims.filter(|dims| dims[0] == row.length) {
        let voxels = dims.iter().fold(size.voxel, |product, &n| product.saturating_mul(n as u64));
        let header = size.bytes.saturating_sub(voxels);
        let header = if header % size.voxel == size.phase { header } else { 0 };
        tried.push(ShapeCandidate::new(dims, header, said));
    }
    tried.sort_by(|a, b| b.prior.total_cmp(&a.prior));
    tried.truncate(MAX_SLICE_CANDIDATES);
    tried.extend(shapes_with_remainder_header(size, agreeing, row.length, said));
    let mut shapes = Vec::new();
    // The agreement of slices depends only on their number of rows, not on the header.
    let mut known: HashMap<usize, LagDip> = HashMap::new();
    for ShapeCandidate { dims, header, prior } in tried {
        let slice = match known.get(&dims[1]) {
            _ if dims[2] <= 1 => LagDip::default(),
            Some(&slice) => slice,
            None => {
                let slice = lags.slice_dip(bytes, dims[0], dims[1])?;
                known.insert(dims[1], slice);
                slice
            }
        };
        let unlike = lags.unrelated.max(f64::MIN_POSITIVE);
        let far = if slice.difference > 0.0 || slice.sigmas != 0.0 { slice.difference } else { unlike };
        let nearness = (unlike / far.max(1e-6 * unlike)).ln().clamp(-1.0, 2.5);
        let score = row.score + dip_weight(slice) + 0.2 * nearness + prior;
        let across = lags.differences.get(1).copied().unwrap_or_default();
        shapes.push(ScoredShape {
            dims,
            header,
            row: row.dip,
            slice,
            neighbour_difference: across,
            unrelated_difference: lags.unrelated,
            score,
        });
    }
    Ok(shapes)
}

/// Exact quotient; `None` if there is a remainder.
fn exact_quotient(n: u64, by: u64) -> Option<u64> {
    (by > 0 && n > 0 && n.is_multiple_of(by)).then(|| n / by)
}

/// Lengths of slices, in voxels, at which neighbours agree, collected over all row lengths.
pub(super) fn agreeing_slice_lengths(lags: &LagDifferences, rows: &[RowCandidate]) -> Vec<usize> {
    let of_row = |row: &RowCandidate| {
        lags.slice_heights(row.length).into_iter().map(|rows| rows * row.length).collect::<Vec<_>>()
    };
    let mut slices: Vec<usize> = rows.iter().flat_map(of_row).collect();
    slices.sort_unstable();
    slices.dedup();
    slices
}

/// Candidates by agreeing slices, where the remainder of the file's length is the header.
fn shapes_with_remainder_header(
    size: &RawFileLength,
    agreeing: &[usize],
    row: usize,
    said: RawNameHints,
) -> Vec<ShapeCandidate> {
    let of_slice = |&slice: &usize| {
        let slice_bytes = slice as u64 * size.voxel;
        let slices = size.bytes / slice_bytes;
        let header = size.bytes - slices * slice_bytes;
        let fits = header <= MAX_HEADER && header % size.voxel == size.phase;
        let dims = [row, slice / row, slices as usize];
        (fits && (1..=MAX_EDGE as u64).contains(&slices)).then(|| ShapeCandidate::new(dims, header, said))
    };
    let fitting = agreeing.iter().filter(|slice| slice.is_multiple_of(row) && **slice >= MIN_ROW * row);
    fitting.filter_map(of_slice).collect()
}

/// Score of a shape before its voxels are examined: plausible proportions, edges and header.
fn shape_prior(dims: [usize; 3], header: u64, said: RawNameHints) -> f64 {
    let [x, y, z] = dims.map(|n| n as f64);
    let longest = x.max(y).max(z);
    let shortest = x.min(y).min(z);
    let mut score = 0.0;
    score -= dims.iter().map(|&edge| edge_penalty(edge)).sum::<f64>();
    score -= 0.05 * (x / y).ln().abs();
    score -= 0.04 * (longest / shortest).ln();
    if dims[0] == dims[1] {
        score += 0.1;
    }
    score -= match header {
        0 => 0.0,
        header if HEADERS.contains(&header) => 0.15,
        header => 0.2 + 0.05 * (1.0 + header as f64 / 256.0).ln(),
    };
    // Fewer than 16 voxels along an axis are a slab rather than a volume.
    score -= dims.iter().map(|&edge| 0.15 * (16.0 / edge as f64).ln().max(0.0)).sum::<f64>();
    if said.dims == Some(dims) {
        score += 2.0;
    }
    score
}
