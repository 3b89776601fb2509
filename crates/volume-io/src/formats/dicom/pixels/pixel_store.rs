//! Pixel data of a DICOM file: location of the frames, and reading of single frames.

use std::io::{self, Read as _};

use super::super::header::DicomHeader;
use super::super::header::parser::PixelElement;
use super::super::header::reader::DicomReader;
use super::super::header::tags::{ITEM, SEQUENCE_END};
use super::super::header::transfer_syntax::PixelCodec;
use super::codec::{DecodedImage, decode_image};
use super::conversion::{PixelConversion, VoxelNumber};
use super::layout::{PixelLayout, PixelNumber};
use super::size_check::{COPY_ADVICE, check_file_size, supported_codec, truncated_error};
use crate::Endian;
use crate::reading::input::InputFile;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, human_bytes};

/// Maximum number of fragments: 16 for each of the maximum number of frames.
const MAX_FRAGMENTS: usize = 1 << 22;

/// Number of pixels read at a time; must be even.
const PIXELS_AT_ONCE: usize = 1 << 18;

/// Fragment of compressed pixels: position in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PixelFragment {
    offset: u64,
    length: u32,
}

/// Pixel data of a file, with the layout of its images.
#[derive(Debug)]
pub(crate) struct PixelStore {
    layout: PixelLayout,
    pub(super) location: PixelLocation,
}

/// Location of the frames of a file.
#[derive(Debug)]
pub(super) enum PixelLocation {
    /// Native frames in the file, one after the other.
    Native { offset: u64, endian: Endian, is_swapped: bool },
    /// Inflated frames in memory, one after the other.
    Inflated(Vec<u8>),
    /// Compressed frames in the file, each in one or several fragments.
    Compressed { codec: PixelCodec, frames: Vec<Vec<PixelFragment>> },
}

impl PixelStore {
    /// Locates the frames of a file, as many as its header announces.
    pub(crate) fn open(
        header: &DicomHeader,
        shape: PixelLayout,
        budget_bytes: u64,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let context = LoadContext { operation: super::super::READ_FILE, path: &header.path };
        let count = header.frame_count();
        let Some(pixels) = header.pixels else {
            return Err(context.bad_input_error("Pixel Data", "it has no pixels", COPY_ADVICE));
        };
        let codec = supported_codec(context, header)?;
        if pixels.length.is_none() {
            let packed = Self::locate_compressed(context, header, pixels, codec, count, control)?;
            return Ok(Self { layout: shape, location: packed });
        }
        if header.syntax.is_encapsulated {
            return Err(context.bad_input_error(
                "Pixel Data",
                "compressed pixels are not in fragments",
                COPY_ADVICE,
            ));
        }
        if header.syntax.is_deflated {
            let expected = shape.stored_bytes(count);
            return Self::inflate(context, header, shape, expected, budget_bytes, control);
        }
        check_file_size(context, header, &shape)?;
        let endian = header.syntax.pixel_endian.unwrap_or(header.syntax.encoding.endian);
        let is_swapped = endian == Endian::Big && shape.bytes_per_number() == 1 && pixels.is_words;
        Ok(Self {
            layout: shape,
            location: PixelLocation::Native { offset: pixels.offset, endian, is_swapped },
        })
    }

    fn inflate(
        context: LoadContext<'_>,
        header: &DicomHeader,
        shape: PixelLayout,
        expected: u64,
        budget_bytes: u64,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        if expected > budget_bytes {
            return Err(context.limit_error(
                "Number of Frames",
                format!(
                    "its pixels take {} uncompressed, {} are allowed",
                    human_bytes(u128::from(expected)),
                    human_bytes(u128::from(budget_bytes))
                ),
                "close other programs, or convert it with `gdcmconv --raw in.dcm out.dcm`",
            ));
        }
        let (_, mut bytes) = DicomHeader::read(&header.path, control)?;
        let mut inflated = Vec::new();
        while (inflated.len() as u64) < expected {
            control.check()?;
            let most = (expected - inflated.len() as u64).min(1 << 20);
            match io::Read::by_ref(&mut bytes).take(most).read_to_end(&mut inflated) {
                Ok(0) => {
                    return Err(truncated_error(
                        context,
                        &shape,
                        header.frame_count(),
                        inflated.len() as u64,
                    ));
                }
                Ok(_) => {}
                Err(error) => {
                    return Err(context.bad_input_error(
                        "data",
                        format!("the deflated data are broken: {error}"),
                        COPY_ADVICE,
                    ));
                }
            }
        }
        Ok(Self { layout: shape, location: PixelLocation::Inflated(inflated) })
    }

    fn locate_compressed(
        context: LoadContext<'_>,
        header: &DicomHeader,
        pixels: PixelElement,
        codec: PixelCodec,
        count: u64,
        control: &LoadControl,
    ) -> Result<PixelLocation, LoadError> {
        let wrong = |why: &str| context.bad_input_error("Pixel Data", why, COPY_ADVICE);
        if header.syntax.is_deflated {
            return Err(wrong("its pixels are compressed twice"));
        }
        let mut input = InputFile::open(context)?;
        input.seek(pixels.offset).map_err(|error| context.io_error(error))?;
        let mut bytes = DicomReader::new(input);
        bytes.position = pixels.offset;
        let mut table = Vec::new();
        let mut fragments = Vec::new();
        let mut is_first = true;
        loop {
            control.check()?;
            let tag = bytes.tag(Endian::Little).map_err(|error| context.io_error(error))?;
            // Without a delimiter the fragments found so far count: the decoder detects incomplete ones.
            let (Some(ITEM), Ok(length)) = (tag, bytes.u32(Endian::Little)) else {
                if matches!(tag, None | Some(SEQUENCE_END | ITEM)) {
                    break;
                }
                return Err(wrong("an unexpected element lies among the fragments"));
            };
            let offset = bytes.position;
            let left = bytes.len.saturating_sub(offset);
            if u64::from(length) > left {
                return Err(wrong(&format!(
                    "the data are truncated: {length} bytes of a fragment expected, {left} found"
                )));
            }
            if is_first {
                is_first = false;
                // An offset table whose size does not match the number of frames is ignored.
                if u64::from(length) == count.saturating_mul(4) {
                    table = parse_offset_table(
                        &bytes.value(u64::from(length)).map_err(|error| context.io_error(error))?,
                    );
                } else {
                    bytes.skip(u64::from(length)).map_err(|error| context.io_error(error))?;
                }
                continue;
            }
            if fragments.len() == MAX_FRAGMENTS {
                return Err(wrong(&format!("it has more than {MAX_FRAGMENTS} fragments")));
            }
            bytes.skip(u64::from(length)).map_err(|error| context.io_error(error))?;
            fragments.push(PixelFragment { offset, length });
        }
        if table.is_empty() && header.values.frame_starts.len() as u64 == count {
            table.clone_from(&header.values.frame_starts);
        }
        let found = fragments.len();
        let frames = assign_fragments(fragments, &table, count).ok_or_else(|| {
            wrong(&format!(
                "its {found} fragments cannot be assigned to {count} frames: no offset table matches"
            ))
        })?;
        Ok(PixelLocation::Compressed { codec, frames })
    }

    /// Returns the pixel layout of the stored images.
    pub(crate) fn shape(&self) -> PixelLayout {
        self.layout
    }

    /// Reads the voxels of a frame.
    pub(crate) fn read<T: VoxelNumber>(
        &self,
        context: LoadContext<'_>,
        frame: usize,
        raster: PixelConversion,
        voxels: &mut [T],
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        control.record_read(context.path);
        let size = self.layout.bytes_per_frame();
        let missing_frame_error =
            || context.bad_input_error("Number of Frames", "it has fewer frames than stated", COPY_ADVICE);
        if self.layout.number == PixelNumber::Bit {
            return self.read_bits(context, frame, raster, voxels);
        }
        match &self.location {
            PixelLocation::Native { offset, endian, is_swapped } => {
                let start = size.checked_mul(frame as u64).and_then(|start| start.checked_add(*offset));
                let mut input = InputFile::open(context)?;
                input
                    .seek(start.ok_or_else(missing_frame_error)?)
                    .map_err(|error| context.io_error(error))?;
                let raster = PixelConversion { endian: *endian, ..raster };
                let at_once = if self.layout.is_planar { voxels.len() } else { PIXELS_AT_ONCE };
                let mut block = Vec::new();
                for voxels in voxels.chunks_mut(at_once.max(1)) {
                    control.check()?;
                    // The last byte of an image of odd size shares a 16-bit word with the next image.
                    let bytes = (voxels.len() * self.layout.bytes_per_pair()).div_ceil(2);
                    block.resize(bytes + usize::from(*is_swapped && !bytes.is_multiple_of(2)), 0);
                    input.reader.read_exact(&mut block).map_err(|error| context.io_error(error))?;
                    if *is_swapped {
                        block.as_chunks_mut::<2>().0.iter_mut().for_each(|pair| pair.swap(0, 1));
                    }
                    raster.write(&block, voxels);
                }
            }
            PixelLocation::Inflated(bytes) => {
                let size = usize::try_from(size).map_err(|_too_large| missing_frame_error())?;
                let bytes = bytes.chunks_exact(size.max(1)).nth(frame).ok_or_else(missing_frame_error)?;
                PixelConversion { endian: Endian::Little, ..raster }.write(bytes, voxels);
            }
            PixelLocation::Compressed { codec, frames } => {
                let fragments = frames.get(frame).ok_or_else(missing_frame_error)?;
                let packed = read_fragments(context, fragments)?;
                let wrong = |why| frame_error(context, frame, why);
                let DecodedImage { bytes, shape } =
                    decode_image(*codec, packed, self.layout).map_err(wrong)?;
                if (bytes.len() as u64) < shape.bytes_per_frame() {
                    return Err(wrong(format!("an image has {} of {size} bytes", bytes.len())));
                }
                PixelConversion { shape, endian: Endian::Little, ..raster }.write(&bytes, voxels);
            }
        }
        Ok(())
    }
}

/// Makes the error for a frame that cannot be decompressed.
pub(super) fn frame_error(context: LoadContext<'_>, frame: usize, why: String) -> LoadError {
    context.bad_input_error(
        &format!("Pixel Data, frame {frame}"),
        why,
        "convert it with `gdcmconv --raw in.dcm out.dcm`, or copy it again",
    )
}

/// Reads and concatenates the bytes of fragments, whose positions have been checked.
pub(super) fn read_fragments(
    context: LoadContext<'_>,
    fragments: &[PixelFragment],
) -> Result<Vec<u8>, LoadError> {
    let mut packed = Vec::new();
    let mut input = InputFile::open(context)?;
    for fragment in fragments {
        input.seek(fragment.offset).map_err(|error| context.io_error(error))?;
        let length = u64::from(fragment.length);
        input
            .reader
            .by_ref()
            .take(length)
            .read_to_end(&mut packed)
            .map_err(|error| context.io_error(error))?;
    }
    Ok(packed)
}

/// Parses a basic offset table: 32-bit offsets of the frames.
fn parse_offset_table(bytes: &[u8]) -> Vec<u64> {
    bytes.as_chunks().0.iter().map(|&word| u64::from(u32::from_le_bytes(word))).collect()
}

/// Assigns fragments to frames: all to a single frame, one to each, or as the offset table says, which counts from
/// the first fragment's item. `None` if they do not match.
fn assign_fragments(
    fragments: Vec<PixelFragment>,
    table: &[u64],
    count: u64,
) -> Option<Vec<Vec<PixelFragment>>> {
    if count == 1 && !fragments.is_empty() {
        return Some(vec![fragments]);
    }
    if fragments.len() as u64 == count {
        return Some(fragments.into_iter().map(|fragment| vec![fragment]).collect());
    }
    // Offsets of items and of their data differ by the same 8 bytes of tag and length.
    let first = fragments.first()?.offset;
    let mut frames: Vec<Vec<PixelFragment>> = Vec::new();
    for fragment in fragments {
        let start = fragment.offset - first;
        if table.get(frames.len()) == Some(&start) {
            frames.push(Vec::new());
        }
        frames.last_mut()?.push(fragment);
    }
    (frames.len() as u64 == count).then_some(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_make_frames() {
        let piece = |offset| PixelFragment { offset, length: 8 };
        let three = vec![piece(100), piece(116), piece(132)];
        assert_eq!(assign_fragments(three.clone(), &[], 1).map(|frames| frames[0].len()), Some(3));
        assert_eq!(assign_fragments(three.clone(), &[], 3).map(|frames| frames.len()), Some(3));
        let two = assign_fragments(three.clone(), &[0, 16], 2).unwrap();
        assert_eq!(two, [vec![piece(100)], vec![piece(116), piece(132)]]);
        for (table, count) in [(&[][..], 2), (&[0, 17], 2), (&[16, 0], 2), (&[0, 16], 4), (&[], 0)] {
            assert_eq!(assign_fragments(three.clone(), table, count), None, "{table:?} {count}");
        }
        assert_eq!(assign_fragments(Vec::new(), &[], 1), None);
    }
}
