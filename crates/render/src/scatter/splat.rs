//! Forward splatting of voxels into a stack of sheets, slab by slab; shared by all scattering passes.

use glam::{DAffine3, DMat3, DVec3};

use super::footprint_table::{RADIUS, footprint_table};
use super::sheet_lists::{SheetLists, slab_lists, slice_lists};
use super::voxels::{ScatterState, ScatterVoxels};
use crate::pipelines::binding::{ShaderPipeline, bind_buffer};
use crate::pipelines::pipeline_variant::{PipelineVariant, ReconstructionVariant, ShaderConstants};
use crate::pipelines::uniforms::{self, rows};
use crate::plan::{BrickSet, SheetFrame, SliceOrder};
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::brick_list;
use crate::volume::transfer_tables::TransferTable;
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{ReconstructionKernel, SheetOrder, SlabQuadrature};

/// Stack of sheets that voxels are splatted into.
#[derive(Debug)]
pub(crate) struct SheetScatterer {
    /// Geometry of rays and slabs.
    pub frame: SheetFrame,
    variant: ScatterVariant,
    /// Slices of voxels, if sheets are aligned with the volume.
    slices: Option<SliceOrder>,
    /// Parts of the uniform that are the same for all slabs.
    uniform: uniforms::ScatterSlabUniform,
    /// Half extents of an unstretched kernel in (w·i, w·j, z).
    half_extents: DVec3,
    /// Maximum stretch of kernels.
    max_stretch: f64,
    /// Bricks of all slabs, slab by slab.
    bricks: wgpu::Buffer,
    /// Starts of the slabs' lists: slab k has the bricks `starts[k] .. starts[k + 1]`.
    starts: Vec<u32>,
    /// Sums per pixel, as fixed-point integers.
    pub sheets: wgpu::Buffer,
    footprints: wgpu::Buffer,
    table: wgpu::Buffer,
}

/// Quantity that is splatted for each voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum SplatQuantity {
    /// Density, classified after summation.
    Density,
    /// Extinction, for lights.
    Extinction,
    /// Density, colour and extinction, for the eye.
    Material,
}

impl SplatQuantity {
    /// Returns the constant `SPLAT` of `scatter/slab.wgsl`.
    pub(crate) fn constant(self) -> (&'static str, f64) {
        let code = match self {
            Self::Density => 0.0,
            Self::Extinction => 1.0,
            Self::Material => 2.0,
        };
        ("SPLAT", code)
    }

    /// Returns the number of sums per pixel.
    fn sum_count(self) -> u32 {
        match self {
            Self::Density | Self::Extinction => 1,
            Self::Material => 5,
        }
    }
}

/// Parameters of splatting: kernel, quadrature, order of the sheets, and the quantity that is splatted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplatParameters {
    pub kernel: ReconstructionKernel,
    pub quadrature: SlabQuadrature,
    pub order: SheetOrder,
    pub quantity: SplatQuantity,
}

/// Pipeline variant shared by the scattering passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ScatterVariant {
    pub reconstruction: ReconstructionVariant,
    pub order: SheetOrder,
    pub splat: SplatQuantity,
}

impl ScatterVariant {
    /// Creates the variant of one of the passes.
    pub(crate) fn for_shader(self, shader: &'static str) -> ScatterPass {
        ScatterPass { shader, variant: self }
    }

    /// Returns `ORDER` and `SPLAT`, the constants of passes that evaluate no kernels.
    pub(crate) fn sheet_constants(self) -> [(&'static str, f64); 2] {
        let order = match self.order {
            SheetOrder::ImageAligned => 0.0,
            SheetOrder::VolumeAligned => 1.0,
            SheetOrder::EveryFootprint => 2.0,
        };
        [("ORDER", order), self.splat.constant()]
    }

    /// Returns all constants of passes that evaluate kernels.
    pub(crate) fn constants(self) -> ShaderConstants {
        let mut constants = self.reconstruction.constants();
        constants.extend(self.sheet_constants());
        constants
    }
}

/// Pipeline variant of a pass that evaluates kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ScatterPass {
    shader: &'static str,
    variant: ScatterVariant,
}

impl PipelineVariant for ScatterPass {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> ShaderConstants {
        self.variant.constants()
    }
}

impl SheetScatterer {
    /// Prepares a stack of sheets, of which `layers` are stored at a time. Only bricks of `seen` are splatted.
    pub(crate) fn new(
        gpu: VolumeContext<'_>,
        voxels: &ScatterVoxels,
        frame: &SheetFrame,
        SplatParameters { kernel, quadrature, order, quantity }: SplatParameters,
        table: &TransferTable,
        seen: &BrickSet,
        layers: u32,
    ) -> Result<Self, GpuError> {
        let VolumeContext { context, volume, .. } = gpu;
        let sheets_from_index = sheets_from_index(frame);
        let dims = volume.volume.dims();
        let slices = (order != SheetOrder::ImageAligned).then(|| SliceOrder::new(frame, dims));
        let tabulated_kernel = if slices.is_some() { isotropic_kernel(kernel) } else { kernel };
        let half = half_extents(frame, &sheets_from_index, tabulated_kernel);
        let widest = frame.widest_stretch();
        let SheetLists { starts, bricks: listed } = match &slices {
            None => slab_lists(frame, &sheets_from_index, voxels.bricks_in(seen), half.z * widest),
            Some(slices) => slice_lists(slices, voxels.bricks_in(seen)),
        };
        let axis = slices
            .map_or([0.0; 3], |slices| std::array::from_fn(|axis| f32::from(u8::from(axis == slices.axis))));
        let [x, y, z] = rows(&sheets_from_index);
        let uniform = uniforms::ScatterSlabUniform {
            frame: uniforms::SheetFrameUniform::new(frame),
            sheets_from_index_x: x,
            sheets_from_index_y: y,
            sheets_from_index_z: z,
            dims: dims.map(|n| n as f32),
            bricks: volume.bricks.dims.map(|n| n as i32),
            layers,
            voxel_step: 1.0,
            light_dims: dims.map(|n| n as u32),
            sheet_count: starts.len() as u32 - 1,
            first_slice: slices.map_or(0.0, |slices| slices.first as f32),
            slice_step: slices.map_or(0.0, |slices| slices.direction as f32),
            axis,
            extinction_unit: table.largest_extinction().max(1e-9),
            ..bytemuck::Zeroable::zeroed()
        };
        Ok(Self {
            frame: frame.clone(),
            variant: ScatterVariant {
                reconstruction: ReconstructionVariant::new(kernel, quadrature)
                    .with_boundaries(volume.possible_boundaries()),
                order,
                splat: quantity,
            },
            slices,
            uniform,
            half_extents: half,
            max_stretch: widest,
            bricks: context.buffer("Scatterer::bricks", &listed, wgpu::BufferUsages::STORAGE),
            starts,
            sheets: sums(context, "Scatterer::sheets", layers * quantity.sum_count(), frame.size)?,
            table: table.buffer.clone(),
            footprints: context.buffer(
                "Scatterer::footprints",
                &footprint_table(tabulated_kernel),
                wgpu::BufferUsages::STORAGE,
            ),
        })
    }

    /// Sets the parameters for splatting back into a light volume, with `divisor` data voxels per light voxel.
    #[must_use]
    pub(crate) fn with_light_grid(
        mut self,
        first_pixel: [f32; 2],
        cube_face: bool,
        light_dims: [usize; 3],
        divisor: usize,
    ) -> Self {
        self.uniform.first_pixel = first_pixel;
        self.uniform.cube_face = u32::from(cube_face);
        self.uniform.light_dims = light_dims.map(|n| n as u32);
        self.uniform.voxel_step = divisor as f32;
        self
    }

    /// Returns the pipeline variant of the stack's passes.
    pub(crate) fn variant(&self) -> ScatterVariant {
        self.variant
    }

    /// Returns the number of sheets in the stack.
    pub(crate) fn sheet_count(&self) -> u32 {
        self.starts.len() as u32 - 1
    }

    /// Returns the list of bricks, sheet by sheet.
    pub(crate) fn bricks(&self) -> &wgpu::Buffer {
        &self.bricks
    }

    /// Returns the footprint tables.
    pub(crate) fn footprints(&self) -> &wgpu::Buffer {
        &self.footprints
    }

    /// Returns the maximum stretch of kernels.
    pub(crate) fn max_stretch(&self) -> f64 {
        self.max_stretch
    }

    /// Returns true if any brick is splatted into slab `k`.
    pub(crate) fn is_filled(&self, k: u32) -> bool {
        k < self.sheet_count() && self.starts[k as usize] < self.starts[k as usize + 1]
    }

    /// Builds the uniform of slab `k`, for kernels of at least `least_stretch` times the voxels' width.
    pub(crate) fn uniform(&self, k: u32, least_stretch: f64) -> uniforms::ScatterSlabUniform {
        // Slices of voxels have no depth of their own, and so one stretch for all.
        let stretch = if self.slices.is_some() {
            self.max_stretch
        } else {
            self.frame.stretch_at(f64::from(k)).max(least_stretch)
        };
        let pitch = self.frame.pitch_at(self.frame.depth_of(f64::from(k))) / self.frame.voxel_edge;
        let starts = &self.starts[k as usize..=k as usize + 1];
        uniforms::ScatterSlabUniform {
            half_extents: (self.half_extents * stretch).as_vec3().into(),
            stretch: stretch as f32,
            k,
            first: starts[0],
            count: starts[1] - starts[0],
            pixel_share: (pitch * pitch * self.frame.slab / self.frame.voxel_edge) as f32,
            ..self.uniform
        }
    }

    /// Creates the uniform buffer of slab `k`.
    pub(crate) fn uniform_buffer(&self, context: &GpuContext, k: u32, least_stretch: f64) -> wgpu::Buffer {
        let uniform = self.uniform(k, least_stretch);
        context.buffer("Scatterer::uniform", &[uniform], wgpu::BufferUsages::UNIFORM)
    }

    /// Creates the bind group of passes with footprints.
    pub(crate) fn bind_group(
        &self,
        context: &GpuContext,
        pipeline: &ShaderPipeline,
        uniform: &wgpu::Buffer,
        with_sheets: bool,
    ) -> wgpu::BindGroup {
        let mut entries =
            vec![bind_buffer("bound_scatter", uniform), bind_buffer("footprint_table", &self.footprints)];
        if with_sheets {
            entries.push(bind_buffer("sheets", &self.sheets));
        }
        pass::bind(context, "Scatterer::bind_group", pipeline, 1, &entries)
    }

    /// Splats the voxels of slab `k`, and counts the footprints.
    pub(crate) fn splat(
        &self,
        gpu: VolumeContext<'_>,
        ScatterState { voxels, counter }: &ScatterState,
        k: u32,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&self.variant.for_shader("scatter/splat.wgsl"))?;
        let uniform = self.uniform_buffer(context, k, 1.0);
        let own = pass::bind(
            context,
            "Scatterer::voxels",
            &pipeline,
            0,
            &[
                bind_buffer("bricks", &self.bricks),
                bind_buffer("table", &self.table),
                bind_buffer("voxels", &voxels.buffer),
                bind_buffer("splats", counter),
            ],
        );
        let shared = self.bind_group(context, &pipeline, &uniform, true);
        let [start, end] = [self.starts[k as usize], self.starts[k as usize + 1]];
        let workgroups = brick_list::two_workgroups_per_brick(end - start);
        pass::dispatch(encoder, "Scatterer::splat", &pipeline, &[&own, &shared], workgroups);
        Ok(())
    }

    /// Returns the size of sheets and lists, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.sheets.size() + self.bricks.size()
    }
}

/// Creates a zeroed buffer of integer sums, one per pixel of each layer.
pub(crate) fn sums(
    context: &GpuContext,
    label: &'static str,
    layers: u32,
    [width, height]: [u32; 2],
) -> Result<wgpu::Buffer, GpuError> {
    let size = 4 * u64::from(layers) * u64::from(width) * u64::from(height);
    let limit = context.device.limits().max_storage_buffer_binding_size;
    if size > limit {
        return Err(GpuError::OverLimit {
            what: "a buffer of the scattering engine".to_owned(),
            size,
            limit,
            help: "choose the gathering engine, which makes the same picture without it",
        });
    }
    Ok(context.uninitialised_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    }))
}

/// Returns the isotropic kernel that replaces one: a Gaussian of the same variance, ⅓ for the others.
fn isotropic_kernel(kernel: ReconstructionKernel) -> ReconstructionKernel {
    match kernel {
        ReconstructionKernel::Gaussian { .. } => kernel,
        ReconstructionKernel::BSpline | ReconstructionKernel::Prefiltered => {
            ReconstructionKernel::Gaussian { sigma: (1.0f64 / 3.0).sqrt() }
        }
    }
}

/// Returns the map from index space to (w·i, w·j, z), where w = 1 + z · `inverse_distance`: the inverse of the
/// frame's rays, point = origin + w·i · right + w·j · down + z · forward.
fn sheets_from_index(frame: &SheetFrame) -> DAffine3 {
    let matrix3 = DMat3::from_cols(frame.origin.per_i, frame.origin.per_j, frame.direction.base).inverse();
    DAffine3 { matrix3, translation: -(matrix3 * frame.origin.base) }
}

/// Returns half the extents of a kernel in (w·i, w·j, z). The Gaussian is bounded by a cylinder along the ray, others
/// by cubes along the axes of the grid.
fn half_extents(frame: &SheetFrame, sheets_from_index: &DAffine3, kernel: ReconstructionKernel) -> DVec3 {
    let rows = sheets_from_index.matrix3.transpose();
    if !matches!(kernel, ReconstructionKernel::Gaussian { .. }) {
        return RADIUS
            * DVec3::new(
                rows.x_axis.abs().element_sum(),
                rows.y_axis.abs().element_sum(),
                rows.z_axis.abs().element_sum(),
            );
    }
    // A point of the cylinder is up to the radius away from the voxel along the ray, and as far across it.
    let [w, h] = frame.size.map(f64::from);
    let depth = rows.z_axis.length();
    let deepest = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)]
        .map(|(i, j)| {
            let cosine = (rows.z_axis.dot(frame.direction.at(i, j).normalize()) / depth).abs().min(1.0);
            cosine + (1.0 - cosine * cosine).sqrt()
        })
        .into_iter()
        .fold(1.0, f64::max);
    RADIUS * DVec3::new(rows.x_axis.length(), rows.y_axis.length(), depth * deepest)
}
