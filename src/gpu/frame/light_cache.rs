//! Which light volumes a picture needs, which of them are there, and which are forgotten.

use std::sync::Arc;

use super::job::LightBuild;
use crate::gpu::light::combine::{CollapsedKey, CollapsedLight};
use crate::gpu::light::volume::LightVolume;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::volume::{GpuVolume, brick_dims};
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::model::MAX_BIAS_VOXELS;
use crate::plan::eye_frame;
use crate::plan::{
    CellSet, FARTHEST, LightKey, MAX_STRETCH_LEVEL, Request, bias_reach, lookup_reach, slab_reach,
    stretch_reach,
};

/// Light volumes that are kept beyond those of the current picture, if it does not have more itself:
/// undoing a drag finds them, and two looks that are compared do not push out each other's.
const SPARE_LIGHT_VOLUMES: usize = 2;

/// The light of a picture: where it is, and what must be done before.
#[derive(Debug, Default)]
pub(crate) struct PlacedLights {
    /// Key of every light's volume; `None` for lights without.
    pub keys: Vec<Option<LightKey>>,
    /// Volumes to be filled.
    pub builds: Vec<LightBuild>,
    /// Whether the picture takes the light of all from one volume of colours.
    pub collapsed: bool,
    /// Bricks of that volume, if they must be filled first.
    pub to_collapse: Option<usize>,
}

/// The reach of samples of previews, whose pixels may be as wide as kernels stretch.
const WIDEST: f64 = MAX_STRETCH_LEVEL;

/// How many cells from what the transfer functions show a picture looks up light: as far as its samples
/// see, and a light bias further. The same for every direction to look from, so that orbiting refills
/// nothing.
fn picture_reach(volume: &GpuVolume, request: &Request, samples: u32) -> u8 {
    let Request { settings, size, .. } = request;
    let size = size.map(|n| n * samples);
    let scene = &volume.scene;
    let frame = eye_frame(&settings.camera, scene, size, settings.sampling.slab);
    let stretch = frame.stretch_level(scene.support_radius() + frame.slab);
    let [width, height] = size.map(f64::from);
    let obliquity = frame.obliquity(0.0, 0.0).max(frame.obliquity(width, height));
    let slab = slab_reach(scene, frame.slab, obliquity, settings.sampling.quadrature);
    // Any bias fills for the largest, so that the next needs nothing.
    let bias = if settings.shadows.bias_voxels > 0.0 { bias_reach(MAX_BIAS_VOXELS) } else { 0 };
    stretch_reach(stretch).saturating_add(slab).saturating_add(bias)
}

/// Cells of a light volume, of `divisor` data voxels per voxel, in which a picture can look whose samples
/// reach so far, and how far those are from what the transfer functions show.
fn needed_cells(
    volume: &GpuVolume,
    tables: &Tables,
    options: &RenderOptions,
    divisor: usize,
    reach: u8,
) -> (Arc<CellSet>, u8) {
    if options.fill_everything {
        let dims = volume.volume.dims().map(|n| n.div_ceil(divisor));
        return (Arc::new(CellSet::full(brick_dims(dims))), FARTHEST);
    }
    let reach = reach.saturating_add(lookup_reach(divisor));
    (tables.cells_within(volume, reach, divisor), reach)
}

fn is_within(needed: &Arc<CellSet>, filled: &Arc<CellSet>) -> bool {
    Arc::ptr_eq(needed, filled) || needed.is_within(filled)
}

impl Renderer {
    /// Finds or makes the light of a request: volumes for each light, or one for all.
    pub(crate) fn place_all_light(&mut self, request: &Request) -> Result<PlacedLights, GpuError> {
        self.collapsed = self.collapsed.take().filter(|collapsed| collapsed.complete);
        // A preview moves one light: the volumes of the others serve it again and again.
        if !request.settings.collapses_lights() || request.coarse.is_some() {
            let (keys, builds) = self.place_lights(request)?;
            return Ok(PlacedLights { keys, builds, ..PlacedLights::default() });
        }
        let Some(volume) = &self.volume else { return Err(GpuError::Refused("no volume".to_owned())) };
        let all =
            (0..request.settings.lights.len()).filter_map(|light| LightKey::of(request, light)).collect();
        let key = CollapsedKey::new(all, &request.settings, &volume.scene, &self.options);
        let Some(tables) = &self.tables else { return Err(GpuError::Refused("no volume".to_owned())) };
        let reach = picture_reach(volume, request, self.options.samples);
        let divisor = request.settings.shadows.resolution.divisor();
        let (needed, _) = needed_cells(volume, tables, &self.options, divisor, reach);
        let usable = |known: &CollapsedLight| known.key == key && is_within(&needed, &known.filled);
        if self.collapsed.as_ref().is_some_and(usable) {
            return Ok(PlacedLights { collapsed: true, ..PlacedLights::default() });
        }
        self.collapsed = None;
        self.recycled.forget_groups();
        let (keys, builds) = self.place_lights(request)?;
        let first = keys.iter().flatten().next();
        let like = self.lights.iter().find(|light| Some(&light.key) == first);
        let like = like.ok_or_else(|| GpuError::Refused("no light casts shadows".to_owned()))?;
        let to_collapse = Some(like.filled.bricks().count());
        self.collapsed = Some(CollapsedLight::new(&self.context, key, like)?);
        Ok(PlacedLights { keys, builds, collapsed: true, to_collapse })
    }

    /// Forgets the light volumes of a picture, which have been collapsed.
    pub(crate) fn forget_collapsed(&mut self, keys: &[Option<LightKey>]) {
        self.lights.retain(|light| !keys.iter().flatten().any(|key| *key == light.key));
        self.recycled.forget_groups();
    }

    /// Finds or makes the light volumes of a request and forgets the oldest of the others.
    fn place_lights(
        &mut self,
        request: &Request,
    ) -> Result<(Vec<Option<LightKey>>, Vec<LightBuild>), GpuError> {
        let (Some(volume), Some(tables)) = (&self.volume, &self.tables) else {
            return Err(GpuError::Refused("no volume".to_owned()));
        };
        let count = request.settings.lights.len();
        self.rebuilds.resize(self.rebuilds.len().max(count), 0);
        let reach = picture_reach(volume, request, self.options.samples);
        let wanted: Vec<_> = (0..count).map(|light| LightKey::of(request, light)).collect();
        let shadowed = wanted.iter().flatten().count();
        let most_kept = shadowed + SPARE_LIGHT_VOLUMES.max(shadowed);
        let at_coarse = |full: &LightKey| request.coarse.map(|resolution| full.at_resolution(resolution));
        let is_wanted = |key: &LightKey| {
            wanted.iter().flatten().any(|full| full == key || at_coarse(full).as_ref() == Some(key))
        };
        let mut keys = vec![None; count];
        let mut builds: Vec<LightBuild> = Vec::new();
        for (light, (slot, full)) in keys.iter_mut().zip(&wanted).enumerate() {
            let Some(full) = full else { continue };
            let options = &self.options;
            let needed = |key: &LightKey, reach: u8| {
                needed_cells(volume, tables, options, key.resolution().divisor(), reach)
            };
            // A preview makes do with what a picture at full quality looks up; around that light is full.
            let least = |key: &LightKey| needed(key, if request.coarse.is_some() { 0 } else { reach }).0;
            let usable = |known: &LightVolume, key: &LightKey| {
                known.key == *key && is_within(&least(key), &known.filled)
            };
            let coarse = at_coarse(full);
            let found = [Some(full.clone()), coarse.clone()]
                .into_iter()
                .flatten()
                .find(|key| self.lights.iter().any(|known| usable(known, key)));
            let key = found.clone().or(coarse).unwrap_or_else(|| full.clone());
            if found.is_none() {
                self.unwanted.extend(self.lights.extract_if(.., |known| known.key == key));
                // One that would be forgotten afterwards.
                if self.lights.len() >= most_kept {
                    let free = (0..self.lights.len()).filter(|&at| !is_wanted(&self.lights[at].key));
                    let oldest = free.min_by_key(|&at| self.lights[at].last_used);
                    self.unwanted.extend(oldest.map(|at| self.lights.swap_remove(at)));
                }
                let filled = needed(&key, reach);
                let around = needed(&key, reach.max(stretch_reach(WIDEST))).0.without(&filled.0);
                let fresh =
                    LightVolume::new(&self.context, volume, key.clone(), filled, around, &mut self.unwanted)?;
                builds.push(LightBuild::new(volume, request, light, &fresh, self.options.chunk));
                self.lights.push(fresh);
            }
            for known in self.lights.iter_mut().filter(|known| known.key == key) {
                known.last_used = self.clock;
            }
            *slot = Some(key);
        }
        self.lights.sort_by_key(|light| std::cmp::Reverse(light.last_used));
        let kept = self.lights.len().min(most_kept);
        self.unwanted.extend(self.lights.drain(kept..));
        Ok((keys, builds))
    }
}
