//! Cache of light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{lookup_reach_of_picture, max_stretch_reach, needed_cells, required_reach};
use crate::GpuError;
use crate::frame::light_fill::LightFill;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::light::combined_light::CombinedLight;
use crate::light::light_volume::{LightVolume, LightVolumeExtent};
use crate::plan::{CellSet, FloorPlane, LightKey, MAX_CELL_DISTANCE, NearFieldOffset, lookup_reach};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::filled_cells::CellMargin;
use crate::resources::product_cache::ProductCache;
use crate::volume::GpuVolume;
use crate::volume::cell_set_cache::CellRequirement;
use crate::volume::transfer_tables::TransferTables;
use chiaroscuro_scene::{NearFieldRay, ShadowAlgorithm};

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

impl LoadedVolume {
    /// Removes the volumes left incomplete by an interrupted picture, so that their textures can be reused.
    pub(crate) fn take_incomplete(&mut self) -> Vec<LightVolume> {
        self.combined = self.combined.take().filter(CacheEntry::is_complete);
        self.lights.take_incomplete()
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
            .is_some_and(|known| known.is_valid_for(combined_key) && known.product.filled.covers(&needed));
        if is_usable {
            return Ok(LightEntries::default());
        }
        self.combined = None;
        let mut placed = self.find_or_create_each_light(inputs, recyclable)?;
        // Lights are only combined if at least one casts shadows.
        if let Some(slot) = placed.slots.iter().flatten().next() {
            let like = &self.lights[*slot].product;
            placed.bricks_to_combine = Some(like.filled_cells.cells.bricks().count());
            let fresh = CombinedLight::new(context, like)?;
            self.combined = Some(CacheEntry::incomplete(combined_key.clone(), fresh));
        }
        Ok(placed)
    }

    /// Drops the light volumes of a picture after they have been combined.
    pub(crate) fn drop_combined_lights(&mut self, keys: &[Option<LightKey>]) {
        self.lights.remove(|known| keys.iter().flatten().any(|key| key == known));
    }

    /// Finds or creates the volume of each light of a picture, and evicts the least recently used others.
    fn find_or_create_each_light(
        &mut self,
        wanted: ProductRequest<'_>,
        recyclable: &mut Vec<LightVolume>,
    ) -> Result<LightEntries, GpuError> {
        let ProductRequest { context, request, keys, picture_number: now, options: _ } = wanted;
        let full_keys = &keys.lights;
        let Self { volume, tables, lights, .. } = self;
        let needs = LightNeeds::new(wanted, volume, &tables.product);
        let shadowed = full_keys.iter().flatten().count();
        // A picture without shadows evicts none, since comparisons return to them.
        let max_cached =
            if shadowed == 0 { lights.len() } else { shadowed + SPARE_LIGHT_VOLUMES.max(shadowed) };
        let at_coarse =
            |full: &LightKey| request.preview_resolution.map(|resolution| full.for_preview(resolution));
        let is_needed = |key: &LightKey| {
            full_keys.iter().flatten().any(|full| full == key || at_coarse(full).as_ref() == Some(key))
        };
        let mut keys = vec![None; full_keys.len()];
        let mut builds: Vec<LightFill> = Vec::new();
        for (index, (claimed, full)) in keys.iter_mut().zip(full_keys).enumerate() {
            let Some(full) = full else { continue };
            let coarse = at_coarse(full);
            let is_usable = |key: &LightKey, known: &LightVolume| needs.are_met(index, key, known);
            let slot = if let Some(slot) = lights.find([Some(full), coarse.as_ref()], is_usable) {
                slot
            } else {
                let key = coarse.unwrap_or_else(|| full.clone());
                let aheads = needs.lookup_offsets(index, &key, lights);
                recyclable.extend(lights.remove(|known| *known == key));
                // Recycles a volume that would be evicted anyway.
                recyclable.extend(lights.evict_oldest(max_cached, is_needed));
                let extent = needs.extent(&key, aheads);
                let fresh = LightVolume::new(context, volume, &key, extent, recyclable)?;
                builds.push(LightFill::new(wanted, (volume, &tables.product), index, &key, &fresh)?);
                lights.insert(key, fresh, now)
            };
            *claimed = Some(lights.claim(slot, now));
        }
        recyclable.extend(lights.keep_latest(max_cached));
        let slot_of =
            |key: &Option<LightKey>| lights.iter().position(|light| Some(light.key()) == key.as_ref());
        let slots: Vec<_> = keys.iter().map(slot_of).collect();
        for build in &mut builds {
            build.cache_index = slots[build.light_index].unwrap_or(0);
        }
        Ok(LightEntries { keys, slots, builds, bricks_to_combine: None })
    }
}

/// Cells of light volumes that a picture looks up.
struct LightNeeds<'a> {
    wanted: ProductRequest<'a>,
    volume: &'a GpuVolume,
    tables: &'a TransferTables,
    /// Distance of light look-ups from visible cells, in cells.
    reach: u8,
}

impl<'a> LightNeeds<'a> {
    fn new(wanted: ProductRequest<'a>, volume: &'a GpuVolume, tables: &'a TransferTables) -> Self {
        let reach = lookup_reach_of_picture(volume, wanted.request, wanted.options.picture.samples);
        Self { wanted, volume, tables, reach }
    }

    /// Returns the cells of a volume within a reach of samples, for look-ups with an offset.
    fn cells(&self, key: &LightKey, reach: u8, offset: NearFieldOffset) -> Arc<CellSet> {
        let needs = CellRequirement { reach, divisor: key.resolution().divisor(), offset };
        needed_cells(self.volume, self.tables, self.wanted.options, needs)
    }

    /// Returns the offset of look-ups from samples, for light `index` of the settings.
    fn lookup_offset(&self, index: usize, key: &LightKey) -> NearFieldOffset {
        let settings = &self.wanted.request.settings;
        let near = settings.effective_near_field();
        if near == NearFieldRay::Off {
            return NearFieldOffset::default();
        }
        let (scene, divisor) = (&self.volume.scene, key.resolution().divisor());
        let light = settings.lights[index].resolve(&settings.camera);
        let way = (NearFieldRay::length_voxels(light.near_field_steps(near)) + 0.5 * divisor as f64)
            * scene.smallest_edge();
        NearFieldOffset::towards_light(&light, scene, way)
    }

    /// Returns the offsets of look-ups that a new volume covers. Compared settings may differ in them, so one volume
    /// covers both.
    fn lookup_offsets(
        &self,
        index: usize,
        key: &LightKey,
        lights: &ProductCache<LightKey, LightVolume>,
    ) -> Vec<NearFieldOffset> {
        let own = self.lookup_offset(index, key);
        let mut aheads = vec![own];
        for known in lights.products_of(key) {
            aheads.extend(known.lookup_offsets.first().filter(|known| **known != own));
        }
        aheads
    }

    /// Returns the extent of the floor if this light gets a shadow map. The map takes the transmittance behind the
    /// whole volume, so nothing visible may lie below the floor.
    fn floor(&self, key: &LightKey) -> Option<FloorPlane> {
        let settings = &self.wanted.request.settings;
        let place = FloorPlane::from_settings(settings)?;
        // With a single point, other algorithms or coloured shadows, the floor pass casts rays.
        if key.samples() < 2
            || settings.shadows.algorithm != ShadowAlgorithm::Splat
            || settings.has_colored_shadows()
        {
            return None;
        }
        (!self.tables.has_attenuation_below(place, &self.volume.scene)).then_some(place)
    }

    /// Returns the distance from visible cells, in data cells, up to which a volume is read.
    fn read_reach(&self, divisor: usize, aheads: &[NearFieldOffset]) -> u8 {
        if self.wanted.options.work.fill_all_light_voxels {
            return MAX_CELL_DISTANCE;
        }
        let farthest = aheads.iter().map(NearFieldOffset::max_distance).max().unwrap_or(0);
        let around =
            if farthest == 0 { lookup_reach(divisor) } else { NearFieldOffset::lookup_margin(divisor) };
        self.reach.saturating_add(around).saturating_add(farthest)
    }

    /// Returns true if a cached volume holds all that the picture looks up of light `index`.
    fn are_met(&self, index: usize, key: &LightKey, known: &LightVolume) -> bool {
        // Cells of the margin are fully lit, which suffices for previews.
        let least_reach = required_reach(self.wanted, self.reach);
        let least = self.cells(key, least_reach, self.lookup_offset(index, key));
        let floor = self.floor(key);
        let has_floor = floor.is_none() || known.floor.as_ref().map(|map| map.extent) == floor;
        has_floor && known.filled_cells.covers(&least)
    }

    /// Returns the extent of a new volume with these offsets of look-ups.
    fn extent(&self, key: &LightKey, aheads: Vec<NearFieldOffset>) -> LightVolumeExtent {
        let all = |reach: u8| {
            let sets = aheads.iter().map(|&ahead| self.cells(key, reach, ahead));
            sets.reduce(|a, b| Arc::new(a.union(&b))).unwrap_or_default()
        };
        let filled = all(self.reach);
        let margin = CellMargin::new(all(self.reach.max(max_stretch_reach())), Arc::clone(&filled));
        let reach = self.read_reach(key.resolution().divisor(), &aheads);
        LightVolumeExtent { filled, margin, reach, floor: self.floor(key), aheads }
    }
}
