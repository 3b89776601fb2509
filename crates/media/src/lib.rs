//! Pictures and animations in files, with their marks, and environment maps.
//!
//! Pictures are written in bands of rows from the top, so that they need not be in memory as a whole. Independent of
//! the renderer and the window.
//!
//! Begin with [`write_picture`] in `picture_file.rs`; [`Animation`] is its counterpart for sequences of pictures.
//! The record of a look is embedded by `png_file.rs` and `exr_file.rs` as text, and read from GIF and MP4 by
//! `animation/embedded_record.rs`. `marks/` draws scale bar, orientation letters and legend over the
//! rows of a picture.

mod animation;
mod environment_map;
mod environment_map_error;
mod error;
mod exr_file;
mod marks;
mod picture_file;
mod png_file;
mod rows;

pub use animation::{Animation, AnimationFormat, AnimationSpec, FrameFolder, frame_names};
pub use environment_map::read_environment_map;
pub use environment_map_error::EnvironmentMapError;
pub use error::{ExportError, ReadPictureError};
pub use marks::{
    ContactSheetImage, MarksLayer, SCENE_SIDES, ScaleBar, marks_layer, marks_layer_of_size,
    orientation_letters, orientation_letters_of_plane, scale_bar,
};
pub use picture_file::{
    PictureFormat, check_picture, may_carry_record, picture_size, read_picture, read_record, write_picture,
};
pub use png_file::{encode_png, encode_shown, export_png};
pub use rows::{PicturePixels, PixelRows};
