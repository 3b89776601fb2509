//! Sequential lossy JPEG of 8 or 12 bits (ITU-T T.81, Huffman coding: SOF0 and SOF1), from an untrusted stream to
//! numbers from 0 to 2^bits − 1; colours are not converted.

mod bits;

use std::array::from_fn;
use std::f64::consts::{PI, SQRT_2};

use bits::{HuffmanTable, ScanBits};

/// Block of 8 x 8 numbers, row by row (T.81 section A.1.3).
type JpegBlock = [[f64; 8]; 8];

/// Error message for an image that ends before it is complete.
const TRUNCATED: &str = "the image is truncated, or broken before its last block";

/// Frame header of an image: size in pixels, components (1 to 4) and bits per component (8 or 12).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct JpegFrameHeader {
    /// Width of the image in pixels, 1 to 65535.
    pub width: usize,
    /// Height of the image in pixels, 1 to 65535.
    pub height: usize,
    /// Number of components per pixel, 1 to 4.
    pub components: usize,
    /// Number of bits per component, 8 or 12.
    pub(super) bits: u32,
    /// True for extended (SOF1), false for baseline (SOF0).
    pub(super) is_extended: bool,
}

/// Decoded image with its size and samples.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JpegImage {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) components: usize,
    pub(super) bits: u32,
    /// Samples row by row, the components of a pixel adjacent: numbers from 0 to 2^bits − 1, as many as width × height
    /// × components.
    pub samples: Vec<u16>,
}

/// Parses a stream up to its frame header, and no further.
///
/// # Errors
/// Reason why `packed` is no JPEG, is broken, or is of an unsupported kind, such as progressive: a clause without a
/// full stop, to be put behind the name of the image. It quotes no text of the stream, only numbers of its header.
pub fn header(packed: &[u8]) -> Result<JpegFrameHeader, String> {
    let mut decoder = LossyJpegDecoder::new(packed)?;
    while decoder.header.width == 0 {
        decoder.read_segment()?;
    }
    Ok(decoder.header)
}

/// Decodes an image: all of it, or nothing. Allocates the size that [`header`] states.
///
/// # Errors
/// Reason why the image cannot be decoded, worded like that of [`header`]; images that are truncated, or too large for
/// the memory, are errors too.
pub fn decode(packed: &[u8]) -> Result<JpegImage, String> {
    let mut decoder = LossyJpegDecoder::new(packed)?;
    while decoder.header.width == 0 || !decoder.pending_components.is_empty() {
        decoder.read_segment()?;
    }
    let JpegFrameHeader { width, height, components, bits, is_extended: _ } = decoder.header;
    Ok(JpegImage { width, height, components, bits, samples: decoder.samples })
}

/// Component of the image (T.81 section B.2.2).
#[derive(Default)]
struct JpegComponent<'a> {
    id: u8,
    /// Index of the component within a pixel.
    index: usize,
    /// Sampling factors, horizontal and vertical.
    sampling_factors: [usize; 2],
    /// Number of blocks with samples, horizontally and vertically.
    blocks: [usize; 2],
    /// Index of the component's quantisation table.
    quantization_table: usize,
    /// Quantisation steps in zigzag order, set when its scan begins.
    quantization_steps: Vec<f64>,
    /// Huffman tables of DC and AC coefficients, set when its scan begins.
    huffman_tables: [HuffmanTable<'a>; 2],
    /// DC coefficient of the previous block, in quantisation steps.
    dc_predictor: i32,
}

/// Decoder state of a stream.
#[derive(Default)]
struct LossyJpegDecoder<'a> {
    bits: ScanBits<'a>,
    /// Frame header; all zero before it is read.
    header: JpegFrameHeader,
    /// Components that no scan has contained yet.
    pending_components: Vec<JpegComponent<'a>>,
    /// Maximum sampling factors, horizontal and vertical.
    max_factors: [usize; 2],
    /// Tables as stored, by destination: DC Huffman, AC Huffman, quantisation.
    tables: [[&'a [u8]; 4]; 3],
    /// Restart interval in minimum coded units (MCUs), or 0.
    restart_interval: usize,
    samples: Vec<u16>,
    /// DCT basis by frequency and position (T.81 section A.3.3), scaled to 1 for frequency 0, so that integers stay
    /// exact; two-dimensional sums are 8 times too large.
    dct_basis: JpegBlock,
}

impl<'a> LossyJpegDecoder<'a> {
    /// Starts a decoder behind the SOI marker.
    fn new(packed: &'a [u8]) -> Result<Self, String> {
        let rest = packed.strip_prefix(b"\xff\xd8").ok_or("it does not begin as a JPEG image")?;
        let wave = |u, x| (f64::from((2 * x + 1) * u) * PI / 16.0).cos();
        let scaled = |u, x| if u == 0 { 1.0 } else { SQRT_2 * wave(u, x) };
        let waves = from_fn(|u| from_fn(|x| scaled(u as u32, x as u32)));
        Ok(Self { bits: ScanBits { rest, ..ScanBits::default() }, dct_basis: waves, ..Self::default() })
    }

    /// Reads a marker with its segment, and the scan behind it if there is one (T.81 table B.1).
    fn read_segment(&mut self) -> Result<(), String> {
        let marker = self.bits.marker().ok_or(TRUNCATED)?;
        let length = self.bits.rest.first_chunk().map_or(0, |&length| u16::from_be_bytes(length));
        let (segment, rest) = self.bits.rest.split_at_checked(length.into()).ok_or(TRUNCATED)?;
        // The length includes its own two bytes.
        let body = segment.get(2..).ok_or(TRUNCATED)?;
        self.bits.rest = rest;
        match marker {
            0xc0 | 0xc1 if self.header.width > 0 => Err("the image has two frame headers")?,
            0xc0 | 0xc1 => self.read_frame(marker, body)?,
            0xc2 => Err("progressive JPEG of 12 bits is not supported")?,
            0xc3 => Err("lossless JPEG is not supported by this decoder")?,
            0xc4 | 0xdb => {
                self.read_tables(marker, body).ok_or("a Huffman or quantisation table is broken")?;
            }
            0xc8..=0xcc => Err("JPEG with arithmetic coding is not supported")?,
            0xc5..=0xcf | 0xde | 0xdf => Err("hierarchical JPEG is not supported")?,
            0xda => self.read_scan(body)?,
            0xdc => Err("JPEG with its height after a scan (DNL) is not supported")?,
            0xdd => self.restart_interval = u16::from_be_bytes(*body.first_chunk().ok_or(TRUNCATED)?).into(),
            0xe0..=0xfe => {} // Application segments and comments.
            _ => Err(TRUNCATED)?,
        }
        Ok(())
    }

    /// Stores Huffman or quantisation tables (T.81 sections B.2.4.1 and B.2.4.2).
    fn read_tables(&mut self, marker: u8, mut body: &'a [u8]) -> Option<()> {
        while let [kind, after @ ..] = body {
            let (kind, place) = (usize::from(kind >> 4), usize::from(kind & 15));
            let (row, length) = if marker == 0xdb {
                (2, 64 * (kind + 1))
            } else {
                let counts = after.first_chunk::<16>()?.iter().map(|&count| usize::from(count));
                (kind, 16 + counts.sum::<usize>())
            };
            let table;
            (table, body) = after.split_at_checked(length).filter(|_| kind < 2)?;
            *self.tables.get_mut(row)?.get_mut(place)? = table;
        }
        Some(())
    }

    /// Parses the frame header: size and components (T.81 section B.2.2).
    fn read_frame(&mut self, marker: u8, body: &[u8]) -> Result<(), String> {
        let &[bits, y1, y0, x1, x0, count, ref named @ ..] = body else { Err(TRUNCATED)? };
        let [width, height] = [[x1, x0], [y1, y0]].map(|two| usize::from(u16::from_be_bytes(two)));
        let (named, after) = named.as_chunks::<3>();
        let factors = named.iter().map(|[_, both, _]| [both >> 4, both & 15].map(usize::from));
        let is_whole = after.is_empty() && named.len() == usize::from(count);
        let is_known = matches!((bits, count), (8 | 12, 1..=4)) && width > 0 && height > 0;
        if !is_whole || !is_known || !factors.clone().flatten().all(|n| matches!(n, 1..=4)) {
            let size = format!("{width} x {height} pixels of {count} samples of {bits} bits");
            return Err(format!("lossy JPEG of {size} is broken, or not supported"));
        }
        let [x, y] = factors.clone().fold([1, 1], |[x, y], [h, v]| [h.max(x), v.max(y)]);
        for (place, (&[id, _, table], [h, v])) in named.iter().zip(factors).enumerate() {
            // Dimensions of the component (T.81 section A.1.1).
            let samples = [(width * h).div_ceil(x), (height * v).div_ceil(y)];
            let blocks = samples.map(|samples| samples.div_ceil(8));
            let (factors, table) = ([h, v], table.into());
            self.pending_components.push(JpegComponent {
                id,
                index: place,
                sampling_factors: factors,
                blocks,
                quantization_table: table,
                ..JpegComponent::default()
            });
        }
        self.max_factors = [x, y];
        let (components, bits, is_extended) = (named.len(), bits.into(), marker == 0xc1);
        self.header = JpegFrameHeader { width, height, components, bits, is_extended };
        Ok(())
    }

    /// Allocates the samples, if the rest of the stream can encode them.
    fn allocate(&mut self) -> Result<(), String> {
        let JpegFrameHeader { width, height, components, .. } = self.header;
        let blocks: usize = self.pending_components.iter().map(|part| part.blocks[0] * part.blocks[1]).sum();
        let count = (width * height).saturating_mul(components);
        // A byte encodes at most 4 blocks: each has a DC code and at least one AC code.
        let is_held = blocks.div_ceil(4) <= self.bits.rest.len();
        if !is_held || self.samples.try_reserve_exact(count - self.samples.len()).is_err() {
            return Err(format!("{width} x {height} pixels are truncated, or do not fit in memory"));
        }
        self.samples.resize(count, 0);
        Ok(())
    }

    /// Removes the components of a scan from the pending ones, and resolves their tables (T.81 section B.2.3).
    fn take_components(&mut self, body: &[u8]) -> Option<Vec<JpegComponent<'a>>> {
        // The last three bytes are constant in sequential scans, and some programs write them wrong.
        let [count, named @ .., _, _, _] = body else { return None };
        let [means, others, steps] = self.tables;
        let parts = named.as_chunks().0.iter().map(|&[id, both]| {
            let index = self.pending_components.iter().position(|part| part.id == id)?;
            let part = self.pending_components.remove(index);
            let means = HuffmanTable::new(means.get(usize::from(both >> 4))?)?;
            let others = HuffmanTable::new(others.get(usize::from(both & 15))?)?;
            let table = steps.get(part.quantization_table).filter(|table| !table.is_empty())?;
            let read = |step: &[u8]| step.iter().fold(0, |high, &low| (high << 8) | u16::from(low));
            // Steps have one or two bytes each.
            let steps = table.chunks(table.len().div_ceil(64)).map(|step| read(step).into());
            Some(JpegComponent {
                quantization_steps: steps.collect(),
                huffman_tables: [means, others],
                ..part
            })
        });
        let parts: Vec<_> = parts.collect::<Option<_>>()?;
        (!parts.is_empty() && named.len() == 2 * usize::from(*count)).then_some(parts)
    }

    /// Decodes a scan (T.81 sections A.2 and E.2.4).
    fn read_scan(&mut self, body: &[u8]) -> Result<(), String> {
        self.allocate()?;
        let parts = self.take_components(body);
        let mut parts = parts.ok_or("a scan lacks a table, or has wrong components")?;
        let ([x, y], JpegFrameHeader { width, height, .. }) = (self.max_factors, self.header);
        let [across, down] = match &parts[..] {
            // A scan of a single component has no padding blocks.
            [part] => part.blocks,
            _ => [width.div_ceil(8 * x), height.div_ceil(8 * y)],
        };
        let is_alone = parts.len() == 1;
        for mcu in 0..across * down {
            if mcu > 0 && mcu.is_multiple_of(self.restart_interval) {
                let restart = 0xd0 + (mcu / self.restart_interval - 1) % 8;
                let found = self.bits.marker().filter(|&found| usize::from(found) == restart);
                found.ok_or("a restart marker is missing")?;
                for part in &mut parts {
                    part.dc_predictor = 0;
                }
            }
            for part in &mut parts {
                let [h, v] = if is_alone { [1, 1] } else { part.sampling_factors };
                for index in 0..h * v {
                    let block = self.bits.decode_block(part)?;
                    let at = [mcu % across * h + index % h, mcu / across * v + index / h];
                    self.write_block(part, at, &block);
                }
            }
        }
        Ok(())
    }

    /// Writes a block to the image, each sample to all pixels that it covers.
    fn write_block(&mut self, part: &JpegComponent<'_>, [x, y]: [usize; 2], block: &JpegBlock) {
        let JpegFrameHeader { width, height, components, bits, is_extended: _ } = self.header;
        let ([h, v], [most_h, most_v]) = (part.sampling_factors, self.max_factors);
        // Level shift (T.81 section A.3.1), plus one half so that truncation rounds.
        let level_shift = (1 << (bits - 1)) as f64 + 0.5;
        let most = ((1 << bits) - 1) as f64;
        let sums = transposed_idct(&transposed_idct(block, &self.dct_basis), &self.dct_basis);
        let samples = sums.map(|row| row.map(|sum| (sum / 8.0 + level_shift).clamp(0.0, most) as u16));
        let [left, right] = [x, x + 1].map(|x| (8 * x * most_h).div_ceil(h).min(width));
        let [top, bottom] = [y, y + 1].map(|y| (8 * y * most_v).div_ceil(v).min(height));
        for row in top..bottom {
            let samples = samples[row * v / most_v % 8];
            for column in left..right {
                let at = (row * width + column) * components + part.index;
                if let Some(number) = self.samples.get_mut(at) {
                    *number = samples[column * h / most_h % 8];
                }
            }
        }
    }
}

/// 1-D inverse DCT along columns, transposing the block.
fn transposed_idct(coefficients: &JpegBlock, waves: &JpegBlock) -> JpegBlock {
    let mut sums = [[0.0; 8]; 8];
    for (heights, wave) in coefficients.iter().zip(waves) {
        // Most coefficients are 0.
        for (line, &height) in sums.iter_mut().zip(heights).filter(|(_, height)| **height != 0.0) {
            line.iter_mut().zip(wave).for_each(|(sum, value)| *sum += height * value);
        }
    }
    sums
}

#[cfg(test)]
mod tests;
