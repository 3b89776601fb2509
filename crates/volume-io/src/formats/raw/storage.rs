//! Storage of raw voxels, from any source of information, and reading of them.

use super::super::number::{FileNumberType, VoxelEncoding};
use super::super::placement::{GridPlacement, VolumeParts};
use super::super::reader::{TrailingData, VolumeSource};
use super::super::samples::VoxelLayout;
use super::super::voxels::{ReadVoxels, ValueMapping};
use super::super::{Endian, FileDimension, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext, ValueMetadata, Volume, VoxelType};

/// Maximum length of a header in bytes for which `--offset` is suggested: a longer excess is no header.
const MAX_HEADER_BYTES: u64 = 1 << 20;

/// Storage of raw voxels, with their placement and metadata.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawStorage {
    /// Voxels along x, y and z.
    pub(super) dims: [u64; 3],
    /// Source of the dimensions, for messages.
    pub(super) dims_source: &'static str,
    pub(super) number: FileNumberType,
    pub(super) components: usize,
    pub(super) is_color: bool,
    pub(super) endian: Endian,
    /// Bytes before the first voxel; `None` if not given.
    pub(super) offset: Option<u64>,
    pub(super) placement: GridPlacement,
    /// Number of consecutive volumes in the file.
    pub(super) frames: u64,
    pub(super) hints: ValueMetadata,
}

impl RawStorage {
    /// Creates the default: scalar, little-endian, one volume, unknown placement.
    pub(super) fn new(dims: [u64; 3], dims_field: &'static str, number: FileNumberType) -> Self {
        Self {
            dims,
            dims_source: dims_field,
            number,
            components: 1,
            is_color: false,
            endian: Endian::Little,
            offset: None,
            placement: GridPlacement::unknown(),
            frames: 1,
            hints: ValueMetadata::default(),
        }
    }

    /// Reads voxels of this layout, which fill the file.
    pub(super) fn read(
        self,
        mut source: VolumeSource<'_>,
        context: LoadContext<'_>,
        name: String,
        help: &str,
    ) -> Result<Volume, LoadError> {
        let part = source.scalar_reduction(context, self.components, self.is_color)?;
        let stored = VoxelEncoding {
            number: self.number,
            endian: self.endian,
            components: self.components,
            reduction: part,
        };
        let frame = source
            .choose_numbered(context, FileDimension::Frame, self.frames, self.dims, |_| String::new())?;
        let room = source.options.limits(source.control);
        let extent = GridExtent::checked(context, self.dims_source, self.dims, stored.voxel_type(), room)?;
        let bytes = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
        let all_bytes = bytes.saturating_mul(self.frames);
        let offset = self.offset.unwrap_or(0);
        let at = offset.saturating_add(bytes.saturating_mul(frame as u64));

        // Voxels may begin with gzip's magic by chance: a file of exactly the right size is not compressed.
        let fits_exactly = offset.checked_add(all_bytes) == Some(source.input.len);
        let zipped_name = source.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"));
        let voxels = if source.start.is_gzip() && (zipped_name || !fits_exactly) {
            let after = if self.frames == 1 { TrailingData::Refused } else { TrailingData::Allowed };
            let help = "check the dimensions, the type and --offset";
            source.voxels(context, at, (&stored, extent), after, help)?
        } else {
            self.check_length(context, (&stored, extent), all_bytes, source.input.len)?;
            read_plain(&mut source, context, at, &stored, extent)?
        };
        let placement = self.placement.with_remark(part.remark());
        let parts = VolumeParts { name, extent, placement, voxels, hints: self.hints };
        parts.into_volume_with_help(context, source.control, help)
    }

    /// Checks that a file of `len` bytes holds exactly the offset and the voxels.
    fn check_length(
        &self,
        context: LoadContext<'_>,
        (stored, extent): (&VoxelEncoding, GridExtent),
        bytes: u64,
        len: u64,
    ) -> Result<(), LoadError> {
        let GridExtent { dims: [x, y, z], voxels, .. } = extent;
        let expected = self.offset.unwrap_or(0).checked_add(bytes);
        if expected == Some(len) {
            return Ok(());
        }
        let after = self.offset.map_or(String::new(), |offset| format!(" after an offset of {offset}"));
        let why = format!(
            "{} bytes were expected for {x} x {y} x {z} voxels of {}{after}, {len} were found",
            expected.map_or("more than 2^64".to_owned(), |expected| expected.to_string()),
            stored.voxel_type().name()
        );
        let excess = len.saturating_sub(bytes);
        let fitting =
            VoxelType::ALL.into_iter().find(|t| (voxels as u64).checked_mul(t.bytes() as u64) == Some(len));
        let help = match (self.offset, fitting) {
            (None, Some(fitting)) => {
                format!("the length fits {}-byte voxels: try --type {}", fitting.bytes(), fitting.name())
            }
            (_, _) if excess > 0 && excess <= MAX_HEADER_BYTES => {
                format!("if the file begins with a header of {excess} bytes, give --offset {excess}")
            }
            _ => "check the dimensions and the type, or copy the file again".to_owned(),
        };
        Err(context.bad_input_error("file size", why, help))
    }
}

/// Reads voxels as stored, although they may look compressed.
fn read_plain(
    source: &mut VolumeSource<'_>,
    context: LoadContext<'_>,
    at: u64,
    stored: &VoxelEncoding,
    extent: GridExtent,
) -> Result<ReadVoxels, LoadError> {
    let meant = ValueMapping::identity(None);
    stored.read_from_file(&mut source.input, at, extent, &meant, source.control).map_err(|fault| {
        let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
        fault.into_error(context, &layout, "bytes", "the file has changed meanwhile: load it again")
    })
}
