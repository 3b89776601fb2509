//! Axis corrections: flips, permutations and anatomical orientation of a file's axes.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Axes of the file along which the order of voxels is reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Flips {
    /// True if the first axis is reversed.
    pub x: bool,
    /// True if the second axis is reversed.
    pub y: bool,
    /// True if the third axis is reversed.
    pub z: bool,
}

impl Flips {
    /// Returns the flags as an array, one for each axis.
    pub fn axes(self) -> [bool; 3] {
        [self.x, self.y, self.z]
    }
}

/// Permutation of the axes: the file's first, second and third axis take the directions of the axes with these names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum AxisOrder {
    #[default]
    Xyz,
    Xzy,
    Yxz,
    Yzx,
    Zxy,
    Zyx,
}

impl AxisOrder {
    /// All six permutations of the axes.
    pub const ALL: [Self; 6] = [Self::Xyz, Self::Xzy, Self::Yxz, Self::Yzx, Self::Zxy, Self::Zyx];

    /// Returns for each axis of the file the index of the axis whose direction it takes.
    pub fn permutation(self) -> [usize; 3] {
        match self {
            Self::Xyz => [0, 1, 2],
            Self::Xzy => [0, 2, 1],
            Self::Yxz => [1, 0, 2],
            Self::Yzx => [1, 2, 0],
            Self::Zxy => [2, 0, 1],
            Self::Zyx => [2, 1, 0],
        }
    }

    /// Returns the inverse permutation.
    #[must_use]
    pub fn inverse(self) -> Self {
        match self {
            Self::Yzx => Self::Zxy,
            Self::Zxy => Self::Yzx,
            own => own,
        }
    }

    /// Returns the name shown to the user.
    pub fn name(self) -> &'static str {
        match self {
            Self::Xyz => "x y z",
            Self::Xzy => "x z y",
            Self::Yxz => "y x z",
            Self::Yzx => "y z x",
            Self::Zxy => "z x y",
            Self::Zyx => "z y x",
        }
    }
}

/// Anatomical orientation of a file's axes; written as three letters, or `unknown`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Orientation {
    /// There is no body, or its orientation is unknown.
    Unknown,
    /// Anatomical directions of the three axes.
    Anatomical(AnatomicalAxes),
}

/// Anatomical directions of three axes, no two of the same pair (R/L, A/P, S/I).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnatomicalAxes([AnatomicalDirection; 3]);

/// Anatomical direction: a signed axis of right-anterior-superior space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct AnatomicalDirection {
    /// Index of the axis: left to right, posterior to anterior, inferior to superior.
    axis: usize,
    is_backwards: bool,
}

/// Letters of the positive and the negative direction of each axis of right-anterior-superior space.
const LETTERS: [[char; 2]; 3] = [['R', 'L'], ['A', 'P'], ['S', 'I']];

impl AnatomicalDirection {
    fn from_letter(letter: char) -> Option<Self> {
        let letter = letter.to_ascii_uppercase();
        let axis = LETTERS.iter().position(|pair| pair.contains(&letter))?;
        Some(Self { axis, is_backwards: letter == LETTERS[axis][1] })
    }

    fn letter(self) -> char {
        LETTERS[self.axis][usize::from(self.is_backwards)]
    }

    /// Returns the unit vector in right-anterior-superior space.
    fn direction(self) -> DVec3 {
        if self.is_backwards { -DVec3::AXES[self.axis] } else { DVec3::AXES[self.axis] }
    }
}

impl AnatomicalAxes {
    /// Parses three letters of any case, one of each pair.
    fn from_letters(text: &str) -> Option<Self> {
        // A fourth letter makes the conversion fail; no more need be looked at.
        let headings: Option<Vec<_>> = text.chars().take(4).map(AnatomicalDirection::from_letter).collect();
        let headings: [AnatomicalDirection; 3] = headings?.try_into().ok()?;
        let has_all = (0..3).all(|axis| headings.iter().any(|heading| heading.axis == axis));
        has_all.then_some(Self(headings))
    }

    /// Returns the unit vectors of the three axes, in right-anterior-superior space.
    pub fn directions(self) -> [DVec3; 3] {
        self.0.map(AnatomicalDirection::direction)
    }

    /// Iterates over all 48 orientations of three axes, those in the order x, y, z first.
    pub fn all() -> impl Iterator<Item = Self> {
        AxisOrder::ALL.into_iter().flat_map(|order| {
            (0..8).map(move |signs: usize| {
                let heading =
                    |place: usize| AnatomicalDirection { axis: place, is_backwards: signs >> place & 1 == 1 };
                Self(order.permutation().map(heading))
            })
        })
    }

    /// Returns the anatomical directions closest to three axes, no pair used twice: the axis best aligned is assigned
    /// first.
    pub fn nearest(axes: [DVec3; 3]) -> Self {
        let mut headings = [0, 1, 2].map(|axis| AnatomicalDirection { axis, is_backwards: false });
        let (mut left, mut sides) = (vec![0, 1, 2], vec![0, 1, 2]);
        while !left.is_empty() {
            let pairs = left.iter().flat_map(|&axis| sides.iter().map(move |&side| (axis, side)));
            let share = |(axis, side): &(usize, usize)| axes[*axis].normalize_or_zero()[*side].abs();
            let Some((axis, side)) = pairs.max_by(|a, b| share(a).total_cmp(&share(b))) else { break };
            headings[axis] = AnatomicalDirection { axis: side, is_backwards: axes[axis][side] < 0.0 };
            left.retain(|&other| other != axis);
            sides.retain(|&other| other != side);
        }
        Self(headings)
    }
}

impl Orientation {
    /// Iterates over all known orientations, for lists.
    pub fn all_anatomical() -> impl Iterator<Item = Self> {
        AnatomicalAxes::all().map(Self::Anatomical)
    }
}

impl fmt::Display for AnatomicalAxes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|heading| write!(f, "{}", heading.letter()))
    }
}

impl fmt::Display for Orientation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("unknown"),
            Self::Anatomical(headings) => headings.fmt(f),
        }
    }
}

impl FromStr for AnatomicalAxes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::from_letters(text).ok_or_else(|| {
            let shown = chiaroscuro_files::sanitised(text, 40);
            format!("expected one letter of each of R/L, A/P and S/I, as in RAS or LPS; found {shown:?}")
        })
    }
}

impl FromStr for Orientation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.trim().eq_ignore_ascii_case("unknown") {
            return Ok(Self::Unknown);
        }
        AnatomicalAxes::from_letters(text.trim()).map(Self::Anatomical).ok_or_else(|| {
            let shown = chiaroscuro_files::sanitised(text, 40);
            format!(
                "expected one letter of each of R/L, A/P and S/I, as in RAS or LPS, or unknown; found {shown:?}"
            )
        })
    }
}

impl TryFrom<String> for Orientation {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Orientation> for String {
    fn from(orientation: Orientation) -> Self {
        orientation.to_string()
    }
}
