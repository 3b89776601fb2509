//! Why a picture cannot serve as surroundings.

use std::path::PathBuf;

/// What is wrong with a picture of surroundings.
#[derive(Debug, thiserror::Error)]
pub enum SurroundingsError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It cannot be decoded.
    #[error("{}: no picture that can be read: {why}; expected Radiance HDR, OpenEXR, PNG or JPEG", path.display())]
    Broken {
        /// Which.
        path: PathBuf,
        /// What the decoder says.
        why: String,
    },
    /// It does not show all directions.
    #[error(
        "{}: {width} × {height} pixels; expected a picture of all directions, twice as wide as high (equirectangular, \
         as 360° panoramas are)", path.display()
    )]
    Shape {
        /// Which.
        path: PathBuf,
        /// Pixels.
        width: usize,
        /// Pixels.
        height: usize,
    },
    /// It would take too much memory.
    #[error("{}: {width} × {height} pixels are more than the {most} that are read; scale it down, which changes no light", path.display())]
    TooLarge {
        /// Which.
        path: PathBuf,
        /// Pixels.
        width: usize,
        /// Pixels.
        height: usize,
        /// Pixels in all.
        most: usize,
    },
    /// There is no light in it.
    #[error("{}: the picture is black, and lights nothing", path.display())]
    Black {
        /// Which.
        path: PathBuf,
    },
}
