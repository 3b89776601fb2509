//! What is opened of a file, or of a folder, that holds several volumes.

use std::fmt;

/// What the user has said about which of several volumes is meant; nothing where there is but one.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct Choice {
    /// The component of vectors and colours, from 0; without one their length, or their luminance.
    pub component: Option<usize>,
    /// The time step, from 0.
    pub frame: Option<usize>,
    /// The channel, from 0.
    pub channel: Option<usize>,
    /// The series of a folder, by its [`Offer::key`].
    pub series: Option<String>,
    /// The array of an archive, by its [`Offer::key`].
    pub array: Option<String>,
}

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
    /// How many there are.
    pub const COUNT: usize = 4;

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

impl Choice {
    /// What is said of a dimension.
    fn said(&self, dimension: Dimension) -> Option<String> {
        match dimension {
            Dimension::Frame => self.frame.map(|frame| frame.to_string()),
            Dimension::Channel => self.channel.map(|channel| channel.to_string()),
            Dimension::Series => self.series.clone(),
            Dimension::Array => self.array.clone(),
        }
    }

    /// The choice with one of the offers of a dimension.
    #[must_use]
    pub fn with(mut self, dimension: Dimension, key: &str) -> Self {
        let number = key.parse().ok();
        match dimension {
            Dimension::Frame => self.frame = number,
            Dimension::Channel => self.channel = number,
            Dimension::Series => self.series = Some(key.to_owned()),
            Dimension::Array => self.array = Some(key.to_owned()),
        }
        self
    }

    /// Which of the offers is meant: the only one, or the one that was named by its key, or its name.
    ///
    /// # Errors
    /// [`Unclear::Several`] where none was named, [`Unclear::Unknown`] where another was.
    pub(super) fn of(&self, dimension: Dimension, offers: &[Offer]) -> Result<usize, Unclear> {
        match self.said(dimension) {
            None if offers.len() == 1 => Ok(0),
            None => Err(Unclear::Several),
            Some(said) => {
                let by = |what: fn(&Offer) -> &String| offers.iter().position(|offer| *what(offer) == said);
                by(|offer| &offer.key).or_else(|| by(|offer| &offer.name)).ok_or(Unclear::Unknown(said))
            }
        }
    }
}

/// Why it is not clear which of several volumes is meant.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Unclear {
    /// Nothing was said.
    Several,
    /// What was said is none of them.
    Unknown(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_several_is_named() {
        let offers = [Offer::numbered(0, "DAPI", [4; 3]), Offer::numbered(1, "GFP", [4; 3])];
        let nothing = Choice::default();
        assert_eq!(nothing.of(Dimension::Channel, &offers), Err(Unclear::Several));
        assert_eq!(nothing.of(Dimension::Channel, &offers[1..]), Ok(0), "there is but one");
        let second = nothing.clone().with(Dimension::Channel, "1");
        assert_eq!(second.of(Dimension::Channel, &offers), Ok(1));
        assert_eq!(second.of(Dimension::Channel, &offers[..1]), Err(Unclear::Unknown("1".to_owned())));
        assert_eq!(second.of(Dimension::Frame, &offers), Err(Unclear::Several), "another dimension");
        let series = nothing.with(Dimension::Series, "GFP");
        assert_eq!(series.of(Dimension::Series, &offers), Ok(1), "by its name");
        assert_eq!(offers[0].to_string(), "0 \"DAPI\" (4 x 4 x 4)");
    }
}
