//! Steps of a picture, each short enough for driver watchdogs and a responsive window.

use std::collections::VecDeque;
use std::ops::Range;

use crate::eye::{antialiasing, floor};
use crate::resources::submission_pace::StepKind;
use crate::resources::work_part::WorkPart;
use crate::scattered_light::steps::ScatteringStep;
use crate::volume::transfer_tables::{TransferTable, TransferTables};
use chiaroscuro_volume::Observer;

/// Stage of the picture that a step belongs to, for reports and for the status bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RenderStage {
    /// Upload of density to the GPU.
    Upload,
    /// Pyramid of prefiltered density.
    Pyramid,
    /// March of light through its sheets.
    LightMarch,
    /// Back-projection of sheets into the light volume.
    LightBackproject,
    /// Ray casting from the voxels of the light volume.
    LightRaycast,
    /// Computation of sky visibility.
    Sky,
    /// Computation of scattered light.
    ScatteredLight,
    /// Linear picture and floor.
    Eye,
    /// Display colours of the picture.
    Display,
}

/// Step of the march or back-projection of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LightStep {
    /// Index of the light build.
    pub build: usize,
    /// Index of the light's colour, if colours are followed separately.
    pub color: Option<usize>,
    /// Index of the view in the build.
    pub view: usize,
    /// Index of the chunk's first slab.
    pub begin: u32,
    /// Part of the chunk's tiles or bricks.
    pub part: WorkPart,
}

/// Step that casts rays from the voxels of some bricks to a light.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RaycastStep {
    /// Index of the light build.
    pub build: usize,
    /// Index of the light's colour, if colours are followed separately.
    pub color: Option<usize>,
    /// Index of the point on the light.
    pub point: usize,
    /// Range of the build's bricks.
    pub bricks: Range<usize>,
}

/// Transfer function: of the eye, of light, or of layers that tint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransferSelector {
    Eye,
    Lighting,
    Tints,
}

impl TransferSelector {
    /// Returns the table of this transfer function, if there is one.
    pub(super) fn table(self, tables: &TransferTables) -> Option<&TransferTable> {
        match self {
            Self::Eye => Some(&tables.eye),
            Self::Lighting => Some(&tables.lighting),
            Self::Tints => tables.tints.as_ref(),
        }
    }
}

/// Product that a picture needs and that is cached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FrameProduct {
    Volume,
    /// Pyramid of densities, and its gradients.
    Pyramid,
    /// Pre-classified voxels of a table.
    Materials(TransferSelector),
    /// Light volume of the build with this index.
    Light(usize),
    CombinedLight,
    /// Volume of sky visibility.
    Sky,
    /// Volume of scattered light.
    ScatteredLight,
    /// Linear light of the volume.
    Picture,
    /// Antialiased linear light of the volume.
    Antialiasing,
    Floor,
    Display,
}

/// Unit of work for one submission.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RenderStep {
    /// Uploads slices of the volume.
    Upload(Range<usize>),
    /// Uploads a box of texels of the coarsest level of an observer's presence texture, with those of the finer levels.
    Presence(Observer, [Range<usize>; 3]),
    /// Uploads pages of finer levels.
    Pages,
    /// Prefilters bricks of one pyramid level.
    Pyramid(u32, Range<usize>),
    /// Computes gradients in bricks of one pyramid level.
    Gradients(u32, Range<usize>),
    /// Classifies voxels by a table, in bricks of one pyramid level.
    Materials {
        side: TransferSelector,
        level: u32,
        bricks: Range<usize>,
    },
    March(LightStep),
    Backproject(LightStep),
    Raycast(RaycastStep),
    /// Averages the latest batch of points: index of the light build, colour, and last point.
    Average {
        build: usize,
        color: Option<usize>,
        point: usize,
    },
    /// Merges the volumes of red, green and blue light: index of the light build.
    MergeColors(usize),
    /// Fills bricks of the combined light volume.
    Combine(Range<usize>),
    /// Computes the blocks of extinction for sky visibility.
    SkyBlocks,
    /// Sweeps a batch of directions for sky visibility.
    SkyBatch(usize),
    /// Runs a step of filling a scattered-light volume.
    ScatteredLight(ScatteringStep),
    /// Draws rows of the picture.
    Eye(Range<u32>),
    /// Draws further rays at edges, in rows of the picture.
    Antialiasing(Range<u32>),
    /// Draws slabs of the eye's scattered sheets.
    ScatterEye(Range<u32>),
    /// Draws rows of the floor.
    Floor(Range<u32>),
    Display,
    /// Marks a product whose steps have all been recorded as complete; records no commands.
    Finish(FrameProduct),
}

impl RenderStage {
    /// Returns the kind of steps that this stage's are submitted with.
    pub(super) fn kind(self) -> StepKind {
        match self {
            Self::Upload | Self::Pyramid => StepKind::Volume,
            Self::LightMarch | Self::LightBackproject | Self::LightRaycast => StepKind::Light,
            Self::Sky | Self::ScatteredLight => StepKind::Ambient,
            Self::Eye | Self::Display => StepKind::Picture,
        }
    }
}

impl RenderStep {
    /// Returns the stage for reports; `None` for steps without commands.
    pub(super) fn stage(&self) -> Option<RenderStage> {
        Some(match self {
            Self::Upload(_) | Self::Presence(..) | Self::Pages => RenderStage::Upload,
            Self::Pyramid(..) | Self::Gradients(..) | Self::Materials { .. } => RenderStage::Pyramid,
            Self::March(..) => RenderStage::LightMarch,
            Self::Backproject(..) | Self::Average { .. } | Self::MergeColors(_) | Self::Combine(_) => {
                RenderStage::LightBackproject
            }
            Self::Raycast(_) => RenderStage::LightRaycast,
            Self::SkyBlocks | Self::SkyBatch(_) => RenderStage::Sky,
            Self::ScatteredLight(_) => RenderStage::ScatteredLight,
            Self::Eye(_) | Self::Antialiasing(_) | Self::ScatterEye(_) | Self::Floor(_) => RenderStage::Eye,
            Self::Display => RenderStage::Display,
            Self::Finish(_) => return None,
        })
    }
}

/// Splits rows that are still to be drawn into bands of `rows`.
pub(super) fn split_into_bands(steps: &mut VecDeque<RenderStep>, rows: u32) {
    let mut cut = VecDeque::with_capacity(steps.len());
    for step in steps.drain(..) {
        match step {
            RenderStep::Eye(range) => append_bands(&mut cut, range, rows, RenderStep::Eye),
            RenderStep::Antialiasing(range) => {
                let rows = (rows / antialiasing::ROW_COST).max(1);
                append_bands(&mut cut, range, rows, RenderStep::Antialiasing);
            }
            RenderStep::Floor(range) => {
                append_bands(&mut cut, range, (rows / floor::ROW_COST).max(1), RenderStep::Floor);
            }
            other => cut.push_back(other),
        }
    }
    *steps = cut;
}

/// Appends bands of rows. Adjacent bands are merged again when the band height grows.
fn append_bands(
    steps: &mut VecDeque<RenderStep>,
    range: Range<u32>,
    rows: u32,
    step: fn(Range<u32>) -> RenderStep,
) {
    let Range { mut start, end } = range;
    if let Some(RenderStep::Eye(last) | RenderStep::Antialiasing(last) | RenderStep::Floor(last)) =
        steps.back()
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
        let mut steps: VecDeque<RenderStep> =
            [RenderStep::Eye(0..10), RenderStep::Floor(0..10), RenderStep::Display].into();
        split_into_bands(&mut steps, 4);
        let eye = [RenderStep::Eye(0..4), RenderStep::Eye(4..8), RenderStep::Eye(8..10)];
        let floor = (0..5).map(|k| RenderStep::Floor(2 * k..2 * k + 2));
        let wanted: VecDeque<RenderStep> =
            eye.into_iter().chain(floor).chain([RenderStep::Display]).collect();
        assert_eq!(steps, wanted);
        split_into_bands(&mut steps, 100);
        assert_eq!(steps, [RenderStep::Eye(0..10), RenderStep::Floor(0..10), RenderStep::Display]);
    }
}
