//! Interface of a format's reader: how its files are recognised, and the source that it reads from.

use std::io::{self, BufReader, Read, Seek as _};
use std::path::Path;

use super::content::members::GzipMembers;
use super::input::{InputFile, is_gzip, max_inflated_bytes};
use super::number::{ScalarReduction, VoxelEncoding};
use super::samples::{ReadFault, VoxelLayout, is_corruption, read_until_full, skip_bytes};
use super::voxels::{ReadVoxels, ValueMapping};
use super::{FileDimension, LoadControl, LoadError, LoadOptions, VolumeOffer};
use chiaroscuro_volume::{GridExtent, LoadContext, Volume};

/// Bytes of a file's beginning that are inspected to recognise it: a NIfTI-2 header has 540, the DICOM magic ends at
/// 132.
const START_BYTES: usize = 1024;

/// Maximum number of volumes that a file may offer by index: more than can be chosen from a list.
const MAX_OFFERS: u64 = 1 << 16;

/// Content that may follow the voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TrailingData {
    /// Anything may follow the voxels.
    Allowed,
    /// The content must end with the voxels.
    Refused,
}

/// Reader of a file format.
pub(crate) struct FormatReader {
    /// Name of the format in messages and menus.
    pub(crate) name: &'static str,
    /// Extensions of its files, in lower case and with their dots.
    pub(crate) extensions: &'static [&'static str],
    /// Returns true if a file with this beginning has the format, whatever its name.
    pub(crate) recognises: fn(&FileStart) -> bool,
    /// Reads a file of the format.
    pub(crate) load: fn(VolumeSource<'_>) -> Result<Volume, LoadError>,
}

/// File to be read, with its options.
pub(crate) struct VolumeSource<'a> {
    pub(crate) path: &'a Path,
    /// Handle, positioned at the file's beginning.
    pub(crate) input: InputFile,
    pub(crate) start: FileStart,
    pub(crate) options: &'a LoadOptions,
    pub(crate) control: &'a LoadControl,
}

impl VolumeSource<'_> {
    /// Content of the file from its beginning, inflated where the whole file is compressed.
    ///
    /// Callers must limit how much they read: a compressed file may expand to any size.
    pub(crate) fn content(&mut self) -> Box<dyn Read + '_> {
        if self.start.is_gzip() {
            Box::new(BufReader::new(GzipMembers::new(&mut self.input.reader)))
        } else {
            Box::new(&mut self.input.reader)
        }
    }

    /// Reads the selected voxels of a grid that begins at byte `at` of the content. The length is checked before
    /// anything is allocated; for compressed files against the largest possible inflated size.
    ///
    /// # Errors
    /// `BadInput` for data that are too short, too long or corrupt, with `help`; `Limit` where memory is exhausted.
    pub(crate) fn voxels(
        &mut self,
        context: LoadContext<'_>,
        at: u64,
        (stored, extent): (&VoxelEncoding, GridExtent),
        after: TrailingData,
        help: &str,
    ) -> Result<ReadVoxels, LoadError> {
        let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
        let needed = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
        let control = self.control;
        let [x, y, z] = extent.dims;
        let grid = format!("for {x} x {y} x {z} voxels of {}", layout.voxel_type.name());
        if self.start.is_gzip() {
            let most = max_inflated_bytes(self.input.len).saturating_sub(at);
            if most < needed {
                let why =
                    format!("the data are truncated: {needed} bytes expected {grid}, at most {most} found");
                return Err(context.bad_input_error("data", why, help));
            }
        } else {
            let found = self.input.len.saturating_sub(at);
            if found < needed {
                let why = format!("the data are truncated: {needed} bytes expected {grid}, {found} found");
                return Err(context.bad_input_error("data", why, help));
            }
            if found > needed && after == TrailingData::Refused {
                let why = format!("there are {found} bytes where {needed} were expected {grid}");
                return Err(context.bad_input_error("data", why, help));
            }
            let read =
                stored.read_from_file(&mut self.input, at, extent, &ValueMapping::identity(None), control);
            return read.map_err(|fault| fault.into_error(context, &layout, "bytes", help));
        }
        let skip = at;
        // One byte more than needed distinguishes "too much" from "enough", and limits decompression bombs.
        let mut content = self.content().take(skip.saturating_add(needed).saturating_add(1));
        let mut read = || {
            if skip_bytes(&mut content, skip, control)? < skip {
                return Err(ReadFault::Short { got: 0 });
            }
            let voxels = stored.read(&mut content, extent, control)?;
            // Also makes the decoder verify the checksum, where nothing else follows.
            if read_until_full(&mut content, &mut [0], control)? > 0 && after == TrailingData::Refused {
                return Err(ReadFault::Long);
            }
            Ok(voxels)
        };
        read().map_err(|fault| {
            let fault = match fault {
                ReadFault::Io(error) if is_corruption(&error) => ReadFault::Corrupt(error),
                fault => fault,
            };
            fault.into_error(context, &layout, "bytes", help)
        })
    }

    /// Index of the chosen one of `count` volumes along a dimension; their names may be empty.
    ///
    /// # Errors
    /// As [`LoadContext::resolve_choice`]; `Limit` for more than [`MAX_OFFERS`].
    pub(crate) fn choose_numbered(
        &self,
        context: LoadContext<'_>,
        dimension: FileDimension,
        count: u64,
        dims: [u64; 3],
        name: impl Fn(usize) -> String,
    ) -> Result<usize, LoadError> {
        let count = checked_offer_count(context, dimension, count)?;
        let offers = (0..count).map(|at| VolumeOffer::with_number(at, &name(at), dims)).collect();
        context.resolve_choice(&self.options.choice, dimension, offers)
    }

    /// Scalar to derive from voxels of several components, by the user's choice.
    ///
    /// # Errors
    /// `BadInput` where the user has chosen a component that does not exist.
    pub(crate) fn scalar_reduction(
        &self,
        context: LoadContext<'_>,
        components: usize,
        is_color: bool,
    ) -> Result<ScalarReduction, LoadError> {
        let component = self.options.choice.resolve_component(components, is_color);
        ScalarReduction::require(context, component, components, is_color)
    }
}

/// Returns a number of volumes that differ along a dimension, if so many can be offered.
///
/// # Errors
/// `Limit` for more than [`MAX_OFFERS`].
pub(crate) fn checked_offer_count(
    context: LoadContext<'_>,
    dimension: FileDimension,
    count: u64,
) -> Result<usize, LoadError> {
    if count <= MAX_OFFERS {
        return Ok(count as usize);
    }
    Err(context.limit_error(
        dimension.option(),
        format!("it holds {count} {}, {MAX_OFFERS} are allowed", dimension.plural()),
        "check the header, or write fewer into one file",
    ))
}

/// First bytes of a file, as stored and inflated.
pub(crate) struct FileStart {
    stored: Vec<u8>,
    /// First bytes of the content, where the whole file is compressed.
    inflated: Option<Vec<u8>>,
}

impl FileStart {
    /// Reads the first bytes of an input, and seeks back to its beginning.
    pub(crate) fn read(input: &mut InputFile) -> io::Result<Self> {
        let mut stored = Vec::with_capacity(START_BYTES);
        input.reader.by_ref().take(START_BYTES as u64).read_to_end(&mut stored)?;
        input.reader.rewind()?;
        let inflated = is_gzip(&stored).then(|| {
            let mut found = Vec::new();
            // A stream that is corrupt, or that the limit cuts off, still yields the bytes before that.
            let mut decoder = GzipMembers::new(&mut input.reader).take(START_BYTES as u64);
            let _how_far = decoder.read_to_end(&mut found);
            found
        });
        input.reader.rewind()?;
        Ok(Self { stored, inflated })
    }

    /// First bytes of the content, inflated where the file is compressed.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.inflated.as_ref().unwrap_or(&self.stored)
    }

    /// First bytes of the file as stored.
    pub(crate) fn stored(&self) -> &[u8] {
        &self.stored
    }

    /// Returns true if the whole file is compressed.
    pub(crate) fn is_gzip(&self) -> bool {
        self.inflated.is_some()
    }

    /// True if the content of a compressed file is compressed once more.
    pub(crate) fn is_packed_twice(&self) -> bool {
        self.inflated.as_deref().is_some_and(is_gzip)
    }

    /// Returns true if the content has `bytes` at offset `at`.
    pub(crate) fn has_at(&self, bytes: &[u8], at: usize) -> bool {
        self.bytes().get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }
}
