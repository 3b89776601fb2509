//! OME-Zarr 0.5 writer: a pyramid of resolutions in sharded arrays of Zarr 3, as a folder or as an archive of one.
//!
//! Formats: <https://ngff.openmicroscopy.org/0.5/>, <https://zarr-specs.readthedocs.io/en/latest/v3/core/index.html> and
//! <https://ngff.openmicroscopy.org/rfc/9/> (the archive). The image is fed slab by slab, so that it may be larger than
//! the memory: each level holds one layer of chunks, and makes its part of the next level of it.

mod archive;
mod chunk_encoder;
mod hierarchy_sink;
mod level_writer;
mod metadata;
mod pyramid_levels;
mod pyramid_spec;
mod pyramid_writer;
mod slab_samples;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use super::VolumeFormat;
use super::export_volume::ExportVolume;
use super::number_conversion::append_number;
use chiaroscuro_files::{
    WriteError, rename_folder_into_place, rename_into_place, temporary_file_for, temporary_folder_for,
};
use hierarchy_sink::FolderSink;
use pyramid_writer::PyramidWriter;

pub use pyramid_spec::PyramidSpec;

/// Slices that are taken from a volume at a time: a layer of chunks of the finest level.
pub const SLAB_SLICES: usize = level_writer::CHUNK_EDGE;

/// Writer of an image that is fed slab by slab.
///
/// Nothing has its final name before [`Self::finish`]; dropping it leaves nothing.
#[derive(Debug)]
pub struct OmeZarrWriter {
    path: PathBuf,
    destination: PyramidDestination,
    pyramid: PyramidWriter<FolderSink>,
}

/// Form in which the finished pyramid gets its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PyramidDestination {
    /// Folder, which may replace one of another program.
    Folder { replaces_others: bool },
    /// ZIP archive of the folder.
    Archive,
}

impl OmeZarrWriter {
    /// Creates a writer of an image, as the format says: a folder or an archive.
    ///
    /// A folder of that name is replaced if this program wrote all of it; with `replaces_others` any hierarchy of Zarr
    /// is.
    ///
    /// # Errors
    /// When nothing can be written there.
    pub fn new(
        path: &Path,
        format: VolumeFormat,
        spec: PyramidSpec,
        replaces_others: bool,
    ) -> Result<Self, WriteError> {
        format.check_writable(path, replaces_others)?;
        let destination = match format {
            VolumeFormat::OmeZarr => PyramidDestination::Folder { replaces_others },
            _ => PyramidDestination::Archive,
        };
        let sink = FolderSink::new(temporary_folder_for(path)?);
        let pyramid = PyramidWriter::new(sink, spec).map_err(WriteError::io_error_for(path))?;
        Ok(Self { path: path.to_owned(), destination, pyramid })
    }

    /// Writes the next slices: all of a volume, which has the number type of the image, and its voxels along x and y.
    ///
    /// # Errors
    /// When the disk is full, or the slab does not fit the image.
    pub fn write_slab(&mut self, slab: &ExportVolume<'_>) -> Result<(), WriteError> {
        let spec = self.pyramid.spec();
        if slab.voxel_type() != spec.voxel_type || slab.dims()[..2] != spec.dims[..2] {
            let what = "a part of the volume has another number type or size than the first one";
            return Err(WriteError::Unsupported { what, path: self.path.clone() });
        }
        let depth = slab.dims()[2];
        for first in (0..depth).step_by(SLAB_SLICES) {
            for slice in slab.slices(first..depth.min(first + SLAB_SLICES)) {
                self.pyramid.write_slab(&slice).map_err(WriteError::io_error_for(&self.path))?;
            }
        }
        Ok(())
    }

    /// Completes the image and gives it its name.
    ///
    /// # Errors
    /// When the disk is full, slices are missing, or the name belongs to something that must not be replaced.
    pub fn finish(self) -> Result<(), WriteError> {
        let Self { path, destination, pyramid } = self;
        let sink = pyramid.finish().map_err(WriteError::io_error_for(&path))?;
        match destination {
            PyramidDestination::Folder { replaces_others } => {
                rename_folder_into_place(sink.into_folder(), &path, replaces_others)
            }
            PyramidDestination::Archive => {
                let mut file = temporary_file_for(&path)?;
                archive::pack(&sink, &mut file).map_err(WriteError::io_error_for(&path))?;
                rename_into_place(file, &path)
            }
        }
    }
}

/// Writes a volume as a folder or an archive.
pub(super) fn write(
    path: &Path,
    format: VolumeFormat,
    volume: &ExportVolume<'_>,
    replaces_others: bool,
) -> Result<(), WriteError> {
    let mut writer = OmeZarrWriter::new(path, format, PyramidSpec::new(volume), replaces_others)?;
    writer.write_slab(volume)?;
    writer.finish()
}
