//! Request to the renderer: volume, look, size and options of a picture.

use std::borrow::Cow;

use super::{PixelWindow, shows_pages};
use chiaroscuro_scene::{
    ImageSpec, LayerComposition, LightVolumeResolution, OutputSettings, PixelFormat, Settings,
};
use chiaroscuro_volume::{DensityMapping, MAX_FIELDS, PagesId, VolumeId};

/// Request for a picture: the volume, its look and the size.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderRequest {
    /// Identity of the volume (`Volume::id`), which changes with its voxels and its geometry.
    pub volume: VolumeId,
    /// Complete look of the picture.
    pub settings: Settings,
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Resolution for previews, at which missing light volumes may be filled.
    pub preview_resolution: Option<LightVolumeResolution>,
}

/// Identity of a volume as a picture shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeKey {
    /// Content hash of the volume, `Volume::content_id`.
    pub content_id: u64,
    /// Quantity that densities from 0 to 1 represent.
    pub density_mapping: DensityMapping,
    /// Quantities that densities of the further fields represent, which are shown as layers.
    pub further: [Option<DensityMapping>; MAX_FIELDS - 1],
    /// Hash of the cuts that hide voxels, if there are some.
    pub mask: Option<u64>,
    /// Layers that the cuts leave whole, a bit for each.
    pub never_cut: u8,
    /// Way in which layers become one picture; if not by the first alone, their fields are stored together.
    pub composition: LayerComposition,
}

impl VolumeKey {
    /// Returns the quantities that densities represent, one for each field that is shown.
    pub fn density_mappings(&self) -> impl Iterator<Item = DensityMapping> {
        [Some(self.density_mapping)].into_iter().chain(self.further).map_while(|mapping| mapping)
    }
}

impl RenderRequest {
    /// Returns the identity of the volume as this picture shows it.
    pub fn volume_key(&self) -> VolumeKey {
        let VolumeId { content_id, ranges, .. } = self.volume;
        VolumeKey {
            content_id,
            density_mapping: self.settings.shown_content(&ranges),
            further: self.settings.further_mappings(&self.volume),
            mask: self.settings.cuts.shapes_id(),
            never_cut: self.settings.layers_never_cut(),
            composition: self.settings.layer_composition(),
        }
    }

    /// Returns the identity of the pages of finer levels that the picture may read.
    pub fn shown_pages(&self) -> PagesId {
        if shows_pages(&self.settings) { self.volume.pages } else { PagesId::default() }
    }

    /// Returns the request with the settings of its mode ([`Settings::resolved_mode`]).
    pub(crate) fn resolved_mode(&self) -> Cow<'_, Self> {
        match self.settings.resolved_mode() {
            Cow::Borrowed(_) => Cow::Borrowed(self),
            Cow::Owned(settings) => Cow::Owned(Self { settings, ..self.clone() }),
        }
    }
}

/// Options of rendering that are not part of the look, by who sets them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RenderOptions {
    /// Kind of picture, set by the window, an export or a command.
    pub picture: PictureOptions,
    /// Amount and extent of the work for it, set for previews and first looks, reports, and exports of light volumes.
    pub work: WorkOptions,
    /// Switches for tests and measurements.
    pub switches: TestSwitches,
}

/// Options of the picture that is made, beside its look and size.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// Omit the background and write straight (not premultiplied) alpha.
    pub transparent: bool,
    /// Exposure, a factor of all displayed light that leaves linear light unchanged; previews need it.
    pub exposure: f32,
    /// Part of the picture to draw, if not all of it.
    pub part: Option<PixelWindow>,
    /// Number of samples per pixel along an edge.
    pub samples: u32,
    /// Number of rays through each sample at edges, for antialiasing; 1 for the ray through its middle alone.
    pub rays: u32,
    /// Bit depth of the displayed picture.
    pub depth: PixelFormat,
}

/// Options of the work for a picture: shortcuts, waits and the extent of light volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkOptions {
    /// Use shortcuts with stretched kernels that only previews may take: normals from the gradient texture, and
    /// kernels without their outermost tails.
    pub preview: bool,
    /// Sample light at points however wide pixels are, with the shaders of larger pictures: for means over a picture,
    /// which sharp kernels do not change.
    pub point_samples: bool,
    /// Number of parts into which each chunk of the light pass is divided, for short submissions.
    pub light_parts: u32,
    /// Wait after every step, so that the durations of stages in a report are exact.
    pub timed: bool,
    /// Fill light volumes everywhere, not only where the picture looks them up.
    pub fill_all_light_voxels: bool,
}

/// Switches that only tests and measurements set, to compare a picture with one made without a saving.
#[derive(Debug, Clone, PartialEq)]
pub struct TestSwitches {
    /// Skip empty space, which changes no displayed byte; light volumes may differ in their last bits.
    pub empty_space_skipping: bool,
    /// Minimum transmittance, below which a ray to the eye or from a light ends.
    pub min_transmittance: f32,
    /// Number of slabs per chunk of the light march, in place of the choice by memory and time.
    pub chunk: Option<u32>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { transparent: false, exposure: 1.0, part: None, samples: 1, rays: 1, depth: PixelFormat::Eight }
    }
}

impl Default for WorkOptions {
    fn default() -> Self {
        Self {
            preview: false,
            point_samples: false,
            light_parts: 1,
            timed: false,
            fill_all_light_voxels: false,
        }
    }
}

impl Default for TestSwitches {
    fn default() -> Self {
        // 1/16 of an 8-bit step.
        Self { empty_space_skipping: true, min_transmittance: 1.0 / 4096.0, chunk: None }
    }
}

impl From<PictureOptions> for RenderOptions {
    fn from(picture: PictureOptions) -> Self {
        Self { picture, ..Self::default() }
    }
}

impl From<WorkOptions> for RenderOptions {
    fn from(work: WorkOptions) -> Self {
        Self { work, ..Self::default() }
    }
}

impl From<TestSwitches> for RenderOptions {
    fn from(switches: TestSwitches) -> Self {
        Self { switches, ..Self::default() }
    }
}

impl RenderOptions {
    /// Creates the options for an exported image of a look.
    pub fn for_image(image_spec: &ImageSpec, settings: &Settings) -> Self {
        let ImageSpec { size: _, transparent, samples, depth, marks: _ } = *image_spec;
        let rays = settings.rays_per_pixel();
        PictureOptions { transparent, samples, rays, depth, ..PictureOptions::default() }.into()
    }

    /// Returns the number of rays through each sample at edges: one with the scattering engine, which draws whole
    /// sheets.
    pub fn rays_per_sample(&self, request: &RenderRequest) -> u32 {
        let scatters = request.settings.uses_scattering_engine();
        if scatters { 1 } else { OutputSettings::nearest_antialiasing(self.picture.rays) }
    }

    /// Returns the part of a picture that is displayed.
    pub fn displayed_window(&self, request: &RenderRequest) -> PixelWindow {
        self.picture.part.unwrap_or_else(|| request.size.into())
    }

    /// Returns the samples that are drawn for the displayed part.
    pub fn sample_window(&self, request: &RenderRequest) -> PixelWindow {
        self.displayed_window(request).supersampled(self.picture.samples)
    }
}

impl TestSwitches {
    /// Returns the optical depth that corresponds to [`Self::min_transmittance`].
    pub fn max_optical_depth(&self) -> f32 {
        // A minimum transmittance of 0 is never reached by 32-bit optical depths.
        if self.min_transmittance > 0.0 { -self.min_transmittance.ln() } else { f32::MAX }
    }
}
