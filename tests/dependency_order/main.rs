//! Checks of the source tree: crates depend downwards only (the table in `src/lib.rs`), modules without cycles between
//! siblings; the UI library stays in the window and the GPU library in the renderer; files state their subject and
//! stay short, and folders have few entries; statics have reasons.

mod advisories;
mod disk_writes;
mod documents;
mod file_form;
mod import_cycles;
mod layers;
mod module_paths;
mod sources;
mod statics;
mod tokens;
mod words;
