//! Number types and byte orders, by how few bits the voxels would take if each were told as its difference from the one
//! before.
//!
//! Bits for each byte of the file can be compared whatever the type: a wrong order puts the noise of the low byte into the
//! high one, two voxels that are taken for one number pay for the second in full, and half a number jumps.

use rayon::prelude::*;

use super::super::said::Said;
use super::spots::{Spots, unrest};
use crate::data::VoxelType;
use crate::data::load::Endian;

/// Bytes of each spot that are looked at: 16 spots have 128 KiB, in 50 ways.
const LOOKED_AT: usize = 8 << 10;

/// Neighbours that share a measure of how large their differences are, as coders adapt.
const BLOCK: usize = 32;

/// Numbers have a sign, or none, when their neighbours then differ by less than this share.
const SMOOTHER: f64 = 0.995;

/// Twice as wide numbers must save this share of the bits: where little happens, pairs of numbers cost hardly less.
const WIDE: f64 = 0.06;

/// Sizes of numbers that anybody measures.
const USUAL: std::ops::Range<f64> = 1e-20..1e20;

/// More than one number of so many is -1 where none is by chance.
const MASK: usize = 100;

/// Differences of a block that may be told in full.
const TOLD: usize = 3;

/// A number type and byte order, and where in the file numbers begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Code {
    pub(super) voxel_type: VoxelType,
    pub(super) endian: Endian,
    /// The first byte of the voxels, modulo their size.
    pub(super) phase: usize,
    /// Bits for each byte of the file; at most 8.
    pub(super) bits: f64,
    /// Those, with what is unusual counted as more.
    pub(super) cost: f64,
    /// Mean difference of neighbours, which is large where small numbers seem to follow the largest.
    pub(super) step: f64,
    /// Mean distance of the numbers from 0.
    pub(super) size: f64,
    has_negative: bool,
    is_mask: bool,
    /// Of signed bytes: whether they seem to have a sign.
    is_signed_byte: Option<bool>,
    /// The same numbers with or without a sign, if that makes other numbers of them.
    pub(super) twin: Option<VoxelType>,
}

/// All number types and byte orders, the likeliest first.
pub(super) fn ranked(spots: &Spots, said: Said) -> Vec<Code> {
    let mut ways = Vec::new();
    for voxel_type in VoxelType::ALL {
        let orders: &[Endian] =
            if voxel_type.bytes() == 1 { &[Endian::Little] } else { &[Endian::Little, Endian::Big] };
        for &endian in orders {
            ways.extend((0..voxel_type.bytes()).map(|phase| (voxel_type, endian, phase)));
        }
    }
    let lively: Vec<usize> = spots.0.iter().map(|spot| liveliest(&spot.bytes)).collect();
    let code = |(voxel_type, endian, phase): (VoxelType, Endian, usize)| {
        let keys: Vec<Vec<i64>> = spots
            .0
            .iter()
            .zip(&lively)
            .map(|(spot, &from)| {
                let skip = from + first(spot.at + from as u64, voxel_type, phase);
                let to = spot.bytes.len().min(from + LOOKED_AT);
                keys(spot.bytes.get(skip..to).unwrap_or_default(), voxel_type, endian)
            })
            .collect();
        let bits = bits_for_each_byte(&keys, voxel_type);
        let unusual = unusual(&keys, voxel_type)
            + if endian == Endian::Big { 0.01 } else { 0.0 }
            + if phase > 0 { 0.05 } else { 0.0 }
            + if has_empty_byte(&keys, voxel_type) { 0.03 } else { 0.0 }
            + if is_mask(&keys) { 1.0 } else { 0.0 }
            + WIDE * f64::from(voxel_type.bytes().ilog2());
        let is_said = said.voxel_type.is_none_or(|said| said == voxel_type)
            && said.endian.is_none_or(|said| said == endian || voxel_type.bytes() == 1);
        // What is said is believed unless the bytes cry out against it.
        let contradicts = if is_said { 0.0 } else { 0.6 };
        // A tenth of a bit for files that hold nothing but constants, which all types tell for nothing.
        let cost = (bits + 0.1) * (1.0 + unusual + contradicts);
        let has_negative = keys.iter().flatten().any(|key| *key < 0);
        let count = keys.iter().map(Vec::len).sum::<usize>().max(1) as f64;
        let size = keys.iter().flatten().map(|key| key.unsigned_abs() as f64).sum::<f64>() / count;
        Code {
            voxel_type,
            endian,
            phase,
            bits,
            cost,
            step: step(&keys),
            size,
            has_negative,
            is_mask: is_mask(&keys),
            is_signed_byte: (voxel_type == VoxelType::I8).then(|| is_signed(&keys)),
            twin: None,
        }
    };
    let mut codes: Vec<Code> = ways.into_par_iter().map(code).collect();
    codes.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    // Signed or not, the rows are the same: the better of the two stands for both.
    let mut kept: Vec<Code> = Vec::new();
    for code in codes {
        let twin = kept.iter_mut().find(|other| other.is_twin_of(&code));
        match twin {
            Some(other) => other.settle(&code, said),
            None => kept.push(code),
        }
    }
    kept
}

impl Code {
    /// Whether another is the same but for the sign.
    fn is_twin_of(&self, other: &Self) -> bool {
        let is_whole = |code: &Self| !matches!(code.voxel_type, VoxelType::F32 | VoxelType::F64);
        is_whole(self)
            && is_whole(other)
            && self.voxel_type.bytes() == other.voxel_type.bytes()
            && (self.endian, self.phase) == (other.endian, other.phase)
    }

    /// Chooses between numbers with a sign and without, which take as many bits.
    fn settle(&mut self, twin: &Self, said: Said) {
        // Where the highest digit is never used, the numbers are the same.
        let differ = self.has_negative || twin.has_negative;
        // Wide numbers that would all be huge are small ones with a sign.
        let is_smaller = self.voxel_type.bytes() > 1 && twin.size < 0.5 * self.size;
        let is_smoother = twin.step < SMOOTHER * self.step || is_smaller && self.step >= SMOOTHER * twin.step;
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
            (self.voxel_type, self.step, self.size) = (twin.voxel_type, twin.step, twin.size);
        }
        self.twin = differ.then_some(other);
    }
}

/// Where in a spot most is to be seen, rather not at its very beginning: there may be a header.
fn liveliest(bytes: &[u8]) -> usize {
    let pieces = (0..bytes.len().saturating_sub(LOOKED_AT / 2)).step_by(LOOKED_AT / 2).skip(1);
    let unrest = |from: usize| unrest(&bytes[from..bytes.len().min(from + LOOKED_AT)]);
    pieces.max_by(|a, b| unrest(*a).total_cmp(&unrest(*b))).unwrap_or_default()
}

/// How many bytes to skip from a place of the file to the next number.
pub(super) fn first(at: u64, voxel_type: VoxelType, phase: usize) -> usize {
    let size = voxel_type.bytes() as u64;
    ((phase as u64 + size - at % size) % size) as usize
}

/// Integers in the order of the numbers: of floats, as many apart as there are floats between them.
fn keys(bytes: &[u8], voxel_type: VoxelType, endian: Endian) -> Vec<i64> {
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

/// Mean difference of neighbours.
fn step(keys: &[Vec<i64>]) -> f64 {
    let pairs = keys.iter().flat_map(|keys| keys.windows(2));
    let (sum, count) =
        pairs.fold((0.0, 0.0), |(sum, count), pair| (sum + pair[0].abs_diff(pair[1]) as f64, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Bits for each byte when numbers are told as differences, in blocks of one scale.
fn bits_for_each_byte(keys: &[Vec<i64>], voxel_type: VoxelType) -> f64 {
    let all = 8.0 * voxel_type.bytes() as f64;
    // Digits that are zero in every number cost nothing.
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

/// Whether whole numbers are all multiples of 256: rather, their bytes are in the other order.
fn has_empty_byte(keys: &[Vec<i64>], voxel_type: VoxelType) -> bool {
    let used = keys.iter().flatten().fold(0, |used, key| used | key);
    !matches!(voxel_type, VoxelType::F32 | VoxelType::F64) && used != 0 && used.trailing_zeros() >= 8
}

/// Whether bytes have a sign: values around 0 go on into what else would be the largest, and there are few where the signs
/// meet at the other end. How far values jump says nothing here, as there may be but two.
fn is_signed(keys: &[Vec<i64>]) -> bool {
    let count = |values: std::ops::RangeInclusive<i64>| {
        keys.iter().flatten().filter(|key| values.contains(key)).count()
    };
    let around_zero = count(-3..=-1).min(count(0..=2));
    let at_the_ends = count(-128..=-126).min(count(125..=127));
    around_zero > 4 * at_the_ends && !is_mask(keys)
}

/// Whether numbers pile up at 0 and at −1, which is all ones: rather, they have no sign, and are as large as they can be.
fn is_mask(keys: &[Vec<i64>]) -> bool {
    let count = |value: i64| keys.iter().flatten().filter(|key| **key == value).count();
    let all: usize = keys.iter().map(Vec::len).sum();
    let [inside, beside] = [-1, -2].map(count);
    inside * MASK > all && inside > 4 * beside
}

/// Of floats, which lie dense around zero: numbers as multiples of the smallest step between the largest of them.
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
    // Of the largest but a hundredth, which may be anything.
    let large = sizes.get(sizes.len() * 99 / 100).copied().filter(|large| USUAL.contains(large))?;
    // Smaller numbers would lose digits, which must be told: there may be few of them.
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

/// Bits of a block of differences; the largest may be told in full, as the edge of an object is.
fn block_bits(steps: impl Iterator<Item = f64>, all: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    let mut largest = [0.0f64; TOLD];
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
    for told in 0..=TOLD.min(count) {
        let rest = (count - told) as f64;
        // The entropy of a two-sided exponential distribution of that mean, log2(2e · mean), from 0 on.
        let mean = if rest == 0.0 { 0.0 } else { (sum / rest).max(0.0) };
        let bits = (1.0 + 2.0 * std::f64::consts::E * mean).log2().min(all) * rest;
        // What is told in full also says where it is.
        least = least.min(bits + told as f64 * (all + (count as f64).log2()));
        sum -= largest.get(told).copied().unwrap_or_default();
    }
    least
}

/// How unusual the numbers are, as a share of their cost.
fn unusual(keys: &[Vec<i64>], voxel_type: VoxelType) -> f64 {
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
                value != 0.0 && !value.is_nan() && !USUAL.contains(&value.abs())
            };
            2.0 * share(&odd)
        }
        VoxelType::I8 => 0.02,
        VoxelType::I16 => 0.005,
        // Counts of more than a hundred million are rarer than floats, which look like that.
        VoxelType::U32 | VoxelType::I32 => 0.03 + 0.3 * share(&|key| key.unsigned_abs() > 1 << 27),
    }
}
