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
    OutputDestination, check_extension, check_writable, hold_lock, is_written_by_us, keep_backup,
    make_folder, quarantine, remove_abandoned_temporary_files, remove_own_file, remove_own_temporary_files,
    rename_own_file, write_atomically,
};
pub use marks::{
    ContactSheetImage, MarksLayer, SCENE_SIDES, ScaleBar, marks_layer, marks_layer_of_size,
    orientation_letters, orientation_letters_of_plane, scale_bar,
};
pub use picture_file::{
    PictureFormat, check_picture, may_carry_record, picture_size, read_picture, read_record, write_picture,
};
pub use png_file::{encode_png, export_png};
pub use rows::PixelRows;
pub use volumes::{
    ConvertError, ExportVolume, NumberRequest, VolumeFormat, nrrd_header_in_space_of, write_volume,
};
