//! XML of other programs' files, parsed in a time that grows no faster than its length.
//!
//! The parser compares each attribute of an element with all others of it, and each namespace with all that hold where it
//! is declared: squares and cubes of their numbers. [`Survey`] goes through the text once beforehand and adds these
//! comparisons up, so that what would take long is refused unparsed.

mod survey;
#[cfg(test)]
pub(crate) mod tests;

use roxmltree::{Document, ParsingOptions};

use super::text::plain;
use survey::Survey;

/// Bytes of text that are parsed at most: the OME-XML of a hundred thousand planes has a third of it.
pub(crate) const MOST_BYTES: usize = 64 << 20;

/// Elements, texts, comments and instructions that are parsed at most: 80 bytes of memory each.
const MOST_NODES: u32 = 4 << 20;

/// Bytes of the longest syntax error that is told: the parser repeats names from the text, however long they are.
const LONGEST_REASON: usize = 200;

/// The reason why a text is not read as XML.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum XmlError {
    /// Text that is not well-formed.
    #[error("it is no XML: {0}")]
    Syntax(String),
    /// A declaration of a document type, which could name other files and unfold to any length.
    #[error("it is XML with a document type (<!DOCTYPE>), which is not read")]
    DocumentType,
    /// More text, or more of its marks, than is parsed.
    #[error("its XML is too long: {found} {what}, and {most} are read at most")]
    Length {
        /// The things that are counted.
        what: &'static str,
        /// Their number.
        found: usize,
        /// The most of them that are read.
        most: usize,
    },
    /// Elements that are nested deeper than any program writes them.
    #[error("the elements of its XML are nested more than {most} deep")]
    Depth {
        /// The deepest nesting that is read.
        most: usize,
    },
    /// Attributes and namespaces whose comparison would take too long.
    #[error(
        "its XML has more attributes and namespaces than can be compared: up to {attributes} attributes in an element, up to {namespaces} namespaces"
    )]
    Comparisons {
        /// Most attributes of one element.
        attributes: usize,
        /// Most namespaces that are declared for one element.
        namespaces: usize,
    },
}

/// The tree of an XML text.
///
/// Takes less than a second and another for every 10 MB; memory stays below a hundred times the text.
///
/// # Errors
/// [`XmlError`] for what is not well-formed, has a document type, or has more of something than any program writes.
pub(crate) fn parse(text: &str) -> Result<Document<'_>, XmlError> {
    Survey::check(text)?;
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| match error {
        roxmltree::Error::DtdDetected => XmlError::DocumentType,
        roxmltree::Error::NodesLimitReached => {
            let most = MOST_NODES as usize;
            XmlError::Length { what: "elements and texts", found: most + 1, most }
        }
        other => XmlError::Syntax(plain(&other.to_string(), LONGEST_REASON)),
    })
}
