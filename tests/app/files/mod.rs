//! Tests of files that the window opens, writes, and keeps between runs.

mod corrections;
mod export;
mod export_marks;
mod foreign_files;
mod large_volumes;
mod layers;
mod opening;
pub(crate) mod raw_import;
mod sessions;
pub(crate) mod start_screen;
mod time_steps;
mod typed_paths;
mod untrusted_paths;
mod volume_choice;
