//! Tiled rendering: pictures of any size, drawn in parts and returned in bands of rows, so that the adapter's texture
//! limits and memory do not limit their size.

use std::borrow::Cow;

use super::part_pages::{BandError, PartPages};
use crate::plan::PixelWindow;
use crate::plan::picture_frame;
use crate::resources::textures::{read_floats, read_texture};
use crate::{RenderOptions, Renderer};
use chiaroscuro_media::PixelRows;
use chiaroscuro_scene::{ImageSpec, PixelFormat, Settings};
use chiaroscuro_volume::{Dataset, Volume, math::SceneSpace};

/// Maximum number of samples in a part: a full-HD picture in one part, and about 100 MiB of textures.
const MAX_PART_SAMPLES: u32 = 1 << 21;

/// Maximum size of a part of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PartLimits {
    /// Maximum number of samples along an edge.
    pub edge: u32,
    /// Maximum number of samples in all.
    pub samples: u32,
}

/// Picture in progress, drawn in bands from the top down.
#[derive(Debug)]
pub struct PictureBands<'a> {
    renderer: &'a mut Renderer,
    dataset: &'a Dataset,
    settings: &'a Settings,
    /// Pages that are read for each part; those of the dataset if `None`.
    pages: Option<PartPages<'a>>,
    spec: ImageSpec,
    /// Width of the margin drawn around each part, in pixels.
    margin: u32,
    /// Bands yet to be drawn, the next one last.
    remaining: Vec<Vec<PixelWindow>>,
    total: usize,
    /// `true` if the volume is not visible in the bands drawn so far.
    is_empty: bool,
}

impl Renderer {
    /// Begins a picture of any size.
    pub fn bands<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        image_spec: &ImageSpec,
    ) -> PictureBands<'a> {
        let longest = self.context().device.limits().max_texture_dimension_2d;
        let largest = PartLimits { edge: longest, samples: MAX_PART_SAMPLES };
        self.bands_within(dataset, settings, image_spec, largest)
    }

    /// Begins a picture in parts of at most the given size.
    pub(crate) fn bands_within<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        image_spec: &ImageSpec,
        largest: PartLimits,
    ) -> PictureBands<'a> {
        let samples = image_spec.samples.max(1);
        let gradients = gradient_margin(dataset.volume(), settings, image_spec.size, samples);
        let margin = gradients.max(edge_margin(settings, samples));
        let longest = (largest.edge / samples).saturating_sub(2 * margin);
        let mut left: Vec<_> =
            PixelWindow::bands(image_spec.size, longest, largest.samples / (samples * samples)).collect();
        left.reverse();
        let total = left.len();
        let image_spec = ImageSpec { samples, ..*image_spec };
        PictureBands {
            renderer: self,
            dataset,
            settings,
            pages: None,
            spec: image_spec,
            margin,
            remaining: left,
            total,
            is_empty: true,
        }
    }
}

/// Number of bands of a picture that were drawn, and of all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BandProgress {
    /// Number of bands that were drawn.
    pub drawn: usize,
    /// Number of all bands.
    pub total: usize,
}

impl<'a> PictureBands<'a> {
    /// Reads the pages of finer levels for each part; parts whose pages do not fit into memory are drawn in halves.
    #[must_use]
    pub fn with_pages(self, pages: Option<PartPages<'a>>) -> Self {
        Self { pages, ..self }
    }

    /// Returns the number of bands drawn, and the total.
    pub fn progress(&self) -> BandProgress {
        BandProgress { drawn: self.total - self.remaining.len(), total: self.total }
    }

    /// Returns true if the volume is not visible in the bands drawn so far.
    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Draws the next band; `None` after the last.
    ///
    /// # Errors
    /// Returns an error if the device fails, memory is exhausted, or pages of finer levels cannot be read.
    pub fn next_rows(&mut self) -> Result<Option<PixelRows>, BandError> {
        let Some(mut parts) = self.remaining.pop() else { return Ok(None) };
        let width = self.spec.size[0] as usize;
        let (top, height) = parts.first().map_or((0, 0), |part| (part.first[1], part.size[1] as usize));
        let channels = 4 * width * height;
        let (mut bytes, mut floats) = (Vec::new(), Vec::new());
        if self.spec.depth == PixelFormat::Eight {
            bytes.resize(channels, 0);
        } else {
            floats.resize(channels, 0.0);
        }
        // Neighbours are drawn one after another, because they share pages.
        parts.reverse();
        while let Some(part) = parts.pop() {
            let drawn = part.widened(self.margin);
            let mut dataset = Cow::Borrowed(self.dataset);
            if let Some(pages) = &mut self.pages {
                let samples = drawn.supersampled(self.spec.samples);
                let Some(read) = pages.dataset(self.dataset, self.settings, part, samples)? else {
                    let [first, second] = part.halves();
                    parts.extend([second, first]);
                    continue;
                };
                dataset = Cow::Owned(read);
            }
            let mut options = RenderOptions::for_image(&self.spec, self.settings);
            options.picture.part = Some(drawn);
            self.renderer.draw(&dataset, self.settings, self.spec.size, &options)?;
            // Tested only until something is visible.
            self.is_empty = self.is_empty && self.renderer.is_picture_empty()?;
            let (context, shown) =
                (self.renderer.context(), &self.renderer.displayed_target()?.display.product.texture);
            if self.spec.depth == PixelFormat::Eight {
                copy_part(&mut bytes, &read_texture(context, shown)?, (width, top), drawn, part);
            } else {
                copy_part(&mut floats, &read_floats(context, shown)?, (width, top), drawn, part);
            }
        }
        Ok(Some(if self.spec.depth == PixelFormat::Eight {
            PixelRows::Bytes(bytes)
        } else {
            PixelRows::Floats(floats)
        }))
    }

    /// Draws all remaining bands at once.
    ///
    /// # Errors
    /// Same as [`Self::next_rows`].
    pub fn all(&mut self) -> Result<PixelRows, BandError> {
        let mut whole = match self.spec.depth {
            PixelFormat::Eight => PixelRows::Bytes(Vec::new()),
            PixelFormat::Sixteen | PixelFormat::Linear => PixelRows::Floats(Vec::new()),
        };
        while let Some(rows) = self.next_rows()? {
            match (&mut whole, rows) {
                (PixelRows::Bytes(all), PixelRows::Bytes(more)) => all.extend(more),
                (PixelRows::Floats(all), PixelRows::Floats(more)) => all.extend(more),
                _ => {}
            }
        }
        Ok(whole)
    }
}

/// Returns the margin that a part needs to find its edges, in pixels: each is found from two samples to all sides.
fn edge_margin(settings: &Settings, samples: u32) -> u32 {
    if settings.rays_per_pixel() > 1 { 2_u32.div_ceil(samples) } else { 0 }
}

/// Returns the margin that a part needs, in pixels: gradients of scattered sheets are differences of neighbouring
/// pixels.
fn gradient_margin(volume: &Volume, settings: &Settings, size: [u32; 2], samples: u32) -> u32 {
    if !settings.uses_scattering_engine() {
        return 0;
    }
    let scene = SceneSpace::new(volume.dims(), volume.world_from_index());
    let fine = PixelWindow::from(size).supersampled(samples);
    let frame = picture_frame(settings, &scene, fine);
    frame.gradient_steps().pixels.div_ceil(samples)
}

/// Copies a part of the drawn texels to its place in a band, which is given by its width and its first row.
fn copy_part<T: Copy>(
    band: &mut [T],
    texels: &[T],
    (width, top): (usize, u32),
    drawn: PixelWindow,
    part: PixelWindow,
) {
    let (left, columns) = (part.first[0] as usize, part.size[0] as usize);
    let [before, above] = [0, 1].map(|axis| (part.first[axis] - drawn.first[axis]) as usize);
    let from = texels.chunks_exact(4 * drawn.size[0] as usize).skip(above);
    let to =
        band.chunks_exact_mut(4 * width).skip((part.first[1] - top) as usize).take(part.size[1] as usize);
    for (to, from) in to.zip(from) {
        to[4 * left..4 * (left + columns)].copy_from_slice(&from[4 * before..4 * (before + columns)]);
    }
}
