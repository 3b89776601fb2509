//! Cache of light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{lookup_reach_of_picture, max_stretch_reach, needed_cells, required_reach};
use crate::frame::light_fill::LightFill;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::light::combined_light::CombinedLight;
use crate::light::light_volume::{LightVolume, LightVolumeExtent};
use crate::plan::{
    CellSet, FloorPlane, FrameKeys, LightKey, MAX_CELL_DISTANCE, NearFieldOffset, lookup_reach,
};
use crate::resources::cache_entry::CacheEntry;
use crate::volume::GpuVolume;
use crate::volume::transfer_tables::{CellRequirement, TransferTables};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{NearFieldRay, SceneLight, Settings, ShadowAlgorithm};

/// Minimum number of cached light volumes beyond those of the current picture: undoing a drag finds them again, and
/// compared settings do not evict each other's.
const SPARE_LIGHT_VOLUMES: usize = 2;

/// Light volumes of a picture, and the work to fill them.
#[derive(Debug, Default)]
pub(crate) struct LightEntries {
    /// Key of each light's volume; `None` for lights without one.
    pub keys: Vec<Option<LightKey>>,
    /// Index of each light's volume among the cached ones.
    pub slots: Vec<Option<usize>>,
    /// Volumes to be filled.
    pub builds: Vec<LightFill>,
    /// Number of bricks of the combined volume, if it has to be filled.
    pub bricks_to_combine: Option<usize>,
}

/// Returns the offset of light look-ups from their samples, for a volume with `divisor` data voxels per voxel.
fn lookup_offset(
    volume: &GpuVolume,
    settings: &Settings,
    light: &SceneLight,
    divisor: usize,
) -> NearFieldOffset {
    let near = settings.effective_near_field();
    if near == NearFieldRay::Off {
        return NearFieldOffset::default();
    }
    let way = (NearFieldRay::length_voxels(light.near_field_steps(near)) + 0.5 * divisor as f64)
        * volume.scene.smallest_edge();
    NearFieldOffset::towards_light(light, &volume.scene, way)
}

/// Returns the extent of the floor if this light gets a shadow map. The map takes the transmittance behind the whole
/// volume, so nothing visible may lie below the floor.
fn floor_with_shadow_map(
    volume: &GpuVolume,
    tables: &TransferTables,
    settings: &Settings,
    points: u32,
) -> Option<FloorPlane> {
    let place = FloorPlane::from_settings(settings)?;
    // With a single point, other algorithms or coloured shadows, the floor pass casts rays.
    if points < 2 || settings.shadows.algorithm != ShadowAlgorithm::Splat || settings.has_colored_shadows() {
        return None;
    }
    let table = &tables.lighting;
    let has_below = place.has_below(&volume.scene, &table.occupied_bricks, |cell| table.occupies(cell));
    (!has_below).then_some(place)
}

/// Returns the distance from visible cells, in data cells, up to which a light volume is read.
fn read_reach(options: &RenderOptions, divisor: usize, reach: u8, aheads: &[NearFieldOffset]) -> u8 {
    if options.work.fill_all_light_voxels {
        return MAX_CELL_DISTANCE;
    }
    let farthest = aheads.iter().map(NearFieldOffset::max_distance).max().unwrap_or(0);
    let around = if farthest == 0 { lookup_reach(divisor) } else { NearFieldOffset::lookup_margin(divisor) };
    reach.saturating_add(around).saturating_add(farthest)
}

fn covers(needed: &Arc<CellSet>, filled: &Arc<CellSet>) -> bool {
    Arc::ptr_eq(needed, filled) || needed.is_subset(filled)
}

impl LoadedVolume {
    /// Removes the volumes left incomplete by an interrupted picture, so that their textures can be reused.
    pub(crate) fn take_incomplete(&mut self) -> Vec<LightVolume> {
        self.combined = self.combined.take().filter(CacheEntry::is_complete);
        self.lights.extract_if(.., |light| !light.is_complete()).map(|light| light.product).collect()
    }

    /// Finds or creates the light volumes of a picture: one for each light, or a combined one. Reusable volumes are
    /// taken from `recyclable`, and evicted ones are put there.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn find_or_create_lights(
        &mut self,
        inputs: ProductRequest<'_>,
        recyclable: &mut Vec<LightVolume>,
    ) -> Result<LightEntries, GpuError> {
        let Some(combined_key) = &inputs.keys.combined else {
            return self.find_or_create_each_light(inputs, recyclable);
        };
        let ProductRequest { context, request, options, .. } = inputs;
        let reach = lookup_reach_of_picture(&self.volume, request, options.picture.samples);
        let divisor = request.settings.shadows.resolution.divisor();
        let needs = CellRequirement { reach, divisor, offset: NearFieldOffset::default() };
        let needed = needed_cells(&self.volume, &self.tables.product, options, needs);
        let is_usable = self
            .combined
            .as_ref()
            .is_some_and(|known| known.is_valid_for(combined_key) && covers(&needed, &known.product.filled));
        if is_usable {
            return Ok(LightEntries::default());
        }
        self.combined = None;
        let mut placed = self.find_or_create_each_light(inputs, recyclable)?;
        // Lights are only combined if at least one casts shadows.
        if let Some(slot) = placed.slots.iter().flatten().next() {
            let like = &self.lights[*slot].product;
            placed.bricks_to_combine = Some(like.filled_cells.bricks().count());
            let fresh = CombinedLight::new(context, like)?;
            self.combined = Some(CacheEntry::incomplete(combined_key.clone(), fresh));
        }
        Ok(placed)
    }

    /// Drops the light volumes of a picture after they have been combined.
    pub(crate) fn drop_combined_lights(&mut self, keys: &[Option<LightKey>]) {
        self.lights.retain(|light| !keys.iter().flatten().any(|key| key == light.key()));
    }

    /// Finds or creates the volume of each light of a picture, and evicts the least recently used others.
    fn find_or_create_each_light(
        &mut self,
        wanted: ProductRequest<'_>,
        recyclable: &mut Vec<LightVolume>,
    ) -> Result<LightEntries, GpuError> {
        let ProductRequest {
            context,
            request,
            options,
            keys: FrameKeys { lights: full_keys, .. },
            picture_number: now,
        } = wanted;
        let Self { volume, tables, lights, .. } = self;
        let reach = lookup_reach_of_picture(volume, request, options.picture.samples);
        let shadowed = full_keys.iter().flatten().count();
        // A picture without shadows evicts none, since comparisons return to them.
        let max_cached =
            if shadowed == 0 { lights.len() } else { shadowed + SPARE_LIGHT_VOLUMES.max(shadowed) };
        let at_coarse =
            |full: &LightKey| request.preview_resolution.map(|resolution| full.for_preview(resolution));
        let is_needed = |key: &LightKey| {
            full_keys.iter().flatten().any(|full| full == key || at_coarse(full).as_ref() == Some(key))
        };
        let needed = |key: &LightKey, reach: u8, ahead: NearFieldOffset| {
            needed_cells(
                volume,
                &tables.product,
                options,
                CellRequirement { reach, divisor: key.resolution().divisor(), offset: ahead },
            )
        };
        let settings = &request.settings;
        let ahead_of = |index: usize, key: &LightKey| {
            let light = settings.lights[index].resolve(&settings.camera);
            lookup_offset(volume, settings, &light, key.resolution().divisor())
        };
        // Cells of the margin are fully lit, which suffices for previews.
        let least_reach = required_reach(wanted, reach);
        let usable = |known: &CacheEntry<LightKey, LightVolume>, index: usize, key: &LightKey| {
            let least = needed(key, least_reach, ahead_of(index, key));
            let floor = floor_with_shadow_map(volume, &tables.product, settings, key.samples());
            let has_floor = floor.is_none() || known.product.floor.as_ref().map(|map| map.extent) == floor;
            known.key() == key && has_floor && covers(&least, &known.product.filled_cells)
        };
        let mut keys = vec![None; full_keys.len()];
        let mut builds: Vec<LightFill> = Vec::new();
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
                    aheads.extend(known.product.lookup_offsets.first().filter(|known| **known != aheads[0]));
                }
                recyclable
                    .extend(lights.extract_if(.., |known| *known.key() == key).map(|light| light.product));
                // Recycles a volume that would be evicted anyway.
                if lights.len() >= max_cached {
                    let free = (0..lights.len()).filter(|&at| !is_needed(lights[at].key()));
                    let oldest = free.min_by_key(|&at| lights[at].product.last_used);
                    recyclable.extend(oldest.map(|at| lights.swap_remove(at).product));
                }
                let all = |reach: u8| {
                    let sets = aheads.iter().map(|&ahead| needed(&key, reach, ahead));
                    sets.reduce(|a, b| Arc::new(a.union(&b))).unwrap_or_default()
                };
                let filled = all(reach);
                let margin = all(reach.max(max_stretch_reach())).difference(&filled);
                let reach = read_reach(options, key.resolution().divisor(), reach, &aheads);
                let floor = floor_with_shadow_map(volume, &tables.product, settings, key.samples());
                let filling = LightVolumeExtent { filled, margin, reach, aheads, floor };
                let fresh = LightVolume::new(context, volume, &key, filling, recyclable)?;
                builds.push(LightFill::new(wanted, volume, index, (&key, &fresh))?);
                lights.push(CacheEntry::incomplete(key.clone(), fresh));
            }
            for known in lights.iter_mut().filter(|known| *known.key() == key) {
                known.product.last_used = now;
            }
            *slot = Some(key);
        }
        lights.sort_by_key(|light| std::cmp::Reverse(light.product.last_used));
        let kept = lights.len().min(max_cached);
        recyclable.extend(lights.drain(kept..).map(|light| light.product));
        let slot_of =
            |key: &Option<LightKey>| lights.iter().position(|light| Some(light.key()) == key.as_ref());
        let slots: Vec<_> = keys.iter().map(slot_of).collect();
        for build in &mut builds {
            build.cache_index = slots[build.light_index].unwrap_or(0);
        }
        Ok(LightEntries { keys, slots, builds, bricks_to_combine: None })
    }
}
