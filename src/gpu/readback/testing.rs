//! Test hooks of the renderer: damaged volumes, single sheets, parts of any size.

use std::sync::Arc;

use super::tiled::Bands;
use super::tiled::LargestPart;
use crate::data::Dataset;
use crate::gpu::light::march::{Sheets, march};
use crate::gpu::resources::readback::read_floats;
use crate::gpu::resources::tools::Tools;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::scatter::voxels::Scattering;
use crate::gpu::volume::Gpu;
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::model::{ImageSpec, Settings};
use crate::plan::{BouncesKey, FARTHEST, MarchTiles, Request, SkyKey, light_views};

impl Renderer {
    /// Begins a picture like [`Self::bands`], in parts of at most `edge` samples along an edge and `samples` in all.
    pub fn bands_of<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        shot: &ImageSpec,
        edge: u32,
        samples: u32,
    ) -> Bands<'a> {
        self.bands_within(dataset, settings, shot, LargestPart { edge, samples })
    }

    /// Overwrites a light's attenuation volume, which must be complete, with zeros. Tests use it to detect if a
    /// change refills the volume.
    pub fn corrupt_attenuation(&mut self, request: &Request, light: usize) -> bool {
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
        self.targets.forget();
        true
    }

    /// Returns the sky visibility of each block of voxels: V₁ along x, y and z of the scene, and V₀.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn openness(&mut self, dataset: &Dataset, settings: &Settings) -> Result<Vec<[f32; 4]>, GpuError> {
        let none = || GpuError::NothingDrawn("sky");
        let request = self.drawn_request(dataset, settings)?;
        let key = SkyKey::of(&request).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.value;
        let found = loaded.skies.iter().find(|sky| sky.holds(&key)).ok_or_else(none)?;
        self.texels(&found.value.view)
    }

    /// Returns the scattered light of each block of voxels: linear RGB, and 1.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn bounced(&mut self, dataset: &Dataset, settings: &Settings) -> Result<Vec<[f32; 4]>, GpuError> {
        let none = || GpuError::NothingDrawn("scattering");
        let request = self.drawn_request(dataset, settings)?;
        let key = BouncesKey::of(&request).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.value;
        let found = loaded.bounces.iter().find(|bounces| bounces.holds(&key)).ok_or_else(none)?;
        self.texels(&found.value.view)
    }

    /// Draws a small picture with light volumes filled everywhere, and returns its request.
    fn drawn_request(&mut self, dataset: &Dataset, settings: &Settings) -> Result<Request, GpuError> {
        let options = RenderOptions { fill_everything: true, ..RenderOptions::default() };
        let settings = &*settings.as_drawn(dataset.volume());
        let size = [8, 8];
        self.draw(dataset, settings, size, &options)?;
        Ok(Request { volume: dataset.volume().id(), settings: settings.clone(), size, coarse: None })
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
        let settings = &*settings.as_drawn(dataset.volume());
        self.draw(dataset, settings, size, &RenderOptions::default())?;
        let request =
            Request { volume: dataset.volume().id(), settings: settings.clone(), size, coarse: None };
        let none = || GpuError::NothingDrawn("light volume");
        let target = self.light_volume(&request, light).ok_or_else(none)?;
        let loaded = &self.loaded.as_ref().ok_or_else(none)?.value;
        let (gpu, tables) = (Gpu::new(&self.tools, &loaded.volume), &loaded.tables.value);
        let lamp = settings.lights[light].in_scene(&settings.camera);
        let geometry = &light_views(&lamp, &settings.shadows, &gpu.volume.scene)[view];
        let count = geometry.frame.slab_count;
        // Separate tools, so that their pool does not leave this ring to later pictures.
        let tools = Tools::new(self.context(), self.tools.shaders.clone())?;
        let sheets = Sheets::new(&tools, geometry, count, i32::from(FARTHEST))?;
        let mut encoder =
            self.context().device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let lamp = (&lamp, settings);
        if let Some(voxels) = loaded.voxels.as_ref().filter(|_| settings.scatters()) {
            let scattering = Scattering::new(self.context(), Arc::clone(voxels));
            let of_light = (settings, target);
            let options = RenderOptions::default();
            let scatter =
                LightScatter::new(gpu, &scattering, (tables, None), geometry, of_light, None, &options)?;
            let table = &tables.lighting.buffer;
            scatter.march(gpu, &scattering, table, lamp, geometry, &sheets, 0..count, &mut encoder)?;
        } else {
            let tiles = MarchTiles::all(geometry, sheets.chunk);
            march(gpu, (tables, None), lamp, geometry, &sheets, 0..count, tiles.of_chunk(0), &mut encoder)?;
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
