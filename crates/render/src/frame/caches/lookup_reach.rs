//! Reach of light look-ups from visible cells, and the cells of a light volume that a picture needs.

use std::sync::Arc;

use crate::RenderOptions;
use crate::frame::loaded_volume::ProductRequest;
use crate::plan::{
    CellSet, MAX_STRETCH_LEVEL, NearFieldOffset, RenderRequest, bias_reach, lookup_reach, picture_frame,
    slab_reach, stretch_reach,
};
use crate::volume::cell_set_cache::CellRequirement;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{GpuVolume, brick_dims};
use chiaroscuro_scene::{MAX_BIAS_VOXELS, NearFieldRay, SKY_LOOKUP_DISTANCE};

/// Maximum number of cached volumes of sky visibility, and of scattered light: one for the picture, one for its
/// previews, and one for undoing a change.
pub(super) const MAX_AMBIENT_VOLUMES: usize = 3;

/// Returns the maximum reach of samples in previews, in cells, whose pixels may be as wide as the maximum stretch.
pub(super) fn max_stretch_reach() -> u8 {
    stretch_reach(MAX_STRETCH_LEVEL)
}

/// Returns the distance of samples from visible cells, in cells. It is the same for all viewing directions, so that
/// orbiting refills nothing.
pub(super) fn view_sample_reach(volume: &GpuVolume, request: &RenderRequest, samples: u32) -> u8 {
    let RenderRequest { settings, size, .. } = request;
    let size = size.map(|n| n * samples);
    let scene = &volume.scene;
    let frame = picture_frame(settings, scene, size);
    let stretch = frame.stretch_level(scene.support_radius() + frame.slab);
    let [width, height] = size.map(f64::from);
    let obliquity = frame.obliquity(0.0, 0.0).max(frame.obliquity(width, height));
    let slab = slab_reach(scene, frame.slab, obliquity, settings.sampling.quadrature);
    stretch_reach(stretch).saturating_add(slab)
}

/// Returns the distance of light look-ups from visible cells, in cells: the reach of samples plus the light bias.
pub(super) fn lookup_reach_of_picture(volume: &GpuVolume, request: &RenderRequest, samples: u32) -> u8 {
    let settings = &request.settings;
    let towards_light = match settings.effective_near_field() {
        // Any bias is filled for the maximum, so that changing it refills nothing.
        NearFieldRay::Off if settings.shadows.bias_voxels > 0.0 => bias_reach(MAX_BIAS_VOXELS),
        _ => 0,
    };
    view_sample_reach(volume, request, samples).saturating_add(towards_light)
}

/// Returns the reach that must be filled: 0 for previews, which accept missing cells.
pub(super) fn required_reach(wanted: ProductRequest<'_>, reach: u8) -> u8 {
    if wanted.request.preview_resolution.is_some() || wanted.options.work.preview { 0 } else { reach }
}

/// Returns the cells of a light volume, with `divisor` data voxels per voxel, that a picture can look up, given the
/// reach of its samples and the offset of its look-ups.
pub(super) fn needed_cells(
    volume: &GpuVolume,
    tables: &TransferTables,
    options: &RenderOptions,
    CellRequirement { reach, divisor, offset: ahead }: CellRequirement,
) -> Arc<CellSet> {
    if options.work.fill_all_light_voxels {
        let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
        return Arc::new(CellSet::full(brick_dims(dims)));
    }
    let around = if ahead == NearFieldOffset::default() {
        lookup_reach(divisor)
    } else {
        NearFieldOffset::lookup_margin(divisor)
    };
    tables
        .needed_cells(volume, CellRequirement { reach: reach.saturating_add(around), divisor, offset: ahead })
}

/// Returns the cells of blocks of `divisor`³ voxels in which sky visibility or scattered light is looked up, slightly
/// in front of the samples.
pub(super) fn ambient_cells(
    volume: &GpuVolume,
    tables: &TransferTables,
    options: &RenderOptions,
    divisor: usize,
    reach: u8,
) -> Arc<CellSet> {
    let reach = reach.saturating_add(bias_reach(SKY_LOOKUP_DISTANCE * divisor as f64));
    needed_cells(
        volume,
        tables,
        options,
        CellRequirement { reach, divisor, offset: NearFieldOffset::default() },
    )
}
