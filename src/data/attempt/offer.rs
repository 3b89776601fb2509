//! Volumes of one file, and in what they differ.

use std::fmt;

/// A way in which the volumes of a file differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// Time steps of one thing.
    Frame,
    /// What several detectors or dyes have seen at once.
    Channel,
    /// Scans in one folder.
    Series,
    /// Arrays in one archive.
    Array,
}

impl Dimension {
    /// The option of the command line that chooses.
    pub fn option(self) -> &'static str {
        match self {
            Self::Frame => "--frame",
            Self::Channel => "--channel",
            Self::Series => "--series",
            Self::Array => "--array",
        }
    }

    /// Several of them, in words.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Frame => "time steps",
            Self::Channel => "channels",
            Self::Series => "series",
            Self::Array => "arrays",
        }
    }
}

/// One of several volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offer {
    /// By what it is chosen: a number from 0, or a name.
    pub key: String,
    /// What the file calls it; short and harmless, may be empty.
    pub name: String,
    /// Voxels along x, y, z, where they are known.
    pub dims: Option<[u64; 3]>,
}

impl Offer {
    /// A volume that is chosen by its number alone.
    pub fn numbered(number: usize, name: &str, dims: [u64; 3]) -> Self {
        Self { key: number.to_string(), name: crate::data::plain(name.trim(), 80), dims: Some(dims) }
    }
}

impl fmt::Display for Offer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.key)?;
        if !self.name.is_empty() && self.name != self.key {
            write!(f, " \"{}\"", self.name)?;
        }
        self.dims.map_or(Ok(()), |[x, y, z]| write!(f, " ({x} x {y} x {z})"))
    }
}
