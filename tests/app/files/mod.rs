//! Files that the window opens, writes, and keeps from one run to the next.

mod choosing;
mod corrections;
mod export;
mod export_marks;
mod foreign_files;
mod foreign_paths;
mod opening;
pub(crate) mod raw_import;
mod roomy;
mod sessions;
mod typed_paths;
