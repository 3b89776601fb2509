//! HDF5: arrays of any program, and volumes of Imaris, `BigDataViewer`, `NeXus`, `NetCDF`-4 and MATLAB.
//!
//! `container/` reads objects of a file, `storage/` the elements of its arrays, and `dialects/` knows where programs
//! put volumes. Nothing leads out of the file: neither links to other files nor external storage are followed.

mod container;
mod dialects;
mod storage;
#[cfg(test)]
mod tests;

use crate::reading::input::{FileChangeGuard, InputFile};
use crate::reading::reader::{FileStart, FormatReader, VolumeSource};
use chiaroscuro_volume::{LoadContext, LoadError, Volume};
use container::{Hdf5File, SIGNATURE};
use dialects::BdvDescription;

pub(crate) const READER: FormatReader = FormatReader {
    name: "HDF5",
    extensions: &[".h5", ".hdf5", ".hdf", ".he5", ".ims", ".nxs", ".nc", ".nc4", ".mat"],
    recognises: is_hdf5,
    load,
};

/// Reader of the descriptions beside files of `BigDataViewer`.
pub(crate) const DESCRIPTION: FormatReader = FormatReader {
    name: "BigDataViewer",
    // Files of other programs have this extension as well: it is told by its content.
    extensions: &[],
    recognises: |start| find(start.bytes(), b"<SpimData"),
    load: load_description,
};

/// Returns true if a file begins with the signature, or has it behind a block of 512 bytes.
fn is_hdf5(start: &FileStart) -> bool {
    start.has_at(SIGNATURE, 0) || start.has_at(SIGNATURE, 512)
}

fn find(bytes: &[u8], text: &[u8]) -> bool {
    bytes.windows(text.len()).any(|window| window == text)
}

/// Loads a volume of an HDF5 file.
fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the HDF5 volume", path: source.path };
    if source.start.is_gzip() {
        let why = "the whole file is compressed, so that its parts cannot be read by their places";
        return Err(context.bad_input_error("format", why, "unpack it with gunzip, and open the result"));
    }
    let file = Hdf5File::open(context, source.control, &source.input)?;
    dialects::load(&mut source, &file)
}

/// Loads a volume of the HDF5 file that a description names.
#[expect(clippy::needless_pass_by_value, reason = "as all readers are called")]
fn load_description(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, options, control, .. } = source;
    let context = LoadContext { operation: "read the description of the volume", path };
    let described = BdvDescription::read(context, control)?;
    let path = described.path(context)?;
    let context = LoadContext { operation: "read the HDF5 volume", path: &path };
    let mut input = InputFile::open(context)?;
    let guard = FileChangeGuard::new(context, &input, control)?;
    let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
    let file = Hdf5File::open(context, control, &input)?;
    let mut source = VolumeSource { path: &path, input, start, options, control };
    guard.check_unchanged(context, dialects::load_big_data_viewer(&mut source, &file, Some(&described)))
}
