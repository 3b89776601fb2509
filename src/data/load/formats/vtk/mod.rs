//! Images of VTK: regular grids in its XML form (`.vti`) and in its older form of text lines (`.vtk`).
//!
//! After "VTK XML File Formats" and "Simple Legacy Formats", <https://docs.vtk.org/en/latest/vtk_file_formats/index.html>.
//! Its other data sets are no regular grids, and are not read.

mod image;
mod legacy;
mod xml;

use super::reader::Reader;

/// What helps where a data set is no regular grid.
const RESAMPLE: &str =
    "resample it to an image in ParaView (Filters, Resample To Image) and save that as .vti";

pub(super) const XML: Reader =
    Reader { name: "VTK image", endings: &[".vti"], recognises: xml::is_xml, load: xml::load };

pub(super) const LEGACY: Reader =
    Reader { name: "legacy VTK", endings: &[".vtk"], recognises: legacy::is_legacy, load: legacy::load };
