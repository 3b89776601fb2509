//! Volumes offered by one file, and the dimensions in which they differ.

use std::fmt;

/// Dimension in which the volumes of a file differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FileDimension {
    /// Time steps of a single object.
    Frame,
    /// Channels recorded at the same time by several detectors or dyes.
    Channel,
    /// Scans in a single folder.
    Series,
    /// Arrays in a single archive.
    Array,
    /// Resolution levels of a single image, finest first.
    Level,
}

impl FileDimension {
    /// Returns the command-line option that selects in this dimension.
    pub fn option(self) -> &'static str {
        match self {
            Self::Frame => "--frame",
            Self::Channel => "--channel",
            Self::Series => "--series",
            Self::Array => "--array",
            Self::Level => "--level",
        }
    }

    /// Returns the plural name, for messages.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Frame => "time steps",
            Self::Channel => "channels",
            Self::Series => "series",
            Self::Array => "arrays",
            Self::Level => "resolution levels",
        }
    }
}

/// One of the volumes that a file offers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VolumeOffer {
    /// Key by which it is selected: a number from 0, or a name.
    pub key: String,
    /// Name that the file gives it; short, sanitised, possibly empty.
    pub name: String,
    /// Voxels along x, y, z, if known.
    pub dims: Option<[u64; 3]>,
    /// Colour that the file gives a channel: red, green and blue in sRGB.
    pub color: Option<[u8; 3]>,
}

impl VolumeOffer {
    /// Creates an offer that is selected by its number alone.
    pub fn with_number(number: usize, name: &str, dims: [u64; 3]) -> Self {
        Self {
            key: number.to_string(),
            name: chiaroscuro_files::sanitised(name.trim(), 80),
            dims: Some(dims),
            color: None,
        }
    }
}

impl fmt::Display for VolumeOffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.key)?;
        if !self.name.is_empty() && self.name != self.key {
            write!(f, " \"{}\"", self.name)?;
        }
        self.dims.map_or(Ok(()), |[x, y, z]| write!(f, " ({x} x {y} x {z})"))
    }
}
