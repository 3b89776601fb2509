//! Area lights: average of the attenuation volumes of point lights on the area.

use super::block_normals::BlockNormals;
use super::light_volume::LightVolume;
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, flag};
use crate::pipelines::uniforms;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::brick_list::{self, BrickEntry};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{LightGeometry, SceneLight};
use glam::{DVec2, DVec3};

/// Number of volumes added per pass; the sum is read and written once for all of them.
const POINTS_PER_BATCH: usize = 4;

/// Temporary volumes for filling the volume of an area light.
#[derive(Debug)]
pub(crate) struct AreaLightAverage {
    /// Attenuation volumes of the points in the current batch.
    points: [LightVolume; POINTS_PER_BATCH],
    /// Partial sums, read from one and written to the other in turn.
    sums: [LightVolume; 2],
    /// Light that is averaged.
    light: SceneLight,
    /// Coordinates of its points on its area.
    coordinates: Vec<DVec2>,
    /// Normals of surfaces, if points are weighted by their cosines to them.
    pub normals: Option<BlockNormals>,
}

impl AreaLightAverage {
    /// Allocates the temporary volumes for a light with this number of points, whose volume is `whole`.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        light: &SceneLight,
        samples: u32,
        whole: &LightVolume,
        normals: Option<BlockNormals>,
    ) -> Result<Self, GpuError> {
        let sum = || whole.with_same_voxels(context, wgpu::TextureFormat::R32Float);
        let point = || whole.with_same_voxels(context, context.storage_format);
        Ok(Self {
            points: [point()?, point()?, point()?, point()?],
            sums: [sum()?, sum()?],
            light: *light,
            coordinates: light.sample_coordinates(samples),
            normals,
        })
    }

    /// Returns the size of all temporary volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let normals = self.normals.as_ref().map_or(0, BlockNormals::bytes);
        normals + self.points.iter().chain(&self.sums).map(LightVolume::bytes).sum::<u64>()
    }

    /// Returns the volume that a point's light is computed in.
    pub(crate) fn point_volume(&self, index: usize) -> &LightVolume {
        &self.points[index % POINTS_PER_BATCH]
    }

    /// Returns true if a batch is complete with this point, so that its volumes are to be added.
    pub(crate) fn ends_batch(&self, index: usize) -> bool {
        index % POINTS_PER_BATCH == POINTS_PER_BATCH - 1 || index + 1 == self.coordinates.len()
    }

    /// Returns true if point `index` belongs to the first batch.
    pub(crate) fn is_in_first_batch(index: usize) -> bool {
        index < POINTS_PER_BATCH
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
            is_last: index + 1 == self.coordinates.len(),
            has_cosines: self.normals.is_some(),
        };
        let pipeline = gpu.shaders.pipeline_into(&variant, whole.texture.format())?;
        let uniform = gpu.uniform("Average::uniform", self.uniform(gpu, whole, index, bricks.len()));
        let list = brick_list::upload_bricks(gpu, bricks);
        let points =
            POINT_NAMES.into_iter().zip(&self.points).map(|(name, point)| bind_view(name, &point.view));
        let others = [
            bind_buffer("bound_average", &uniform),
            bind_buffer("bricks", &list),
            bind_view("before", &self.sums[turn % 2].view),
            bind_view("after", &self.sums[(turn + 1) % 2].view),
            bind_view("attenuation", &whole.view),
            bind_view("normals", self.normals.as_ref().map_or(gpu.placeholder, |near| &near.normals.view)),
            sampler("clamped", &gpu.volume.clamped),
        ];
        let entries: Vec<_> = points.chain(others).collect();
        let own = gpu.bind("Average::bind_group", &pipeline, 0, &entries);
        let groups = brick_list::two_workgroups_per_brick(bricks.len() as u32);
        pass::dispatch(encoder, "Average::pass", &pipeline, &[&own], groups);
        Ok(())
    }

    /// Builds the uniform of the batch that ends with point `index`.
    fn uniform(
        &self,
        gpu: VolumeContext<'_>,
        whole: &LightVolume,
        index: usize,
        bricks: usize,
    ) -> uniforms::AverageUniform {
        let (place, perspective) = match self.light.kind {
            LightGeometry::Parallel => (self.light.direction(), 0.0),
            LightGeometry::Perspective => (self.light.position.into(), 1.0),
        };
        let border = |border: DVec3| border.as_vec3().into();
        let first = index - index % POINTS_PER_BATCH;
        let batch: [DVec2; POINTS_PER_BATCH] =
            std::array::from_fn(|at| self.coordinates.get(first + at).copied().unwrap_or_default());
        uniforms::AverageUniform {
            dims: whole.dims.map(|n| n as u32),
            bricks: bricks as u32,
            place: border(place),
            perspective,
            right: self.light.area.map_or([0.0; 3], |area| border(area.right)),
            share: 1.0 / (index + 1) as f32,
            up: self.light.area.map_or([0.0; 3], |area| border(area.up)),
            voxel_step: whole.divisor as f32,
            to_right: batch.map(|at| at.x as f32),
            to_top: batch.map(|at| at.y as f32),
            lookup: self.normals.as_ref().map_or([0.0; 3], |near| near.normals.lookup()),
            pad0: 0.0,
            space: uniforms::SpaceUniform::new(&gpu.volume.scene),
        }
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
    /// `true` if points are weighted by their cosines to surfaces.
    has_cosines: bool,
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
            flag("COSINES", self.has_cosines),
        ]
    }
}
