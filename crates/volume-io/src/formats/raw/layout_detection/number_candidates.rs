//! Detection of number type and byte order, by the estimated entropy of differences between neighbouring voxels.
//!
//! Bits per byte of the file are comparable between types: a wrong byte order moves the noise of the low byte into
//! the high one, two voxels taken for one number pay for the second in full, and half numbers jump.

use rayon::prelude::*;

use super::super::name_hints::RawNameHints;
use super::sample_blocks::{SampleBlocks, variation};
use crate::Endian;
use chiaroscuro_volume::VoxelType;

/// Bytes of each sample block that are analysed: 128 KiB over 16 blocks, for each of 50 combinations.
const ANALYSED_BYTES: usize = 8 << 10;

/// Number of neighbours that share a scale of differences, as in adaptive coders.
const BLOCK: usize = 32;

/// Ratio of mean differences below which one of the signed and unsigned interpretations is preferred.
const SIGN_PREFERENCE_RATIO: f64 = 0.995;

/// Share of the bits that numbers of twice the size must save: in homogeneous regions pairs of numbers cost hardly
/// less.
const WIDE_NUMBER_PENALTY: f64 = 0.06;

/// Usual magnitudes of measured numbers.
const USUAL_MAGNITUDES: std::ops::Range<f64> = 1e-20..1e20;

/// Reciprocal share of numbers that are -1 beyond which this is no coincidence.
const MASK_RECIPROCAL_SHARE: usize = 100;

/// Maximum number of differences per block that are coded in full, as outliers.
const MAX_OUTLIERS: usize = 3;

/// Interpretation of the bytes: number type, byte order, and alignment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NumberCandidate {
    pub(super) voxel_type: VoxelType,
    pub(super) endian: Endian,
    /// Offset of the first voxel, modulo the size of a number.
    pub(super) phase: usize,
    /// Estimated entropy in bits per byte of the file; at most 8.
    pub(super) bits: f64,
    /// Entropy with penalties for unusual properties; interpretations are ranked by it.
    pub(super) cost: f64,
    /// Mean difference of neighbours; large where a wrong sign makes small numbers follow the largest.
    pub(super) mean_difference: f64,
    /// Mean absolute value of the numbers.
    pub(super) mean_magnitude: f64,
    has_negative: bool,
    is_mask: bool,
    /// For signed bytes: true if the distribution suggests a sign.
    is_signed_byte: Option<bool>,
    /// Interpretation with the opposite signedness, if it gives different numbers.
    pub(super) other_signedness: Option<VoxelType>,
}

/// Ranks all interpretations of the blocks, most likely first.
pub(super) fn rank_candidates(spots: &SampleBlocks, said: RawNameHints) -> Vec<NumberCandidate> {
    let mut ways = Vec::new();
    for voxel_type in VoxelType::ALL {
        let orders: &[Endian] =
            if voxel_type.bytes() == 1 { &[Endian::Little] } else { &[Endian::Little, Endian::Big] };
        for &endian in orders {
            ways.extend((0..voxel_type.bytes()).map(|phase| (voxel_type, endian, phase)));
        }
    }
    let lively: Vec<usize> = spots.0.iter().map(|spot| most_varied_offset(&spot.bytes)).collect();
    let code = |(voxel_type, endian, phase): (VoxelType, Endian, usize)| {
        let keys: Vec<Vec<i64>> = spots
            .0
            .iter()
            .zip(&lively)
            .map(|(spot, &from)| {
                let skip = from + bytes_to_next_number(spot.at + from as u64, voxel_type, phase);
                let to = spot.bytes.len().min(from + ANALYSED_BYTES);
                ordered_keys(spot.bytes.get(skip..to).unwrap_or_default(), voxel_type, endian)
            })
            .collect();
        let bits = bits_per_byte(&keys, voxel_type);
        let unusual = unusual_penalty(&keys, voxel_type)
            + if endian == Endian::Big { 0.01 } else { 0.0 }
            + if phase > 0 { 0.05 } else { 0.0 }
            + if has_zero_low_byte(&keys, voxel_type) { 0.03 } else { 0.0 }
            + if has_all_ones_cluster(&keys) { 1.0 } else { 0.0 }
            + WIDE_NUMBER_PENALTY * f64::from(voxel_type.bytes().ilog2());
        let is_said = said.voxel_type.is_none_or(|said| said == voxel_type)
            && said.endian.is_none_or(|said| said == endian || voxel_type.bytes() == 1);
        // Hints of the file name are believed unless the content strongly contradicts.
        let contradicts = if is_said { 0.0 } else { 0.6 };
        // A tenth of a bit for files of constants, whose entropy is 0 in every interpretation.
        let cost = (bits + 0.1) * (1.0 + unusual + contradicts);
        let has_negative = keys.iter().flatten().any(|key| *key < 0);
        let count = keys.iter().map(Vec::len).sum::<usize>().max(1) as f64;
        let size = keys.iter().flatten().map(|key| key.unsigned_abs() as f64).sum::<f64>() / count;
        NumberCandidate {
            voxel_type,
            endian,
            phase,
            bits,
            cost,
            mean_difference: mean_difference(&keys),
            mean_magnitude: size,
            has_negative,
            is_mask: has_all_ones_cluster(&keys),
            is_signed_byte: (voxel_type == VoxelType::I8).then(|| is_signed(&keys)),
            other_signedness: None,
        }
    };
    let mut codes: Vec<NumberCandidate> = ways.into_par_iter().map(code).collect();
    codes.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    // Signed and unsigned give the same rows: the better of the two stands for both.
    let mut kept: Vec<NumberCandidate> = Vec::new();
    for code in codes {
        let twin = kept.iter_mut().find(|other| other.differs_in_sign_only(&code));
        match twin {
            Some(other) => other.choose_signedness(&code, said),
            None => kept.push(code),
        }
    }
    kept
}

impl NumberCandidate {
    /// Returns true if two interpretations differ only in signedness.
    fn differs_in_sign_only(&self, other: &Self) -> bool {
        let is_whole = |code: &Self| !matches!(code.voxel_type, VoxelType::F32 | VoxelType::F64);
        is_whole(self)
            && is_whole(other)
            && self.voxel_type.bytes() == other.voxel_type.bytes()
            && (self.endian, self.phase) == (other.endian, other.phase)
    }

    /// Chooses between the signed and unsigned interpretation, which have equal entropy.
    fn choose_signedness(&mut self, twin: &Self, said: RawNameHints) {
        // Without numbers that have the highest bit set, both give the same values.
        let differ = self.has_negative || twin.has_negative;
        // Large unsigned numbers throughout are rather small signed ones.
        let is_smaller = self.voxel_type.bytes() > 1 && twin.mean_magnitude < 0.5 * self.mean_magnitude;
        let is_smoother = twin.mean_difference < SIGN_PREFERENCE_RATIO * self.mean_difference
            || is_smaller && self.mean_difference >= SIGN_PREFERENCE_RATIO * twin.mean_difference;
        let is_byte = self.voxel_type.bytes() == 1;
        let is_signed = if self.is_signed_byte.is_some() { self.is_signed_byte } else { twin.is_signed_byte };
        let is_likelier = if is_byte {
            (twin.voxel_type == VoxelType::I8) == (is_signed == Some(true))
        } else {
            is_smoother && !twin.is_mask
        };
        let is_better = is_likelier && said.voxel_type != Some(self.voxel_type)
            || said.voxel_type == Some(twin.voxel_type);
        let other = if is_better { self.voxel_type } else { twin.voxel_type };
        if is_better {
            (self.voxel_type, self.mean_difference, self.mean_magnitude) =
                (twin.voxel_type, twin.mean_difference, twin.mean_magnitude);
        }
        self.other_signedness = differ.then_some(other);
    }
}

/// Offset of the part of a block with the greatest variation, except for its very beginning, which may be a header.
fn most_varied_offset(bytes: &[u8]) -> usize {
    let pieces = (0..bytes.len().saturating_sub(ANALYSED_BYTES / 2)).step_by(ANALYSED_BYTES / 2).skip(1);
    let unrest = |from: usize| variation(&bytes[from..bytes.len().min(from + ANALYSED_BYTES)]);
    pieces.max_by(|a, b| unrest(*a).total_cmp(&unrest(*b))).unwrap_or_default()
}

/// Number of bytes to skip from an offset in the file to the next number.
pub(super) fn bytes_to_next_number(at: u64, voxel_type: VoxelType, phase: usize) -> usize {
    let size = voxel_type.bytes() as u64;
    ((phase as u64 + size - at % size) % size) as usize
}

/// Maps numbers to integers in the same order; for floats, the difference counts the floats in between.
fn ordered_keys(bytes: &[u8], voxel_type: VoxelType, endian: Endian) -> Vec<i64> {
    macro_rules! keys {
        ($number:ty, $key:expr) => {
            bytes
                .chunks_exact(size_of::<$number>())
                .map(|chunk| {
                    let raw = chunk.try_into().unwrap_or_default();
                    $key(match endian {
                        Endian::Little => <$number>::from_le_bytes(raw),
                        Endian::Big => <$number>::from_be_bytes(raw),
                    })
                })
                .collect()
        };
    }
    match voxel_type {
        VoxelType::U8 => keys!(u8, i64::from),
        VoxelType::I8 => keys!(i8, i64::from),
        VoxelType::U16 => keys!(u16, i64::from),
        VoxelType::I16 => keys!(i16, i64::from),
        VoxelType::U32 => keys!(u32, i64::from),
        VoxelType::I32 => keys!(i32, i64::from),
        VoxelType::F32 => keys!(i32, |bits: i32| i64::from(bits ^ (((bits >> 31) as u32) >> 1) as i32)),
        VoxelType::F64 => keys!(i64, |bits: i64| bits ^ (((bits >> 63) as u64) >> 1) as i64),
    }
}

/// Mean absolute difference of neighbours.
fn mean_difference(keys: &[Vec<i64>]) -> f64 {
    let pairs = keys.iter().flat_map(|keys| keys.windows(2));
    let (sum, count) =
        pairs.fold((0.0, 0.0), |(sum, count), pair| (sum + pair[0].abs_diff(pair[1]) as f64, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Estimates the bits per byte for differences between neighbours, with one scale per block.
fn bits_per_byte(keys: &[Vec<i64>], voxel_type: VoxelType) -> f64 {
    let all = 8.0 * voxel_type.bytes() as f64;
    // Low bits that are zero in every number cost nothing.
    let used = keys.iter().flatten().fold(0, |used, key| used | key);
    let shift = if used == 0 { 0 } else { used.trailing_zeros() };
    let linear = linear_scale(keys, voxel_type);
    let (mut bits, mut count) = (0.0, 0usize);
    for keys in keys {
        let pairs = keys.len().saturating_sub(1);
        for start in (0..pairs).step_by(BLOCK) {
            let block = &keys[start..(start + BLOCK + 1).min(keys.len())];
            let pairs = || block.windows(2);
            let mut least = block_bits(pairs().map(|pair| (pair[0].abs_diff(pair[1]) >> shift) as f64), all);
            if let Some(scale) = &linear {
                let even = pairs().map(|pair| (scale(pair[0]) - scale(pair[1])).abs());
                least = least.min(block_bits(even, all));
            }
            bits += least;
            count += block.len() - 1;
        }
    }
    if count == 0 { 8.0 } else { bits / (count * voxel_type.bytes()) as f64 }
}

/// Returns true if all integers are multiples of 256, so that the byte order is probably the opposite.
fn has_zero_low_byte(keys: &[Vec<i64>], voxel_type: VoxelType) -> bool {
    let used = keys.iter().flatten().fold(0, |used, key| used | key);
    !matches!(voxel_type, VoxelType::F32 | VoxelType::F64) && used != 0 && used.trailing_zeros() >= 8
}

/// Returns true if bytes seem to be signed: values are frequent on both sides of 0 and rare at both ends of the
/// signed range. Differences do not help here, since there may be only two values.
fn is_signed(keys: &[Vec<i64>]) -> bool {
    let count = |values: std::ops::RangeInclusive<i64>| {
        keys.iter().flatten().filter(|key| values.contains(key)).count()
    };
    let around_zero = count(-3..=-1).min(count(0..=2));
    let at_the_ends = count(-128..=-126).min(count(125..=127));
    around_zero > 4 * at_the_ends && !has_all_ones_cluster(keys)
}

/// Returns true if the numbers cluster at −1, which is all ones: they are rather unsigned, with the maximum in a
/// mask.
fn has_all_ones_cluster(keys: &[Vec<i64>]) -> bool {
    let count = |value: i64| keys.iter().flatten().filter(|key| **key == value).count();
    let all: usize = keys.iter().map(Vec::len).sum();
    let [inside, beside] = [-1, -2].map(count);
    inside * MASK_RECIPROCAL_SHARE > all && inside > 4 * beside
}

/// Function that maps floats, which are dense around zero, to multiples of the smallest step between the largest
/// ones; `None` where too many are small.
fn linear_scale(keys: &[Vec<i64>], voxel_type: VoxelType) -> Option<Box<dyn Fn(i64) -> f64>> {
    let (number, digits): (fn(i64) -> f64, i32) = match voxel_type {
        VoxelType::F32 => (float_of, 24),
        VoxelType::F64 => (double_of, 53),
        _ => return None,
    };
    let mut sizes: Vec<f64> = keys
        .iter()
        .flatten()
        .step_by(17)
        .map(|&key| number(key).abs())
        .filter(|size| size.is_finite())
        .collect();
    sizes.sort_unstable_by(f64::total_cmp);
    // Of the 99th percentile, since the largest hundredth may be anything.
    let large =
        sizes.get(sizes.len() * 99 / 100).copied().filter(|large| USUAL_MAGNITUDES.contains(large))?;
    // Smaller numbers would lose digits that must be coded; few are acceptable.
    let is_small = |size: &&f64| **size > 0.0 && **size < large / 1024.0;
    if sizes.iter().filter(is_small).count() * 50 > sizes.len() {
        return None;
    }
    let step = large * 2f64.powi(-digits);
    Some(Box::new(move |key| {
        let number = number(key);
        if number.is_finite() { number.clamp(-large, large) / step } else { 0.0 }
    }))
}

fn float_of(key: i64) -> f64 {
    let bits = key as i32;
    f32::from_bits((bits ^ (((bits >> 31) as u32) >> 1) as i32) as u32).into()
}

fn double_of(key: i64) -> f64 {
    f64::from_bits((key ^ (((key >> 63) as u64) >> 1) as i64) as u64)
}

/// Estimated bits of a block of differences; the largest ones may be coded in full, for instance at the edge of an
/// object.
fn block_bits(steps: impl Iterator<Item = f64>, all: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    let mut largest = [0.0f64; MAX_OUTLIERS];
    for step in steps {
        sum += step;
        count += 1;
        let mut step = step;
        for large in &mut largest {
            if step > *large {
                std::mem::swap(&mut step, large);
            }
        }
    }
    let mut least = f64::INFINITY;
    for outliers in 0..=MAX_OUTLIERS.min(count) {
        let rest = (count - outliers) as f64;
        // Entropy of a Laplace distribution with this mean, log2(2e · mean), at least 0.
        let mean = if rest == 0.0 { 0.0 } else { (sum / rest).max(0.0) };
        let bits = (1.0 + 2.0 * std::f64::consts::E * mean).log2().min(all) * rest;
        // Outliers also cost the bits of their position.
        least = least.min(bits + outliers as f64 * (all + (count as f64).log2()));
        sum -= largest.get(outliers).copied().unwrap_or_default();
    }
    least
}

/// Penalty for unusual numbers, as a share of their cost.
fn unusual_penalty(keys: &[Vec<i64>], voxel_type: VoxelType) -> f64 {
    let share = |odd: &dyn Fn(i64) -> bool| {
        let count = keys.iter().map(Vec::len).sum::<usize>().max(1);
        keys.iter().flatten().filter(|key| odd(**key)).count() as f64 / count as f64
    };
    match voxel_type {
        VoxelType::U8 | VoxelType::U16 | VoxelType::F64 | VoxelType::F32 => {
            let odd = |key: i64| {
                let value = match voxel_type {
                    VoxelType::F32 => float_of(key),
                    VoxelType::F64 => double_of(key),
                    _ => return false,
                };
                value != 0.0 && !value.is_nan() && !USUAL_MAGNITUDES.contains(&value.abs())
            };
            2.0 * share(&odd)
        }
        VoxelType::I8 => 0.02,
        VoxelType::I16 => 0.005,
        // Counts over a hundred million are rarer than floats, whose bit patterns look like them.
        VoxelType::U32 | VoxelType::I32 => 0.03 + 0.3 * share(&|key| key.unsigned_abs() > 1 << 27),
    }
}
