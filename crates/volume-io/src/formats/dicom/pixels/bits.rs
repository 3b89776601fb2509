//! Pixels of one bit, eight to a byte, lowest bit first (PS3.5 section 8.1): masks of segmentations.

use std::io::Read as _;

use super::super::header::transfer_syntax::PixelCodec;
use super::codec::{decode_image, inflate};
use super::conversion::{PixelConversion, VoxelNumber};
use super::layout::{IntegerBits, PixelLayout, PixelNumber};
use super::pixel_store::{PixelLocation, PixelStore, frame_error, read_fragments};
use super::rle;
use super::size_check::COPY_ADVICE;
use crate::reading::input::InputFile;
use chiaroscuro_volume::{LoadContext, LoadError};

/// Storage of a mask that a codec has unpacked to a byte for each pixel.
const BYTE: PixelNumber =
    PixelNumber::Integer(IntegerBits { allocated: 8, stored: 8, high: 7, is_signed: false });

impl PixelStore {
    /// Reads the voxels of a frame of one-bit pixels.
    pub(super) fn read_bits<T: VoxelNumber>(
        &self,
        context: LoadContext<'_>,
        frame: usize,
        raster: PixelConversion,
        voxels: &mut [T],
    ) -> Result<(), LoadError> {
        let beyond =
            || context.bad_input_error("Number of Frames", "it has fewer frames than stated", COPY_ADVICE);
        let pixels = self.shape().pixel_count() as u64;
        let first = pixels.checked_mul(frame as u64).ok_or_else(beyond)?;
        // Begins at the 16-bit word that contains the frame's first bit, as bytes may be swapped within words.
        let start = first / 16 * 2;
        let skipped = (first - start * 8) as usize;
        let length = (skipped as u64 + pixels).div_ceil(16) * 2;
        let mut packed = Vec::new();
        match &self.location {
            PixelLocation::Native { offset, is_swapped, .. } => {
                let mut input = InputFile::open(context)?;
                input.seek(offset.saturating_add(start)).map_err(|error| context.io_error(error))?;
                let read = input.reader.by_ref().take(length).read_to_end(&mut packed);
                read.map_err(|error| context.io_error(error))?;
                if *is_swapped {
                    packed.as_chunks_mut::<2>().0.iter_mut().for_each(|pair| pair.swap(0, 1));
                }
            }
            PixelLocation::Inflated(bytes) => {
                let from = usize::try_from(start).ok().and_then(|start| bytes.get(start..));
                let from = from.ok_or_else(beyond)?;
                packed.extend_from_slice(&from[..from.len().min(length as usize)]);
            }
            PixelLocation::Compressed { codec, frames } => {
                let compressed = read_fragments(context, frames.get(frame).ok_or_else(beyond)?)?;
                let mask = decode_mask(*codec, compressed, self.shape())
                    .map_err(|why| frame_error(context, frame, why))?;
                raster.write(&mask[..mask.len().min(voxels.len())], voxels);
                return Ok(());
            }
        }
        let bits = unpack(&packed, skipped, pixels as usize).ok_or_else(beyond)?;
        raster.write(&bits[..bits.len().min(voxels.len())], voxels);
        Ok(())
    }
}

/// Unpacks `count` bits from bit `first` on, to 0 or 1 each; `None` where there are fewer.
fn unpack(packed: &[u8], first: usize, count: usize) -> Option<Vec<u8>> {
    let end = first.checked_add(count).filter(|&end| end <= packed.len().saturating_mul(8))?;
    Some((first..end).map(|at| packed[at / 8] >> (at % 8) & 1).collect())
}

/// Decompresses a frame of one-bit pixels, to 0 or 1 for each. Codecs of bytes are given the packed bits, those of
/// pictures the pixels; of run lengths there are both.
///
/// # Errors
/// A message that tells what is wrong with the image.
fn decode_mask(codec: PixelCodec, compressed: Vec<u8>, shape: PixelLayout) -> Result<Vec<u8>, String> {
    let pixels = shape.pixel_count();
    let packed_bytes = pixels.div_ceil(8);
    let unpacked = |packed: &[u8]| {
        unpack(packed, 0, pixels)
            .ok_or_else(|| format!("an image has {} of {packed_bytes} bytes of packed bits", packed.len()))
    };
    let mut mask = match codec {
        PixelCodec::Native => return unpacked(&compressed),
        PixelCodec::Deflated => return unpacked(&inflate(&compressed, packed_bytes)?),
        PixelCodec::Rle => match rle::decode(&compressed, pixels, 1, 1) {
            Ok(mask) => mask,
            // With more bytes than packed bits take, up to an even number, it is a truncated mask of bytes.
            Err(why) if rle::decode(&compressed, packed_bytes + 2, 1, 1).is_ok() => return Err(why),
            Err(why) => {
                return unpacked(&rle::decode(&compressed, packed_bytes, 1, 1).map_err(|_packed| why)?);
            }
        },
        PixelCodec::Jpeg | PixelCodec::JpegLs | PixelCodec::Jpeg2000 => {
            decode_image(codec, compressed, PixelLayout { number: BYTE, ..shape })?.bytes
        }
    };
    for pixel in &mut mask {
        *pixel = u8::from(*pixel != 0);
    }
    Ok(mask)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_from_anywhere() {
        assert_eq!(unpack(&[0b1000_0001, 0b0000_0010], 0, 10), Some(vec![1, 0, 0, 0, 0, 0, 0, 1, 0, 1]));
        assert_eq!(unpack(&[0b1000_0001, 0b0000_0010], 7, 3), Some(vec![1, 0, 1]));
        for (first, count) in [(0, 17), (16, 1), (usize::MAX, 1), (1, usize::MAX)] {
            assert_eq!(unpack(&[0; 2], first, count), None, "{first} {count}");
        }
    }
}
