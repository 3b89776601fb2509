//! File output: nothing else in the program opens files for writing, renames or removes them.
//!
//! Files are written atomically, never replace anything but regular files, and name the program that wrote them.

mod atomic_write;
mod destination;
mod own_files;
mod program_mark;
mod temporary_file;

pub use atomic_write::{check_extension, check_writable, keep_backup, write_atomically};
pub(super) use atomic_write::{open_regular, rename_into_place, temporary_file_for};
pub use destination::OutputDestination;
pub use own_files::{hold_lock, make_folder, quarantine, remove_own_file, rename_own_file};
pub use program_mark::is_written_by_us;
pub(super) use temporary_file::{TemporaryFile, unnamed_file};
pub use temporary_file::{remove_abandoned_temporary_files, remove_own_temporary_files};
