//! Errors of reading a panorama as an environment map.

use std::path::PathBuf;

/// Reason for which a picture cannot serve as an environment map.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentMapError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The picture cannot be decoded.
    #[error("{}: not a readable picture: {why}; expected Radiance HDR, OpenEXR, PNG or JPEG", path.display())]
    Broken {
        /// Path of the file.
        path: PathBuf,
        /// Message of the decoder.
        why: String,
    },
    /// The picture does not show all directions: its width is not twice its height.
    #[error(
        "{}: {width} × {height} pixels; expected a picture of all directions, twice as wide as high (equirectangular, \
         as 360° panoramas are)", path.display()
    )]
    Shape {
        /// Path of the file.
        path: PathBuf,
        /// Width of the picture, in pixels.
        width: usize,
        /// Height of the picture, in pixels.
        height: usize,
    },
    /// The picture would take too much memory.
    #[error(
        "{}: {width} × {height} pixels are more than the {max_pixels} that are supported; scale it down, which does \
         not change the light", path.display()
    )]
    TooLarge {
        /// Path of the file.
        path: PathBuf,
        /// Width of the picture, in pixels.
        width: usize,
        /// Height of the picture, in pixels.
        height: usize,
        /// Maximum number of pixels in total.
        max_pixels: usize,
    },
    /// The picture contains no light.
    #[error("{}: the picture is black, and gives no light", path.display())]
    Black {
        /// Path of the file.
        path: PathBuf,
    },
}
