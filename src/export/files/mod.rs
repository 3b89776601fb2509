//! File output: nothing else in the program opens files for writing, renames or removes them.
//!
//! Files are written atomically, never replace anything but regular files, and name the program that wrote them.

mod destination;
mod guarded;
mod made_by;
mod unfinished;
mod whole;

pub use destination::Destination;
pub use guarded::{hold_lock, make_folder, put_aside, remove, rename};
pub use made_by::is_ours;
pub(super) use unfinished::{Unfinished, scratch};
pub use unfinished::{remove_abandoned, remove_unfinished};
pub use whole::{check_ending, check_writable, keep_backup, write_atomically};
pub(super) use whole::{open_regular, place, temporary_beside};
