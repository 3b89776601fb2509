//! Light pass of the scattering engine: splats voxels, marches light through the sheets, splats the sheets back into
//! the grid, and divides by the weights.

use std::ops::Range;

use super::eye::splatted_bricks;
use super::splat::{ScatterVariant, Scatterer, Splat, Splatting, sums};
use super::voxels::Scattering;
use crate::gpu::light::march::{SLABS_PER_TEXEL, Sheets, march_uniform};
use crate::gpu::light::volume::LightVolume;
use crate::gpu::pipelines::binding::{buffer, sampler, view_of};
use crate::gpu::pipelines::variant::{Constants, Only, Variant, deposit_constant, flag, is_cut};
use crate::gpu::resources::pass;
use crate::gpu::volume::listed_bricks::{self, Listed};
use crate::gpu::volume::transfer_tables::{Tables, upload_distances};
use crate::gpu::volume::{Gpu, Levels};
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{Classification, Deposit, SceneLight, Settings, SheetOrder};
use crate::plan::{BrickSet, LightView, scatter_reach_bricks};

/// Pipeline variant of the march over scattered sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ScatterMarchVariant {
    is_cut: bool,
    deposit: Deposit,
    sheets: ScatterVariant,
    /// `true` if pixels are wider than voxels somewhere.
    is_stretched: bool,
    /// Reach of a sample's kernel, in bricks around its own.
    dilation: i32,
}

impl Variant for ScatterMarchVariant {
    fn shader(&self) -> &'static str {
        "scatter/light.wgsl"
    }

    fn constants(&self) -> Constants {
        let mut constants = self.sheets.reconstruction.constants();
        constants.extend([
            flag("CUT", self.is_cut),
            flag("STRETCH", self.is_stretched),
            deposit_constant(self.deposit),
            self.sheets.splat.constant(),
            ("DILATION", f64::from(self.dilation)),
        ]);
        constants
    }
}

/// Sheets of one view of a light, and the sums that are splatted back into the grid.
#[derive(Debug)]
pub(crate) struct LightScatter {
    scatterer: Scatterer,
    /// Sums of deposits times weights, Σ D·h, per light voxel.
    light: wgpu::Buffer,
    /// Weight volume: sums of weights, Σ h, per light voxel.
    weights: wgpu::Buffer,
    /// Distances, in bricks, to the nearest brick whose sheets are read, and to the nearest that attenuates light.
    distances: wgpu::TextureView,
    dilation: i32,
    /// Deposits of the slabs that share a texel of the ring.
    deposits: wgpu::Buffer,
    /// Number of data voxels per light voxel, along an axis.
    divisor: usize,
}

impl LightScatter {
    /// Prepares a view. Sheets are splatted back in the bricks of `read` only, or everywhere without it.
    pub(crate) fn new(
        gpu: Gpu<'_>,
        scattering: &Scattering,
        (tables, color): (&Tables, Option<usize>),
        view: &LightView,
        (settings, target): (&Settings, &LightVolume),
        read: Option<&BrickSet>,
        options: &RenderOptions,
    ) -> Result<Self, GpuError> {
        let seen = splatted_bricks(&view.frame, &tables.lighting.occupied, options);
        let shadows = &settings.shadows;
        let what = match settings.sampling.classification {
            Classification::Post => Splat::Density,
            Classification::Pre => Splat::Extinction,
        };
        let what = (what, tables.met(color));
        let order = SheetOrder::ImageAligned;
        let kernel = Splatting { kernel: shadows.kernel, quadrature: shadows.quadrature, order };
        let [nx, ny, nz] = target.dims.map(|n| n as u32);
        let dims = tables.lighting.occupied.dims;
        let unread = read.map_or_else(|| BrickSet::full(dims).distances(), BrickSet::distances);
        let thin = if options.empty_space_skipping {
            tables.lighting.occupied.distances()
        } else {
            vec![0; unread.len()]
        };
        let pairs: Vec<u8> = unread.into_iter().zip(thin).flat_map(|(r, g)| [r, g]).collect();
        Ok(Self {
            distances: upload_distances(
                gpu.context,
                "LightScatter::distances",
                dims,
                &pairs,
                wgpu::TextureFormat::Rg8Uint,
            )?,
            scatterer: Scatterer::new(gpu, &scattering.voxels, &view.frame, kernel, what, &seen, 1)?
                .towards_grid(
                    view.first_pixel.as_vec2().into(),
                    view.cube_face,
                    (target.dims, target.divisor),
                ),
            light: sums(gpu.context, "LightScatter::light", nz, [nx, ny])?,
            weights: sums(gpu.context, "LightScatter::weights", nz, [nx, ny])?,
            dilation: scatter_reach_bricks(&view.frame),
            deposits: sums(gpu.context, "LightScatter::deposits", SLABS_PER_TEXEL, view.frame.size)?,
            divisor: target.divisor,
        })
    }

    /// Splats some slabs and marches light through them.
    #[expect(clippy::too_many_arguments, reason = "what the gathering pass takes, and two more")]
    pub(crate) fn march(
        &self,
        gpu: Gpu<'_>,
        scattering: &Scattering,
        table: &wgpu::Buffer,
        (lamp, settings): (&SceneLight, &Settings),
        view: &LightView,
        sheets: &Sheets,
        slabs: Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Gpu { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&ScatterMarchVariant {
            is_cut: is_cut(settings.cuts.shading()),
            deposit: settings.shadows.deposit,
            sheets: self.scatterer.variant(),
            is_stretched: self.scatterer.widest() > 1.0,
            dilation: self.dilation,
        })?;
        let cut = settings.cuts.shading().region(&gpu.volume.scene);
        let uniform = march_uniform(lamp, &cut, view, sheets, slabs.clone());
        let uniform = context.buffer("LightScatter::march", &[uniform], wgpu::BufferUsages::UNIFORM);
        let mut entries = sheets.march_entries(&uniform, table, &self.distances).to_vec();
        entries.push(buffer("deposits", &self.deposits));
        let own = pass::bind(context, "LightScatter::march", &pipeline, 0, &entries);
        let grid = gpu.uniform("Volume::grid", gpu.volume.grid(0));
        let levels = Levels::of(self.scatterer.widest() > 1.0);
        for k in slabs {
            if self.scatterer.is_filled(k) {
                self.scatterer.splat(gpu, scattering, k, encoder)?;
            }
            let slab = self.scatterer.uniform_buffer(context, k, 1.0);
            let shared = pass::bind(
                context,
                "LightScatter::sheets",
                &pipeline,
                1,
                &[
                    buffer("bound_grid", &grid),
                    view_of("pyramid_texture", levels.choose(&gpu.volume.pyramid_views)),
                    view_of("presence_texture", gpu.presence(levels)),
                    sampler("clamped", &gpu.volume.clamped),
                    buffer("bound_scatter", &slab),
                    buffer("sheets", &self.scatterer.sheets),
                ],
            );
            pass::dispatch(
                encoder,
                "LightScatter::march",
                &pipeline,
                &[&own, &shared],
                pass::tiles(view.frame.size),
            );
        }
        Ok(())
    }

    /// Splats some sheets back into the grid.
    pub(crate) fn splat_back(
        &self,
        gpu: Gpu<'_>,
        sheets: &Sheets,
        slabs: Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Gpu { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&self.scatterer.variant().of("scatter/reverse.wgsl"))?;
        let own = pass::bind(
            context,
            "LightScatter::grid",
            &pipeline,
            0,
            &[
                view_of("distances", &self.distances),
                view_of("ring", &sheets.ring.view),
                buffer("light", &self.light),
                buffer("weights", &self.weights),
            ],
        );
        for k in slabs {
            let slab = self.scatterer.uniform_buffer(context, k, self.divisor as f64);
            let shared = self.scatterer.bind_group(context, &pipeline, &slab, false);
            pass::dispatch(
                encoder,
                "LightScatter::splat_back",
                &pipeline,
                &[&own, &shared],
                pass::tiles(self.scatterer.frame.size),
            );
        }
        Ok(())
    }

    /// Divides light by weights, into the listed bricks of the light volume.
    pub(crate) fn normalise(
        &self,
        gpu: Gpu<'_>,
        target: &LightVolume,
        bricks: &[Listed],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let Gpu { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline_into(&Only("scatter/normalise.wgsl"), target.texture.format())?;
        let list = listed_bricks::upload(gpu, bricks);
        let mut uniform = self.scatterer.uniform(0, 1.0);
        uniform.count = bricks.len() as u32;
        let uniform = context.buffer("LightScatter::normalise", &[uniform], wgpu::BufferUsages::UNIFORM);
        let own = pass::bind(
            context,
            "LightScatter::normalise",
            &pipeline,
            0,
            &[
                buffer("bricks", &list),
                buffer("light", &self.light),
                buffer("weights", &self.weights),
                view_of("attenuation", &target.view),
            ],
        );
        let shared =
            pass::bind(context, "LightScatter::slab", &pipeline, 1, &[buffer("bound_scatter", &uniform)]);
        pass::dispatch(
            encoder,
            "LightScatter::normalise",
            &pipeline,
            &[&own, &shared],
            listed_bricks::workgroups(bricks.len() as u32),
        );
        Ok(())
    }

    /// Returns the size of sheets, light and weights, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.scatterer.bytes() + self.light.size() + self.weights.size() + self.deposits.size()
    }
}
