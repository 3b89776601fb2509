//! Area lights: average of the attenuation volumes of point lights on the area.

use super::light_volume::LightVolume;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, flag};
use crate::pipelines::uniforms;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::brick_list::{self, BrickEntry};
use crate::{GpuContext, GpuError};

/// Number of volumes added per pass; the sum is read and written once for all of them.
const POINTS_PER_BATCH: usize = 4;

/// Temporary volumes for filling the volume of an area light.
#[derive(Debug)]
pub(crate) struct AreaLightAverage {
    /// Attenuation volumes of the points in the current batch.
    points: [LightVolume; POINTS_PER_BATCH],
    /// Partial sums, read from one and written to the other in turn.
    sums: [LightVolume; 2],
    /// Number of points on the area light.
    count: usize,
}

impl AreaLightAverage {
    /// Allocates the temporary volumes for a light whose volume is `whole`.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, whole: &LightVolume, count: usize) -> Result<Self, GpuError> {
        let sum = || whole.with_same_voxels(context, wgpu::TextureFormat::R32Float);
        let point = || whole.with_same_voxels(context, context.storage_format);
        Ok(Self { points: [point()?, point()?, point()?, point()?], sums: [sum()?, sum()?], count })
    }

    /// Returns the size of all temporary volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.points.iter().chain(&self.sums).map(LightVolume::bytes).sum()
    }

    /// Returns the volume that a point's light is computed in.
    pub(crate) fn point_volume(&self, index: usize) -> &LightVolume {
        &self.points[index % POINTS_PER_BATCH]
    }

    /// Returns true if a batch is complete with this point, so that its volumes are to be added.
    pub(crate) fn ends_batch(&self, index: usize) -> bool {
        index % POINTS_PER_BATCH == POINTS_PER_BATCH - 1 || index + 1 == self.count
    }

    /// Adds the volumes of the batch that ends with point `index`, in the listed bricks; the last batch writes the
    /// average into the light's own volume.
    pub(crate) fn add_batch(
        &self,
        gpu: VolumeContext<'_>,
        whole: &LightVolume,
        index: usize,
        bricks: &[BrickEntry],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let turn = index / POINTS_PER_BATCH;
        let variant = AverageVariant {
            batch_size: index % POINTS_PER_BATCH + 1,
            is_first: turn == 0,
            is_last: index + 1 == self.count,
        };
        let pipeline = gpu.shaders.pipeline_into(&variant, whole.texture.format())?;
        let uniform = uniforms::AverageUniform {
            dims: whole.dims.map(|n| n as u32),
            bricks: bricks.len() as u32,
            share: 1.0 / (index + 1) as f32,
            pad0: 0,
            pad1: 0,
            pad2: 0,
        };
        let uniform = gpu.uniform("Average::uniform", uniform);
        let list = brick_list::upload_bricks(gpu, bricks);
        let points =
            POINT_NAMES.into_iter().zip(&self.points).map(|(name, point)| bind_view(name, &point.view));
        let others = [
            bind_buffer("bound_average", &uniform),
            bind_buffer("bricks", &list),
            bind_view("before", &self.sums[turn % 2].view),
            bind_view("after", &self.sums[(turn + 1) % 2].view),
            bind_view("attenuation", &whole.view),
        ];
        let entries: Vec<_> = points.chain(others).collect();
        let own = gpu.bind("Average::bind_group", &pipeline, 0, &entries);
        let groups = brick_list::two_workgroups_per_brick(bricks.len() as u32);
        pass::dispatch(encoder, "Average::pass", &pipeline, &[&own], groups);
        Ok(())
    }
}

/// Names of the point volumes in the shader.
const POINT_NAMES: [&str; POINTS_PER_BATCH] = ["point_0", "point_1", "point_2", "point_3"];

/// Pipeline variant of the averaging pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct AverageVariant {
    batch_size: usize,
    is_first: bool,
    is_last: bool,
}

impl PipelineVariant for AverageVariant {
    fn shader(&self) -> &'static str {
        "light/area_light.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![
            ("BATCH_SIZE", self.batch_size as f64),
            flag("IS_FIRST", self.is_first),
            flag("IS_LAST", self.is_last),
        ]
    }
}
