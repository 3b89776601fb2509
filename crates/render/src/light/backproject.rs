//! Back-projection, the second half of the light pass: splats the sheets back into the light volume.

use std::ops::{Range, RangeInclusive};

use glam::{DAffine3, DMat3, DVec3};

use super::light_volume::LightVolume;
use super::march::LightSheets;
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{PipelineVariant, ReconstructionVariant, ShaderConstants, flag};
use crate::pipelines::uniforms::{self, rows};
use crate::plan::{LightView, MarchTiles};
use crate::resources::pass;
use crate::resources::work_part::WorkPart;
use crate::volume::VolumeContext;
use crate::volume::brick_list::{self, BrickEntry};
use crate::volume::transfer_tables::UNLIMITED_REACH;
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{ReconstructionKernel, ReverseKernel, ShadowSettings, SlabQuadrature};
use chiaroscuro_volume::{BRICK_EDGE, math::SceneSpace};

/// Work for each chunk of slabs: bricks to back-project and tiles to march.
#[derive(Debug)]
pub(crate) struct ChunkSchedule {
    /// Bricks of the light volume by the chunk that completes them.
    chunks: Vec<Vec<BrickEntry>>,
    /// Tiles of the sheets that are marched.
    tiles: MarchTiles,
}

impl ChunkSchedule {
    /// Lists for each chunk the bricks in which any voxel receives its last sheet, and the tiles in which sheets are
    /// read: all of them if `reach` is [`UNLIMITED_REACH`].
    ///
    /// `reach` is the number of cells beyond the filled ones that the reverse kernel reads. For a floor the
    /// transmittance behind all sheets is read, too; in between it only changes where bricks are filled, since
    /// everything that attenuates light lies in one of them.
    pub(crate) fn new(
        scene: &SceneSpace,
        view: &LightView,
        light: &LightVolume,
        chunk: u32,
        reach: i32,
        has_floor: bool,
    ) -> Self {
        let count = view.frame.slab_count.div_ceil(chunk).max(1);
        let mut chunks = vec![Vec::new(); count as usize];
        let completion = CompletionDepths::new(scene, view, light);
        for (brick, cells) in light.filled_cells.cells.bricks() {
            let slabs = completion.slabs(brick);
            for list in &mut chunks[(slabs.start() / chunk) as usize..=(slabs.end() / chunk) as usize] {
                list.push(brick_list::brick_entry((brick, cells)));
            }
        }
        let tiles = if reach == UNLIMITED_REACH {
            MarchTiles::all(view, chunk)
        } else {
            MarchTiles::covering(view, scene, chunk, brick_boxes(light, reach), has_floor)
        };
        Self { chunks, tiles }
    }

    /// Returns the tiles of a chunk that belong to a part of its march.
    pub(crate) fn tiles(&self, chunk: usize, part: WorkPart) -> &[u32] {
        part.slice(self.tiles.chunk(chunk))
    }
}

/// Returns the boxes, in index space, around the bricks of a light volume in which sheets are read.
fn brick_boxes(light: &LightVolume, reach: i32) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    // Cells are pairs of voxels along each axis, and samples belong to the cell in which they lie
    // (`density/cells.wgsl`).
    let beyond = DVec3::splat(2.0 * f64::from(reach));
    let edge = (BRICK_EDGE * light.divisor) as f64;
    light.filled_cells.cells.bricks().map(move |(brick, _)| {
        let low = edge * DVec3::from(brick.map(|at| at as f64));
        [low - beyond, low + edge + beyond]
    })
}

/// Depths at which the voxels of bricks are complete: linear in the brick's coordinates.
struct CompletionDepths {
    /// Last slab that reaches the first voxel of brick 0, fractional.
    first: f64,
    /// Slabs from a brick to the next along each axis of the grid.
    per_brick: DVec3,
    /// Range of the slabs of a brick's voxels relative to its first voxel, with slack on either side.
    within: [f64; 2],
    /// Last slab of the view.
    last: f64,
}

impl CompletionDepths {
    fn new(scene: &SceneSpace, view: &LightView, light: &LightVolume) -> Self {
        let frame = &view.frame;
        let step = light.divisor as f64;
        let slab_of = |place: DVec3| (place.dot(view.axes.z_axis) - frame.first_depth) / frame.slab;
        let voxel = scene.scene_from_index.transform_point3(DVec3::splat(0.5 * step - 0.5));
        let per_voxel = scene.scene_from_index.matrix3.transpose() * view.axes.z_axis * (step / frame.slab);
        let across = (BRICK_EDGE - 1) as f64 * per_voxel;
        // One slab of slack each for the quadrature points and for the rounding of the shader.
        let slack = 1.0;
        Self {
            first: slab_of(voxel - view.anchor) + 2.0 * view.kernel_slabs() - 0.5,
            per_brick: BRICK_EDGE as f64 * per_voxel,
            within: [
                across.min(DVec3::ZERO).element_sum() - slack,
                across.max(DVec3::ZERO).element_sum() + slack,
            ],
            last: f64::from(frame.slab_count.max(1) - 1),
        }
    }

    /// Returns the slabs, from the first to the last, that complete any voxel of a brick.
    fn slabs(&self, brick: [usize; 3]) -> RangeInclusive<u32> {
        let slab = self.first + self.per_brick.dot(DVec3::from(brick.map(|at| at as f64)));
        let [low, high] = self.within.map(|beyond| slab + beyond);
        // Casts round towards zero, which is down between the limits.
        (low.clamp(0.0, self.last) as u32)..=(high.clamp(0.0, self.last) as u32)
    }
}

/// Returns the map from index space to light axes: x and y in pixels of the anchor plane, z in scene units.
fn light_from_index(scene: &SceneSpace, view: &LightView) -> DAffine3 {
    let to_light = DMat3::from_diagonal(DVec3::new(1.0 / view.frame.pitch, 1.0 / view.frame.pitch, 1.0))
        * view.axes.transpose();
    DAffine3 { matrix3: to_light, translation: -(to_light * view.anchor) } * scene.scene_from_index
}

/// Pipeline variant of the back-projection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct BackprojectVariant {
    reconstruction: ReconstructionVariant,
    first_touch: bool,
    /// `true` if kernels are wider than a pixel or a slab somewhere.
    is_wide: bool,
    /// Size of a workgroup. A software driver's 8-lane vector processes a whole brick, and computes what precedes its
    /// first voxel once.
    lanes: u32,
}

impl BackprojectVariant {
    /// Creates the variant; `is_wide` tells if kernels are wider than a pixel or a slab somewhere.
    pub(crate) fn from_shadows(context: &GpuContext, shadows: &ShadowSettings, is_wide: bool) -> Self {
        // The prefiltered kernel is a tent when it is spread.
        let kernel = match shadows.reverse_kernel {
            ReverseKernel::Tent => ReconstructionKernel::Prefiltered,
            ReverseKernel::Forward => shadows.kernel,
        };
        Self {
            reconstruction: ReconstructionVariant::new(kernel, shadows.quadrature),
            first_touch: shadows.first_touch,
            is_wide,
            lanes: if context.is_software() { 8 } else { 64 },
        }
    }
}

impl PipelineVariant for BackprojectVariant {
    fn shader(&self) -> &'static str {
        "light/backproject.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.reconstruction.constants();
        constants.extend([
            flag("FIRST_TOUCH", self.first_touch),
            flag("WIDE", self.is_wide),
            ("LANES", f64::from(self.lanes)),
        ]);
        constants
    }
}

/// Back-projects some slabs into the voxels that they complete, within a part of the bricks.
#[expect(clippy::too_many_arguments, reason = "each is another thing: who, what, how, where from, where to")]
pub(crate) fn backproject(
    gpu: VolumeContext<'_>,
    shadows: &ShadowSettings,
    view: &LightView,
    sheets: &LightSheets,
    schedule: &ChunkSchedule,
    light: &LightVolume,
    slabs: Range<u32>,
    part: WorkPart,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let VolumeContext { context, shaders, volume, .. } = gpu;
    let bricks = part.slice(&schedule.chunks[(slabs.start / sheets.chunk) as usize]);
    if bricks.is_empty() {
        return Ok(());
    }
    let is_wide = !view.kernel_is_narrow() || shadows.quadrature == SlabQuadrature::Two;
    let variant = BackprojectVariant::from_shadows(context, shadows, is_wide);
    let pipeline = shaders.pipeline_into(&variant, light.texture.format())?;
    let [x, y, z] = rows(&light_from_index(&volume.scene, view));
    let uniform = uniforms::BackprojectionUniform {
        frame: uniforms::SheetFrameUniform::new(&view.frame),
        light_from_index_x: x,
        light_from_index_y: y,
        light_from_index_z: z,
        first_pixel: view.first_pixel.as_vec2().into(),
        kernel_edge: view.kernel_edge as f32,
        voxel_step: light.divisor as f32,
        dims: light.dims.map(|n| n as u32),
        cube_face: u32::from(view.cube_face),
        begin: slabs.start,
        end: slabs.end,
        layers: sheets.layers,
        bricks: bricks.len() as u32,
        ring_scale: [sheets.ring.texture.width(), sheets.ring.texture.height()].map(|n| 1.0 / n as f32),
        pad0: 0.0,
        pad1: 0.0,
    };
    let uniform = gpu.uniform("Backprojection::uniform", uniform);
    let list = brick_list::upload_bricks(gpu, bricks);
    let bind_group = gpu.bind(
        "Backprojection::bind_group",
        &pipeline,
        0,
        &[
            bind_buffer("bound_view", &uniform),
            bind_buffer("bricks", &list),
            bind_view("ring", &sheets.ring.view),
            sampler("ring_sampler", &volume.clamped),
            bind_view("attenuation", &light.view),
        ],
    );
    pass::dispatch(
        encoder,
        "Backprojection::pass",
        &pipeline,
        &[&bind_group],
        brick_list::one_workgroup_per_brick(bricks.len() as u32),
    );
    Ok(())
}
