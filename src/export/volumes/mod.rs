//! Export of volumes to other programs: a format for each file name extension, with the metadata that it supports.
//!
//! Voxels are reoriented and converted row by row while they are written, so that no copy of the volume is kept in
//! memory.

mod export_volume;
mod metaimage;
mod nifti;
mod npy;
mod nrrd;
mod number_conversion;
mod reorientation;
#[cfg(test)]
mod tests;
mod tiff;
mod vti;

use std::io::{BufWriter, Write};
use std::path::Path;

pub use export_volume::ExportVolume;
pub use number_conversion::{ConvertError, NumberRequest};

use super::ExportError;
use super::files::{rename_into_place, temporary_file_for};
use crate::data::{Volume, VoxelType};

/// File format for exported volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VolumeFormat {
    /// NRRD: supports all metadata of a volume.
    Nrrd,
    /// `MetaImage`, with header and voxels in one file.
    MetaImage,
    /// NIfTI-1, or NIfTI-2 for long axes.
    Nifti,
    /// `NIfTI`, compressed as a whole with gzip.
    NiftiGzip,
    /// TIFF: one page per slice, with `ImageJ` metadata.
    Tiff,
    /// `NumPy` array file (NPY).
    Npy,
    /// VTK image data in XML.
    Vti,
}

impl VolumeFormat {
    /// All formats, the most useful first.
    pub const ALL: [Self; 7] =
        [Self::Nrrd, Self::MetaImage, Self::NiftiGzip, Self::Nifti, Self::Tiff, Self::Npy, Self::Vti];

    /// File name extensions, without the dot; the first one names the format.
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Nrrd => &["nrrd"],
            Self::MetaImage => &["mha"],
            Self::Nifti => &["nii"],
            Self::NiftiGzip => &["nii.gz"],
            Self::Tiff => &["tif", "tiff"],
            Self::Npy => &["npy"],
            Self::Vti => &["vti"],
        }
    }

    /// Returns the format that a file name's extension indicates.
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_lowercase();
        let has = |ending: &str| name.strip_suffix(ending).is_some_and(|rest| rest.ends_with('.'));
        Self::ALL.into_iter().find(|format| format.extensions().iter().any(|ending| has(ending)))
    }

    /// Returns true if the format supports optional compression of the voxels.
    pub const fn may_be_compressed(self) -> bool {
        matches!(self, Self::Nrrd | Self::MetaImage)
    }

    /// Lists the known metadata of a volume that the format cannot store.
    pub fn unsupported_metadata(self, volume: &ExportVolume<'_>) -> Vec<&'static str> {
        let hints = volume.hints();
        let straight = volume.has_spacing_only();
        let is_known = !volume.has_unknown_scale() || volume.has_unknown_geometry();
        let (scale, place) = match self {
            Self::Nrrd | Self::MetaImage => (true, true),
            // Without an anatomical orientation, only distances are stored.
            Self::Nifti | Self::NiftiGzip => (is_known, volume.is_anatomical() || straight),
            Self::Tiff => (true, straight),
            Self::Npy => (volume.has_unknown_scale(), straight),
            // Axes are stored, but not their anatomical directions.
            Self::Vti => (is_known, true),
        };
        let (padding, unit) = match self {
            Self::Nrrd | Self::MetaImage | Self::Tiff => (true, true),
            Self::Nifti | Self::NiftiGzip | Self::Npy | Self::Vti => (false, false),
        };
        let known = [
            (scale || self == Self::Npy, "the fact that the voxel size is unknown"),
            (scale || self != Self::Npy, "the voxel size"),
            (place, "the position and axis directions"),
            (self != Self::Vti || !volume.is_anatomical(), "the orientation of a body"),
            (padding || hints.padding.is_none(), "the padding value"),
            (unit || volume.unit().is_none(), "the unit of the values"),
            (self == Self::Nrrd || hints.labels.is_empty(), "names and colours of labels"),
        ];
        known.into_iter().filter(|(is_kept, _)| !is_kept).map(|(_, what)| what).collect()
    }

    fn write(
        self,
        out: &mut dyn Write,
        volume: &ExportVolume<'_>,
        is_compressed: bool,
    ) -> std::io::Result<()> {
        match self {
            Self::Nrrd => nrrd::write(out, volume, is_compressed),
            Self::MetaImage => metaimage::write(out, volume, is_compressed),
            Self::Nifti => nifti::write(out, volume, false),
            Self::NiftiGzip => nifti::write(out, volume, true),
            Self::Tiff => tiff::write(out, volume),
            Self::Npy => npy::write(out, volume),
            Self::Vti => vti::write(out, volume),
        }
    }
}

/// Writes a volume atomically.
///
/// # Errors
/// Under the conditions of [`write_atomically`](super::write_atomically).
pub fn write_volume(
    path: &Path,
    format: VolumeFormat,
    volume: &ExportVolume<'_>,
    is_compressed: bool,
) -> Result<(), ExportError> {
    let mut file = temporary_file_for(path)?;
    let failed = ExportError::io_error_for(path);
    let mut out = BufWriter::new(&mut file);
    format.write(&mut out, volume, is_compressed).and_then(|()| out.flush()).map_err(&failed)?;
    drop(out);
    rename_into_place(file, path)
}

/// Returns the header of an attached NRRD of 32-bit floats in the same world space as a volume, including the empty
/// line at its end; the voxels follow in little-endian order.
pub fn nrrd_header_in_space_of(
    volume: &Volume,
    content: &str,
    dims: [usize; 3],
    world_from_index: glam::DAffine3,
) -> String {
    let header = nrrd::NrrdFileHeader {
        content,
        voxel_type: VoxelType::F32,
        dims,
        world_from_index: Some(world_from_index),
        is_anatomical: volume.is_anatomical(),
        has_unknown_scale: volume.has_unknown_scale(),
        is_gzip: false,
    };
    header.text() + "\n"
}
