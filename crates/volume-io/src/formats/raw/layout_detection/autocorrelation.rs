//! Autocorrelation of the voxel stream: finds row and slice lengths as minima of the mean absolute difference over
//! lag.

use std::io;
use std::ops::Range;

use rayon::prelude::*;

use super::super::bytes::RawBytes;
use super::number_candidates::{NumberCandidate, bytes_to_next_number};
use super::numbers::{for_each_value, with_numbers};
use super::sample_blocks::SampleBlocks;
use crate::Endian;
use chiaroscuro_volume::VoxelType;

/// Minimum row length, and minimum number of rows of a slice.
pub(super) const MIN_ROW: usize = 8;

/// Maximum row length that is searched for, in voxels; longer ones can only be given by the file name.
pub(super) const MAX_ROW: usize = 4096;

/// Number of voxels, over all blocks, that are compared with others.
const COMPARED_VOXELS: usize = 8192;

/// Number of runs of voxels, over all blocks, that are compared with another slice: in a file, and in memory, where
/// no reading is needed.
const MAX_RUNS: [usize; 2] = [16, 64];

/// Number of adjacent voxels whose results form one sample of the statistics, to estimate the standard deviation.
const GROUP_VOXELS: usize = 128;

/// Bytes that are read in one piece to search for slices of unknown size: two of 1024 × 1024 voxels of two bytes.
const LONG_PIECE_BYTES: u64 = 4 << 20;

/// Number of voxel pairs that are compared in it: a millisecond or two, since they are contiguous.
const LONG_PAIRS: usize = 1 << 22;

/// Maximum number of slice heights that are proposed by agreement.
const MAX_SLICE_HEIGHTS: usize = 6;

/// Maximum ratio of the dip along rows to that across rows: rows may be closer together than their voxels.
const MAX_DIP_RATIO: f64 = 3.0;

/// Quantiles of the values that become black and white, so that no single outlier decides.
const OUTER_QUANTILES: [f64; 2] = [0.005, 0.995];

/// Mapping of numbers to grey levels from 0 to 1.
#[derive(Debug, Clone, Copy)]
struct GreyMapping {
    voxel_type: VoxelType,
    endian: Endian,
    low: f64,
    per_grey: f64,
}

impl GreyMapping {
    fn grey(&self, value: f64) -> f32 {
        let grey = (value - self.low) / self.per_grey;
        // NaN becomes black.
        if grey > 0.0 { grey.min(1.0) as f32 } else { 0.0 }
    }

    fn map(&self, bytes: &[u8]) -> Vec<f32> {
        let mut greys = Vec::new();
        with_numbers!(bytes, self.voxel_type, self.endian, numbers => greys.extend(numbers.map(|n| self.grey(n))));
        greys
    }
}

/// Local minimum of the mean difference at a lag, against the lags next to it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LagDip {
    /// Mean absolute difference at the lag, in grey levels.
    pub(super) difference: f64,
    /// Relative depth against the difference at the lags around: 0 for no dip.
    pub(super) depth: f64,
    /// Depth in standard deviations of chance.
    pub(super) sigmas: f64,
}

/// Absolute differences of voxels at a lag and around it, summed in groups.
#[derive(Debug, Default)]
struct DifferenceGroups(Vec<DifferenceSums>);

#[derive(Debug, Clone, Copy, Default)]
struct DifferenceSums {
    at: f64,
    /// Sums at the lags around it: along a row, and from row to row.
    neighbouring: [f64; 2],
    count: f64,
}

impl DifferenceGroups {
    /// Dip along rows, which a wrong row length does not deepen; limited where there is hardly one across rows, as
    /// for wrong numbers of rows.
    fn dip(&self) -> LagDip {
        let [along, across] = [0, 1].map(|which| self.dip_along(which));
        let most = MAX_DIP_RATIO * across.depth;
        if along.depth <= most { along } else { LagDip { depth: most, sigmas: across.sigmas, ..along } }
    }

    fn dip_along(&self, which: usize) -> LagDip {
        let count: f64 = self.0.iter().map(|sums| sums.count).sum();
        if count == 0.0 {
            return LagDip::default();
        }
        let gains = || self.0.iter().map(|sums| sums.neighbouring[which] - sums.at);
        let at: f64 = self.0.iter().map(|sums| sums.at).sum();
        let around: f64 = self.0.iter().map(|sums| sums.neighbouring[which]).sum();
        let gain: f64 = gains().sum();
        // The spread of the groups' gains gives the standard error of their sum.
        let n = self.0.len() as f64;
        let spread: f64 = gains().map(|group| (group - gain / n).powi(2)).sum();
        let deviation = (spread * n / (n - 1.0).max(1.0)).sqrt();
        let depth = if around > 0.0 { gain / around } else { 0.0 };
        LagDip { difference: at / count, depth, sigmas: if deviation > 0.0 { gain / deviation } else { 0.0 } }
    }
}

/// Grey levels of a sample block.
#[derive(Debug)]
struct GreyBlock {
    /// Offset of its first voxel in the file, in bytes.
    at: u64,
    greys: Vec<f32>,
    /// Runs of voxels where the content varies.
    runs: Vec<Range<usize>>,
}

/// Number of contiguous voxels that are compared with another slice.
const RUN_VOXELS: usize = 256;

/// Minimum variation of a run, as a share of the greatest.
const MIN_VARIATION: f64 = 0.05;

/// Runs of voxels where the content varies, in a scattered order.
fn runs(greys: &[f32]) -> Vec<Range<usize>> {
    let mut found: Vec<(Range<usize>, f64)> = (0..greys.len())
        .step_by(RUN_VOXELS)
        .map(|start| {
            let run = start..(start + RUN_VOXELS).min(greys.len());
            // Means of eight voxels, to reduce noise.
            let means: Vec<f64> = greys[run.clone()]
                .chunks(8)
                .map(|part| part.iter().map(|&grey| f64::from(grey)).sum::<f64>() / 8.0)
                .collect();
            let mean = means.iter().sum::<f64>() / means.len() as f64;
            (run, means.iter().map(|part| (part - mean) * (part - mean)).sum())
        })
        .collect();
    let most = found.iter().map(|run| run.1).fold(0.0, f64::max);
    found.retain(|run| run.1 >= MIN_VARIATION * most);
    // Multiplicative (Fibonacci) hashing: any number of leading runs is spread over the block.
    let count = found.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&at| (at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    order.into_iter().map(|at| found[at].0.clone()).collect()
}

/// Voxels of one interpretation, and their mean differences by lag.
#[derive(Debug)]
pub(super) struct LagDifferences {
    greys: GreyMapping,
    stretches: Vec<GreyBlock>,
    /// Mean absolute difference at each lag in voxels, from 0.
    pub(super) differences: Vec<f64>,
    /// Mean absolute difference of unrelated voxels.
    pub(super) unrelated: f64,
    /// Grey levels of one long piece from the middle of the file.
    long_piece: Vec<f32>,
}

impl LagDifferences {
    pub(super) fn new(
        bytes: &mut RawBytes,
        spots: &SampleBlocks,
        code: &NumberCandidate,
    ) -> io::Result<Self> {
        let (voxel_type, endian) = (code.voxel_type, code.endian);
        let skip = |at: u64, piece: &[u8]| bytes_to_next_number(at, voxel_type, code.phase).min(piece.len());
        let mut all = Vec::new();
        for spot in &spots.0 {
            let skip = skip(spot.at, &spot.bytes);
            // Every seventh value is enough for quantiles; seven is not a power of two.
            let mut at = 0usize;
            for_each_value(&spot.bytes[skip..], voxel_type, endian, |value| {
                if at.is_multiple_of(7) && value.is_finite() {
                    all.push(value);
                }
                at += 1;
            });
        }
        all.sort_unstable_by(f64::total_cmp);
        let quantile = |share: f64| all.get((share * all.len() as f64) as usize).copied().unwrap_or_default();
        let [mut low, mut high] = OUTER_QUANTILES.map(quantile);
        if low == high {
            (low, high) = (quantile(0.0), all.last().copied().unwrap_or_default());
        }
        let per_grey = if high > low { high - low } else { 1.0 };
        let greys = GreyMapping { voxel_type, endian, low, per_grey };
        let stretches: Vec<GreyBlock> = spots
            .0
            .iter()
            .map(|spot| {
                let skip = skip(spot.at, &spot.bytes);
                let greys = greys.map(&spot.bytes[skip..]);
                GreyBlock { at: spot.at + skip as u64, runs: runs(&greys), greys }
            })
            .collect();
        let differences = mean_differences(&stretches);
        let length = LONG_PIECE_BYTES.min(bytes.readable());
        let from = (bytes.readable() - length) / 2;
        let mut piece = vec![0; length as usize];
        let read = bytes.read_at(from, &mut piece)?;
        let skip = skip(from, &piece[..read]);
        let long = greys.map(&piece[skip..read]);
        let mut lags = Self { greys, stretches, differences, unrelated: 0.0, long_piece: long };
        lags.unrelated = lags.mean_unrelated();
        Ok(lags)
    }

    /// Start voxels of comparisons in a block: evenly spread, with room for the longest lag.
    fn starts(stretch: &GreyBlock, count: usize, longest: usize) -> impl Iterator<Item = usize> + use<> {
        let room = stretch.greys.len().saturating_sub(longest);
        (0..room).step_by((room / count).max(1)).take(count)
    }

    /// Mean absolute difference of voxels at unrelated positions of all blocks.
    fn mean_unrelated(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        let all: Vec<f32> =
            self.stretches.iter().flat_map(|stretch| stretch.greys.iter().copied().step_by(61)).collect();
        for (at, grey) in all.iter().enumerate() {
            // A step (prime 7919) that is coprime with usual lengths, from an offset of 5/8 of the whole.
            let other = (at * 7919 + all.len() * 5 / 8) % all.len().max(1);
            sum += f64::from((grey - all[other]).abs());
            count += 1.0;
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Dip at a row length: voxels are more similar to the next row than to the voxels next to that.
    pub(super) fn row_dip(&self, length: usize) -> LagDip {
        let mut groups = Vec::new();
        for stretch in &self.stretches {
            let count = COMPARED_VOXELS / self.stretches.len();
            let starts: Vec<usize> = Self::starts(stretch, count, length + 1).collect();
            for part in starts.chunks(GROUP_VOXELS) {
                let mut sums = DifferenceSums::default();
                for &start in part {
                    let grey = stretch.greys[start];
                    let difference = |lag: usize| f64::from((stretch.greys[start + lag] - grey).abs());
                    sums.at += difference(length);
                    let around = 0.5 * (difference(length - 1) + difference(length + 1));
                    sums.neighbouring = sums.neighbouring.map(|sum| sum + around);
                    sums.count += 1.0;
                }
                groups.push(sums);
            }
        }
        DifferenceGroups(groups).dip()
    }

    /// Numbers of rows at whose distance the long piece has local minima of the difference, deepest first.
    pub(super) fn slice_heights(&self, row: usize) -> Vec<usize> {
        let long = &self.long_piece;
        let most = long.len() / 2 / row;
        if most < MIN_ROW + 2 {
            return Vec::new();
        }
        let mut sums = vec![0.0f64; most];
        let mut left = (LONG_PAIRS / most).max(256);
        for run in runs(&long[..long.len() / 2]) {
            if left == 0 {
                break;
            }
            left = left.saturating_sub(run.len());
            for (rows, sum) in sums.iter_mut().enumerate() {
                let ahead = rows * row;
                *sum += sum_of_absolute_differences(
                    &long[run.clone()],
                    &long[run.start + ahead..run.end + ahead],
                );
            }
        }
        let depth =
            |rows: usize| 1.0 - 2.0 * sums[rows] / (sums[rows - 1] + sums[rows + 1]).max(f64::MIN_POSITIVE);
        let mut found: Vec<(usize, f64)> =
            (MIN_ROW..most - 1).map(|rows| (rows, depth(rows))).filter(|(_, depth)| *depth > 0.0).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found.truncate(MAX_SLICE_HEIGHTS);
        found.into_iter().map(|(rows, _)| rows).collect()
    }

    /// Dip at a slice length: voxels are more similar to the next slice than to the voxels around that.
    pub(super) fn slice_dip(&self, bytes: &mut RawBytes, row: usize, rows: usize) -> io::Result<LagDip> {
        let size = self.greys.voxel_type.bytes();
        if rows < 2 {
            return Ok(LagDip::default());
        }
        let (slice, reach) = (row * rows, row + 1);
        let mut groups = Vec::new();
        let mut buffer = Vec::new();
        let runs = MAX_RUNS[usize::from(bytes.is_in_memory())].div_ceil(self.stretches.len().max(1));
        for stretch in &self.stretches {
            for run in stretch.runs.iter().take(runs) {
                // Contiguous voxels: one read.
                let here = &stretch.greys[run.clone()];
                let at = stretch.at + (run.start * size) as u64;
                let length = (here.len() + 2 * reach) * size;
                let ahead = at + ((slice - reach) * size) as u64;
                let place = if ahead + length as u64 <= bytes.readable() {
                    ahead
                } else if let Some(behind) = at.checked_sub(((slice + reach) * size) as u64) {
                    behind
                } else {
                    continue;
                };
                buffer.resize(length, 0);
                let read = bytes.read_at(place, &mut buffer)?;
                if read < length {
                    continue;
                }
                // The row before, the same row with one voxel more at both ends, and the row after.
                let part =
                    |from: usize, count: usize| self.greys.map(&buffer[from * size..(from + count) * size]);
                let [before, behind] = [1, 1 + 2 * row].map(|from| part(from, here.len()));
                let same = part(row, here.len() + 2);
                for part in (0..here.len()).step_by(GROUP_VOXELS) {
                    let mut sums = DifferenceSums::default();
                    for at in part..(part + GROUP_VOXELS).min(here.len()) {
                        let difference = |other: f32| f64::from((other - here[at]).abs());
                        sums.at += difference(same[at + 1]);
                        sums.neighbouring[0] += 0.5 * (difference(same[at]) + difference(same[at + 2]));
                        sums.neighbouring[1] += 0.5 * (difference(before[at]) + difference(behind[at]));
                        sums.count += 1.0;
                    }
                    groups.push(sums);
                }
            }
        }
        Ok(DifferenceGroups(groups).dip())
    }
}

/// Sum of absolute differences; eight independent sums allow vectorisation.
fn sum_of_absolute_differences(here: &[f32], there: &[f32]) -> f64 {
    let (here, rest) = here.as_chunks::<8>();
    let (there, others) = there.as_chunks::<8>();
    let mut sums = [0.0f32; 8];
    for (here, there) in here.iter().zip(there) {
        for (sum, (here, there)) in sums.iter_mut().zip(here.iter().zip(there)) {
            *sum += (there - here).abs();
        }
    }
    let rest = rest.iter().zip(others).map(|(here, there)| f64::from((there - here).abs()));
    sums.into_iter().map(f64::from).sum::<f64>() + rest.sum::<f64>()
}

/// Mean absolute difference of all blocks at each lag.
fn mean_differences(stretches: &[GreyBlock]) -> Vec<f64> {
    let shortest = stretches.iter().map(|stretch| stretch.greys.len()).min().unwrap_or_default();
    let longest = MAX_ROW.min(shortest / 2);
    let starts =
        |stretch: &GreyBlock| LagDifferences::starts(stretch, COMPARED_VOXELS / stretches.len(), longest + 1);
    let sums: Vec<Vec<f32>> = stretches
        .par_iter()
        .map(|stretch| {
            let mut sums = vec![0.0f32; longest + 1];
            for start in starts(stretch) {
                let grey = stretch.greys[start];
                for (sum, other) in sums.iter_mut().zip(&stretch.greys[start..]) {
                    *sum += (other - grey).abs();
                }
            }
            sums
        })
        .collect();
    let count = stretches.iter().map(|stretch| starts(stretch).count()).sum::<usize>().max(1) as f64;
    (0..=longest).map(|lag| sums.iter().map(|sums| f64::from(sums[lag])).sum::<f64>() / count).collect()
}
