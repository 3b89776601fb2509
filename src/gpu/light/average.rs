//! Area lights: average of the attenuation volumes of point lights on the area.

use super::volume::LightVolume;
use crate::gpu::pipelines::binding::{buffer, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{Constants, Variant, flag};
use crate::gpu::resources::pass;
use crate::gpu::volume::Gpu;
use crate::gpu::volume::listed_bricks::{self, Listed};
use crate::gpu::{Context, GpuError};

/// Number of volumes added per pass; the sum is read and written once for all of them.
const ADDED: usize = 4;

/// Temporary volumes for filling the volume of an area light.
#[derive(Debug)]
pub(crate) struct Average {
    /// Attenuation volumes of the points in the current batch.
    points: [LightVolume; ADDED],
    /// Partial sums, read from one and written to the other in turn.
    sums: [LightVolume; 2],
    /// Number of points on the area light.
    count: usize,
}

impl Average {
    /// Allocates the temporary volumes for a light whose volume is `whole`.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &Context, whole: &LightVolume, count: usize) -> Result<Self, GpuError> {
        let sum = || whole.alike(context, wgpu::TextureFormat::R32Float);
        let point = || whole.alike(context, context.storage_format);
        Ok(Self { points: [point()?, point()?, point()?, point()?], sums: [sum()?, sum()?], count })
    }

    /// Returns the size of all temporary volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.points.iter().chain(&self.sums).map(LightVolume::bytes).sum()
    }

    /// Returns the volume that a point's light is computed in.
    pub(crate) fn point(&self, index: usize) -> &LightVolume {
        &self.points[index % ADDED]
    }

    /// Returns true if a batch is complete with this point, so that its volumes are to be added.
    pub(crate) fn is_due(&self, index: usize) -> bool {
        index % ADDED == ADDED - 1 || index + 1 == self.count
    }

    /// Adds the volumes of the batch that ends with point `index`, in the listed bricks; the last batch writes the
    /// average into the light's own volume.
    pub(crate) fn add(
        &self,
        gpu: Gpu<'_>,
        whole: &LightVolume,
        index: usize,
        bricks: &[Listed],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let turn = index / ADDED;
        let variant = AverageVariant {
            added: index % ADDED + 1,
            is_first: turn == 0,
            is_last: index + 1 == self.count,
        };
        let pipeline = gpu.shaders.pipeline_into(&variant, whole.texture.format())?;
        let uniform = uniforms::Average {
            dims: whole.dims.map(|n| n as u32),
            bricks: bricks.len() as u32,
            share: 1.0 / (index + 1) as f32,
            pad0: 0,
            pad1: 0,
            pad2: 0,
        };
        let uniform = gpu.uniform("Average::uniform", uniform);
        let list = listed_bricks::upload(gpu, bricks);
        let points = POINTS.into_iter().zip(&self.points).map(|(name, point)| view_of(name, &point.view));
        let others = [
            buffer("bound_average", &uniform),
            buffer("bricks", &list),
            view_of("before", &self.sums[turn % 2].view),
            view_of("after", &self.sums[(turn + 1) % 2].view),
            view_of("attenuation", &whole.view),
        ];
        let entries: Vec<_> = points.chain(others).collect();
        let own = gpu.bind("Average::bind_group", &pipeline, 0, &entries);
        let groups = listed_bricks::workgroups(bricks.len() as u32);
        pass::dispatch(encoder, "Average::pass", &pipeline, &[&own], groups);
        Ok(())
    }
}

/// Names of the point volumes in the shader.
const POINTS: [&str; ADDED] = ["point_0", "point_1", "point_2", "point_3"];

/// Pipeline variant of the averaging pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct AverageVariant {
    added: usize,
    is_first: bool,
    is_last: bool,
}

impl Variant for AverageVariant {
    fn shader(&self) -> &'static str {
        "light/average.wgsl"
    }

    fn constants(&self) -> Constants {
        vec![("ADDED", self.added as f64), flag("IS_FIRST", self.is_first), flag("IS_LAST", self.is_last)]
    }
}
