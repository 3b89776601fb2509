//! Conventions of programs that write HDF5 files: where the volumes are, and what is known about them.

mod array_axes;
mod array_choice;
mod array_tree;
mod bdv_xml;
mod big_data_viewer;
mod coordinates;
mod imaris;
mod nexus;
mod volume_read;

use super::container::{Hdf5File, LinkTarget};
use crate::reading::reader::VolumeSource;
use crate::unsupported;
use chiaroscuro_volume::{LoadError, Volume};

pub(super) use bdv_xml::{BdvDescription, read_beside};
pub(super) use big_data_viewer::load as load_big_data_viewer;

/// Text at the beginning of files that MATLAB writes.
const MATLAB: &[u8] = b"MATLAB 7.3";

/// Loads the chosen volume of a file by the conventions that its root group shows.
pub(super) fn load(source: &mut VolumeSource<'_>, file: &Hdf5File<'_>) -> Result<Volume, LoadError> {
    let root = file.root()?;
    let links = root.links(file)?;
    let has = |name: &str| links.iter().any(|link| link.name == name);
    if has("minc-2.0") {
        return Err(unsupported::minc_2_refusal(file.context()));
    }
    let choice = &source.options.choice;
    if has(imaris::DATA) && has(imaris::INFO) {
        choice.record_format("Imaris");
        return imaris::load(source, file);
    }
    if links.iter().any(|link| big_data_viewer::is_time_step(&link.name)) && has("s00") {
        choice.record_format("BigDataViewer");
        let described = read_beside(file.context(), source.control)?;
        return big_data_viewer::load(source, file, described.as_ref());
    }
    let is_matlab = source.start.stored().starts_with(MATLAB);
    let attributes = root.attributes(file)?;
    let is_said = |name: &str| attributes.iter().any(|attribute| attribute.name == name);
    if is_matlab {
        choice.record_format("MATLAB 7.3");
    } else if is_said("_NCProperties") {
        choice.record_format("NetCDF-4");
    } else if is_said("NX_class") || is_said("default") {
        choice.record_format("NeXus");
    }
    array_choice::load(source, file, &root, is_matlab).map_err(|error| {
        // Arrays that are only referred to are what is missing.
        let is_elsewhere = links.iter().any(|link| link.target == LinkTarget::OtherFile);
        if is_elsewhere && error.is_about(array_choice::FIELD) { other_file_error(file) } else { error }
    })
}

/// Error for volumes that lie in other files.
fn other_file_error(file: &Hdf5File<'_>) -> LoadError {
    file.context().bad_input_error(
        "links",
        "its volumes lie in other files, which are not followed",
        "open the file in which they lie, or write them into one file",
    )
}
