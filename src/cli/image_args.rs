//! Command-line arguments that describe a still picture.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::scene::parse_size;
use chiaroscuro_media::PictureFormat;
use chiaroscuro_scene::{Annotations, ImageSpec, MAX_SAMPLES_PER_EDGE, PixelFormat};

/// Arguments of a still picture.
#[derive(Debug, Args)]
pub(super) struct ImageArgs {
    /// Width and height in pixels; sizes beyond the limits of the adapter are rendered in tiles
    #[arg(long, value_name = "WxH", default_value = "1280x960", value_parser = parse_size)]
    size: [u32; 2],
    /// Leave the background out (straight alpha in PNG, premultiplied in EXR)
    #[arg(long)]
    transparent: bool,
    /// Samples along each edge of a pixel: 2 means 4 samples per pixel
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES_PER_EDGE)))]
    samples: u32,
    /// Bits per colour channel of a PNG file; EXR files hold linear light in 16-bit floats
    #[arg(long, value_enum, default_value_t = BitDepthArg::Eight)]
    bits: BitDepthArg,
    /// Annotations to draw over the picture: scale bar, orientation letters of a body, legend of colours and values
    #[arg(long, value_enum, value_delimiter = ',', value_name = "MARK")]
    marks: Vec<MarkArg>,
}

/// Mark drawn over a picture, as named on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum MarkArg {
    ScaleBar,
    Letters,
    Legend,
}

/// Bits per colour channel of a PNG file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BitDepthArg {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

impl ImageArgs {
    /// Returns the image spec for a file with this name.
    pub(super) fn spec(&self, path: &Path) -> ImageSpec {
        let wanted = match self.bits {
            BitDepthArg::Eight => PixelFormat::Eight,
            BitDepthArg::Sixteen => PixelFormat::Sixteen,
        };
        let depth = PictureFormat::from_path(path).supported_depth(wanted);
        let marks = Annotations {
            scale_bar: self.marks.contains(&MarkArg::ScaleBar),
            letters: self.marks.contains(&MarkArg::Letters),
            legend: self.marks.contains(&MarkArg::Legend),
        };
        ImageSpec { size: self.size, transparent: self.transparent, samples: self.samples, depth, marks }
    }
}
