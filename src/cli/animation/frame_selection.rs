//! Selection of some frames of an animation, which several programs draw beside each other.

use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use crate::cli::CliError;
use chiaroscuro_media::{read_picture, read_record};

/// Largest number of parts: one program for each frame of the longest turn.
const MAX_PARTS: u32 = 3600;

/// Part of an animation: number `number` of `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AnimationPart {
    number: u32,
    count: u32,
}

impl FromStr for AnimationPart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        let (number, count) = numbers.ok_or("expected K/N, such as 3/16")?;
        if (1..=count).contains(&number) && count <= MAX_PARTS {
            Ok(Self { number, count })
        } else {
            Err(format!("expected a part from 1/{count} to {count}/{count}, of {MAX_PARTS} at most"))
        }
    }
}

/// Frames from the first to the last, which is one of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FrameRange {
    first: u32,
    last: u32,
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        let (first, last) = ends.ok_or("expected A..B, such as 0..35")?;
        if first <= last {
            Ok(Self { first, last })
        } else {
            Err("the first number is after the last".to_owned())
        }
    }
}

impl FrameRange {
    /// Returns the first number.
    pub(super) fn first(self) -> u32 {
        self.first
    }

    /// Returns the last number, which belongs to the range.
    pub(super) fn last(self) -> u32 {
        self.last
    }

    /// Returns the numbers; `None` if there are only `count`, which end before the last.
    pub(super) fn within(self, count: u32) -> Option<Range<u32>> {
        (self.last < count).then_some(self.first..self.last + 1)
    }
}

/// Frames of an animation that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FrameSelection {
    first: u32,
    end: u32,
}

impl FrameSelection {
    /// Creates the selection of a part or a range of an animation of so many frames; `None` if all are drawn.
    ///
    /// # Errors
    /// Returns an error if the range ends after the animation.
    pub(super) fn from_args(
        part: Option<AnimationPart>,
        only: Option<FrameRange>,
        frames: u32,
    ) -> Result<Option<Self>, CliError> {
        if let Some(range) = only {
            let Some(Range { start, end }) = range.within(frames) else {
                let (last, missing) = (frames - 1, range.last);
                return Err(CliError::Usage(format!(
                    "--only: frames are numbered from 0 to {last}, and there is no frame {missing}"
                )));
            };
            return Ok(Some(Self { first: start, end }));
        }
        // Parts that differ by a frame at most; those of more programs than frames may be empty.
        let begin =
            |number: u32, count: u32| (u64::from(number) * u64::from(frames) / u64::from(count)) as u32;
        Ok(part.map(|AnimationPart { number, count }| Self {
            first: begin(number - 1, count),
            end: begin(number, count),
        }))
    }

    /// Returns the numbers of the frames.
    pub(super) fn range(self) -> Range<u32> {
        self.first..self.end
    }
}

/// Returns true if a file is a whole picture of this size with this record: the same look of the same volume, drawn by the
/// same version on the same adapter.
pub(super) fn is_drawn(path: &Path, size: [u32; 2], record: &str) -> bool {
    let is_recorded = read_record(path).is_ok_and(|found| found.as_deref() == Some(record));
    // Decoding checks the sums in the file.
    is_recorded && read_picture(path).is_ok_and(|picture| picture.size == size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn selected(part: &str, frames: u32) -> Range<u32> {
        let part = part.parse().expect("a part");
        FrameSelection::from_args(Some(part), None, frames)
            .expect("a selection")
            .expect("some frames")
            .range()
    }

    #[test]
    fn parts_are_a_turn_together() {
        for (count, frames) in [(1, 72), (5, 72), (16, 72), (7, 3)] {
            let parts: Vec<_> =
                (1..=count).flat_map(|at| selected(&format!("{at}/{count}"), frames)).collect();
            assert!(parts.iter().copied().eq(0..frames), "{count} of {frames}: {parts:?}");
        }
        for wrong in ["0/4", "5/4", "1", "a/2", "1/0", "1/99999", "-1/3"] {
            assert!(wrong.parse::<AnimationPart>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn ranges_include_their_ends() {
        let range = |text: &str| text.parse::<FrameRange>();
        let selected = |text| FrameSelection::from_args(None, Some(range(text).unwrap()), 10);
        assert_eq!(selected("2..4").unwrap().unwrap().range(), 2..5);
        assert_eq!(selected("9..9").unwrap().unwrap().range(), 9..10);
        assert!(selected("9..10").unwrap_err().to_string().contains("from 0 to 9"));
        assert!(range("4..2").is_err() && range("4").is_err() && range("..2").is_err());
        assert_eq!(FrameSelection::from_args(None, None, 10).unwrap(), None);
    }
}
