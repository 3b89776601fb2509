//! XML of other programs' files, parsed in time that grows at most linearly with its length.
//!
//! The parser compares each attribute of an element with all its others, and each namespace with all that are in
//! scope where it is declared: quadratic and cubic in their numbers. `XmlCostEstimate` scans the text once
//! beforehand and counts these comparisons, so that expensive input is rejected unparsed.

mod cost_estimate;
#[cfg(any(test, feature = "testing"))]
pub mod slow_texts;
#[cfg(test)]
mod tests;

use roxmltree::{Document, ParsingOptions};

use super::sanitise::sanitised;
use cost_estimate::XmlCostEstimate;

/// Maximum number of bytes to parse: the OME-XML of a hundred thousand planes has a third of it.
pub const MAX_XML_BYTES: usize = 64 << 20;

/// Maximum number of nodes (elements, texts, comments, instructions) to parse: 80 bytes of memory each.
const MAX_XML_NODES: u32 = 4 << 20;

/// Maximum length of a syntax error in bytes: the parser quotes names from the text, however long they are.
const MAX_ERROR_BYTES: usize = 200;

/// Reason for which a text is not read as XML.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum XmlError {
    /// The text is not well-formed.
    #[error("it is not well-formed XML: {0}")]
    Syntax(String),
    /// The text declares a document type, which could name other files and expand to any length.
    #[error("it is XML with a document type (<!DOCTYPE>), which is not supported")]
    DocumentType,
    /// The text is too long, or has too many markup characters.
    #[error("its XML is too long: {found} {what}, at most {max} are supported")]
    Length {
        /// Unit that is counted, such as bytes.
        what: &'static str,
        /// Number of units found.
        found: usize,
        /// Maximum number of units that is read.
        max: usize,
    },
    /// Elements are nested deeper than in any real file.
    #[error("the elements of its XML are nested more than {most} deep")]
    Depth {
        /// Maximum nesting depth of elements.
        most: usize,
    },
    /// Comparing attributes and namespaces would take too long.
    #[error(
        "its XML has more attributes and namespaces than can be compared: up to {attributes} attributes in an element, up to {namespaces} namespaces"
    )]
    Comparisons {
        /// Largest number of attributes in one element.
        attributes: usize,
        /// Largest number of namespaces in scope of one element.
        namespaces: usize,
    },
}

/// Parses an XML text to a tree.
///
/// Takes less than a second, plus one for every 10 MB; memory stays below a hundred times the text.
///
/// # Errors
/// [`XmlError`] for text that is not well-formed, has a document type, or exceeds a limit.
pub fn parse(text: &str) -> Result<Document<'_>, XmlError> {
    XmlCostEstimate::check(text)?;
    let options = ParsingOptions { nodes_limit: MAX_XML_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| match error {
        roxmltree::Error::DtdDetected => XmlError::DocumentType,
        roxmltree::Error::NodesLimitReached => {
            let most = MAX_XML_NODES as usize;
            XmlError::Length { what: "elements and texts", found: most + 1, max: most }
        }
        other => XmlError::Syntax(sanitised(&other.to_string(), MAX_ERROR_BYTES)),
    })
}
