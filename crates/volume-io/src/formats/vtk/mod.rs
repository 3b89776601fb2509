//! VTK images: regular grids in the XML format (`.vti`), and in the legacy format of text lines (`.vtk`).
//!
//! After "VTK XML File Formats" and "Simple Legacy Formats",
//! <https://docs.vtk.org/en/latest/vtk_file_formats/index.html>. Other VTK data sets are not regular grids, and are
//! not supported.

mod image;
mod legacy;
mod xml;

use super::reader::FormatReader;

/// Help text for data sets that are not regular grids.
const RESAMPLE: &str =
    "resample it to an image in ParaView (Filters, Resample To Image) and save that as .vti";

pub(super) const XML: FormatReader =
    FormatReader { name: "VTK image", extensions: &[".vti"], recognises: xml::is_xml, load: xml::load };

pub(super) const LEGACY: FormatReader = FormatReader {
    name: "legacy VTK",
    extensions: &[".vtk"],
    recognises: legacy::is_legacy,
    load: legacy::load,
};
