//! A volume with everything on the GPU that is made from it.

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

/// What a picture is asked for, and of whom.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub context: &'a Context,
    pub request: &'a Request,
    pub options: &'a RenderOptions,
    pub keys: &'a FrameKeys,
    /// Counts pictures: volumes that were used last are kept longest.
    pub now: u64,
}

/// A volume on the GPU, and what makes sense only together with it.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// Density, pyramid and gradients.
    pub volume: GpuVolume,
    /// What was uploaded: the voxels, and the values that they show.
    pub dataset: Dataset,
    /// Both transfer functions, and where they show anything.
    pub tables: Cached<TablesKey, Tables>,
    /// Voxels as these classify them, once a picture has asked for that.
    materials: Vec<Arc<Materials>>,
    /// Attenuation volumes, most recently used first.
    pub lights: Vec<Cached<LightKey, LightVolume>>,
    /// The diffuse light of all of them in one.
    pub combined: Option<Cached<CombinedKey, CombinedLight>>,
    /// How open to the sky places are.
    pub skies: Vec<Cached<SkyKey, SkyVolume>>,
    /// Light that has bounced.
    pub bounces: Vec<Cached<BouncesKey, BouncesVolume>>,
    /// Voxels for scattering, once a picture has asked for them.
    pub voxels: Option<Arc<ScatterVoxels>>,
}

impl Loaded {
    /// Makes room for a volume, and tables for a first look; nothing is uploaded yet, but for what is known of which of
    /// its voxels are there.
    ///
    /// # Errors
    /// When the adapter cannot hold them.
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

    /// Whether it was made from voxels of the type of these: the same numbers of another type are stored otherwise.
    pub(crate) fn has_type_of(&self, dataset: &Dataset) -> bool {
        let voxel_type = |dataset: &Dataset| dataset.volume().samples().voxel_type();
        voxel_type(&self.dataset) == voxel_type(dataset)
    }

    /// Brings the tables up to date. Returns how many were baked.
    ///
    /// # Errors
    /// When memory is out.
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

    /// Has the tables know what they make of voxels, where the settings have these classified before they are spread;
    /// some of it may have to be filled yet.
    ///
    /// # Errors
    /// When memory is out.
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
        // What earlier tables made of voxels leaves its room.
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

    /// The voxels that a picture scatters.
    ///
    /// # Errors
    /// When they are more than a buffer of the adapter can hold.
    pub(crate) fn voxels_for(
        &mut self,
        context: &Context,
        settings: &Settings,
    ) -> Result<Arc<ScatterVoxels>, GpuError> {
        // Sums of nothing are zeros, but voxels of nothing are not splatted by themselves.
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

    /// Bytes of light volumes, of which pictures look up those of their lights, or one for all.
    pub(crate) fn light_bytes(&self) -> u64 {
        let combined = self.combined.as_ref().map_or(0, |combined| combined.value.bytes());
        combined + self.lights.iter().map(|light| light.value.bytes()).sum::<u64>()
    }

    /// Bytes of all textures and buffers.
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
