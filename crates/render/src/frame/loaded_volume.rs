//! Loaded volume with all GPU products that are made from it.

use std::sync::Arc;

use crate::light::combined_light::CombinedLight;
use crate::light::light_volume::LightVolume;
use crate::plan::{
    BouncesKey, CombinedKey, FrameKeys, LightKey, RenderRequest, SkyKey, TablesKey, VolumeKey,
};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::product_cache::ProductCache;
use crate::scatter::voxels::ScatterVoxels;
use crate::scattered_light::volume::ScatteredLightVolume;
use crate::sky::volume::SkyVolume;
use crate::volume::GpuVolume;
use crate::volume::page_pool::PagePool;
use crate::volume::preclassified::{PreclassificationKey, PreclassifiedVoxels};
use crate::volume::presence::PresenceTextures;
use crate::volume::reused_textures::ReusedTextures;
use crate::volume::transfer_tables::{TableBakeResult, TransferTables};
use crate::{GpuContext, GpuError, RenderOptions};
use chiaroscuro_scene::{LayerComposition, LightVolumeResolution, Settings, SheetOrder};
use chiaroscuro_volume::{Dataset, Observer, PagesId, ResidentPages};

/// Inputs for finding or creating the products of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProductRequest<'a> {
    pub context: &'a GpuContext,
    pub request: &'a RenderRequest,
    pub options: &'a RenderOptions,
    pub keys: &'a FrameKeys,
    /// Number of the picture, stored as the last use of cached volumes.
    pub picture_number: u64,
}

/// Volume on the GPU, with the products that depend on it.
#[derive(Debug)]
pub(crate) struct LoadedVolume {
    /// Density, pyramid and gradients.
    pub volume: GpuVolume,
    /// Dataset that was uploaded: voxels, and the values at densities 0 and 1.
    pub dataset: Dataset,
    /// Tables of both transfer functions, with the cells where they are visible.
    pub tables: CacheEntry<TablesKey, TransferTables>,
    /// Pre-classified voxels, if a picture has asked for them.
    materials: Vec<Arc<PreclassifiedVoxels>>,
    /// Tints of the first field by further layers, if there are some.
    tints: Option<Arc<PreclassifiedVoxels>>,
    /// Attenuation volumes, most recently used first.
    pub lights: ProductCache<LightKey, LightVolume>,
    /// Diffuse light of all shadowed lights in one volume.
    pub combined: Option<CacheEntry<CombinedKey, CombinedLight>>,
    /// Cached volumes of sky visibility.
    pub skies: ProductCache<SkyKey, SkyVolume>,
    /// Cached volumes of scattered light.
    pub bounces: ProductCache<BouncesKey, ScatteredLightVolume>,
    /// Lists of voxels for the scattering engine, if a picture has asked for them.
    pub scatter_voxels: Option<Arc<ScatterVoxels>>,
}

/// Returns true if missing voxels of the first field are absent from a composition, whatever the others have.
fn counts_missing(composition: LayerComposition) -> bool {
    composition != LayerComposition::Composed
}

impl LoadedVolume {
    /// Allocates a volume and its tables. Nothing is uploaded yet, except textures that are passed in.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold them.
    pub(crate) fn new(
        context: &GpuContext,
        dataset: &Dataset,
        settings: &Settings,
        tables_key: &TablesKey,
        reused: ReusedTextures,
    ) -> Result<Self, GpuError> {
        let composition = tables_key.volume.composition;
        let counts_missing = counts_missing(composition);
        let volume = GpuVolume::new(context, dataset.volume(), dataset.bricks(), counts_missing, reused)?;
        // The mask of the first field is that of the picture, even if the layer is never cut.
        let never_cut = tables_key.volume.never_cut;
        let dataset = match dataset.volume().mask() {
            Some(mask) if never_cut != 0 => {
                &dataset.with_mask_where(Some(mask), |at| never_cut >> at & 1 == 0)
            }
            _ => dataset,
        };
        let volume = match composition {
            LayerComposition::First => volume,
            // Tints colour matter up to the edge of what is hidden.
            LayerComposition::Tinted => volume.with_fields(context, dataset.with_mask(None).fields())?,
            LayerComposition::Composed => volume.with_fields(context, dataset.fields())?,
        };
        // There are no pages yet whose densities the bounds could hold for.
        let tables_key = TablesKey { bounds: PagesId::default().bounds, ..tables_key.clone() };
        let TableBakeResult { tables, .. } =
            TransferTables::bake(context, &volume, settings, &tables_key, None)?;
        let tables = CacheEntry::complete(tables_key, tables);
        let dataset = dataset.clone();
        let materials = Vec::new();
        Ok(Self {
            volume,
            dataset,
            tables,
            materials,
            tints: None,
            lights: ProductCache::default(),
            combined: None,
            skies: ProductCache::default(),
            bounces: ProductCache::default(),
            scatter_voxels: None,
        })
    }

    /// Returns the textures that hold for a picture of the same content under another key.
    pub(crate) fn into_reused(entry: CacheEntry<VolumeKey, Self>, wanted: &VolumeKey) -> ReusedTextures {
        if !entry.is_complete() {
            return ReusedTextures::default();
        }
        // Fields of layers are uploaded together with the densities.
        let is_first_alone = wanted.composition == LayerComposition::First;
        let has_same_densities = VolumeKey { mask: wanted.mask, ..*entry.key() } == *wanted;
        let Self { volume, .. } = entry.product;
        let mask = volume.volume.mask().cloned();
        let GpuVolume { density, pyramid, presence, .. } = volume;
        ReusedTextures {
            density: (is_first_alone && has_same_densities).then_some((density, pyramid)),
            presence: presence
                .filter(|presence| presence.counts_missing == counts_missing(wanted.composition))
                .map(|presence| (presence, mask)),
        }
    }

    /// Returns true if the dataset has the voxel type of the loaded one; equal numbers of another type have another
    /// texture format.
    pub(crate) fn has_voxel_type_of(&self, dataset: &Dataset) -> bool {
        let voxel_type = |dataset: &Dataset| dataset.volume().samples().voxel_type();
        voxel_type(&self.dataset) == voxel_type(dataset)
    }

    /// Returns true if all volumes of light that a picture looks up are complete; those of lights may have the resolution
    /// for previews.
    pub(crate) fn has_light_of(&self, keys: &FrameKeys, preview: Option<LightVolumeResolution>) -> bool {
        let is_combined = keys
            .combined
            .as_ref()
            .is_some_and(|key| self.combined.as_ref().is_some_and(|known| known.is_valid_for(key)));
        let has_light = |full: &LightKey| {
            let coarse = preview.map(|resolution| full.for_preview(resolution));
            let is_it = |key: &LightKey| key == full || Some(key) == coarse.as_ref();
            self.lights.iter().any(|known| known.is_complete() && is_it(known.key()))
        };
        let has_sky = |key: &SkyKey| self.skies.iter().any(|known| known.is_complete() && known.key() == key);
        let has_bounces =
            |key: &BouncesKey| self.bounces.iter().any(|known| known.is_complete() && known.key() == key);
        (is_combined || keys.lights.iter().flatten().all(has_light))
            && keys.sky.as_ref().is_none_or(has_sky)
            && keys.bounces.as_ref().is_none_or(has_bounces)
    }

    /// Returns true if pictures of the volume can read pages of finer levels: if no voxels are missing or hidden.
    pub(crate) fn can_show_pages(&self) -> bool {
        self.volume.presence.is_none()
    }

    /// Updates the pages of finer levels, and the bounds of cells that hold for them. Returns true if textures have changed.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold the pages.
    pub(crate) fn refresh_pages(
        &mut self,
        context: &GpuContext,
        pages: Option<&Arc<ResidentPages>>,
    ) -> Result<bool, GpuError> {
        let bounds = pages.map_or(&self.volume.own_bricks, |pages| pages.bounds());
        self.volume.bricks = Arc::clone(bounds);
        let known = self.volume.pages.as_ref().map(PagePool::id);
        if known == pages.map(|pages| pages.id()) {
            return Ok(false);
        }
        let earlier = self.volume.pages.take();
        self.volume.pages = pages.map(|pages| PagePool::new(context, pages, earlier)).transpose()?;
        Ok(true)
    }

    /// Updates the table of pages to the transfer tables. Returns true if it is another one.
    pub(crate) fn refresh_page_table(&mut self, context: &GpuContext) -> bool {
        let tables = &self.tables.product;
        let pages = self.volume.pages.as_mut();
        pages.is_some_and(|pages| pages.refresh_table(context, tables.eye.baked(), tables.lighting.baked()))
    }

    /// Returns the number of steps that upload pages which are missing.
    pub(crate) fn pending_page_steps(&self) -> usize {
        self.volume.pages.as_ref().map_or(0, PagePool::pending_steps)
    }

    /// Updates the tables to a key. Returns the number of tables baked.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn refresh_tables(
        &mut self,
        context: &GpuContext,
        settings: &Settings,
        key: &TablesKey,
    ) -> Result<u32, GpuError> {
        if self.tables.is_valid_for(key) {
            return Ok(0);
        }
        let TableBakeResult { tables, baked } =
            TransferTables::bake(context, &self.volume, settings, key, Some(&self.tables))?;
        self.tables = CacheEntry::complete(key.clone(), tables);
        Ok(baked)
    }

    /// Assigns pre-classified voxels to the tables if the settings classify before reconstruction; new ones have yet
    /// to be filled.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn refresh_materials(
        &mut self,
        context: &GpuContext,
        settings: &Settings,
    ) -> Result<(), GpuError> {
        let tables = &mut self.tables.product;
        tables.set_materials(None, None);
        let tints = tables.tints.as_ref().map(|table| (table.baked(), &table.occupied_bricks));
        let known = self.tints.take();
        self.tints = match tints {
            None => None,
            Some((baked, occupied)) => {
                let baked = Arc::clone(baked);
                let key = PreclassificationKey { baked, is_crisp: false, observer: Observer::Eye };
                Some(match known {
                    Some(known) if known.matches(&key) => known,
                    other => {
                        let left = other.and_then(Arc::into_inner);
                        Arc::new(PreclassifiedVoxels::new(context, &self.volume, key, occupied, left)?)
                    }
                })
            }
        };
        if let Some(table) = &mut tables.tints {
            table.materials.clone_from(&self.tints);
        }
        let classification = settings.classification();
        if !classification.is_pre() {
            return Ok(());
        }
        let is_crisp = classification.has_crisp_edges();
        let differ = self.volume.presence.as_ref().is_some_and(PresenceTextures::differ_by_observer);
        let light = if differ { Observer::Light } else { Observer::Eye };
        let wanted = [(&tables.eye, Observer::Eye), (&tables.lighting, light)].map(|(table, observer)| {
            let key = PreclassificationKey { baked: Arc::clone(table.baked()), is_crisp, observer };
            (key, Arc::clone(&table.occupied_bricks))
        });
        // Pre-classified voxels of earlier tables are reused for their textures.
        let (needed, mut reusable): (Vec<_>, Vec<_>) = std::mem::take(&mut self.materials)
            .into_iter()
            .partition(|known| wanted.iter().any(|(key, _)| known.matches(key)));
        self.materials = needed;
        let mut found = [None, None];
        for ((key, occupied), found) in wanted.into_iter().zip(&mut found) {
            let known = self.materials.iter().find(|known| known.matches(&key));
            let materials = if let Some(known) = known {
                Arc::clone(known)
            } else {
                let left = reusable.pop().and_then(Arc::into_inner);
                let fresh = PreclassifiedVoxels::new(context, &self.volume, key, &occupied, left)?;
                let fresh = Arc::new(fresh);
                self.materials.push(Arc::clone(&fresh));
                fresh
            };
            *found = Some(materials);
        }
        let [eye, lighting] = found;
        tables.set_materials(eye, lighting);
        Ok(())
    }

    /// Returns the voxels that the scattering engine splats.
    ///
    /// # Errors
    /// Returns an error if they exceed the adapter's largest buffer.
    pub(crate) fn scatter_voxels_for(
        &mut self,
        context: &GpuContext,
        settings: &Settings,
    ) -> Result<Arc<ScatterVoxels>, GpuError> {
        // Sheets of summed densities are 0 where no voxel is splatted; voxels splatted one by one are needed even at
        // the lowest density, if that is visible.
        let by_voxel =
            settings.classification().is_pre() || settings.sampling.order == SheetOrder::EveryFootprint;
        let all = by_voxel && self.tables.product.has_extinction_at_zero();
        if let Some(known) = self.scatter_voxels.as_ref().filter(|known| known.has_empty_bricks || !all) {
            return Ok(Arc::clone(known));
        }
        let fresh = Arc::new(ScatterVoxels::new(context, &self.volume, all)?);
        self.scatter_voxels = Some(Arc::clone(&fresh));
        Ok(fresh)
    }

    /// Returns the size of all attenuation volumes and the combined one, in bytes.
    pub(crate) fn light_bytes(&self) -> u64 {
        let combined = self.combined.as_ref().map_or(0, |combined| combined.product.bytes());
        combined + self.lights.iter().map(|light| light.product.bytes()).sum::<u64>()
    }

    /// Returns the size of all textures and buffers, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let voxels = self.scatter_voxels.as_ref().map_or(0, |voxels| voxels.bytes());
        let materials =
            self.materials.iter().chain(&self.tints).map(|materials| materials.bytes()).sum::<u64>();
        self.volume.bytes()
            + materials
            + voxels
            + self.light_bytes()
            + self.sky_bytes()
            + self.bounces_bytes()
    }
}
