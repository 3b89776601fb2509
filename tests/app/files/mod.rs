//! Tests of files that the window opens, writes, and keeps between runs.

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
