//! Volumes as files of other programs: a format for each ending, each with what it has room for.
//!
//! Voxels are turned and converted while they are written, row by row, so that nothing beside the volume is in memory.

mod metaimage;
mod nifti;
mod npy;
mod nrrd;
mod numbers;
mod outgoing;
#[cfg(test)]
mod tests;
mod tiff;
mod turn;
mod vti;

use std::io::{BufWriter, Write};
use std::path::Path;

pub use numbers::{ConvertError, NumberWish};
pub use outgoing::Outgoing;

use super::ExportError;
use super::files::{place, temporary_beside};
use crate::data::{Volume, VoxelType};

/// A format that volumes are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VolumeFormat {
    /// Everything that is known of a volume has its place.
    Nrrd,
    /// `MetaImage`, header and voxels in one file.
    MetaImage,
    /// NIfTI-1, or NIfTI-2 for long axes.
    Nifti,
    /// The same, in gzip as a whole.
    NiftiGzip,
    /// Pages, with `ImageJ`'s words.
    Tiff,
    /// An array of `NumPy`.
    Npy,
    /// VTK's image in XML.
    Vti,
}

impl VolumeFormat {
    /// All of them, the most useful first.
    pub const ALL: [Self; 7] =
        [Self::Nrrd, Self::MetaImage, Self::NiftiGzip, Self::Nifti, Self::Tiff, Self::Npy, Self::Vti];

    /// Endings of their files, without the dot; the first is what the format is called by.
    pub const fn endings(self) -> &'static [&'static str] {
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

    /// What a file's name, or a format's, ends with.
    pub fn of_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_lowercase();
        let has = |ending: &str| name.strip_suffix(ending).is_some_and(|rest| rest.ends_with('.'));
        Self::ALL.into_iter().find(|format| format.endings().iter().any(|ending| has(ending)))
    }

    /// Whether its files hold their voxels compressed when that is asked for.
    pub const fn may_be_compressed(self) -> bool {
        matches!(self, Self::Nrrd | Self::MetaImage)
    }

    /// What is known of a volume and has no place in the format.
    pub fn lost(self, volume: &Outgoing<'_>) -> Vec<&'static str> {
        let hints = volume.hints();
        let straight = volume.has_distances_alone();
        let is_known = !volume.has_unknown_scale() || volume.has_no_place();
        let (scale, place) = match self {
            Self::Nrrd | Self::MetaImage => (true, true),
            // Without a known body there are distances alone.
            Self::Nifti | Self::NiftiGzip => (is_known, volume.is_anatomical() || straight),
            Self::Tiff => (true, straight),
            Self::Npy => (volume.has_unknown_scale(), straight),
            // Axes are kept; which sides of a body they go to is not.
            Self::Vti => (is_known, true),
        };
        let (padding, unit) = match self {
            Self::Nrrd | Self::MetaImage | Self::Tiff => (true, true),
            Self::Nifti | Self::NiftiGzip | Self::Npy | Self::Vti => (false, false),
        };
        let known = [
            (scale || self == Self::Npy, "that nobody knows how large voxels are"),
            (scale || self != Self::Npy, "how large voxels are"),
            (place, "where it lies and which way its axes go"),
            (self != Self::Vti || !volume.is_anatomical(), "which way a body lies"),
            (padding || hints.padding.is_none(), "the padding value"),
            (unit || volume.unit().is_none(), "the unit of the values"),
            (self == Self::Nrrd || hints.labels.is_empty(), "names and colours of labels"),
        ];
        known.into_iter().filter(|(is_kept, _)| !is_kept).map(|(_, what)| what).collect()
    }

    fn write(self, out: &mut dyn Write, volume: &Outgoing<'_>, is_compressed: bool) -> std::io::Result<()> {
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

/// Writes a volume, whole or not at all.
///
/// # Errors
/// As [`write_atomically`](super::write_atomically).
pub fn write_volume(
    path: &Path,
    format: VolumeFormat,
    volume: &Outgoing<'_>,
    is_compressed: bool,
) -> Result<(), ExportError> {
    let mut file = temporary_beside(path)?;
    let failed = ExportError::writing(path);
    let mut out = BufWriter::new(&mut file);
    format.write(&mut out, volume, is_compressed).and_then(|()| out.flush()).map_err(&failed)?;
    drop(out);
    place(file, path)
}

/// The header of an attached NRRD of 32-bit floats that lies in the world as a volume does, with the empty line that ends
/// it; voxels follow, the lowest byte of each first.
pub fn nrrd_header_like(
    volume: &Volume,
    content: &str,
    dims: [usize; 3],
    world_from_index: glam::DAffine3,
) -> String {
    let header = nrrd::Header {
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
