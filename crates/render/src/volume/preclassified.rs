//! Pre-classified volume: voxels with the transfer function applied before reconstruction.
//!
//! A pyramid like that of densities, with four channels. The first is extinction relative to the maximum, which takes
//! the place of density: normals are its gradients, light is attenuated by it, and a table converts it to extinction.
//! The others are the colours multiplied by it.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::brick_list::two_workgroups_per_brick;
use super::layers::{BakedLayers, MaskUse};
use super::pyramid::{self, LevelBuffers, level_buffers, level_view};
use super::texture_shapes::pyramid_dims;
use super::{GpuVolume, PyramidViews, VolumeContext, texture_3d};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, SingleVariant, flag};
use crate::plan::{BrickSet, MAX_STRETCH_LEVEL};
use crate::resources::pass;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{Observer, memory_budget_bytes};

/// Inputs that voxels are classified with.
#[derive(Debug, Clone)]
pub(crate) struct PreclassificationKey {
    /// Transfer functions of all layers.
    pub baked: Arc<BakedLayers>,
    /// `true` if edges are made steep.
    pub is_crisp: bool,
    /// Observer from whom voxels may be hidden.
    pub observer: Observer,
}

impl PreclassificationKey {
    fn matches(&self, other: &Self) -> bool {
        (self.is_crisp, self.observer) == (other.is_crisp, other.observer)
            && self.baked.has_same_matter(&other.baked)
    }
}

/// Pre-classified voxels of one transfer function.
#[derive(Debug)]
pub(crate) struct PreclassifiedVoxels {
    key: PreclassificationKey,
    texture: wgpu::Texture,
    pub views: PyramidViews,
    /// Table that converts relative to absolute extinction, bound in place of the transfer function.
    pub table: wgpu::Buffer,
    /// Packed coordinates of the bricks that may be non-empty, or were for an earlier transfer function, for each level
    /// in ascending order.
    bricks: Vec<Vec<u32>>,
    is_complete: AtomicBool,
}

impl PreclassifiedVoxels {
    /// Creates the texture for a volume, or takes that of `reusable`; nothing is classified yet. `occupied` are the
    /// bricks of the volume in which the transfer function has extinction.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold the texture.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &GpuVolume,
        key: PreclassificationKey,
        occupied: &BrickSet,
        reusable: Option<Self>,
    ) -> Result<Self, GpuError> {
        let shares = key.baked.conversion_table(key.is_crisp);
        let table = context.buffer("Materials::table", &shares.to_f32s(), wgpu::BufferUsages::STORAGE);
        let dims = volume.volume.dims();
        let mut bricks = pyramid::level_bricks(dims, occupied.dims, |at| occupied.members[at]);
        let texture = match reusable {
            Some(voxels) => {
                for (new, held) in bricks.iter_mut().zip(voxels.bricks) {
                    new.extend(held);
                    new.sort_unstable();
                    new.dedup();
                }
                voxels.texture
            }
            None => Self::texture(context, dims)?,
        };
        Ok(Self {
            key,
            views: PyramidViews::new(&texture),
            texture,
            table,
            bricks,
            is_complete: AtomicBool::new(false),
        })
    }

    fn texture(context: &GpuContext, dims: [usize; 3]) -> Result<wgpu::Texture, GpuError> {
        let bytes = bytes(pyramid_dims(dims).iter().map(|&n| n as u64).product());
        // Software drivers commit memory when it is first written, and the system then kills the process.
        if context.is_software() && bytes > memory_budget_bytes() {
            return Err(GpuError::OutOfMemory {
                what: "classified voxels".to_owned(),
                mebibytes: bytes >> 20,
            });
        }
        context.texture(&wgpu::TextureDescriptor {
            mip_level_count: MAX_STRETCH_LEVEL as u32 + 1,
            ..texture_3d(
                "Materials::texture",
                pyramid_dims(dims),
                wgpu::TextureFormat::Rgba16Float,
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
            )
        })
    }

    /// Returns true if the voxels are classified with these inputs.
    pub(crate) fn matches(&self, key: &PreclassificationKey) -> bool {
        self.key.matches(key)
    }

    /// Marks the pyramid as complete.
    pub(crate) fn mark_complete(&self) {
        self.is_complete.store(true, Ordering::Relaxed);
    }

    /// Returns true if the pyramid is complete.
    pub(crate) fn is_complete(&self) -> bool {
        self.is_complete.load(Ordering::Relaxed)
    }

    /// Returns each level with its bricks, split into short steps; finest first.
    pub(crate) fn steps(&self) -> impl Iterator<Item = (u32, Range<usize>)> + '_ {
        pyramid::level_steps(&self.bricks)
    }

    /// Fills some bricks of one level. The finer level must be complete. `table` holds the transfer function.
    pub(crate) fn fill(
        &self,
        gpu: VolumeContext<'_>,
        table: &wgpu::Buffer,
        level: u32,
        range: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, volume, placeholder, .. } = gpu;
        let bricks = &self.bricks[level as usize][range.clone()];
        let has_missing = volume.presence.is_some();
        let layers = self.key.baked.parameters().zip(volume.fields.as_ref());
        let pipeline = match level {
            0 if layers.is_some() => shaders.pipeline(&ComposedVariant {
                are_tints: self.key.baked.are_tints(),
                mask: if has_missing { self.key.baked.mask_use() } else { MaskUse::Unused },
            })?,
            0 => shaders.pipeline(&MaterialsVariant { has_missing, is_crisp: self.key.is_crisp })?,
            _ => shaders.pipeline_into(&SingleVariant("volume/downsample.wgsl"), self.texture.format())?,
        };
        let source = match level {
            0 => volume.density_view.clone(),
            _ => level_view(&self.texture, level - 1),
        };
        let presence = volume.presence.as_ref();
        let presence = presence.map(|presence| level_view(&presence.get(self.key.observer).texture, 0));
        let presence = presence.as_ref().unwrap_or(placeholder);
        let LevelBuffers { uniform, bricks: list } = level_buffers(context, level, bricks);
        let target = level_view(&self.texture, level);
        let mut entries = vec![
            bind_view("level", &target),
            bind_buffer("bound_resample", &uniform),
            bind_buffer("bricks", &list),
        ];
        let parameters = layers.map(|(parameters, _)| gpu.uniform("Materials::layers", *parameters));
        match (level, layers.zip(parameters.as_ref())) {
            (0, Some(((_, fields), parameters))) => entries.extend([
                bind_buffer("layer_tables", table),
                bind_buffer("bound_layers", parameters),
                bind_view("field_texture", &fields.view),
                bind_view("presence_level", presence),
            ]),
            (0, None) => entries.extend([
                bind_view("source_texture", &source),
                bind_buffer("table", table),
                bind_view("presence_level", presence),
            ]),
            _ => entries
                .extend([bind_view("source_texture", &source), sampler("source_sampler", &volume.clamped)]),
        }
        let bind_group = pass::bind(context, "Materials::bind_group", &pipeline, 0, &entries);
        let groups = two_workgroups_per_brick(bricks.len().max(1) as u32);
        pass::dispatch(encoder, "Materials::fill", &pipeline, &[&bind_group], groups);
        Ok(())
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let size = self.texture.size();
        let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
        bytes(texels)
    }
}

/// Returns the size in bytes of four 16-bit channels for `texels` texels of the finest level; the coarser levels add
/// a seventh.
fn bytes(texels: u64) -> u64 {
    texels * 64 / 7
}

/// Pipeline variant of the pass that composes voxels of layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ComposedVariant {
    are_tints: bool,
    mask: MaskUse,
}

impl PipelineVariant for ComposedVariant {
    fn shader(&self) -> &'static str {
        "volume/composed_voxels.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![
            flag("TINTS", self.are_tints),
            flag("MISSING", self.mask == MaskUse::AllLayers),
            flag("MASK_BY_LAYER", self.mask == MaskUse::SomeLayers),
        ]
    }
}

/// Pipeline variant of the pass that classifies voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct MaterialsVariant {
    has_missing: bool,
    is_crisp: bool,
}

impl PipelineVariant for MaterialsVariant {
    fn shader(&self) -> &'static str {
        "volume/preclassified.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![flag("MISSING", self.has_missing), flag("CRISP", self.is_crisp)]
    }
}
