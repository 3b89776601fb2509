//! What is asked of the renderer: which volume, which look, how large, and how it is to be computed.

use super::PixelWindow;
use crate::data::{Shown, VolumeId};
use crate::model::{Depth, ImageSpec, Resolution, Settings};

/// A picture to be made: of which volume, how, and how large.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// `Volume::id`, which changes with its voxels and its geometry.
    pub volume: VolumeId,
    /// The whole look.
    pub settings: Settings,
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Previews: light volumes that are not there yet may be filled at this resolution.
    pub coarse: Option<Resolution>,
}

/// A volume as pictures show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeKey {
    /// `Volume::content_id`.
    pub content_id: u64,
    /// What densities from 0 to 1 stand for.
    pub shown: Shown,
}

impl Request {
    /// The volume as this picture shows it.
    pub fn shown_volume(&self) -> VolumeKey {
        let VolumeId { content_id, ranges, .. } = self.volume;
        VolumeKey { content_id, shown: self.settings.shown(&ranges) }
    }
}

/// Ways of rendering that are no part of the look.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Leave out the background, write straight alpha.
    pub transparent: bool,
    /// Multiplies all light of what is shown; the light itself stays as it is. Previews need it.
    pub exposure: f32,
    /// Skip empty space. Only a test that it changes nothing, and a measurement of what it saves, switch it off.
    pub empty_space_skipping: bool,
    /// Fill light volumes everywhere, not only where the picture looks them up.
    pub fill_everything: bool,
    /// A ray ends when less than this is left of its light, to the eye or from a light.
    pub min_transmittance: f32,
    /// Slabs per chunk of the light march, instead of what memory and time suggest.
    pub chunk: Option<u32>,
    /// Pieces into which each chunk of the light pass is cut, for short submissions.
    pub light_parts: u32,
    /// Take shortcuts with stretched kernels that only previews may: normals from the texture of gradients,
    /// and nothing of their outermost tails.
    pub preview: bool,
    /// Wait after every step, so that a report's stages are true.
    pub timed: bool,
    /// The part of the picture that is drawn, if not all of it.
    pub part: Option<PixelWindow>,
    /// Samples of a pixel along an edge.
    pub samples: u32,
    /// What is shown.
    pub depth: Depth,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            transparent: false,
            exposure: 1.0,
            empty_space_skipping: true,
            fill_everything: false,
            // 1/16 of an 8-bit step.
            min_transmittance: 1.0 / 4096.0,
            chunk: None,
            light_parts: 1,
            preview: false,
            timed: false,
            part: None,
            samples: 1,
            depth: Depth::Eight,
        }
    }
}

impl RenderOptions {
    /// What a picture is drawn with that is taken like this.
    pub fn of_shot(shot: &ImageSpec) -> Self {
        let ImageSpec { size: _, transparent, samples, depth, marks: _ } = *shot;
        Self { transparent, samples, depth, ..Self::default() }
    }

    /// The part of a picture that is shown.
    pub fn shown(&self, request: &Request) -> PixelWindow {
        self.part.unwrap_or_else(|| request.size.into())
    }

    /// The samples that are drawn for the part that is shown.
    pub fn window(&self, request: &Request) -> PixelWindow {
        self.shown(request).finer(self.samples)
    }

    /// The optical depth at which [`Self::min_transmittance`] is left.
    pub fn max_optical_depth(&self) -> f32 {
        // No 32-bit optical depth is beyond that of nothing at all.
        if self.min_transmittance > 0.0 { -self.min_transmittance.ln() } else { f32::MAX }
    }
}
