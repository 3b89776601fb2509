//! Command-line arguments that describe a still picture.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::scene::parse_size;
use crate::export::PictureFormat;
use crate::model::{Annotations, ImageSpec, MAX_SAMPLES_PER_EDGE, PixelFormat};

/// Arguments of a still picture.
#[derive(Debug, Args)]
pub(super) struct ImageArgs {
    /// Pixels; more than the adapter can draw at once are drawn in parts
    #[arg(long, value_name = "WxH", default_value = "1280x960", value_parser = parse_size)]
    size: [u32; 2],
    /// Leave the background out (straight alpha in PNG, premultiplied in EXR)
    #[arg(long)]
    transparent: bool,
    /// Samples of each pixel along an edge: 2 means four
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES_PER_EDGE)))]
    samples: u32,
    /// Bits of each colour of a PNG file; EXR files hold linear light in 16-bit floats
    #[arg(long, value_enum, default_value_t = BitDepthArg::Eight)]
    bits: BitDepthArg,
    /// Write over the picture how long things are (`scale_bar`), which side of a body is where (`letters`), which
    /// colour stands for which value (`legend`)
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
