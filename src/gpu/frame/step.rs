//! Pieces of work for one picture, each short enough for a watchdog and a waiting user.

use std::collections::VecDeque;
use std::ops::Range;

use crate::gpu::bounces::steps::BounceStep;
use crate::gpu::eye::floor;
use crate::gpu::resources::part::Part;
use crate::gpu::volume::transfer_tables::{Table, Tables};

/// What a step belongs to, for reports and for the status bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Density, on its way to the GPU.
    Upload,
    /// The pyramid of prefiltered volumes.
    Pyramid,
    /// Sheets of a light.
    LightMarch,
    /// Sheets into the light volume.
    LightBackproject,
    /// Rays from the voxels of the light volume.
    LightRaycast,
    /// Light of the sky.
    Sky,
    /// Light that bounces.
    Bounces,
    /// The picture.
    Eye,
    /// Display colours of the picture.
    Display,
}

/// A piece of one half of a light pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LightStep {
    /// Index of the light build.
    pub build: usize,
    /// Which of the colours of light, where each is followed by itself.
    pub color: Option<usize>,
    /// Index of its view.
    pub view: usize,
    /// First slab of the chunk.
    pub begin: u32,
    /// Which part of the tiles or bricks.
    pub part: Part,
}

/// Rays from the voxels of some bricks to a light.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RaycastStep {
    /// Index of the light build.
    pub build: usize,
    /// Which of the colours of light, where each is followed by itself.
    pub color: Option<usize>,
    /// Number of the point of the light.
    pub point: usize,
    /// Which of its bricks.
    pub bricks: Range<usize>,
}

/// A transfer function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Eye,
    Lighting,
}

impl Side {
    /// Its table.
    pub(super) fn of(self, tables: &Tables) -> &Table {
        match self {
            Self::Eye => &tables.eye,
            Self::Lighting => &tables.lighting,
        }
    }
}

/// Something that a picture needs, and that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Product {
    Volume,
    /// What a table makes of voxels.
    Materials(Side),
    /// The volume that a light build fills.
    Light(usize),
    CombinedLight,
    /// The volume of the sky's visibility.
    Sky,
    /// The volume of light that has bounced.
    Bounces,
    /// Linear light of the volume.
    Picture,
    Floor,
    Shown,
}

/// A piece of work for one submission.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    /// Slices of the volume.
    Upload(Range<usize>),
    /// Slices of the coarsest level of what is there.
    Presence(Range<usize>),
    /// Level, and which of its bricks.
    Pyramid(u32, Range<usize>),
    /// Level, and which of its bricks.
    Gradients(u32, Range<usize>),
    /// By which table voxels are classified, level, and which of its bricks.
    Materials(Side, u32, Range<usize>),
    March(LightStep),
    Backproject(LightStep),
    Raycast(RaycastStep),
    /// The volumes of points of a light join those before: index of the light build, the colour, and the last of them.
    Average {
        build: usize,
        color: Option<usize>,
        point: usize,
    },
    /// The volumes of a light's colours become one: index of the light build.
    JoinColors(usize),
    /// Bricks of the volume in which all lights are combined.
    Combine(Range<usize>),
    /// What attenuates the light of a sky.
    SkyBlocks,
    /// A batch of directions of a sky.
    SkyBatch(usize),
    /// A piece of the filling of a volume of bounced light.
    Bounce(BounceStep),
    /// Rows of the picture.
    Eye(Range<u32>),
    /// Slabs of the eye's scattered sheets.
    ScatterEye(Range<u32>),
    /// Rows of the floor.
    Floor(Range<u32>),
    Display,
    /// Everything of a product has been recorded; no work of its own.
    Finish(Product),
}

impl Step {
    /// What it belongs to; `None` of what is no work.
    pub(super) fn stage(&self) -> Option<Stage> {
        Some(match self {
            Self::Upload(_) | Self::Presence(_) => Stage::Upload,
            Self::Pyramid(..) | Self::Gradients(..) | Self::Materials(..) => Stage::Pyramid,
            Self::March(..) => Stage::LightMarch,
            Self::Backproject(..) | Self::Average { .. } | Self::JoinColors(_) | Self::Combine(_) => {
                Stage::LightBackproject
            }
            Self::Raycast(_) => Stage::LightRaycast,
            Self::SkyBlocks | Self::SkyBatch(_) => Stage::Sky,
            Self::Bounce(_) => Stage::Bounces,
            Self::Eye(_) | Self::ScatterEye(_) | Self::Floor(_) => Stage::Eye,
            Self::Display => Stage::Display,
            Self::Finish(_) => return None,
        })
    }
}

/// Cuts rows that are still to be drawn into bands of `rows`.
pub(super) fn cut_into_bands(steps: &mut VecDeque<Step>, rows: u32) {
    let mut cut = VecDeque::with_capacity(steps.len());
    for step in steps.drain(..) {
        match step {
            Step::Eye(range) => cut_rows(&mut cut, range, rows, Step::Eye),
            Step::Floor(range) => cut_rows(&mut cut, range, (rows / floor::COST).max(1), Step::Floor),
            other => cut.push_back(other),
        }
    }
    *steps = cut;
}

/// Adds bands of rows. Adjoining bands are joined again when the band grows.
fn cut_rows(steps: &mut VecDeque<Step>, range: Range<u32>, rows: u32, step: fn(Range<u32>) -> Step) {
    let Range { mut start, end } = range;
    if let Some(Step::Eye(last) | Step::Floor(last)) = steps.back()
        && steps.back() == Some(&step(last.clone()))
        && last.end == start
        && last.end - last.start < rows
    {
        start = last.start;
        steps.pop_back();
    }
    while start < end {
        steps.push_back(step(start..end.min(start + rows)));
        start += rows;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_cut_and_joined_again() {
        let mut steps: VecDeque<Step> = [Step::Eye(0..10), Step::Floor(0..10), Step::Display].into();
        cut_into_bands(&mut steps, 4);
        let eye = [Step::Eye(0..4), Step::Eye(4..8), Step::Eye(8..10)];
        let floor = (0..5).map(|k| Step::Floor(2 * k..2 * k + 2));
        let wanted: VecDeque<Step> = eye.into_iter().chain(floor).chain([Step::Display]).collect();
        assert_eq!(steps, wanted);
        cut_into_bands(&mut steps, 100);
        assert_eq!(steps, [Step::Eye(0..10), Step::Floor(0..10), Step::Display]);
    }
}
