//! Test hooks of the renderer: damaged volumes, single sheets, parts of any size.

use std::sync::Arc;

use super::tiled::PartLimits;
use super::tiled::PictureBands;
use crate::light::fill_inputs::{LightTables, LightWithSettings};
use crate::light::march::{LightSheets, march};
use crate::plan::{BouncesKey, MAX_CELL_DISTANCE, MarchTiles, RenderRequest, SkyKey, light_views};
use crate::resources::gpu_tools::GpuTools;
use crate::resources::textures::read_floats;
use crate::scatter::light::{LightScatterer, ScatterTarget};
use crate::scatter::voxels::ScatterState;
use crate::sky::block_texture::BlockTexture;
use crate::volume::VolumeContext;
use crate::{GpuError, RenderOptions, Renderer, WorkOptions};
use chiaroscuro_scene::{ImageSpec, Settings};
use chiaroscuro_volume::{CELL_EDGE, Dataset};

impl Renderer {
    /// Begins a picture like [`Self::bands`], in parts of at most `edge` samples along an edge and `samples` in all.
    pub fn bands_with_limits<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        spec: &ImageSpec,
        edge: u32,
        samples: u32,
    ) -> PictureBands<'a> {
        self.bands_within(dataset, settings, spec, PartLimits { edge, samples })
    }

    /// Overwrites a light's attenuation volume, which must be complete, with zeros. Tests use it to detect if a
    /// change refills the volume.
    pub fn corrupt_attenuation(&mut self, request: &RenderRequest, light: usize) -> bool {
        let Some(found) = self.light_volume(request, light) else { return false };
        let texel = found.texture.format().block_copy_size(None).unwrap_or(2);
        let [nx, ny, _] = found.dims.map(|n| n as u32);
        let zeros = vec![0u8; (found.bytes()) as usize];
        self.context().queue.write_texture(
            found.texture.as_image_copy(),
            &zeros,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(texel * nx),
                rows_per_image: Some(ny),
            },
            found.texture.size(),
        );
        self.targets.invalidate();
        true
    }

    /// Returns the sky visibility of each block of voxels: V₁ along x, y and z of the scene, and V₀.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn sky_visibility(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let none = || GpuError::NothingDrawn("sky");
        let request = self.drawn_request(dataset, settings)?;
        let key = SkyKey::new(&request).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.product;
        let found = loaded.skies.iter().find(|sky| sky.is_valid_for(&key)).ok_or_else(none)?;
        self.texels(&found.product.blocks.view)
    }

    /// Draws a picture, and returns the sky visibility of the blocks that it looks up, V₁ along x, y and z of the scene
    /// and V₀; `None` for all others.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn needed_sky_visibility(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
    ) -> Result<Vec<Option<[f32; 4]>>, GpuError> {
        let none = || GpuError::NothingDrawn("sky");
        let settings = settings.resolved_for_dataset(dataset).into_owned();
        self.draw(dataset, &settings, size, &RenderOptions::default())?;
        let request = RenderRequest { volume: dataset.id(), settings, size, preview_resolution: None };
        let key = SkyKey::new(&request).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.product;
        let found = loaded.skies.iter().find(|sky| sky.is_valid_for(&key)).ok_or_else(none)?;
        let BlockTexture { dims: [nx, ny, _], ref view, .. } = found.product.blocks;
        let filled = &found.product.filled_cells;
        let moments = self.texels(view)?.into_iter().enumerate();
        let is_filled =
            |at: usize| filled.contains([at % nx, at / nx % ny, at / (nx * ny)].map(|n| n / CELL_EDGE));
        Ok(moments.map(|(at, moment)| is_filled(at).then_some(moment)).collect())
    }

    /// Returns the scattered light of each block of voxels: linear RGB, and 1.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn scattered_light(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let none = || GpuError::NothingDrawn("scattering");
        let request = self.drawn_request(dataset, settings)?;
        let key = BouncesKey::new(&request).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.product;
        let found = loaded.bounces.iter().find(|bounces| bounces.is_valid_for(&key)).ok_or_else(none)?;
        self.texels(&found.product.blocks.view)
    }

    /// Draws a small picture with light volumes filled everywhere, and returns its request.
    fn drawn_request(&mut self, dataset: &Dataset, settings: &Settings) -> Result<RenderRequest, GpuError> {
        let options =
            RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
        let settings = &*settings.resolved_for_dataset(dataset);
        let size = [8, 8];
        self.draw(dataset, settings, size, &options)?;
        Ok(RenderRequest { volume: dataset.id(), settings: settings.clone(), size, preview_resolution: None })
    }

    /// Reads back the texels of a texture with four channels.
    fn texels(&self, view: &wgpu::TextureView) -> Result<Vec<[f32; 4]>, GpuError> {
        let floats = read_floats(self.context(), view.texture())?;
        Ok(floats.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect())
    }

    /// Returns the sheets of one view of a light: the transmittance that each slab deposits, sheet by sheet from
    /// front to back, each row by row. For small volumes, because all sheets are held at once.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn light_sheets(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        light: usize,
        view: usize,
    ) -> Result<Vec<f32>, GpuError> {
        let size = [8, 8];
        let settings = &*settings.resolved_for_dataset(dataset);
        self.draw(dataset, settings, size, &RenderOptions::default())?;
        let request = RenderRequest {
            volume: dataset.id(),
            settings: settings.clone(),
            size,
            preview_resolution: None,
        };
        let none = || GpuError::NothingDrawn("light volume");
        let target = self.light_volume(&request, light).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.product;
        let (gpu, tables) = (VolumeContext::for_light(&self.tools, &loaded.volume), &loaded.tables.product);
        let scene_light = settings.lights[light].resolve(&settings.camera);
        let geometry = &light_views(&scene_light, &settings.shadows, &gpu.volume.scene)[view];
        let count = geometry.frame.slab_count;
        // Separate tools, so that their pool does not leave this ring to later pictures.
        let tools = GpuTools::new(self.context(), self.tools.shaders.clone())?;
        let sheets = LightSheets::new(&tools, geometry, count, i32::from(MAX_CELL_DISTANCE))?;
        let mut encoder =
            self.context().device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let source = LightWithSettings { light: &scene_light, settings };
        let white = LightTables { tables, color: None };
        if let Some(voxels) = loaded.scatter_voxels.as_ref().filter(|_| settings.uses_scattering_engine()) {
            let scattering = ScatterState::new(self.context(), Arc::clone(voxels));
            let target = ScatterTarget { settings, light_volume: target };
            let options = RenderOptions::default();
            let scatter = LightScatterer::new(gpu, &scattering, white, geometry, target, None, &options)?;
            let table = &tables.lighting.buffer;
            scatter.march(gpu, &scattering, table, source, geometry, &sheets, 0..count, &mut encoder)?;
        } else {
            let tiles = MarchTiles::all(geometry, sheets.chunk);
            march(gpu, white, source, geometry, &sheets, 0..count, tiles.chunk(0), &mut encoder)?;
        }
        self.context().queue.submit([encoder.finish()]);
        // Four slabs per texel, in a texture that may be larger than the sheets.
        let texels = read_floats(self.context(), &sheets.ring.texture)?;
        let (columns, rows) = (sheets.ring.texture.width() as usize, sheets.ring.texture.height() as usize);
        let [width, height] = geometry.frame.size.map(|n| n as usize);
        let texels = texels.as_slice();
        let of_slab = |k: usize| {
            let row = move |j: usize| &texels[(k / 4 * rows + j) * columns * 4..][..4 * width];
            (0..height).map(row).flat_map(move |row| row.iter().skip(k % 4).step_by(4).copied())
        };
        Ok((0..count as usize).flat_map(of_slab).collect())
    }
}
