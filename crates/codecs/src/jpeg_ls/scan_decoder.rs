//! Entropy decoder of one JPEG-LS scan (ITU-T T.87 annex A).

use std::array::from_fn;
use std::mem::replace;

use super::{JpegLsHeader, JpegLsImage, JpegLsStream, TRUNCATED};

/// Number of contexts (T.87 A.3.4), rounded up to a power of two so that all indices fit; from 365 on the two of run
/// interruption.
const CONTEXTS: usize = 512;
/// Number of bits that encode a run length (J of T.87 A.2.1), by run index.
const RUN_LENGTH_BITS: [u32; 32] =
    [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Decoder of a scan (T.87 annex A), with the names used there.
pub(super) struct JpegLsScanDecoder {
    /// Number of components of a pixel, including those of other scans.
    components: usize,
    maxval: i32,
    near: i32,
    range: i32,
    qbpp: u32,
    limit: u32,
    reset: i32,
    /// Gradient thresholds: NEAR + 1, T1, T2 and T3.
    thresholds: [i32; 4],
    /// Context counters A, B (after runs: Nn), C and N.
    contexts: [[i32; 4]; CONTEXTS],
    bits: JpegLsBits,
}

/// Components that share a run: their offsets within a pixel, their index into [`RUN_LENGTH_BITS`], and the left
/// neighbours of the previous line's first pixel.
type ComponentGroup<const N: usize> = ([usize; N], usize, [i32; N]);

impl JpegLsScanDecoder {
    pub(super) fn new(frame: &JpegLsHeader, presets: [u16; 5], near: u8) -> Result<Self, &'static str> {
        let &JpegLsHeader { components, bits, .. } = frame;
        let or = |given, usual| if given == 0 { usual } else { given };
        let ([maxval, t1, t2, t3, reset], near) = (presets.map(i32::from), i32::from(near));
        let (maxval, reset) = (or(maxval, (1 << bits) - 1), or(reset, 64));
        // Default thresholds (T.87 C.2.4.1.1.1).
        let (few, many) = (256 / (maxval + 1), (maxval.min(4095) + 128) / 256);
        let mut last = near + 1;
        let usual = [(3, 2, 3), (7, 3, 5), (21, 4, 7)].map(|(basic, least, nears)| {
            let bound = if few > 1 { basic / few } else { many * (basic - least) + least };
            let bound = least.max(bound + nears * near);
            last = if bound > maxval { last } else { bound.max(last) };
            last
        });
        let bounds = [near + 1, or(t1, usual[0]), or(t2, usual[1]), or(t3, usual[2])];
        // Valid ranges (T.87 tables C.2 and C.3).
        let are_right = bounds.is_sorted() && bounds[3] <= maxval && near <= maxval / 2;
        if !are_right || maxval >= 1 << bits || !(3..=maxval.max(255)).contains(&reset) {
            return Err("its parameters are out of range");
        }
        let range = (maxval + 2 * near) / (2 * near + 1) + 1;
        let [qbpp, bpp] = [range - 1, maxval.max(3)].map(|most| 32 - most.leading_zeros());
        let (limit, contexts) = (2 * (bpp + bpp.max(8)), [[0; 4]; CONTEXTS]);
        let bits = JpegLsBits::default();
        Ok(Self { components, maxval, near, range, qbpp, limit, reset, thresholds: bounds, contexts, bits })
    }

    /// Decodes the components of a scan, those of one array together; returns the offset at which the scan ends.
    pub(super) fn scan<const N: usize>(
        mut self,
        stream: &JpegLsStream<'_>,
        places: &[[usize; N]],
        picture: &mut JpegLsImage,
    ) -> Result<usize, &'static str> {
        let &JpegLsStream { packed, at, restart_interval: restart, .. } = stream;
        let (row, numbers) = (picture.width * picture.components, &mut picture.samples);
        if (picture.height * places.len()).div_ceil(8) > packed.len() - at {
            return Err(TRUNCATED);
        }
        let missing = row.saturating_mul(picture.height) - numbers.len();
        if numbers.try_reserve_exact(missing).is_err() {
            return Err("it is too large");
        }
        let mut marker = self.reset(packed, at);
        let fresh = || places.iter().map(|&places| (places, 0, [0; N])).collect();
        let (zeros, mut groups): (_, Vec<_>) = (vec![0; row], fresh());
        for y in 0..picture.height {
            let is_restart = y > 0 && y.checked_rem(restart) == Some(0);
            if is_restart {
                // Restart markers are numbered from D0 to D7 (T.81 B.2.1).
                if packed.get(marker + 1) != Some(&(0xd0 + (y / restart - 1) as u8 % 8)) {
                    return Err("a restart marker is missing");
                }
                (marker, groups) = (self.reset(packed, marker + 2), fresh());
            }
            numbers.resize(numbers.len().max((y + 1) * row), 0);
            let (above, line) = numbers.split_at_mut(y * row);
            let above = above.rchunks(row).next().filter(|_| !is_restart).unwrap_or(&zeros);
            let line = line.get_mut(..row).unwrap_or_default();
            for group in &mut groups {
                self.decode_line(above, line, group);
                if self.bits.at > self.bits.end {
                    return Err(TRUNCATED);
                }
            }
        }
        Ok(marker)
    }

    /// Resets the contexts (T.87 A.2.1); returns the offset of the next marker.
    fn reset(&mut self, packed: &[u8], at: usize) -> usize {
        self.contexts = [[2.max((self.range + 32) / 64), 0, 0, 1]; CONTEXTS];
        let rest = packed.get(at..).unwrap_or_default();
        let marker = rest.windows(2).position(|two| matches!(two, [0xff, 0x80..=0xff]));
        let length = marker.unwrap_or(rest.len());
        self.bits = JpegLsBits::new(rest.get(..length).unwrap_or_default());
        at + length
    }

    /// Decodes a line of a component group (T.87 A.3 to A.7).
    fn decode_line<const N: usize>(
        &mut self,
        above: &[u16],
        line: &mut [u16],
        group: &mut ComponentGroup<N>,
    ) {
        let ((places, run, previous_left), components) = (group, self.components);
        let mut b = from_fn(|i| above.get(places[i]).map_or(0, |&number| number.into()));
        let (mut a, mut c, mut run_remaining) = (b, replace(previous_left, b), 0);
        let width = line.len() / components;
        for (x, pixel) in line.chunks_exact_mut(components).enumerate() {
            let next = above.get((x + 1) * components..).unwrap_or_default();
            let d = from_fn(|i| next.get(places[i]).map_or(b[i], |&number| number.into()));
            if run_remaining == 0 {
                let kinds: [_; N] = from_fn(|i| self.context(a[i], b[i], c[i], d[i]));
                if kinds == [0; N] {
                    run_remaining = 1 + self.decode_run_length(run, width - x);
                } else {
                    a = from_fn(|i| self.decode_regular(kinds[i], a[i], b[i], c[i]));
                }
            }
            if run_remaining == 1 {
                a = from_fn(|i| self.decode_run_interruption::<N>(*run, a[i], b[i]));
                *run = run.saturating_sub(1);
            }
            run_remaining = run_remaining.saturating_sub(1);
            for (&place, &number) in places.iter().zip(&a) {
                if let Some(old) = pixel.get_mut(place) {
                    *old = number as u16;
                }
            }
            (c, b) = (b, d);
        }
    }

    /// Returns the context of a pixel, negative for the mirrored context (T.87 A.3).
    fn context(&self, a: i32, b: i32, c: i32, d: i32) -> i32 {
        let [high, middle, low] = [d - b, b - c, c - a].map(|gradient| {
            let size = gradient.abs();
            self.thresholds.iter().map(|&bound| i32::from(size >= bound)).sum::<i32>() * gradient.signum()
        });
        81 * high + 9 * middle + low
    }

    /// Decodes a sample in regular mode, that is, outside of runs (T.87 A.4 to A.6).
    fn decode_regular(&mut self, kind: i32, a: i32, b: i32, c: i32) -> i32 {
        let (sign, index) = (if kind < 0 { -1 } else { 1 }, kind.unsigned_abs() as usize % CONTEXTS);
        let [sum, bias, correction, n] = self.contexts[index];
        let expected = (a + b - c).clamp(a.min(b), a.max(b)) + sign * correction;
        let low = golomb_parameter(sum, n);
        let mapped = self.decode_mapped_error(low, 0);
        let is_turned = low == 0 && self.near == 0 && 2 * bias <= -n;
        let difference = mapped >> 1 ^ -(mapped & 1) ^ -i32::from(is_turned);
        let [_, b, c, n] = self.update_context(index, difference.abs(), difference * (2 * self.near + 1));
        if *b <= -*n {
            (*b, *c) = ((*b + *n).max(1 - *n), (*c - 1).max(-128));
        } else if *b > 0 {
            (*b, *c) = ((*b - *n).min(0), (*c + 1).min(127));
        }
        self.reconstruct(expected.clamp(0, self.maxval), sign * difference)
    }

    /// Decodes the length of a run, given the number of remaining pixels (T.87 A.7.1).
    fn decode_run_length(&mut self, run: &mut usize, left: usize) -> usize {
        let mut length = 0;
        while length < left {
            let bits = RUN_LENGTH_BITS[*run % RUN_LENGTH_BITS.len()];
            if self.bits.take(1) == 0 {
                length += self.bits.take(bits) as usize;
                // The sample that interrupts a run must lie in the same line.
                if length >= left {
                    self.bits.at = self.bits.end + 1;
                }
                return length;
            }
            length += 1 << bits;
            *run = (*run + usize::from(length <= left)).min(RUN_LENGTH_BITS.len() - 1);
        }
        length
    }

    /// Decodes the sample that interrupts a run (T.87 A.7.2); `RItype` is always 0 with several interleaved
    /// components.
    fn decode_run_interruption<const N: usize>(&mut self, run: usize, a: i32, b: i32) -> i32 {
        let ri_type = i32::from(N == 1 && (a - b).abs() <= self.near);
        let index = (365 + ri_type as usize) % CONTEXTS;
        let [sum, below, _, n] = self.contexts[index];
        let low = golomb_parameter(sum.saturating_add(ri_type * (n >> 1)), n);
        let mapped = self.decode_mapped_error(low, RUN_LENGTH_BITS[run % RUN_LENGTH_BITS.len()] + 1);
        let size = (mapped + ri_type + 1) >> 1;
        let is_often = low != 0 || 2 * below >= n;
        let is_below = size > 0 && ((mapped + ri_type) & 1 == 1) == is_often;
        self.update_context(index, (mapped + 1 - ri_type) >> 1, is_below.into());
        let difference = if is_below == (ri_type == 0 && a > b) { size } else { -size };
        self.reconstruct(if ri_type == 1 { a } else { b }, difference)
    }

    /// Updates the counters of a context (T.87 A.6.1, A.7.2).
    fn update_context(&mut self, index: usize, size: i32, difference: i32) -> &mut [i32; 4] {
        let context = &mut self.contexts[index % CONTEXTS];
        let [a, b, _, n] = context;
        let half = u32::from(*n == self.reset);
        *a = a.saturating_add(size) >> half;
        *b = (*b + difference) >> half;
        *n = (*n >> half) + 1;
        context
    }

    /// Reconstructs a sample from prediction and error, modulo the range (T.87 A.4.4, A.4.5).
    fn reconstruct(&self, expected: i32, difference: i32) -> i32 {
        let step = 2 * self.near + 1;
        let number = expected + difference * step;
        let wrap = i32::from(number < -self.near) - i32::from(number > self.maxval + self.near);
        (number + wrap * self.range * step).clamp(0, self.maxval)
    }

    /// Decodes a mapped error in limited-length Golomb code, with parameter k = `low` and the limit reduced by `off`
    /// (T.87 A.5.3).
    fn decode_mapped_error(&mut self, low: u32, off: u32) -> i32 {
        let most = self.limit.saturating_sub(self.qbpp + 1 + off);
        let zeros = self.bits.peek().leading_zeros();
        self.bits.at += zeros as usize + 1;
        let mapped =
            if zeros < most { zeros << low | self.bits.take(low) } else { self.bits.take(self.qbpp) + 1 };
        if zeros > most || mapped > self.range.cast_unsigned() {
            self.bits.at = self.bits.end + 1;
            return 0;
        }
        mapped.cast_signed()
    }
}

/// Returns the Golomb parameter k for an error sum and its count: the smallest with `count << k >= sum` (T.87 A.5.1).
fn golomb_parameter(sum: i32, count: i32) -> u32 {
    let low = count.leading_zeros().saturating_sub(sum.leading_zeros());
    low + u32::from(count << low < sum)
}

/// Bit reader of the data between two markers.
#[derive(Default)]
struct JpegLsBits {
    /// Data without stuffed bits, followed by zeros.
    bytes: Vec<u8>,
    end: usize,
    /// Index of the next bit; beyond `end` after an error.
    at: usize,
}

impl JpegLsBits {
    /// Removes bit stuffing: a byte after FF holds only 7 bits (T.87 A.1).
    fn new(packed: &[u8]) -> Self {
        let (mut bytes, mut bits, mut count, mut last) = (Vec::new(), 0, 0, 0);
        for &byte in packed {
            let size = if last == 0xff { 7 } else { 8 };
            (bits, count, last) = (bits << size | u32::from(byte), count + size, byte);
            if count >= 8 {
                count -= 8;
                bytes.push((bits >> count) as u8);
            }
        }
        let end = 8 * bytes.len() + count;
        bytes.extend([(bits << (8 - count)) as u8, 0, 0, 0, 0, 0, 0, 0, 0]);
        Self { bytes, end, at: 0 }
    }

    /// Returns at least the next 57 bits, left-aligned, without consuming them.
    fn peek(&self) -> u64 {
        let eight = self.bytes.get(self.at / 8..).and_then(|rest| rest.first_chunk());
        eight.map_or(0, |&eight| u64::from_be_bytes(eight) << (self.at % 8))
    }

    /// Consumes up to 32 bits.
    fn take(&mut self, count: u32) -> u32 {
        let taken = self.peek() >> 1 >> (63 - count);
        self.at += count as usize;
        taken as u32
    }
}
