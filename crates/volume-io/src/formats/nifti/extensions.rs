//! Header extensions, between the header and the voxels: the names and colours of labels that Caret, Connectome
//! Workbench and `TotalSegmentator` write there, as XML.
//!
//! After `nifti1.h` ("extended header structure"): each extension begins with its size and a code. Programs write the
//! XML under several codes, also under 0, so that it is recognised by its content.

use super::super::content::FileContent;
use super::super::samples::{ReadFault, read_until_full};
use super::super::{Endian, LoadControl};
use super::header::{EXTENDER_BYTES, NiftiHeader};
use chiaroscuro_files::xml;
use chiaroscuro_volume::FileLabelTable;

/// Maximum number of bytes read: twice the XML of as many labels as are stored.
const MAX_EXTENSION_BYTES: u64 = 1 << 20;

/// Size of the fields before an extension's content: its size in bytes, these included, and its code.
const FIELD_BYTES: usize = 8;

/// Start of the element that lists the labels.
const LABEL_TABLE: &str = "LabelTable";

/// Labels of a header's extensions, and a remark for the user where these cannot be read.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ExtensionLabels {
    pub(super) labels: FileLabelTable,
    pub(super) remark: Option<String>,
}

impl ExtensionLabels {
    /// Reads the extensions of a file that holds header and voxels, up to [`MAX_EXTENSION_BYTES`]; the content stays
    /// before the voxels.
    pub(super) fn read(
        content: &mut FileContent,
        header: &NiftiHeader,
        control: &LoadControl,
    ) -> Result<Self, ReadFault> {
        let start = header.version.header_bytes();
        let length = header.data_start.saturating_sub(start);
        if !header.has_data || length <= EXTENDER_BYTES {
            return Ok(Self::default());
        }
        content.seek_forward(start, control)?;
        let mut bytes = vec![0; length.min(MAX_EXTENSION_BYTES) as usize];
        let found = read_until_full(content, &mut bytes, control).map_err(ReadFault::into_decoder_fault)?;
        Ok(match find_labels(&bytes[..found], header.endian) {
            Ok(labels) => Self { labels, remark: None },
            Err(why) => Self { remark: Some(why), ..Self::default() },
        })
    }
}

/// Finds the first table of labels in the extensions, which begin with the extender; empty where there is none.
fn find_labels(bytes: &[u8], endian: Endian) -> Result<FileLabelTable, String> {
    let (extender, mut rest) =
        bytes.split_at_checked(EXTENDER_BYTES as usize).unwrap_or((bytes, Default::default()));
    let has_extensions = extender.first().is_some_and(|&flag| flag != 0);
    while has_extensions && let Some(&size) = rest.first_chunk() {
        let size = match endian {
            Endian::Little => u32::from_le_bytes(size),
            Endian::Big => u32::from_be_bytes(size),
        };
        // Zeros up to the voxels.
        if size == 0 {
            break;
        }
        let Some(content) = rest.get(FIELD_BYTES..size as usize) else {
            return Err(format!("a header extension of {size} bytes is ignored: it is broken or too long"));
        };
        let text = String::from_utf8_lossy(content);
        if text.contains(&format!("<{LABEL_TABLE}")) {
            let text = text.trim_matches(|c: char| matches!(c, '\0' | '\u{feff}') || c.is_whitespace());
            return parse_labels(text)
                .map_err(|error| format!("the label table in the header is ignored: {error}"));
        }
        rest = &rest[size as usize..];
    }
    Ok(FileLabelTable::default())
}

/// Parses the labels of an XML text: `<Label Key="1" Red="0.5" Green="0" Blue="1" Alpha="1">Liver</Label>`. Labels
/// without a key are left out.
fn parse_labels(text: &str) -> Result<FileLabelTable, xml::XmlError> {
    let document = xml::parse(text)?;
    let mut labels = FileLabelTable::default();
    let table = document.descendants().find(|node| node.tag_name().name() == LABEL_TABLE);
    let entries = table.into_iter().flat_map(|table| table.children());
    for entry in entries.filter(|entry| entry.tag_name().name() == "Label") {
        let attribute = |name: &str| entry.attribute(name).map(str::trim);
        let part = |name: &str| attribute(name)?.parse::<f32>().ok();
        let Some(number) = attribute("Key").and_then(|key| key.parse().ok()) else { continue };
        let color = match ["Red", "Green", "Blue"].map(part) {
            [Some(red), Some(green), Some(blue)] => Some([red, green, blue]),
            _ => None,
        };
        labels.insert(number, entry.text().unwrap_or_default(), color);
    }
    Ok(labels)
}
