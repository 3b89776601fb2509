//! Lists of steps for the products of a picture that are stale.

use std::sync::Arc;

use crate::eye::eye_pass::EyePass;
use crate::frame::step::{FrameProduct, RenderStep, TransferSelector};
use crate::light::combined_light;
use crate::plan::{RenderRequest, SliceOrder};
use crate::scatter::eye::SLABS_PER_STEP;
use crate::volume::preclassified::PreclassifiedVoxels;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{GpuVolume, pyramid};
use chiaroscuro_scene::SheetOrder;

/// Returns the steps that upload the densities of a volume.
pub(super) fn upload_steps(volume: &GpuVolume) -> Vec<RenderStep> {
    let slices = volume.volume.dims()[2];
    let each = volume.slices_per_step();
    (0..slices).step_by(each).map(|first| RenderStep::Upload(first..slices.min(first + each))).collect()
}

/// Returns the steps that compute the pyramid of densities and its gradients.
pub(super) fn pyramid_steps(volume: &GpuVolume) -> Vec<RenderStep> {
    let mut steps: Vec<_> =
        pyramid::steps(volume).map(|(level, bricks)| RenderStep::Pyramid(level, bricks)).collect();
    if volume.pyramid.as_ref().is_some_and(|pyramid| pyramid.gradients.is_some()) {
        steps.extend(pyramid::steps(volume).map(|(level, bricks)| RenderStep::Gradients(level, bricks)));
    }
    steps.push(RenderStep::Finish(FrameProduct::Pyramid));
    steps
}

/// Returns the steps that classify voxels.
pub(super) fn material_steps(tables: &TransferTables) -> Vec<RenderStep> {
    let mut steps = Vec::new();
    let mut begun: Option<&Arc<PreclassifiedVoxels>> = None;
    for side in [TransferSelector::Eye, TransferSelector::Lighting, TransferSelector::Tints] {
        let table = side.table(tables);
        let Some(materials) = table.and_then(|table| table.materials.as_ref()) else { continue };
        // Both tables usually share one set of voxels.
        if materials.is_complete() || begun.is_some_and(|begun| Arc::ptr_eq(begun, materials)) {
            continue;
        }
        steps.extend(materials.steps().map(|(level, bricks)| RenderStep::Materials { side, level, bricks }));
        steps.push(RenderStep::Finish(FrameProduct::Materials(side)));
        begun = Some(materials);
    }
    steps
}

/// Returns the steps that fill the combined light volume.
pub(super) fn combine_steps(bricks: Option<usize>) -> Vec<RenderStep> {
    let Some(bricks) = bricks else { return Vec::new() };
    let firsts = (0..bricks).step_by(combined_light::BRICKS_PER_STEP);
    let end = |first: usize| bricks.min(first + combined_light::BRICKS_PER_STEP);
    let mut steps: Vec<_> = firsts.map(|first| RenderStep::Combine(first..end(first))).collect();
    steps.push(RenderStep::Finish(FrameProduct::CombinedLight));
    steps
}

/// Returns the steps that draw the linear picture.
pub(super) fn eye_steps(
    volume: &GpuVolume,
    eye: &EyePass,
    request: &RenderRequest,
    scatters: bool,
) -> Vec<RenderStep> {
    let frame = eye.frame();
    // If everything lies behind the eye there is no sheet; the gathering pass then clears the picture.
    if !scatters || frame.slab_count == 0 {
        return vec![RenderStep::Eye(0..frame.size[1])];
    }
    let count = match request.settings.sampling.order {
        SheetOrder::ImageAligned => frame.slab_count,
        SheetOrder::VolumeAligned | SheetOrder::EveryFootprint => {
            SliceOrder::new(frame, volume.volume.dims()).count
        }
    };
    let firsts = (0..count).step_by(SLABS_PER_STEP as usize);
    firsts.map(|k| RenderStep::ScatterEye(k..count.min(k + SLABS_PER_STEP))).collect()
}
