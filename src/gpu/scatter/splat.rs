//! Forward splatting: voxels into the sheets of one stack, slab after slab; what all scattering passes
//! share.

use glam::{DAffine3, DMat3, DVec3};

use super::footprint_table::{RADIUS, footprint_table};
use super::sheet_lists::{slab_lists, slice_lists};
use super::voxels::{ScatterVoxels, Scattering};
use crate::gpu::pipelines::binding::{Pipeline, buffer};
use crate::gpu::pipelines::uniforms::{self, rows};
use crate::gpu::pipelines::variant::{Constants, Reconstruction, Variant};
use crate::gpu::resources::pass;
use crate::gpu::volume::Gpu;
use crate::gpu::volume::listed_bricks;
use crate::gpu::volume::transfer_tables::Table;
use crate::gpu::{Context, GpuError};
use crate::model::{Kernel, Quadrature, SheetOrder};
use crate::plan::{BrickSet, SheetFrame, SliceOrder};

/// A stack of sheets that voxels are splatted into.
#[derive(Debug)]
pub(crate) struct Scatterer {
    /// Rays and slabs.
    pub frame: SheetFrame,
    variant: ScatterVariant,
    /// Slices of voxels, if sheets are along the volume.
    slices: Option<SliceOrder>,
    /// What does not change from slab to slab.
    uniform: uniforms::Scatter,
    /// Half a kernel's extents in (w·i, w·j, z), where it is not stretched.
    half: DVec3,
    /// How many times wider kernels are where they are widest.
    widest: f64,
    /// Bricks, slab by slab.
    bricks: wgpu::Buffer,
    /// Bricks of slab k are `starts[k] .. starts[k + 1]` of the list.
    starts: Vec<u32>,
    /// Sums, as integers.
    pub sheets: wgpu::Buffer,
    footprints: wgpu::Buffer,
    table: wgpu::Buffer,
}

/// What of a voxel is splatted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Splat {
    /// The voxel's density.
    Density,
    /// The voxel's extinction, for lights.
    Extinction,
    /// The voxel's density, colour and extinction, for the eye.
    Material,
}

impl Splat {
    /// `SPLAT` of `scatter/slab.wgsl`.
    pub(crate) fn constant(self) -> (&'static str, f64) {
        let code = match self {
            Self::Density => 0.0,
            Self::Extinction => 1.0,
            Self::Material => 2.0,
        };
        ("SPLAT", code)
    }

    /// Sums per pixel.
    fn sums(self) -> u32 {
        match self {
            Self::Density | Self::Extinction => 1,
            Self::Material => 5,
        }
    }
}

/// How voxels are splatted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Splatting {
    pub kernel: Kernel,
    pub quadrature: Quadrature,
    pub order: SheetOrder,
}

/// What tells one pipeline of the scattering passes from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ScatterVariant {
    pub reconstruction: Reconstruction,
    pub order: SheetOrder,
    pub splat: Splat,
}

impl ScatterVariant {
    /// The variant of one of the passes.
    pub(crate) fn of(self, shader: &'static str) -> ScatterPass {
        ScatterPass { shader, variant: self }
    }

    /// `ORDER` and `SPLAT`: what passes know that do not evaluate kernels.
    pub(crate) fn sheet_constants(self) -> [(&'static str, f64); 2] {
        let order = match self.order {
            SheetOrder::ImageAligned => 0.0,
            SheetOrder::VolumeAligned => 1.0,
            SheetOrder::EveryFootprint => 2.0,
        };
        [("ORDER", order), self.splat.constant()]
    }

    /// All that there is.
    pub(crate) fn constants(self) -> Constants {
        let mut constants = self.reconstruction.constants();
        constants.extend(self.sheet_constants());
        constants
    }
}

/// One of the passes that evaluate kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ScatterPass {
    shader: &'static str,
    variant: ScatterVariant,
}

impl Variant for ScatterPass {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> Constants {
        self.variant.constants()
    }
}

impl Scatterer {
    /// Prepares a stack of sheets of which `layers` are kept. Only bricks of `seen` are splatted.
    pub(crate) fn new(
        gpu: Gpu<'_>,
        voxels: &ScatterVoxels,
        frame: &SheetFrame,
        Splatting { kernel, quadrature, order }: Splatting,
        (what, table): (Splat, &Table),
        seen: &BrickSet,
        layers: u32,
    ) -> Result<Self, GpuError> {
        let Gpu { context, volume, .. } = gpu;
        let sheets_from_index = sheets_from_index(frame);
        let dims = volume.volume.dims();
        let slices = (order != SheetOrder::ImageAligned).then(|| SliceOrder::new(frame, dims));
        let tabled = if slices.is_some() { round(kernel) } else { kernel };
        let half = half_extents(frame, &sheets_from_index, tabled);
        let widest = frame.widest_stretch();
        let (starts, listed) = match &slices {
            None => slab_lists(frame, &sheets_from_index, voxels.among(seen), half.z * widest),
            Some(slices) => slice_lists(slices, voxels.among(seen)),
        };
        let axis = slices
            .map_or([0.0; 3], |slices| std::array::from_fn(|axis| f32::from(u8::from(axis == slices.axis))));
        let [x, y, z] = rows(&sheets_from_index);
        let uniform = uniforms::Scatter {
            frame: uniforms::SheetFrame::new(frame),
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
            slice_step: slices.map_or(0.0, |slices| slices.step as f32),
            axis,
            extinction_unit: table.largest_extinction().max(1e-9),
            ..bytemuck::Zeroable::zeroed()
        };
        Ok(Self {
            frame: frame.clone(),
            variant: ScatterVariant {
                reconstruction: Reconstruction::new(kernel, quadrature).with_missing(volume.has_missing()),
                order,
                splat: what,
            },
            slices,
            uniform,
            half,
            widest,
            bricks: context.buffer("Scatterer::bricks", &listed, wgpu::BufferUsages::STORAGE),
            starts,
            sheets: sums(context, "Scatterer::sheets", layers * what.sums(), frame.size)?,
            table: table.buffer.clone(),
            footprints: context.buffer(
                "Scatterer::footprints",
                &footprint_table(tabled),
                wgpu::BufferUsages::STORAGE,
            ),
        })
    }

    /// This stack seen from a light volume: `divisor` data voxels per light voxel.
    #[must_use]
    pub(crate) fn towards_grid(
        mut self,
        first_pixel: [f32; 2],
        cube_face: bool,
        (light_dims, divisor): ([usize; 3], usize),
    ) -> Self {
        self.uniform.first_pixel = first_pixel;
        self.uniform.cube_face = u32::from(cube_face);
        self.uniform.light_dims = light_dims.map(|n| n as u32);
        self.uniform.voxel_step = divisor as f32;
        self
    }

    /// What tells pipelines of its passes from others.
    pub(crate) fn variant(&self) -> ScatterVariant {
        self.variant
    }

    /// Sheets of the stack.
    pub(crate) fn sheet_count(&self) -> u32 {
        self.starts.len() as u32 - 1
    }

    /// Bricks, sheet by sheet.
    pub(crate) fn bricks(&self) -> &wgpu::Buffer {
        &self.bricks
    }

    /// Footprint tables.
    pub(crate) fn footprints(&self) -> &wgpu::Buffer {
        &self.footprints
    }

    /// How many times wider kernels are where they are widest.
    pub(crate) fn widest(&self) -> f64 {
        self.widest
    }

    /// Whether anything is splatted into slab `k`.
    pub(crate) fn is_filled(&self, k: u32) -> bool {
        k < self.sheet_count() && self.starts[k as usize] < self.starts[k as usize + 1]
    }

    /// What shaders know about slab `k`, for kernels that are nowhere narrower than `least_stretch`
    /// voxels per voxel.
    pub(crate) fn uniform(&self, k: u32, least_stretch: f64) -> uniforms::Scatter {
        // A slice of voxels has no depth of its own.
        let stretch = if self.slices.is_some() {
            self.widest
        } else {
            self.frame.stretch_at(f64::from(k)).max(least_stretch)
        };
        let pitch = self.frame.pitch_at(self.frame.depth_of(f64::from(k))) / self.frame.voxel_edge;
        let starts = &self.starts[k as usize..=k as usize + 1];
        uniforms::Scatter {
            half: (self.half * stretch).as_vec3().into(),
            stretch: stretch as f32,
            k,
            first: starts[0],
            count: starts[1] - starts[0],
            pixel_share: (pitch * pitch * self.frame.slab / self.frame.voxel_edge) as f32,
            ..self.uniform
        }
    }

    /// What shaders know of a slab, as a buffer.
    pub(crate) fn uniform_buffer(&self, context: &Context, k: u32, least_stretch: f64) -> wgpu::Buffer {
        let uniform = self.uniform(k, least_stretch);
        context.buffer("Scatterer::uniform", &[uniform], wgpu::BufferUsages::UNIFORM)
    }

    /// The bind group of passes with footprints.
    pub(crate) fn bind_group(
        &self,
        context: &Context,
        pipeline: &Pipeline,
        uniform: &wgpu::Buffer,
        with_sheets: bool,
    ) -> wgpu::BindGroup {
        let mut entries = vec![buffer("bound_scatter", uniform), buffer("footprint_table", &self.footprints)];
        if with_sheets {
            entries.push(buffer("sheets", &self.sheets));
        }
        pass::bind(context, "Scatterer::bind_group", pipeline, 1, &entries)
    }

    /// Splats the voxels of slab `k`, and counts them.
    pub(crate) fn splat(
        &self,
        gpu: Gpu<'_>,
        Scattering { voxels, counter }: &Scattering,
        k: u32,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Gpu { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&self.variant.of("scatter/splat.wgsl"))?;
        let uniform = self.uniform_buffer(context, k, 1.0);
        let own = pass::bind(
            context,
            "Scatterer::voxels",
            &pipeline,
            0,
            &[
                buffer("bricks", &self.bricks),
                buffer("table", &self.table),
                buffer("voxels", &voxels.buffer),
                buffer("splats", counter),
            ],
        );
        let shared = self.bind_group(context, &pipeline, &uniform, true);
        let [start, end] = [self.starts[k as usize], self.starts[k as usize + 1]];
        let workgroups = listed_bricks::workgroups(end - start);
        pass::dispatch(encoder, "Scatterer::splat", &pipeline, &[&own, &shared], workgroups);
        Ok(())
    }

    /// Bytes of sheets and lists.
    pub(crate) fn bytes(&self) -> u64 {
        self.sheets.size() + self.bricks.size()
    }
}

/// Integer sums, one per pixel of so many layers; they begin at zero.
pub(crate) fn sums(
    context: &Context,
    label: &'static str,
    layers: u32,
    [width, height]: [u32; 2],
) -> Result<wgpu::Buffer, GpuError> {
    let size = 4 * u64::from(layers) * u64::from(width) * u64::from(height);
    let limit = context.device.limits().max_storage_buffer_binding_size;
    if size > limit {
        return Err(GpuError::OverLimit {
            what: "a buffer to scatter into".to_owned(),
            size,
            limit,
            help: "the gathering engine makes the same picture without it",
        });
    }
    Ok(context.empty_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    }))
}

/// The round kernel that stands for one: that of the same variance, ⅓ of the other two.
fn round(kernel: Kernel) -> Kernel {
    match kernel {
        Kernel::Gaussian { .. } => kernel,
        Kernel::BSpline | Kernel::Prefiltered => Kernel::Gaussian { sigma: (1.0f64 / 3.0).sqrt() },
    }
}

/// `ORDER` of `scatter/slab.wgsl`.
/// Index space to (w·i, w·j, z), where w = 1 + z · `inverse_distance`: the inverse of the frame's rays,
/// point = origin + w·i · right + w·j · down + z · forward.
fn sheets_from_index(frame: &SheetFrame) -> DAffine3 {
    let matrix3 = DMat3::from_cols(frame.origin.per_i, frame.origin.per_j, frame.direction.base).inverse();
    DAffine3 { matrix3, translation: -(matrix3 * frame.origin.base) }
}

/// Half a kernel's extents in (w·i, w·j, z). That of the Gaussian is a cylinder along the ray; the
/// others are cubes along the axes of the grid.
fn half_extents(frame: &SheetFrame, sheets_from_index: &DAffine3, kernel: Kernel) -> DVec3 {
    let rows = sheets_from_index.matrix3.transpose();
    if !matches!(kernel, Kernel::Gaussian { .. }) {
        return RADIUS
            * DVec3::new(
                rows.x_axis.abs().element_sum(),
                rows.y_axis.abs().element_sum(),
                rows.z_axis.abs().element_sum(),
            );
    }
    // A point of the cylinder is off the voxel by up to the radius along the ray and by as much across.
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
