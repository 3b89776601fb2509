//! Portion of a file's grid that is read: all voxels, a region, a subsampling, or block averages.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Maximum stride of a subsampling, and maximum edge of a block, in voxels. Larger ones leave nothing visible even of
/// the longest axes, and a row of this many voxels is still a small buffer.
pub(super) const MAX_STRIDE: usize = 4096;

/// Portion of a volume that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Portion {
    /// Region in voxels of the file; `None` for the whole grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<VoxelRegion>,
    /// Reduction of the voxels within the region.
    #[serde(skip_serializing_if = "Downsampling::is_none")]
    pub thinning: Downsampling,
}

/// Reduction of the voxels of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Downsampling {
    /// All voxels are kept.
    #[default]
    None,
    /// Subsampling: along each axis the first voxel, then every n-th.
    Every(usize),
    /// Averages of blocks of n voxels along each axis; for labels the most frequent one.
    Average(usize),
}

/// Box of voxels, any end of which may be left open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct VoxelRegion(pub [VoxelSpan; 3]);

/// Range of voxels along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct VoxelSpan {
    /// First voxel of the range, from 0.
    pub first: usize,
    /// End of the range, exclusive; `None` for the end of the axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<usize>,
}

impl Portion {
    /// Returns true if no voxel is left out.
    pub fn is_whole(&self) -> bool {
        self.region.is_none() && self.thinning.stride() == 1
    }

    /// Returns the subsampling of the whole grid with the given stride.
    pub fn with_stride(step: usize) -> Self {
        Self { region: None, thinning: Downsampling::Every(step) }
    }

    /// Returns the averages of blocks of the whole grid with the given edge.
    #[cfg(any(test, feature = "testing"))]
    pub fn with_block_average(block: usize) -> Self {
        Self { region: None, thinning: Downsampling::Average(block) }
    }

    /// Describes the portion in words, to be followed by the grid: `every 2nd voxel of`.
    pub fn in_words(&self) -> String {
        let thinning = match (self.thinning, self.thinning.stride()) {
            (_, 1) => "",
            (Downsampling::Average(_), n) => &format!("means of {n} x {n} x {n} voxels of "),
            (_, 2) => "every second voxel of ",
            (_, 3) => "every third voxel of ",
            (_, n) => &format!("every {n}th voxel of "),
        };
        let region = self.region.map_or(String::new(), |region| format!("the region {region} of "));
        format!("{thinning}{region}").trim_end().to_owned()
    }
}

impl Downsampling {
    /// Returns the stride, or the edge of a block, in voxels of the file.
    pub fn stride(self) -> usize {
        match self {
            Self::None => 1,
            Self::Every(n) | Self::Average(n) => n.clamp(1, MAX_STRIDE),
        }
    }

    fn is_none(&self) -> bool {
        self.stride() == 1
    }
}

/// Parses text such as `0:10,5:,:`.
impl FromStr for VoxelRegion {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected =
            || format!("expected first and end along x, y and z, as in 0:64,0:64,10:20, found {text:?}");
        let stretch = |text: &str| {
            let (first, end) = text.split_once(':')?;
            let number = |text: &str, default| {
                if text.is_empty() { Some(default) } else { text.parse().ok().map(Some) }
            };
            Some(VoxelSpan { first: number(first.trim(), Some(0))??, end: number(end.trim(), None)? })
        };
        let stretches: Option<Vec<VoxelSpan>> = text.split(',').map(stretch).collect();
        stretches.and_then(|stretches| stretches.try_into().ok()).map(Self).ok_or_else(expected)
    }
}

impl fmt::Display for VoxelRegion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (axis, VoxelSpan { first, end }) in self.0.into_iter().enumerate() {
            let comma = if axis > 0 { "," } else { "" };
            let end = end.map_or(String::new(), |end| end.to_string());
            write!(f, "{comma}{first}:{end}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_understood_and_written_alike() {
        let region: VoxelRegion = "1:4,:,2:".parse().unwrap();
        assert_eq!(region.to_string(), "1:4,0:,2:");
        assert_eq!(region.to_string().parse(), Ok(region));
        for text in ["", "1:2", "1:2,3:4", "1:2,3:4,5", "a:2,3:4,5:6", "-1:2,3:4,5:6", "1:2,3:4,5:6,7:8"] {
            assert!(text.parse::<VoxelRegion>().is_err(), "{text}");
        }
    }

    #[test]
    fn portions_serialise_compactly() {
        for (portion, text) in [
            (Portion::default(), "{}"),
            (Portion::with_stride(2), r#"{"thinning":{"every":2}}"#),
            (Portion::with_block_average(4), r#"{"thinning":{"average":4}}"#),
            (
                Portion { region: "0:8,:,1:".parse().ok(), thinning: Downsampling::Every(3) },
                r#"{"region":[{"first":0,"end":8},{"first":0},{"first":1}],"thinning":{"every":3}}"#,
            ),
        ] {
            assert_eq!(serde_json::to_string(&portion).unwrap(), text);
            assert_eq!(serde_json::from_str::<Portion>(text).unwrap(), portion);
        }
        // A value that no version writes, as from an edited session file.
        let odd: Portion = serde_json::from_str(r#"{"thinning":{"every":0}}"#).unwrap();
        assert!(odd.is_whole());
    }

    #[test]
    fn portions_are_described_in_words() {
        let boxed = Portion { region: "0:8,:,1:".parse().ok(), thinning: Downsampling::Every(2) };
        assert_eq!(boxed.in_words(), "every second voxel of the region 0:8,0:,1: of");
        assert_eq!(Portion::with_block_average(4).in_words(), "means of 4 x 4 x 4 voxels of");
        assert_eq!(Portion::with_stride(5).in_words(), "every 5th voxel of");
    }
}
