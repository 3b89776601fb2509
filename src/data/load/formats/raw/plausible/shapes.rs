//! Rows, slices and headers that make up a file's length, and how well neighbours agree in them.

use std::collections::HashMap;
use std::io;

use super::super::bytes::RawBytes;
use super::super::said::Said;
use super::codes::Code;
use super::lags::{Dip, Lags, SHORTEST};

/// Lengths of headers that formats and programs have: none, the smallest of MRC and others in use, Analyze and `NIfTI`,
/// whole blocks of a disk.
pub(super) const HEADERS: [u64; 14] = [0, 16, 32, 64, 80, 128, 256, 348, 352, 512, 1024, 2048, 4096, 8192];

/// The longest header that is guessed where voxels do not fill the file.
const LONGEST_HEADER: u64 = 64 << 10;

/// The longest edge that is guessed.
const LONGEST: usize = 1 << 16;

/// Lengths of rows that are looked at more closely.
const ROWS: usize = 8;

/// Rows that score so much less than the best are not looked at: slices that agree make up for no more.
const HOPELESS: f64 = 1.2;

/// Numbers of rows in a slice that are looked at for each length of rows.
const SLICES: usize = 32;

/// How long a file of numbers is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    bytes: u64,
    voxel: u64,
    phase: u64,
}

impl Size {
    pub(super) fn of(bytes: &RawBytes, code: &Code) -> Self {
        Self { bytes: bytes.length(), voxel: code.voxel_type.bytes() as u64, phase: code.phase as u64 }
    }

    /// How many voxels follow a header; none if it is no whole number of them.
    fn after(&self, header: u64) -> Option<u64> {
        let rest = self.bytes.checked_sub(header)?;
        (header % self.voxel == self.phase && rest.is_multiple_of(self.voxel)).then_some(rest / self.voxel)
    }

    /// Whether headers of a usual length leave whole numbers of voxels.
    pub(super) fn is_usual(&self) -> bool {
        self.usual().next().is_some()
    }

    /// Headers that leave whole numbers of voxels, with how many.
    fn usual(&self) -> impl Iterator<Item = (u64, u64)> {
        HEADERS.into_iter().filter_map(|header| Some((header, self.after(header)?)))
    }
}

/// A length of rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    length: usize,
    dip: Dip,
    score: f64,
}

/// A shape that is to be looked at.
#[derive(Debug, Clone, Copy)]
struct Tried {
    dims: [usize; 3],
    header: u64,
    /// How likely it is before that.
    prior: f64,
}

impl Tried {
    fn new(dims: [usize; 3], header: u64, said: Said) -> Self {
        Self { dims, header, prior: prior(dims, header, said) }
    }
}

/// A shape, and how well neighbours agree in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    pub(super) dims: [usize; 3],
    pub(super) header: u64,
    pub(super) row: Dip,
    pub(super) slice: Dip,
    /// Mean difference of neighbours along x.
    pub(super) across: f64,
    /// Mean difference of voxels that have nothing to do with each other.
    pub(super) unlike: f64,
    pub(super) score: f64,
}

/// How much a dip counts: its depth, as far as it is more than chance.
fn weight(dip: Dip) -> f64 {
    // Four deviations leave nothing to chance, whatever the number of distances that were tried.
    dip.depth * (dip.sigmas / 4.0).clamp(0.0, 1.0)
}

/// How unusual an edge is.
fn odd(edge: usize) -> f64 {
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

/// Lengths of rows, the likeliest first.
pub(super) fn rows(size: &Size, lags: &Lags, said: Said) -> Vec<Row> {
    let differences = &lags.differences;
    let depth = |length: usize| {
        let around = 0.5 * (differences.get(length - 1)? + differences.get(length + 1)?);
        (around > 0.0).then(|| 1.0 - differences[length] / around)
    };
    // By what the table says, and by what fits the length.
    let mut promising: Vec<(usize, f64)> = (SHORTEST..differences.len().saturating_sub(1))
        .filter_map(|length| Some((length, depth(length)?)))
        .map(|(length, depth)| {
            let fits = size.usual().any(|(_, voxels)| voxels.is_multiple_of(length as u64));
            let closeness = 1.0 - differences[length] / lags.unlike.max(f64::MIN_POSITIVE);
            (length, depth + 0.3 * closeness.max(0.0) + if fits { 0.1 } else { 0.0 })
        })
        .collect();
    promising.sort_by(|a, b| b.1.total_cmp(&a.1));
    promising.truncate(3 * ROWS);
    let mut lengths: Vec<usize> = promising.into_iter().map(|(length, _)| length).collect();
    lengths.extend(said.dims.map(|dims| dims[0]));
    lengths.extend(size.usual().filter_map(|(_, voxels)| cube(voxels)));
    lengths.sort_unstable();
    lengths.dedup();
    let mut rows: Vec<Row> = lengths
        .into_iter()
        .filter(|length| (1..=LONGEST).contains(length))
        .map(|length| {
            let dip = lags.row(length);
            let nearness = (lags.unlike / dip.difference.max(1e-6 * lags.unlike).max(f64::MIN_POSITIVE)).ln();
            Row { length, dip, score: weight(dip) + 0.2 * nearness.clamp(-1.0, 2.5) }
        })
        .collect();
    rows.sort_by(|a, b| b.score.total_cmp(&a.score));
    let best = rows.first().map_or(0.0, |row| row.score);
    let mut at = 0;
    rows.retain(|row| {
        at += 1;
        let is_said = said.dims.is_some_and(|dims| dims[0] == row.length);
        is_said || at <= ROWS && row.score > best - HOPELESS
    });
    rows
}

/// The edge of a cube of so many voxels.
fn cube(voxels: u64) -> Option<usize> {
    let edge = (voxels as f64).cbrt().round() as u64;
    (edge.checked_pow(3)? == voxels).then_some(edge as usize)
}

/// Numbers of rows in a slice, and of slices, for a length of rows.
pub(super) fn slices(
    bytes: &mut RawBytes,
    size: &Size,
    lags: &Lags,
    row: Row,
    agreeing: &[usize],
    said: Said,
) -> io::Result<Vec<Shape>> {
    let mut tried: Vec<Tried> = Vec::new();
    for (header, voxels) in size.usual() {
        let Some(rest) = whole(voxels, row.length as u64) else { continue };
        for y in (SHORTEST..=LONGEST.min(rest as usize)).filter(|y| rest.is_multiple_of(*y as u64)) {
            let z = rest / y as u64;
            if z <= LONGEST as u64 {
                let dims = [row.length, y, z as usize];
                tried.push(Tried::new(dims, header, said));
            }
        }
    }
    if let Some(dims) = said.dims.filter(|dims| dims[0] == row.length) {
        let voxels = dims.iter().fold(size.voxel, |product, &n| product.saturating_mul(n as u64));
        let header = size.bytes.saturating_sub(voxels);
        let header = if header % size.voxel == size.phase { header } else { 0 };
        tried.push(Tried::new(dims, header, said));
    }
    tried.sort_by(|a, b| b.prior.total_cmp(&a.prior));
    tried.truncate(SLICES);
    tried.extend(left_over(size, agreeing, row.length, said));
    let mut shapes = Vec::new();
    // Whatever comes before them, slices of so many rows agree as well.
    let mut known: HashMap<usize, Dip> = HashMap::new();
    for Tried { dims, header, prior } in tried {
        let slice = match known.get(&dims[1]) {
            _ if dims[2] <= 1 => Dip::default(),
            Some(&slice) => slice,
            None => {
                let slice = lags.slice(bytes, dims[0], dims[1])?;
                known.insert(dims[1], slice);
                slice
            }
        };
        let unlike = lags.unlike.max(f64::MIN_POSITIVE);
        let far = if slice.difference > 0.0 || slice.sigmas != 0.0 { slice.difference } else { unlike };
        let nearness = (unlike / far.max(1e-6 * unlike)).ln().clamp(-1.0, 2.5);
        let score = row.score + weight(slice) + 0.2 * nearness + prior;
        let across = lags.differences.get(1).copied().unwrap_or_default();
        shapes.push(Shape { dims, header, row: row.dip, slice, across, unlike: lags.unlike, score });
    }
    Ok(shapes)
}

/// A number divided by another that divides it.
fn whole(n: u64, by: u64) -> Option<u64> {
    (by > 0 && n > 0 && n.is_multiple_of(by)).then(|| n / by)
}

/// Voxels of slices that agree, whatever the length of rows that they were found by.
pub(super) fn agreeing(lags: &Lags, rows: &[Row]) -> Vec<usize> {
    let of_row =
        |row: &Row| lags.slices(row.length).into_iter().map(|rows| rows * row.length).collect::<Vec<_>>();
    let mut slices: Vec<usize> = rows.iter().flat_map(of_row).collect();
    slices.sort_unstable();
    slices.dedup();
    slices
}

/// Shapes of slices that agree, with a header of what is left over.
fn left_over(size: &Size, agreeing: &[usize], row: usize, said: Said) -> Vec<Tried> {
    let of_slice = |&slice: &usize| {
        let slice_bytes = slice as u64 * size.voxel;
        let slices = size.bytes / slice_bytes;
        let header = size.bytes - slices * slice_bytes;
        let fits = header <= LONGEST_HEADER && header % size.voxel == size.phase;
        let dims = [row, slice / row, slices as usize];
        (fits && (1..=LONGEST as u64).contains(&slices)).then(|| Tried::new(dims, header, said))
    };
    let fitting = agreeing.iter().filter(|slice| slice.is_multiple_of(row) && **slice >= SHORTEST * row);
    fitting.filter_map(of_slice).collect()
}

/// How likely a shape is before its voxels are looked at.
fn prior(dims: [usize; 3], header: u64, said: Said) -> f64 {
    let [x, y, z] = dims.map(|n| n as f64);
    let longest = x.max(y).max(z);
    let shortest = x.min(y).min(z);
    let mut score = 0.0;
    score -= dims.iter().map(|&edge| odd(edge)).sum::<f64>();
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
    // Fewer than 16 are seen as a slab, not as a volume.
    score -= dims.iter().map(|&edge| 0.15 * (16.0 / edge as f64).ln().max(0.0)).sum::<f64>();
    if said.dims == Some(dims) {
        score += 2.0;
    }
    score
}
