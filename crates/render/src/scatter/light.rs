//! Light pass of the scattering engine: splats voxels, marches light through the sheets, splats the sheets back into
//! the grid, and divides by the weights.

use std::ops::Range;

use super::eye::bricks_to_splat;
use super::splat::{ScatterVariant, SheetScatterer, SplatParameters, SplatQuantity, sums};
use super::voxels::ScatterState;
use crate::light::fill_inputs::{LightTables, LightWithSettings};
use crate::light::light_volume::LightVolume;
use crate::light::march::{LightSheets, SLABS_PER_TEXEL, march_uniform};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{
    PipelineVariant, ShaderConstants, SingleVariant, deposit_constant, flag, is_cut,
};
use crate::plan::{BrickSet, LightView, scatter_reach_bricks};
use crate::resources::pass;
use crate::volume::brick_list::{self, BrickEntry};
use crate::volume::transfer_tables::upload_distances;
use crate::volume::{PyramidLevels, VolumeContext};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{DepositMode, Settings, SheetOrder};

/// Pipeline variant of the march over scattered sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ScatterMarchVariant {
    is_cut: bool,
    deposit: DepositMode,
    sheets: ScatterVariant,
    /// `true` if pixels are wider than voxels somewhere.
    is_stretched: bool,
    /// Reach of a sample's kernel, in bricks around its own.
    dilation: i32,
}

impl PipelineVariant for ScatterMarchVariant {
    fn shader(&self) -> &'static str {
        "scatter/light.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
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
pub(crate) struct LightScatterer {
    scatterer: SheetScatterer,
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

/// Light volume into which sheets are splatted back, with the settings of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScatterTarget<'a> {
    pub settings: &'a Settings,
    pub light_volume: &'a LightVolume,
}

impl LightScatterer {
    /// Prepares a view. Sheets are splatted back in the bricks of `read` only, or everywhere without it.
    pub(crate) fn new(
        gpu: VolumeContext<'_>,
        scattering: &ScatterState,
        LightTables { tables, color }: LightTables<'_>,
        view: &LightView,
        ScatterTarget { settings, light_volume: target }: ScatterTarget<'_>,
        read: Option<&BrickSet>,
        options: &RenderOptions,
    ) -> Result<Self, GpuError> {
        let seen = bricks_to_splat(&view.frame, &tables.lighting.occupied_bricks, options);
        let shadows = &settings.shadows;
        let is_pre = settings.classification().is_pre();
        let quantity = if is_pre { SplatQuantity::Extinction } else { SplatQuantity::Density };
        let table = tables.lighting_of_color(color);
        let splat = SplatParameters {
            kernel: shadows.kernel,
            quadrature: shadows.quadrature,
            order: SheetOrder::ImageAligned,
            quantity,
        };
        let [nx, ny, nz] = target.dims.map(|n| n as u32);
        let dims = tables.lighting.occupied_bricks.dims;
        let read_distances = read.map_or_else(|| BrickSet::full(dims).distances(), BrickSet::distances);
        let attenuating_distances = if options.switches.empty_space_skipping {
            tables.lighting.occupied_bricks.distances()
        } else {
            vec![0; read_distances.len()]
        };
        let pairs: Vec<u8> =
            read_distances.into_iter().zip(attenuating_distances).flat_map(|(r, g)| [r, g]).collect();
        Ok(Self {
            distances: upload_distances(
                gpu.context,
                "LightScatter::distances",
                dims,
                &pairs,
                wgpu::TextureFormat::Rg8Uint,
            )?,
            scatterer: SheetScatterer::new(gpu, &scattering.voxels, &view.frame, splat, table, &seen, 1)?
                .with_light_grid(
                    view.first_pixel.as_vec2().into(),
                    view.cube_face,
                    target.dims,
                    target.divisor,
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
        gpu: VolumeContext<'_>,
        scattering: &ScatterState,
        table: &wgpu::Buffer,
        LightWithSettings { light: scene_light, settings }: LightWithSettings<'_>,
        view: &LightView,
        sheets: &LightSheets,
        slabs: Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&ScatterMarchVariant {
            is_cut: is_cut(settings.cuts.shadowing_part()),
            deposit: settings.shadows.deposit,
            sheets: self.scatterer.variant(),
            is_stretched: self.scatterer.max_stretch() > 1.0,
            dilation: self.dilation,
        })?;
        let cut = settings.cuts.shadowing_part().region(&gpu.volume.scene);
        let uniform = march_uniform(scene_light, &cut, view, sheets, slabs.clone());
        let uniform = context.buffer("LightScatter::march", &[uniform], wgpu::BufferUsages::UNIFORM);
        let mut entries = sheets.march_entries(&uniform, table, &self.distances).to_vec();
        entries.push(bind_buffer("deposits", &self.deposits));
        let own = pass::bind(context, "LightScatter::march", &pipeline, 0, &entries);
        let grid = gpu.uniform("Volume::grid", gpu.volume.grid(0));
        let levels = PyramidLevels::for_stretch(self.scatterer.max_stretch() > 1.0);
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
                    bind_buffer("bound_grid", &grid),
                    bind_view("presence_texture", gpu.presence(levels)),
                    sampler("clamped", &gpu.volume.clamped),
                    bind_buffer("bound_scatter", &slab),
                    bind_buffer("sheets", &self.scatterer.sheets),
                ],
            );
            pass::dispatch(
                encoder,
                "LightScatter::march",
                &pipeline,
                &[&own, &shared],
                pass::tile_workgroups(view.frame.size),
            );
        }
        Ok(())
    }

    /// Splats some sheets back into the grid.
    pub(crate) fn splat_back(
        &self,
        gpu: VolumeContext<'_>,
        sheets: &LightSheets,
        slabs: Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let VolumeContext { context, shaders, .. } = gpu;
        let pipeline = shaders.pipeline(&self.scatterer.variant().for_shader("scatter/reverse.wgsl"))?;
        let own = pass::bind(
            context,
            "LightScatter::grid",
            &pipeline,
            0,
            &[
                bind_view("distances", &self.distances),
                bind_view("ring", &sheets.ring.view),
                bind_buffer("light", &self.light),
                bind_buffer("weights", &self.weights),
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
                pass::tile_workgroups(self.scatterer.frame.size),
            );
        }
        Ok(())
    }

    /// Divides light by weights, into the listed bricks of the light volume.
    pub(crate) fn normalise(
        &self,
        gpu: VolumeContext<'_>,
        target: &LightVolume,
        bricks: &[BrickEntry],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let VolumeContext { context, shaders, .. } = gpu;
        let pipeline =
            shaders.pipeline_into(&SingleVariant("scatter/normalise.wgsl"), target.texture.format())?;
        let list = brick_list::upload_bricks(gpu, bricks);
        let mut uniform = self.scatterer.uniform(0, 1.0);
        uniform.count = bricks.len() as u32;
        let uniform = context.buffer("LightScatter::normalise", &[uniform], wgpu::BufferUsages::UNIFORM);
        let own = pass::bind(
            context,
            "LightScatter::normalise",
            &pipeline,
            0,
            &[
                bind_buffer("bricks", &list),
                bind_buffer("light", &self.light),
                bind_buffer("weights", &self.weights),
                bind_view("attenuation", &target.view),
            ],
        );
        let shared = pass::bind(
            context,
            "LightScatter::slab",
            &pipeline,
            1,
            &[bind_buffer("bound_scatter", &uniform)],
        );
        pass::dispatch(
            encoder,
            "LightScatter::normalise",
            &pipeline,
            &[&own, &shared],
            brick_list::two_workgroups_per_brick(bricks.len() as u32),
        );
        Ok(())
    }

    /// Returns the size of sheets, light and weights, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.scatterer.bytes() + self.light.size() + self.weights.size() + self.deposits.size()
    }
}
