//! Reference renderer in f64, slow and readable, with which the GPU is compared stage by stage.
//!
//! It follows the paper literally (P §3.5, figure 3): sheet buffers are filled by splatting voxels, composited as
//! seen from the light, splatted back into a light volume and normalised; then sheets are composited for the eye.
//! [`ReferenceWeights::Footprint`] does this; [`ReferenceWeights::Gather`] computes the same sums by gathering, with
//! the weights of the GPU, which must then agree to rounding. There is no empty-space skipping and no early ray
//! termination. Only `plan` of chiaroscuro-render is imported, not its passes, or comparing would prove nothing.
//!
//! Begin with [`Reference::picture`] in `eye/mod.rs`. The table says where each stage is computed, and which function
//! returns its result.
//!
//! | stage | file | to compare |
//! |---|---|---|
//! | prefiltered volume and its pyramid | `field/pyramid` | [`Reference::density`] |
//! | voxels composed of layers | `field/layers` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | pre-classified voxels | `field/classified` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | densities of sheets | `gather`, `footprint`, `sheet_stack` | [`Reference::eye_sheet`] |
//! | presence: grid and missing voxels | `extent/presence` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | crop box and clip plane | `extent/cut` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | march of light | `light_march` | [`Reference::light_sheets`] |
//! | reverse splat | `back_project` | [`Reference::back_project`], [`Reference::attenuation`] |
//! | weights of points on surfaces | `extent/point_weights`, `extent/surface_normals` | [`Reference::attenuation`] |
//! | rays to the light | `shadow_ray` | [`Reference::attenuation`], [`Reference::picture`] |
//! | sky visibility and light | `indirect/sky` | [`Reference::sky_visibility`], [`Reference::picture`] |
//! | bounced light | `indirect/bounces` | [`Reference::bounced_light`], [`Reference::picture`] |
//! | the floor | `floor` | [`Reference::floor`] |
//! | shading, compositing | `shade`, `eye` | [`Reference::picture`] |

mod back_project;
mod extent;
mod eye;
mod field;
mod floor;
mod footprint;
mod gather;
mod indirect;
mod kernel;
mod light_march;
mod shade;
mod shadow_ray;
mod sheet_stack;
#[cfg(test)]
mod tests;

pub use back_project::AttenuationVolume;
pub use field::pyramid::Pyramid;
pub use field::{DensityField, Rounding};
pub use indirect::bounces::{BouncedLight, ScatteringMedium};
pub use indirect::sky::SkyVisibility;
pub use kernel::{cubic_b_spline, gaussian, tent};
pub use light_march::ViewSheets;

use std::sync::Arc;

use glam::DVec3;

use chiaroscuro_scene::{
    BakedTransfer, LayerComposition, LightVolumeResolution, ReconstructionKernel, SceneLight, Settings,
    VolumeLayer, mask_from_shapes,
};
use chiaroscuro_volume::{Dataset, ValueRange, Volume, math::SceneSpace};
use extent::presence_pyramids::PresencePyramids;
use field::classified::{ALL_TRANSFER_SIDES, ClassifiedVoxels, TransferSide};
use field::layers::{composed_voxels, tint_voxels};
use kernel::KernelProfile;

/// Weights with which densities and light are summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReferenceWeights {
    /// Weights of the GPU: kernels evaluated at one or two points per slab, normalised to sum to 1.
    #[default]
    Gather,
    /// Weights of the paper: kernel slices integrated over the slab, not normalised when splatted into the sheet.
    Footprint,
    /// Weights of the scattering engine: a round Gaussian's slices integrated over the slab, other kernels evaluated
    /// at one or two points per slab, neither normalised when splatted into the sheet.
    Scatter,
}

/// Deliberate fault. Tests use it to prove that a comparison with the GPU, or a check against a closed form, can
/// fail; each is visible only where the faulty quantity matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReferenceFault {
    /// No fault: the correct reference.
    #[default]
    None,
    /// All kernels are 5 % wider: affects every stage where densities or light vary.
    WiderKernel,
    /// Sheets deposit the transmittance behind their slab, whatever the settings say.
    DepositAfter,
    /// The reverse splat is not divided by its sum of weights. Weights of the B-spline sum to 1 anyway if the kernel
    /// is one pixel and one slab wide: the fault shows with another slab thickness, another kernel or a perspective
    /// light.
    NoDivision,
    /// Slabs are as thick for oblique rays as for straight ones: affects only perspective eyes and lights.
    NoObliquity,
    /// Normals point inwards: affects only specular light, since diffuse light is two-sided.
    FlippedNormal,
    /// Partly cut slabs count as whole: affects only cut volumes.
    WholeSlabs,
    /// Densities are looked up half a voxel further along x.
    ShiftedKernel,
}

/// Options of a reference renderer.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReferenceOptions {
    /// Weights of the sums; [`ReferenceWeights::Gather`] stands for those of the engine in the settings.
    pub weights: ReferenceWeights,
    /// Deliberate fault, if any.
    pub fault: ReferenceFault,
    /// Rounding of densities and of the prefiltered volume's levels when stored; `None` for none.
    pub rounding: Option<Rounding>,
    /// Colour channel of light that is followed under coloured shadows: red, green or blue. Only this channel of the
    /// picture is valid ([`merge_color_channels`]).
    pub color: Option<usize>,
}

/// Combines a picture under coloured shadows from pictures of the three channels, which are independent of each
/// other. The coverage is the same in all.
pub fn merge_color_channels(picture: impl Fn(usize) -> Vec<[f64; 4]>) -> Vec<[f64; 4]> {
    let [red, green, blue] = [0, 1, 2].map(picture);
    let joined = |((r, g), b): ((&[f64; 4], &[f64; 4]), &[f64; 4])| [r[0], g[1], b[2], r[3]];
    red.iter().zip(&green).zip(&blue).map(joined).collect()
}

/// Volume with its look, ready to be rendered.
#[derive(Debug, Clone)]
pub struct Reference<'a> {
    settings: &'a Settings,
    options: ReferenceOptions,
    scene: SceneSpace,
    range: ValueRange,
    field: DensityField,
    pyramid: Pyramid,
    /// Presence pyramids, if voxels are missing or hidden.
    presence: Option<PresencePyramids>,
    /// Pre-classified voxels of the eye and of light, if voxels are classified before kernels spread them.
    classified: Option<Box<[ClassifiedVoxels; 3]>>,
    /// Tints of the first field by further layers: opacity in place of extinction.
    tints: Option<Box<ClassifiedVoxels>>,
}

/// Returns the transfer function of a side, for the colour channel of light that is followed, if any.
fn transfer_table(
    settings: &Settings,
    side: TransferSide,
    color: Option<usize>,
    (range, scene): (ValueRange, &SceneSpace),
) -> BakedTransfer {
    match (side, color) {
        (TransferSide::Eye, _) => settings.bake_eye(range, scene),
        (TransferSide::Lighting, Some(color)) if settings.has_colored_shadows() => {
            settings.bake_lighting(range, scene).for_light_color(color)
        }
        (TransferSide::Lighting | TransferSide::Indirect, _) => settings.bake_lighting(range, scene),
    }
}

impl<'a> Reference<'a> {
    /// Creates a reference for a volume and settings; for labels, the settings must be [as
    /// drawn](Settings::resolved_for).
    pub fn new(volume: &Volume, settings: &'a Settings, options: ReferenceOptions) -> Self {
        let mask = mask_from_shapes(volume, settings.cuts.enabled_shapes()).map(Arc::new);
        let volume = &volume.with_density_mapping(settings.shown_content(&volume.ranges())).with_mask(mask);
        let range = volume.table_range();
        let field = DensityField::with_rounding(volume, options.rounding.unwrap_or(|density| density));
        let pyramid = Pyramid::new(&field, kernel_width(options.fault), options.rounding);
        // Layers have missing voxels of their own.
        let counts_missing = settings.layer_composition() != LayerComposition::Composed;
        let presence = PresencePyramids::from_volume(volume, counts_missing, options);
        let scene = volume.scene();
        let classification = settings.classification();
        let classified = classification.is_pre().then(|| {
            let (width, rounding) = (kernel_width(options.fault), options.rounding);
            Box::new(ALL_TRANSFER_SIDES.map(|side| {
                let table = transfer_table(settings, side, options.color, (range, &scene));
                let table = (&table, classification.has_crisp_edges());
                let presence = presence.as_ref().map(|presence| presence.for_side(side));
                ClassifiedVoxels::classify(&field, table, presence, width, rounding)
            }))
        });
        Self { settings, options, scene, range, field, pyramid, presence, classified, tints: None }
    }

    /// Creates a reference for a dataset whose fields are shown as layers; settings must be [as
    /// drawn](Settings::resolved_for_dataset).
    pub fn with_layers(dataset: &Dataset, settings: &'a Settings, options: ReferenceOptions) -> Self {
        let id = dataset.id();
        let further = settings.further_mappings(&id).into_iter().map_while(|mapping| mapping);
        let dataset =
            &dataset.with_density_mappings([settings.shown_content(&id.ranges)].into_iter().chain(further));
        let plain = Self::new(dataset.volume(), settings, options);
        let scene = plain.scene;
        let (dims, width) = (dataset.volume().dims(), kernel_width(options.fault));
        if settings.layer_composition() != LayerComposition::Composed {
            let bake = |layer: &VolumeLayer, volume: &Volume| layer.bake_eye(volume.table_range(), &scene);
            let tints = settings.has_tints().then(|| tint_voxels(dataset, settings, bake));
            let tints = tints.map(|tints| {
                ClassifiedVoxels::from_matter(dims, &tints, (1.0, None), None, width, options.rounding)
            });
            return Self { tints: tints.map(Box::new), ..plain };
        }
        let classified = ALL_TRANSFER_SIDES.map(|side| {
            let has_effect = |layer: &VolumeLayer| match side {
                TransferSide::Eye => layer.is_seen(),
                TransferSide::Lighting | TransferSide::Indirect => layer.casts_shadows(),
            };
            let bake = |layer: &VolumeLayer, volume: &Volume| {
                let range = volume.table_range();
                match (side, options.color) {
                    (TransferSide::Eye, _) => layer.bake_eye(range, &scene),
                    (TransferSide::Lighting, Some(color)) if settings.has_colored_shadows() => {
                        settings.bake_lighting_of(layer, range, &scene).for_light_color(color)
                    }
                    _ => settings.bake_lighting_of(layer, range, &scene),
                }
            };
            // Light of several colours is attenuated in proportion to extinctions.
            let has_colors = side != TransferSide::Eye && settings.has_colored_shadows();
            let opacity_length = (!has_colors).then(|| scene.mean_edge());
            let fields = settings.layers.iter().zip(dataset.fields().iter());
            let largest: f64 = fields
                .filter(|(layer, _)| layer.blend.adds_matter())
                .map(|(layer, field)| f64::from(bake(layer, field.volume()).max_extinction()))
                .sum();
            let presence = plain.presence.as_ref().map(|presence| presence.for_side(side));
            let is_by_layer = settings.layers.iter().any(VolumeLayer::is_never_cut);
            let (of_layers, presence) = if is_by_layer { (presence, None) } else { (None, presence) };
            let matter = composed_voxels(dataset, settings, has_effect, bake, opacity_length, of_layers);
            let unit = (largest, opacity_length);
            ClassifiedVoxels::from_matter(dims, &matter, unit, presence, width, options.rounding)
        });
        Self { classified: Some(Box::new(classified)), ..plain }
    }

    /// Returns a colour under the tints of further layers at a point in index space.
    fn tinted(&self, color: [f64; 3], point: DVec3, level: f64) -> [f64; 3] {
        let Some(tints) = &self.tints else { return color };
        let point = point + self.kernel_shift();
        let left = 1.0 - tints.shares.fetch(point, level);
        std::array::from_fn(|i| color[i] * left + tints.colors[i].fetch(point, level))
    }

    /// Returns the pre-classified voxels of a side, if voxels are classified before kernels spread them.
    fn classified(&self, side: TransferSide) -> Option<&ClassifiedVoxels> {
        let [eye, lighting, around] = &**self.classified.as_ref()?;
        Some(match side {
            TransferSide::Eye => eye,
            TransferSide::Lighting => lighting,
            TransferSide::Indirect => around,
        })
    }

    /// Returns the pyramid that is gathered: of densities, or of shares of the largest extinction.
    fn gathered_pyramid(&self, side: TransferSide) -> &Pyramid {
        self.classified(side).map_or(&self.pyramid, |classified| &classified.shares)
    }

    /// Returns the kernel for gathering: classified voxels always have the prefiltered one.
    fn gathered_kernel(&self, chosen: ReconstructionKernel) -> ReconstructionKernel {
        if self.classified.is_some() { ReconstructionKernel::Prefiltered } else { chosen }
    }

    /// Returns the table that classifies gathered densities.
    fn gathered_table(&self, side: TransferSide) -> BakedTransfer {
        match self.classified(side) {
            Some(classified) => classified.table.clone(),
            None => self.table(side),
        }
    }

    /// Returns the transfer function of a side.
    fn table(&self, side: TransferSide) -> BakedTransfer {
        transfer_table(self.settings, side, self.options.color, (self.range, &self.scene))
    }

    /// Returns the presence of densities gathered for light; 1 for classified voxels, whose extinction ends at missing
    /// ones anyway.
    fn gathered_presence(&self, profile: &KernelProfile, point: DVec3, level: f64) -> f64 {
        if self.classified.is_some() {
            1.0
        } else {
            self.presence(TransferSide::Lighting, profile, point, level)
        }
    }

    /// Returns the density at an index-space point as the GPU gathers it, with the kernel stretched 2^`level` times.
    pub fn density(&self, kernel: ReconstructionKernel, point: DVec3, level: f64) -> f64 {
        gather::density(self, TransferSide::Eye, &self.profile(kernel), point + self.kernel_shift(), level)
    }

    /// Returns light `index`, resolved into scene space.
    fn light(&self, index: usize) -> SceneLight {
        self.settings.lights[index].resolve(&self.settings.camera)
    }

    /// Returns the point lights that represent light `index`.
    fn points(&self, index: usize) -> Vec<SceneLight> {
        self.light(index).sample_lights(self.settings.shadows.area.samples)
    }

    /// Returns the resolution of the volume of light `index`; a combined volume has one resolution for all lights.
    fn light_resolution(&self, index: usize) -> LightVolumeResolution {
        let shadows = &self.settings.shadows;
        if self.settings.combines_lights() {
            shadows.resolution
        } else {
            self.light(index).volume_resolution(shadows, self.scene.dims)
        }
    }

    /// Returns true if light `index` has an attenuation volume.
    fn has_attenuation_volume(&self, index: usize) -> bool {
        self.settings.shadows.algorithm.has_volume() && self.settings.lights[index].needs_volume()
    }

    /// Returns the weights in use: those of the engine in the settings unless others are chosen.
    fn weights(&self) -> ReferenceWeights {
        let gathers = self.options.weights == ReferenceWeights::Gather;
        if gathers && self.settings.uses_scattering_engine() {
            ReferenceWeights::Scatter
        } else {
            self.options.weights
        }
    }

    fn profile(&self, kernel: ReconstructionKernel) -> KernelProfile {
        KernelProfile { kernel, width: kernel_width(self.options.fault) }
    }

    /// Returns the shift of density lookups by a fault.
    fn kernel_shift(&self) -> DVec3 {
        if self.options.fault == ReferenceFault::ShiftedKernel { DVec3::X / 2.0 } else { DVec3::ZERO }
    }
}

/// Returns the width of kernels relative to the correct one.
fn kernel_width(fault: ReferenceFault) -> f64 {
    if fault == ReferenceFault::WiderKernel { 1.05 } else { 1.0 }
}

/// Converts one sRGB component to linear light (IEC 61966-2-1); independent of the renderer's own conversion.
fn linear_from_srgb(encoded: f32) -> f64 {
    let encoded = f64::from(encoded);
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
