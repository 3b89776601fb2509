//! Safe reading and writing of files; the lowest layer.
//!
//! Only this crate of the project opens files for writing, renames or removes them. Files are written atomically,
//! replace nothing but regular files, and carry a mark of this program where their format has room for one. Text and
//! numbers in files of other programs are not trusted: they are read up to a limit, and sanitised before they are
//! shown.
//!
//! Begin with [`write_atomically`] in `atomic_write.rs`; `replaced_folder.rs` does for folders of Zarr what it does for
//! files. Temporary files, and their removal after the program was
//! killed while writing, are in `temporary_file.rs`. `untrusted/` has the limits of reading, `program_mark/` recognises
//! the program's own files, and [`fault`] has the failures that tests provoke.

mod atomic_write;
mod destination;
mod error;
pub mod fault;
mod own_files;
mod program_mark;
mod provenance;
mod replaced_folder;
mod temporary_file;
mod temporary_folder;
mod untrusted;

pub use atomic_write::{
    check_extension, check_writable, keep_backup, open_regular, rename_into_place, temporary_file_for,
    write_atomically,
};
pub use destination::OutputDestination;
pub use error::{OpenFileError, WriteError};
pub use own_files::{create_lock, hold_lock, make_folder, quarantine, remove_own_file, rename_own_file};
pub use program_mark::is_written_by_us;
pub use provenance::{MAX_LOOK_BYTES, PROVENANCE_MARK, provenance_mark, with_provenance_mark};
pub use replaced_folder::{check_folder_writable, rename_folder_into_place, temporary_folder_for};
pub use temporary_file::{
    TemporaryFile, remove_abandoned_temporary_files, remove_own_temporary_files, unnamed_file,
};
pub use temporary_folder::TemporaryFolder;
pub use untrusted::{
    XmlError, fingerprint, natural_sort_key, one_line, read_bounded, read_small_file, sanitised,
    sanitised_line, without_controls, xml,
};
