//! Loaded volume with all GPU products that are made from it.

use std::sync::Arc;

use crate::data::Dataset;
use crate::gpu::bounces::volume::BouncesVolume;
use crate::gpu::light::combine::CombinedLight;
use crate::gpu::light::volume::LightVolume;
use crate::gpu::resources::cached::Cached;
use crate::gpu::scatter::voxels::ScatterVoxels;
use crate::gpu::sky::volume::SkyVolume;
use crate::gpu::volume::GpuVolume;
use crate::gpu::volume::materials::Materials;
use crate::gpu::volume::presence::Presence;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::{Context, GpuError, RenderOptions};
use crate::model::{Classification, Settings, SheetOrder};
use crate::plan::{BouncesKey, CombinedKey, FrameKeys, LightKey, Request, SkyKey, TablesKey};

/// Inputs for finding or creating the products of a picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub context: &'a Context,
    pub request: &'a Request,
    pub options: &'a RenderOptions,
    pub keys: &'a FrameKeys,
    /// Number of the picture, stored as the last use of cached volumes.
    pub now: u64,
}

/// Volume on the GPU, with the products that depend on it.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// Density, pyramid and gradients.
    pub volume: GpuVolume,
    /// Dataset that was uploaded: voxels, and the values at densities 0 and 1.
    pub dataset: Dataset,
    /// Tables of both transfer functions, with the cells where they are visible.
    pub tables: Cached<TablesKey, Tables>,
    /// Pre-classified voxels, if a picture has asked for them.
    materials: Vec<Arc<Materials>>,
    /// Attenuation volumes, most recently used first.
    pub lights: Vec<Cached<LightKey, LightVolume>>,
    /// Diffuse light of all shadowed lights in one volume.
    pub combined: Option<Cached<CombinedKey, CombinedLight>>,
    /// Cached volumes of sky visibility.
    pub skies: Vec<Cached<SkyKey, SkyVolume>>,
    /// Cached volumes of scattered light.
    pub bounces: Vec<Cached<BouncesKey, BouncesVolume>>,
    /// Lists of voxels for the scattering engine, if a picture has asked for them.
    pub voxels: Option<Arc<ScatterVoxels>>,
}

impl Loaded {
    /// Allocates a volume and its tables. Nothing is uploaded yet, except a `presence` texture that is passed in.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold them.
    pub(crate) fn new(
        context: &Context,
        dataset: &Dataset,
        settings: &Settings,
        tables_key: &TablesKey,
        presence: Option<Presence>,
    ) -> Result<Self, GpuError> {
        let volume = GpuVolume::new(context, dataset.volume(), dataset.bricks(), presence)?;
        let (tables, _) = Tables::new(context, &volume, settings, tables_key, None)?;
        let tables = Cached::complete(tables_key.clone(), tables);
        let dataset = dataset.clone();
        let materials = Vec::new();
        Ok(Self {
            volume,
            dataset,
            tables,
            materials,
            lights: Vec::new(),
            combined: None,
            skies: Vec::new(),
            bounces: Vec::new(),
            voxels: None,
        })
    }

    /// Returns true if the dataset has the voxel type of the loaded one; equal numbers of another type have another
    /// texture format.
    pub(crate) fn has_type_of(&self, dataset: &Dataset) -> bool {
        let voxel_type = |dataset: &Dataset| dataset.volume().samples().voxel_type();
        voxel_type(&self.dataset) == voxel_type(dataset)
    }

    /// Updates the tables to a key. Returns the number of tables baked.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn refresh_tables(
        &mut self,
        context: &Context,
        settings: &Settings,
        key: &TablesKey,
    ) -> Result<u32, GpuError> {
        if self.tables.holds(key) {
            return Ok(0);
        }
        let known = Some((self.tables.key(), &self.tables.value));
        let (fresh, baked) = Tables::new(context, &self.volume, settings, key, known)?;
        self.tables = Cached::complete(key.clone(), fresh);
        Ok(baked)
    }

    /// Assigns pre-classified voxels to the tables if the settings classify before reconstruction; new ones have yet
    /// to be filled.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn refresh_materials(
        &mut self,
        context: &Context,
        settings: &Settings,
    ) -> Result<(), GpuError> {
        let tables = &mut self.tables.value;
        tables.set_materials(None, None);
        if settings.sampling.classification == Classification::Post {
            return Ok(());
        }
        let baked = [&tables.eye, &tables.lighting].map(|table| Arc::clone(table.baked()));
        // Pre-classified voxels of earlier tables are reused for their textures.
        let (needed, mut left): (Vec<_>, Vec<_>) = std::mem::take(&mut self.materials)
            .into_iter()
            .partition(|known| baked.iter().any(|baked| known.is_of(baked)));
        self.materials = needed;
        let mut found = [None, None];
        for (baked, found) in baked.iter().zip(&mut found) {
            let known = self.materials.iter().find(|known| known.is_of(baked));
            let materials = if let Some(known) = known {
                Arc::clone(known)
            } else {
                let left = left.pop().and_then(Arc::into_inner);
                let fresh = Arc::new(Materials::new(context, &self.volume, baked, left)?);
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
    pub(crate) fn voxels_for(
        &mut self,
        context: &Context,
        settings: &Settings,
    ) -> Result<Arc<ScatterVoxels>, GpuError> {
        // Sheets of summed densities are 0 where no voxel is splatted; voxels splatted one by one are needed even at
        // the lowest density, if that is visible.
        let by_voxel = settings.sampling.classification == Classification::Pre
            || settings.sampling.order == SheetOrder::EveryFootprint;
        let all = by_voxel && self.tables.value.shows_empty_space();
        if let Some(known) = self.voxels.as_ref().filter(|known| known.holds_all || !all) {
            return Ok(Arc::clone(known));
        }
        let fresh = Arc::new(ScatterVoxels::new(context, &self.volume, all)?);
        self.voxels = Some(Arc::clone(&fresh));
        Ok(fresh)
    }

    /// Returns the size of all attenuation volumes and the combined one, in bytes.
    pub(crate) fn light_bytes(&self) -> u64 {
        let combined = self.combined.as_ref().map_or(0, |combined| combined.value.bytes());
        combined + self.lights.iter().map(|light| light.value.bytes()).sum::<u64>()
    }

    /// Returns the size of all textures and buffers, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let voxels = self.voxels.as_ref().map_or(0, |voxels| voxels.bytes());
        let materials = self.materials.iter().map(|materials| materials.bytes()).sum::<u64>();
        self.volume.bytes()
            + materials
            + voxels
            + self.light_bytes()
            + self.sky_bytes()
            + self.bounces_bytes()
    }
}
