//! Untrusted input: sanitising of text from files, XML parsing in bounded time, and bounded reading of small files.

mod natural_order;
mod small_file;
mod text;
pub(crate) mod xml;

pub(crate) use natural_order::natural;
pub(crate) use small_file::read_bounded;
pub use small_file::read_small;
pub use text::{fingerprint, one_line, plain, single_line, without_controls};
pub use xml::XmlError;
