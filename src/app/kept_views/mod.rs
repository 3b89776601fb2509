//! Kept views and looks in the window: the strip of thumbnails below the picture.

mod strip;
mod thumbnails;

pub(crate) use self::strip::KeptStrip;
