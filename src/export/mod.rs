//! Export of files: pictures, animations, volumes, and atomic writing of any other file.
//!
//! Pictures are written in bands of rows from the top, so that they need not be in memory as a whole. Independent of
//! the renderer and the window.

mod animation;
mod error;
mod exr_file;
mod files;
mod marks;
mod picture_file;
mod png_file;
mod rows;
mod volumes;

pub use animation::{Animation, AnimationFormat, AnimationSpec, frame_names};
pub use error::{ExportError, ReadPictureError};
pub use files::{
    Destination, check_ending, check_writable, hold_lock, is_ours, keep_backup, make_folder, put_aside,
    remove, remove_abandoned, remove_unfinished, rename, write_atomically,
};
pub use marks::{Layer, SIDES, ScaleBar, Sheet, marks, marks_of_size, scale_bar, sides, sides_along};
pub use picture_file::{
    PictureFormat, check_picture, may_carry_record, picture_size, read_picture, read_record, write_picture,
};
pub use png_file::{encode_png, export_png};
pub use rows::Rows;
pub use volumes::{ConvertError, NumberWish, Outgoing, VolumeFormat, nrrd_header_like, write_volume};
