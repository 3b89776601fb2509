//! The slow, readable renderer in f64 that the GPU is compared with, stage by stage.
//!
//! It follows the paper literally (P §3.5, figure 3): sheet buffers filled by splatting voxels,
//! composited as seen from the light, splatted back into a light volume and normalised, then the
//! same again for the eye. [`Weights::Footprint`] is that; [`Weights::Gather`] are the same sums
//! turned around, with the weights of the GPU, which must then agree to rounding. Nothing is
//! skipped and no ray ends early.
//!
//! | stage | file | to compare |
//! |---|---|---|
//! | prefiltered volume and its pyramid | `field/pyramid` | [`Reference::density`] |
//! | voxels classified before they are spread | `field/classified` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | densities of sheets | `gather`, `footprint`, `sheet` | [`Reference::eye_sheet`] |
//! | what is there at all | `remains/presence` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | crop box and clip plane | `remains/cut` | [`Reference::light_sheets`], [`Reference::picture`] |
//! | march of light | `light` | [`Reference::light_sheets`] |
//! | reverse splat | `back_project` | [`Reference::back_project`], [`Reference::attenuation`] |
//! | rays to the light | `shadow_ray` | [`Reference::attenuation`], [`Reference::picture`] |
//! | the light of a sky | `around/sky` | [`Reference::openness`], [`Reference::picture`] |
//! | light that bounces | `around/bounces` | [`Reference::bounced`], [`Reference::picture`] |
//! | the floor | `floor` | [`Reference::floor`] |
//! | shading, compositing | `shade`, `eye` | [`Reference::picture`] |

mod around;
mod back_project;
mod eye;
mod field;
mod floor;
mod footprint;
mod gather;
mod kernel;
mod light;
mod remains;
mod shade;
mod shadow_ray;
mod sheet;
#[cfg(test)]
mod tests;

pub use around::bounces::{Bounced, Medium};
pub use around::sky::Openness;
pub use back_project::Attenuation;
pub use field::pyramid::Pyramid;
pub use field::{Field, Rounding};
pub use kernel::{cubic_b_spline, gaussian, tent};
pub use light::ViewSheets;

use glam::DVec3;

use crate::data::{ValueRange, Volume};
use crate::math::SceneSpace;
use crate::model::{BakedTransfer, Classification, Kernel, Resolution, SceneLight, Settings};
use field::classified::{Classified, SIDES, Side};
use kernel::Profile;

/// Whose weights the sums are taken with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weights {
    /// The GPU's: kernels evaluated at one or two points per slab, weights that sum to 1.
    #[default]
    Gather,
    /// The paper's: kernel slices integrated over the slab, not normalised on the way to the sheet.
    Footprint,
    /// Those of the scattering engine: a round Gaussian's slices integrated over the slab, other
    /// kernels evaluated at one or two points per slab, neither normalised on the way to the sheet.
    Scatter,
}

/// A deliberate mistake. Tests use it to prove that a comparison with the GPU, or a check against
/// a closed form, can fail; each is visible only where what it spoils matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fault {
    /// No mistake.
    #[default]
    None,
    /// All kernels 5 % wider: every stage, wherever densities or light vary.
    WiderKernel,
    /// Sheets deposit the transmittance behind their slab, whatever the settings say.
    DepositAfter,
    /// The reverse splat is not divided by its sum of weights. Those of the B-spline sum to 1 by
    /// themselves where the kernel is one pixel and one slab wide: look at another slab thickness,
    /// another kernel or a perspective light.
    NoDivision,
    /// Slabs are as thick for oblique rays as for straight ones: perspective eyes and lights only.
    NoObliquity,
    /// Normals point inwards: specular light only, since diffuse light is two-sided.
    FlippedNormal,
    /// Slabs that are cut count as a whole: only where something is cut.
    WholeSlabs,
    /// Densities are looked up half a voxel further along x.
    ShiftedKernel,
}

/// What kind of reference is wanted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Whose weights; [`Weights::Gather`] stands for those of the settings' engine.
    pub weights: Weights,
    /// Which mistake, if any.
    pub fault: Fault,
    /// How densities and the prefiltered volume's levels are stored; `None` keeps them as they are.
    pub rounding: Option<Rounding>,
    /// Which colour of light is followed, where shadows are coloured: red, green or blue. Of the picture that component
    /// alone means something ([`of_colors`]).
    pub color: Option<usize>,
}

/// A picture under coloured shadows: colours of light do not depend on each other, so that it is that of each colour in its
/// component. The coverage is the same in all.
pub fn of_colors(picture: impl Fn(usize) -> Vec<[f64; 4]>) -> Vec<[f64; 4]> {
    let [red, green, blue] = [0, 1, 2].map(picture);
    let joined = |((r, g), b): ((&[f64; 4], &[f64; 4]), &[f64; 4])| [r[0], g[1], b[2], r[3]];
    red.iter().zip(&green).zip(&blue).map(joined).collect()
}

/// A volume and the look of it, ready to be rendered.
#[derive(Debug, Clone)]
pub struct Reference<'a> {
    settings: &'a Settings,
    options: Options,
    scene: SceneSpace,
    range: ValueRange,
    field: Field,
    pyramid: Pyramid,
    /// The share of kernels that lies on voxels that are there, where some are missing.
    presence: Option<Pyramid>,
    /// How that changes along x, y and z, where it is as it is stored.
    presence_changes: Option<[Pyramid; 3]>,
    /// Voxels as the eye and light see them, where they are classified before kernels spread them.
    classified: Option<Box<[Classified; 3]>>,
}

/// The transfer function of a side, where one of the colours of light is followed.
fn table_of(
    settings: &Settings,
    side: Side,
    color: Option<usize>,
    (range, scene): (ValueRange, &SceneSpace),
) -> BakedTransfer {
    match (side, color) {
        (Side::Eye, _) => settings.baked_eye(range, scene),
        (Side::Lighting, Some(color)) if settings.has_colored_shadows() => {
            settings.baked_lighting(range, scene).met_by(color)
        }
        (Side::Lighting | Side::Around, _) => settings.baked_lighting(range, scene),
    }
}

impl<'a> Reference<'a> {
    /// A reference for a volume with some settings; of labels, settings [as drawn](Settings::as_drawn).
    pub fn new(volume: &Volume, settings: &'a Settings, options: Options) -> Self {
        let volume = &volume.showing(settings.shown(&volume.ranges()));
        let range = volume.table_range();
        let field = Field::with_rounding(volume, options.rounding.unwrap_or(|density| density));
        let pyramid = Pyramid::of(&field, kernel_width(options.fault), options.rounding);
        let mut presence =
            Field::of_presence(volume).map(|field| Pyramid::of(&field, kernel_width(options.fault), None));
        let mut presence_changes = None;
        if options.rounding.is_some() {
            // Stored in signed bytes, the share over all of their range.
            presence_changes = presence
                .as_ref()
                .map(|presence| [0, 1, 2].map(|axis| presence.changes(axis).in_steps(127.0)));
            presence = presence.map(|presence| presence.in_steps(254.0));
        }
        let scene = volume.scene();
        let classified = (settings.sampling.classification == Classification::Pre).then(|| {
            let tables = SIDES.map(|side| table_of(settings, side, options.color, (range, &scene)));
            let (width, rounding) = (kernel_width(options.fault), options.rounding);
            Box::new(tables.map(|table| Classified::of(&field, &table, presence.as_ref(), width, rounding)))
        });
        Self { settings, options, scene, range, field, pyramid, presence, presence_changes, classified }
    }

    /// Voxels as they are classified before kernels spread them, if they are.
    fn classified(&self, side: Side) -> Option<&Classified> {
        let [eye, lighting, around] = &**self.classified.as_ref()?;
        Some(match side {
            Side::Eye => eye,
            Side::Lighting => lighting,
            Side::Around => around,
        })
    }

    /// The pyramid of what is gathered: of densities, or of shares of the largest extinction.
    fn gathered_pyramid(&self, side: Side) -> &Pyramid {
        self.classified(side).map_or(&self.pyramid, |classified| &classified.shares)
    }

    /// The kernel of what is gathered: classified voxels are spread by the prefiltered one.
    fn gathered_kernel(&self, chosen: Kernel) -> Kernel {
        if self.classified.is_some() { Kernel::Prefiltered } else { chosen }
    }

    /// What the density that is gathered means.
    fn gathered_table(&self, side: Side) -> BakedTransfer {
        match self.classified(side) {
            Some(classified) => classified.table.clone(),
            None => self.table(side),
        }
    }

    /// The transfer function of a side.
    fn table(&self, side: Side) -> BakedTransfer {
        table_of(self.settings, side, self.options.color, (self.range, &self.scene))
    }

    /// The share of what is gathered that is there; classified voxels end by themselves.
    fn gathered_presence(&self, profile: &Profile, point: DVec3, level: f64) -> f64 {
        if self.classified.is_some() { 1.0 } else { self.presence(profile, point, level) }
    }

    /// The density at an index-space point as the GPU gathers it, with the kernel stretched
    /// 2^`level` times.
    pub fn density(&self, kernel: Kernel, point: DVec3, level: f64) -> f64 {
        gather::density(self, Side::Eye, &self.profile(kernel), point + self.kernel_shift(), level)
    }

    /// Light `index`, its position in the scene.
    fn light(&self, index: usize) -> SceneLight {
        self.settings.lights[index].in_scene(&self.settings.camera)
    }

    /// The points of light `index` that stand for it.
    fn points(&self, index: usize) -> Vec<SceneLight> {
        self.light(index).points(self.settings.shadows.area.samples)
    }

    /// The resolution of the volume of light `index`; one volume for all lights has one.
    fn light_resolution(&self, index: usize) -> Resolution {
        let shadows = &self.settings.shadows;
        if self.settings.combines_lights() {
            shadows.resolution
        } else {
            self.light(index).resolution(shadows, self.scene.dims)
        }
    }

    /// Whether light `index` has an attenuation volume.
    fn casts(&self, index: usize) -> bool {
        self.settings.shadows.algorithm.has_volume() && self.settings.lights[index].needs_volume()
    }

    /// Whose weights are used: those of the settings' engine unless others are asked for.
    fn weights(&self) -> Weights {
        let gathers = self.options.weights == Weights::Gather;
        if gathers && self.settings.scatters() { Weights::Scatter } else { self.options.weights }
    }

    fn profile(&self, kernel: Kernel) -> Profile {
        Profile { kernel, width: kernel_width(self.options.fault) }
    }

    /// Where densities are looked up, relative to where they should be.
    fn kernel_shift(&self) -> DVec3 {
        if self.options.fault == Fault::ShiftedKernel { DVec3::X / 2.0 } else { DVec3::ZERO }
    }
}

/// The kernels' width relative to the right one.
fn kernel_width(fault: Fault) -> f64 {
    if fault == Fault::WiderKernel { 1.05 } else { 1.0 }
}

/// One sRGB component to linear light (IEC 61966-2-1); the reference has its own.
fn linear_from_srgb(encoded: f32) -> f64 {
    let encoded = f64::from(encoded);
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
