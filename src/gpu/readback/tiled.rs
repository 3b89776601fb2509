//! Pictures of any size: drawn in parts, handed over in bands of rows, so that neither the adapter's largest
//! texture nor its memory limits them.

use crate::data::{Dataset, Volume};
use crate::export::Rows;
use crate::gpu::resources::readback::{read_floats, read_texture};
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::math::SceneSpace;
use crate::model::{Depth, ImageSpec, Settings};
use crate::plan::PixelWindow;
use crate::plan::picture_frame;

/// Most samples of a part: a picture of high-definition television in one part, and about 100 MiB of textures.
const MOST_SAMPLES: u32 = 1 << 21;

/// How large a part of a picture may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LargestPart {
    /// Samples along an edge.
    pub edge: u32,
    /// Samples in all.
    pub samples: u32,
}

/// A picture that is being made, from the top down.
#[derive(Debug)]
pub struct Bands<'a> {
    renderer: &'a mut Renderer,
    dataset: &'a Dataset,
    settings: &'a Settings,
    shot: ImageSpec,
    /// Pixels that are drawn around each part.
    margin: u32,
    /// Those that are left, the next one last.
    left: Vec<Vec<PixelWindow>>,
    total: usize,
    /// Nothing of the volume is seen in the parts that are done.
    is_empty: bool,
}

impl Renderer {
    /// Begins a picture of any size.
    pub fn bands<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        shot: &ImageSpec,
    ) -> Bands<'a> {
        let longest = self.context().device.limits().max_texture_dimension_2d;
        let largest = LargestPart { edge: longest, samples: MOST_SAMPLES };
        self.bands_within(dataset, settings, shot, largest)
    }

    /// Begins a picture in parts whose edges have no more than so many samples, and which have no more than so many
    /// in all.
    pub(crate) fn bands_within<'a>(
        &'a mut self,
        dataset: &'a Dataset,
        settings: &'a Settings,
        shot: &ImageSpec,
        largest: LargestPart,
    ) -> Bands<'a> {
        let samples = shot.samples.max(1);
        let margin = margin(dataset.volume(), settings, shot.size, samples);
        let longest = (largest.edge / samples).saturating_sub(2 * margin);
        let mut left: Vec<_> =
            PixelWindow::bands(shot.size, longest, largest.samples / (samples * samples)).collect();
        left.reverse();
        let total = left.len();
        let shot = ImageSpec { samples, ..*shot };
        Bands { renderer: self, dataset, settings, shot, margin, left, total, is_empty: true }
    }
}

impl Bands<'_> {
    /// How many bands are done, of how many.
    pub fn progress(&self) -> (usize, usize) {
        (self.total - self.left.len(), self.total)
    }

    /// Whether nothing of the volume is seen in the bands that are done.
    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Draws the next band. `None` after the last.
    ///
    /// # Errors
    /// When the GPU cannot do it.
    pub fn next_rows(&mut self) -> Result<Option<Rows>, GpuError> {
        let Some(parts) = self.left.pop() else { return Ok(None) };
        let width = self.shot.size[0] as usize;
        let height = parts.first().map_or(0, |part| part.size[1] as usize);
        let channels = 4 * width * height;
        let (mut bytes, mut floats) = (Vec::new(), Vec::new());
        if self.shot.depth == Depth::Eight {
            bytes.resize(channels, 0);
        } else {
            floats.resize(channels, 0.0);
        }
        for part in parts {
            let drawn = part.widened(self.margin);
            let options = RenderOptions { part: Some(drawn), ..RenderOptions::of_shot(&self.shot) };
            self.renderer.draw(self.dataset, self.settings, self.shot.size, &options)?;
            // When something is seen, nobody asks any more.
            self.is_empty = self.is_empty && self.renderer.is_picture_empty()?;
            let (context, shown) = (self.renderer.context(), &self.renderer.shown()?.shown.value.texture);
            if self.shot.depth == Depth::Eight {
                lay(&mut bytes, &read_texture(context, shown)?, width, drawn, part);
            } else {
                lay(&mut floats, &read_floats(context, shown)?, width, drawn, part);
            }
        }
        Ok(Some(if self.shot.depth == Depth::Eight { Rows::Bytes(bytes) } else { Rows::Floats(floats) }))
    }

    /// All that is left of the picture at once.
    ///
    /// # Errors
    /// As [`Self::next_rows`].
    pub fn all(mut self) -> Result<Rows, GpuError> {
        let mut whole = match self.shot.depth {
            Depth::Eight => Rows::Bytes(Vec::new()),
            Depth::Sixteen | Depth::Linear => Rows::Floats(Vec::new()),
        };
        while let Some(rows) = self.next_rows()? {
            match (&mut whole, rows) {
                (Rows::Bytes(all), Rows::Bytes(more)) => all.extend(more),
                (Rows::Floats(all), Rows::Floats(more)) => all.extend(more),
                _ => {}
            }
        }
        Ok(whole)
    }
}

/// Pixels around a part that its own need: gradients of scattered sheets are differences of neighbours.
fn margin(volume: &Volume, settings: &Settings, size: [u32; 2], samples: u32) -> u32 {
    if !settings.scatters() {
        return 0;
    }
    let scene = SceneSpace::new(volume.dims(), volume.world_from_index());
    let fine = PixelWindow::from(size).finer(samples);
    let frame = picture_frame(settings, &scene, fine);
    frame.gradient_steps().0.div_ceil(samples)
}

/// Puts a part of what was drawn into its place in a band.
fn lay<T: Copy>(band: &mut [T], texels: &[T], width: usize, drawn: PixelWindow, part: PixelWindow) {
    let (left, columns) = (part.first[0] as usize, part.size[0] as usize);
    let [before, above] = [0, 1].map(|axis| (part.first[axis] - drawn.first[axis]) as usize);
    let rows = texels.chunks_exact(4 * drawn.size[0] as usize).skip(above);
    for (to, from) in band.chunks_exact_mut(4 * width).zip(rows) {
        to[4 * left..4 * (left + columns)].copy_from_slice(&from[4 * before..4 * (before + columns)]);
    }
}
