//! How pictures are taken, as the command line says it.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::scene::parse_size;
use crate::export::PictureFormat;
use crate::model::{Depth, ImageSpec, MAX_SAMPLES};

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
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: u32,
    /// Bits of each colour of a PNG file; EXR files hold linear light in 16-bit floats
    #[arg(long, value_enum, default_value_t = Bits::Eight)]
    bits: Bits,
}

/// Bits of each colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Bits {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

impl ImageArgs {
    /// What is asked for, in a file of this name.
    pub(super) fn spec(&self, path: &Path) -> ImageSpec {
        let wanted = match self.bits {
            Bits::Eight => Depth::Eight,
            Bits::Sixteen => Depth::Sixteen,
        };
        let depth = PictureFormat::of_path(path).depth(wanted);
        ImageSpec { size: self.size, transparent: self.transparent, samples: self.samples, depth }
    }
}
