//! Cache of light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::reach::{least_reach, needed_cells, picture_reach, widest};
use crate::gpu::frame::light_build::LightBuild;
use crate::gpu::frame::loaded::{Loaded, Wanted};
use crate::gpu::light::combine::CombinedLight;
use crate::gpu::light::volume::{Filling, LightVolume};
use crate::gpu::resources::cached::Cached;
use crate::gpu::volume::GpuVolume;
use crate::gpu::volume::transfer_tables::{Needs, Tables};
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{NearField, SceneLight, Settings, ShadowAlgorithm};
use crate::plan::{CellSet, CellsAhead, FARTHEST, FloorPlace, FrameKeys, LightKey, lookup_reach};

/// Minimum number of cached light volumes beyond those of the current picture: undoing a drag finds them again, and
/// compared settings do not evict each other's.
const SPARE_LIGHT_VOLUMES: usize = 2;

/// Light volumes of a picture, and the work to fill them.
#[derive(Debug, Default)]
pub(in crate::gpu::frame) struct PlacedLights {
    /// Key of each light's volume; `None` for lights without one.
    pub keys: Vec<Option<LightKey>>,
    /// Index of each light's volume among the cached ones.
    pub slots: Vec<Option<usize>>,
    /// Volumes to be filled.
    pub builds: Vec<LightBuild>,
    /// Number of bricks of the combined volume, if it has to be filled.
    pub bricks_to_combine: Option<usize>,
}

/// Returns the offset of light look-ups from their samples, for a volume with `divisor` data voxels per voxel.
fn lookups_ahead(volume: &GpuVolume, settings: &Settings, light: &SceneLight, divisor: usize) -> CellsAhead {
    let near = settings.near_field();
    if near == NearField::Off {
        return CellsAhead::default();
    }
    let way = (NearField::length_voxels(light.near_steps(near)) + 0.5 * divisor as f64)
        * volume.scene.smallest_edge();
    CellsAhead::towards(light, &volume.scene, way)
}

/// Returns the extent of the floor if this light gets a shadow map. The map takes the transmittance behind the whole
/// volume, so nothing visible may lie below the floor.
fn floor_of(volume: &GpuVolume, tables: &Tables, settings: &Settings, points: u32) -> Option<FloorPlace> {
    let place = FloorPlace::of(settings)?;
    // With a single point, other algorithms or coloured shadows, the floor pass casts rays.
    if points < 2 || settings.shadows.algorithm != ShadowAlgorithm::Splat || settings.has_colored_shadows() {
        return None;
    }
    let table = &tables.lighting;
    let has_below = place.has_below(&volume.scene, &table.occupied, |cell| table.occupies(cell));
    (!has_below).then_some(place)
}

/// Returns the distance from visible cells, in data cells, up to which a light volume is read.
fn read_around(options: &RenderOptions, divisor: usize, reach: u8, aheads: &[CellsAhead]) -> u8 {
    if options.fill_everything {
        return FARTHEST;
    }
    let farthest = aheads.iter().map(CellsAhead::farthest).max().unwrap_or(0);
    let around = if farthest == 0 { lookup_reach(divisor) } else { CellsAhead::reach(divisor) };
    reach.saturating_add(around).saturating_add(farthest)
}

fn is_within(needed: &Arc<CellSet>, filled: &Arc<CellSet>) -> bool {
    Arc::ptr_eq(needed, filled) || needed.is_within(filled)
}

impl Loaded {
    /// Removes the volumes left incomplete by an interrupted picture, so that their textures can be reused.
    pub(crate) fn take_unfinished(&mut self) -> Vec<LightVolume> {
        self.combined = self.combined.take().filter(Cached::is_complete);
        self.lights.extract_if(.., |light| !light.is_complete()).map(|light| light.value).collect()
    }

    /// Finds or creates the light volumes of a picture: one for each light, or a combined one. Reusable volumes are
    /// taken from `recyclable`, and evicted ones are put there.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(in crate::gpu::frame) fn place_lights(
        &mut self,
        wanted: Wanted<'_>,
        recyclable: &mut Vec<LightVolume>,
    ) -> Result<PlacedLights, GpuError> {
        let Some(combined_key) = &wanted.keys.combined else { return self.place_each(wanted, recyclable) };
        let Wanted { context, request, options, .. } = wanted;
        let reach = picture_reach(&self.volume, request, options.samples);
        let divisor = request.settings.shadows.resolution.divisor();
        let needs = Needs { reach, divisor, ahead: CellsAhead::default() };
        let needed = needed_cells(&self.volume, &self.tables.value, options, needs);
        let is_usable = self
            .combined
            .as_ref()
            .is_some_and(|known| known.holds(combined_key) && is_within(&needed, &known.value.filled));
        if is_usable {
            return Ok(PlacedLights::default());
        }
        self.combined = None;
        let mut placed = self.place_each(wanted, recyclable)?;
        // Lights are only combined if at least one casts shadows.
        if let Some(slot) = placed.slots.iter().flatten().next() {
            let like = &self.lights[*slot].value;
            placed.bricks_to_combine = Some(like.filled.bricks().count());
            let fresh = CombinedLight::new(context, like)?;
            self.combined = Some(Cached::unfilled(combined_key.clone(), fresh));
        }
        Ok(placed)
    }

    /// Drops the light volumes of a picture after they have been combined.
    pub(crate) fn forget_combined(&mut self, keys: &[Option<LightKey>]) {
        self.lights.retain(|light| !keys.iter().flatten().any(|key| key == light.key()));
    }

    /// Finds or creates the volume of each light of a picture, and evicts the least recently used others.
    fn place_each(
        &mut self,
        wanted: Wanted<'_>,
        recyclable: &mut Vec<LightVolume>,
    ) -> Result<PlacedLights, GpuError> {
        let Wanted { context, request, options, keys: FrameKeys { lights: full_keys, .. }, now } = wanted;
        let Self { volume, tables, lights, .. } = self;
        let reach = picture_reach(volume, request, options.samples);
        let shadowed = full_keys.iter().flatten().count();
        // A picture without shadows evicts none, since comparisons return to them.
        let most_kept =
            if shadowed == 0 { lights.len() } else { shadowed + SPARE_LIGHT_VOLUMES.max(shadowed) };
        let at_coarse = |full: &LightKey| request.coarse.map(|resolution| full.coarse(resolution));
        let is_wanted = |key: &LightKey| {
            full_keys.iter().flatten().any(|full| full == key || at_coarse(full).as_ref() == Some(key))
        };
        let needed = |key: &LightKey, reach: u8, ahead: CellsAhead| {
            needed_cells(
                volume,
                &tables.value,
                options,
                Needs { reach, divisor: key.resolution().divisor(), ahead },
            )
        };
        let settings = &request.settings;
        let ahead_of = |index: usize, key: &LightKey| {
            let light = settings.lights[index].in_scene(&settings.camera);
            lookups_ahead(volume, settings, &light, key.resolution().divisor())
        };
        // Cells of the margin are fully lit, which suffices for previews.
        let least_reach = least_reach(wanted, reach);
        let usable = |known: &Cached<LightKey, LightVolume>, index: usize, key: &LightKey| {
            let least = needed(key, least_reach, ahead_of(index, key));
            let floor = floor_of(volume, &tables.value, settings, key.samples());
            let has_floor = floor.is_none() || known.value.floor.as_ref().map(|map| map.place) == floor;
            known.key() == key && has_floor && is_within(&least, &known.value.filled)
        };
        let mut keys = vec![None; full_keys.len()];
        let mut builds: Vec<LightBuild> = Vec::new();
        for (index, (slot, full)) in keys.iter_mut().zip(full_keys).enumerate() {
            let Some(full) = full else { continue };
            let coarse = at_coarse(full);
            let found = [Some(full), coarse.as_ref()]
                .into_iter()
                .flatten()
                .find(|key| lights.iter().any(|known| usable(known, index, key)))
                .cloned();
            let key = found.clone().or(coarse).unwrap_or_else(|| full.clone());
            if found.is_none() {
                // Compared settings may differ in their look-up offsets, so one volume covers both.
                let mut aheads = vec![ahead_of(index, &key)];
                for known in lights.iter().filter(|known| *known.key() == key) {
                    aheads.extend(known.value.aheads.first().filter(|known| **known != aheads[0]));
                }
                recyclable
                    .extend(lights.extract_if(.., |known| *known.key() == key).map(|light| light.value));
                // Recycles a volume that would be evicted anyway.
                if lights.len() >= most_kept {
                    let free = (0..lights.len()).filter(|&at| !is_wanted(lights[at].key()));
                    let oldest = free.min_by_key(|&at| lights[at].value.last_used);
                    recyclable.extend(oldest.map(|at| lights.swap_remove(at).value));
                }
                let all = |reach: u8| {
                    let sets = aheads.iter().map(|&ahead| needed(&key, reach, ahead));
                    sets.reduce(|a, b| Arc::new(a.with(&b))).unwrap_or_default()
                };
                let filled = all(reach);
                let margin = all(reach.max(widest())).without(&filled);
                let reach = read_around(options, key.resolution().divisor(), reach, &aheads);
                let floor = floor_of(volume, &tables.value, settings, key.samples());
                let filling = Filling { filled, margin, reach, aheads, floor };
                let fresh = LightVolume::new(context, volume, &key, filling, recyclable)?;
                builds.push(LightBuild::new(wanted, volume, index, (&key, &fresh))?);
                lights.push(Cached::unfilled(key.clone(), fresh));
            }
            for known in lights.iter_mut().filter(|known| *known.key() == key) {
                known.value.last_used = now;
            }
            *slot = Some(key);
        }
        lights.sort_by_key(|light| std::cmp::Reverse(light.value.last_used));
        let kept = lights.len().min(most_kept);
        recyclable.extend(lights.drain(kept..).map(|light| light.value));
        let slot_of =
            |key: &Option<LightKey>| lights.iter().position(|light| Some(light.key()) == key.as_ref());
        let slots: Vec<_> = keys.iter().map(slot_of).collect();
        for build in &mut builds {
            build.slot = slots[build.index].unwrap_or(0);
        }
        Ok(PlacedLights { keys, slots, builds, bricks_to_combine: None })
    }
}
