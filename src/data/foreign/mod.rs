//! What others wrote: text made harmless, and small files.

mod natural_order;
mod small_file;
mod text;

pub(crate) use natural_order::natural;
pub use small_file::read_small;
pub use text::{fingerprint, plain, single_line, without_controls};
