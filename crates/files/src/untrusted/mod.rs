//! Untrusted input: sanitising of text from files, XML parsing in bounded time, and bounded reading of small files.

mod natural_order;
mod sanitise;
mod small_file;
pub mod xml;

pub use natural_order::natural_sort_key;
pub use sanitise::{fingerprint, one_line, sanitised, sanitised_line, without_controls};
pub use small_file::read_bounded;
pub use small_file::read_small_file;
pub use xml::XmlError;
