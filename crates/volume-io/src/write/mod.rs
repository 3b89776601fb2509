//! Export of volumes to other programs: a format for each file name extension, with the metadata that it supports.
//!
//! Voxels are reoriented and converted row by row while they are written, so that no copy of the volume is kept in
//! memory. `ome_zarr` writes volumes in several resolutions, also slab by slab.

mod export_volume;
mod metaimage;
mod nifti;
mod npy;
mod nrrd;
mod number_conversion;
mod ome_zarr;
mod reorientation;
#[cfg(test)]
mod tests;
mod tiff;
mod vti;

use std::io::{BufWriter, Write};
use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};

pub use export_volume::ExportVolume;
pub use number_conversion::{ConvertError, NumberRequest};
pub use ome_zarr::{OmeZarrWriter, PyramidSpec, SLAB_SLICES};

use chiaroscuro_files::{
    WriteError, check_folder_writable, check_writable, rename_into_place, temporary_file_for,
};
use chiaroscuro_volume::{Volume, VoxelType};

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
    /// OME-Zarr: a folder with the image in several resolutions.
    OmeZarr,
    /// OME-Zarr in a ZIP archive.
    OmeZarrArchive,
}

impl VolumeFormat {
    /// All formats, the most useful first.
    pub const ALL: [Self; 9] = [
        Self::Nrrd,
        Self::MetaImage,
        Self::NiftiGzip,
        Self::Nifti,
        Self::Tiff,
        Self::Npy,
        Self::Vti,
        Self::OmeZarr,
        Self::OmeZarrArchive,
    ];

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
            Self::OmeZarr => &["ome.zarr", "zarr"],
            Self::OmeZarrArchive => &["ozx", "zarr.zip"],
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

    /// Returns true if the format is a folder, which is no file for standard output.
    pub const fn is_folder(self) -> bool {
        matches!(self, Self::OmeZarr)
    }

    /// Returns true if a volume of the format is always compressed.
    pub const fn is_always_compressed(self) -> bool {
        matches!(self, Self::NiftiGzip) || self.is_pyramid()
    }

    /// Returns true if the format is written slab by slab, in several resolutions, by [`OmeZarrWriter`].
    pub const fn is_pyramid(self) -> bool {
        matches!(self, Self::OmeZarr | Self::OmeZarrArchive)
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
            Self::OmeZarr | Self::OmeZarrArchive => (true, volume.is_axis_aligned()),
        };
        let (padding, unit) = match self {
            Self::Nrrd | Self::MetaImage | Self::Tiff => (true, true),
            Self::Nifti | Self::NiftiGzip | Self::Npy | Self::Vti | Self::OmeZarr | Self::OmeZarrArchive => {
                (false, false)
            }
        };
        let known = [
            (scale || self == Self::Npy, "the fact that the voxel size is unknown"),
            (scale || self != Self::Npy, "the voxel size"),
            (place, "the position and axis directions"),
            (
                (self != Self::Vti && !self.is_pyramid()) || !volume.is_anatomical(),
                "the orientation of a body",
            ),
            (padding || hints.padding.is_none(), "the padding value"),
            (unit || volume.unit().is_none(), "the unit of the values"),
            (
                self == Self::Nrrd || self.is_pyramid() || hints.labels.is_empty(),
                "names and colours of labels",
            ),
        ];
        known.into_iter().filter(|(is_kept, _)| !is_kept).map(|(_, what)| what).collect()
    }

    /// Checks that a volume can be written under a name, before the work that is to be written begins.
    ///
    /// With `replaces_others`, a folder of another program is replaced, if it is one of Zarr.
    ///
    /// # Errors
    /// Under the conditions of [`write_volume`].
    pub fn check_writable(self, path: &Path, replaces_others: bool) -> Result<(), WriteError> {
        if self.is_folder() { check_folder_writable(path, replaces_others) } else { check_writable(path) }
    }
}

/// Writes a volume atomically. A folder is replaced only if this program wrote all of it.
///
/// # Errors
/// Under the conditions of [`write_atomically`](chiaroscuro_files::write_atomically) and
/// [`check_folder_writable`].
pub fn write_volume(
    path: &Path,
    format: VolumeFormat,
    volume: &ExportVolume<'_>,
    is_compressed: bool,
) -> Result<(), WriteError> {
    type EncodeVolume = fn(&mut dyn Write, &ExportVolume<'_>, bool) -> std::io::Result<()>;
    let encode: EncodeVolume = match format {
        VolumeFormat::Nrrd => nrrd::write,
        VolumeFormat::MetaImage => metaimage::write,
        VolumeFormat::Nifti => |out, volume, _| nifti::write(out, volume, false),
        VolumeFormat::NiftiGzip => |out, volume, _| nifti::write(out, volume, true),
        VolumeFormat::Tiff => |out, volume, _| tiff::write(out, volume),
        VolumeFormat::Npy => |out, volume, _| npy::write(out, volume),
        VolumeFormat::Vti => |out, volume, _| vti::write(out, volume),
        VolumeFormat::OmeZarr | VolumeFormat::OmeZarrArchive => {
            return ome_zarr::write(path, format, volume, false);
        }
    };
    let mut file = temporary_file_for(path)?;
    let failed = WriteError::io_error_for(path);
    let mut out = BufWriter::new(&mut file);
    encode(&mut out, volume, is_compressed).and_then(|()| out.flush()).map_err(&failed)?;
    drop(out);
    rename_into_place(file, path)
}

/// Encodes one 32-bit float for each block of `block_edge`³ voxels of a volume as an attached NRRD.
///
/// The grid has `dims` blocks and lies in the volume's world space; `content` is the description in the header.
pub fn nrrd_of_blocks(
    volume: &Volume,
    content: &str,
    dims: [usize; 3],
    block_edge: usize,
    values: &[f32],
) -> Vec<u8> {
    let step = block_edge as f64;
    // The centre of block 0 is the middle of voxels 0 to block_edge - 1.
    let index_from_block = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::splat(step)),
        translation: DVec3::splat(step / 2.0 - 0.5),
    };
    let header = nrrd::NrrdFileHeader {
        content,
        voxel_type: VoxelType::F32,
        dims,
        world_from_index: Some(volume.world_from_index() * index_from_block),
        is_anatomical: volume.is_anatomical(),
        has_unknown_scale: volume.has_unknown_scale(),
        is_gzip: false,
    };
    let mut bytes = (header.text() + "\n").into_bytes();
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}
