//! Look proposals: complete looks of a volume that differ in material, lighting or view.

mod publication_looks;

use glam::DVec3;

use self::publication_looks::publication_looks;
use super::domain::DataDomain;
use super::threshold::otsu_threshold;
use super::{MIN_VISIBLE_OPACITY, floor_color, frame_object, histogram_above, transfer};
use crate::{
    Background, Camera, Easing, LightSettings, LightShape, LightingRig, Settings, SkyMode, SkySettings,
    TransferFunction,
};
use chiaroscuro_volume::{Histogram, Volume};

/// Proposed look with its name and description.
#[derive(Debug, Clone, PartialEq)]
pub struct LookProposal {
    /// Name of the proposal in menus.
    pub name: &'static str,
    /// Difference from the first look, for a tooltip.
    pub description: &'static str,
    /// Settings of the look; its exposure is measured later.
    pub settings: Settings,
}

/// Share of the visible voxels that an inner structure may take: not a few specks, nor nearly all.
const INNER_SHARE: std::ops::RangeInclusive<f64> = 0.01..=0.7;

/// Opacity factor of the outer material when it is a veil: it is translucent, but still visible.
const VEIL_OPACITY: f64 = 0.06;

/// Opacity below which an outer material is a veil: opaque surfaces begin with 0.3, and a veil keeps half of that at
/// most.
const MAX_VEIL_OPACITY: f64 = 0.2;

/// Opacity factor of the translucent look, which lets the material behind show through.
const TRANSLUCENT_OPACITY: f64 = 0.3;

/// Camera elevation in degrees of the look from above.
const FROM_ABOVE_DEG: f64 = 48.0;

/// Rotation in degrees to the other side: behind the object; for patients, from the right front to the left profile.
const BEHIND_DEG: f64 = 180.0;
const LEFT_PROFILE_DEG: f64 = 120.0;

/// Sky intensity of soft light: as much as the key light on a surface that is turned 60° from it.
const SOFT_SKY: f64 = 0.5;

/// Angular width in degrees of a light with soft shadows: a window across a room.
const SOFT_DEG: f64 = 30.0;

/// Colour of fired clay, with which modellers judge form by light alone.
const CLAY_COLOR: [f32; 3] = [0.80, 0.76, 0.72];

/// Returns twelve looks of a volume, the first look first, another if it has an inner structure, and one more if that
/// is not within a veil already. The volume may be subsampled.
///
/// Looks that every volume has come first, so that a number selects the same kind of look for all data.
pub fn propose_looks(first: &Settings, volume: &Volume, histogram: &Histogram) -> Vec<LookProposal> {
    let proposal = |name, differs, settings| LookProposal { name, description: differs, settings };
    let mut all = vec![proposal("First look", "as the volume is opened", first.clone())];
    let lit = |rig: LightingRig| Settings { lights: rig.lights(&first.camera), ..first.clone() };
    all.push(proposal("Rim light", "lit from behind: outlines shine", lit(LightingRig::Rim)));
    all.push(proposal(
        "Soft light",
        "a bright sky all around and a light as wide as a window: soft shadows",
        soft_light_look(first),
    ));
    all.push(proposal("Clay", "one neutral colour: shape by light alone", clay_look(first)));
    let mut above = first.clone();
    above.camera.elevation_deg = FROM_ABOVE_DEG;
    above.floor.on = true;
    above.floor.color = floor_color(first.output.exposure);
    let above = reframed(above, first, volume);
    all.push(proposal("From above", "seen from above, on a floor that receives the shadow", above));
    let mut other = first.clone();
    other.camera.azimuth_deg += if volume.is_anatomical() { LEFT_PROFILE_DEG } else { BEHIND_DEG };
    all.push(proposal("Other side", "seen from the other side", reframed(other, first, volume)));
    let mut paper = first.clone();
    paper.output.background = Background { top: [1.0; 3], bottom: [0.94; 3] };
    paper.floor.shadow_only = true;
    all.push(proposal("On paper", "on a white background, as in print", paper));
    let mut thin = first.clone();
    transfer::scale_opacity(&mut thin.layer_mut().transfer, TRANSLUCENT_OPACITY);
    thin.layer_mut().labels.modify_all(|_, look| look.opacity *= TRANSLUCENT_OPACITY);
    all.push(proposal("Translucent", "less opaque: what lies behind shows through", thin));
    all.extend(publication_looks(first));
    let has_veil = veil_end(&first.layer().transfer);
    if let Some(start) = has_veil.or_else(|| inner_start(&first.layer().transfer, volume, histogram)) {
        let channels = DataDomain::from_channels(volume);
        let inner = transfer::inner_transfer(&first.layer().transfer, start, channels);
        let inner = first.clone().with_transfer(inner);
        all.push(proposal("Inner structure", "only the densest material", reframed(inner, first, volume)));
        if has_veil.is_some() {
            return sanitise_all(all);
        }
        let veil = transfer::veiled_transfer(&first.layer().transfer, start, VEIL_OPACITY, channels);
        let veil = first.clone().with_transfer(veil);
        all.push(proposal("Veil", "the outside is a veil around the densest material", veil));
    }
    sanitise_all(all)
}

fn sanitise_all(mut all: Vec<LookProposal>) -> Vec<LookProposal> {
    for LookProposal { settings, .. } in &mut all {
        settings.sanitise();
    }
    all
}

/// Returns the value at which the material inside a veil begins, if the function has one: opacity only rises from
/// there, and everything below is hardly opaque.
fn veil_end(function: &TransferFunction) -> Option<f64> {
    let points = &function.points;
    let last_clear = points.iter().rposition(|point| point.opacity <= 0.0)?;
    let (below, above) = points.split_at(last_clear);
    let most = below.iter().map(|point| point.opacity).fold(0.0, f64::max);
    let rises = above.windows(2).all(|pair| pair[0].opacity <= pair[1].opacity);
    (rises && above.len() > 1 && most > 0.0 && most < MAX_VEIL_OPACITY).then(|| points[last_clear].value)
}

/// Returns the settings with the camera framed on the visible object, and the lights rotated with the camera.
fn reframed(mut settings: Settings, first: &Settings, volume: &Volume) -> Settings {
    frame_object(&mut settings, volume);
    settings.lights = rotate_lights_with_camera(&settings.lights, &first.camera, &settings.camera);
    settings
}

/// Rotates lights so that they keep their positions relative to the camera.
fn rotate_lights_with_camera(lights: &[LightSettings], from: &Camera, to: &Camera) -> Vec<LightSettings> {
    let turn = to.scene_from_view() * from.scene_from_view().transpose();
    let moved = |light: &LightSettings| {
        let mut light = light.clone();
        let place = turn * DVec3::from(light.resolve(from).position);
        light.set_scene_position(place, to);
        light
    };
    lights.iter().map(moved).collect()
}

/// Returns the value at which the inner structure begins; `None` if opacity does not rise with value, or if there is
/// no inner structure.
fn inner_start(function: &TransferFunction, volume: &Volume, histogram: &Histogram) -> Option<f64> {
    let points = &function.points;
    let is_ramp = points.windows(2).all(|pair| pair[0].opacity <= pair[1].opacity)
        && points.iter().all(|point| point.easing != Easing::Step);
    let bins = histogram.counts.len();
    let shown = (0..bins)
        .map(|bin| bin as f64 / bins as f64)
        .find(|&density| function.opacity_at(volume.value_of(density)) > MIN_VISIBLE_OPACITY)?;
    // Otsu's split of the visible part.
    let above = histogram_above(histogram, shown);
    let start = otsu_threshold(&above);
    let first = (start * bins as f64) as usize;
    let inside = above.counts.iter().skip(first).sum::<u64>() as f64 / above.total.max(1) as f64;
    (is_ramp && INNER_SHARE.contains(&inside)).then(|| volume.value_of(start))
}

/// Returns the look with a sky beside the lights, the first of which is as large as a window across a room.
fn soft_light_look(first: &Settings) -> Settings {
    let sky = SkySettings { mode: SkyMode::Gradient, intensity: SOFT_SKY, ..SkySettings::default() };
    let mut soft = Settings { sky, ..first.clone() };
    if let Some(key) = soft.lights.iter_mut().find(|light| light.on && light.casts_shadows) {
        (key.shape, key.angle_deg) = (LightShape::Disc, SOFT_DEG);
    }
    soft
}

/// Returns the look in one colour, slightly rough, with three-point lighting.
fn clay_look(first: &Settings) -> Settings {
    let mut clay = Settings { lights: LightingRig::KeyFillBack.lights(&first.camera), ..first.clone() };
    for point in &mut clay.layer_mut().transfer.points {
        point.color = CLAY_COLOR;
    }
    clay.layer_mut().labels.modify_all(|_, look| look.color = CLAY_COLOR);
    clay.shading.specular = 0.08;
    clay
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::tests::ball;
    use crate::first_look::{FirstLookOptions, first_settings, first_settings_with};
    use chiaroscuro_volume::{KindName, synthetic::builtin};

    fn proposals(volume: &Volume) -> Vec<LookProposal> {
        let histogram = Histogram::from_volume(volume);
        propose_looks(&first_settings(volume, &histogram), volume, &histogram)
    }

    #[test]
    fn looks_are_twelve_to_fourteen_that_differ() {
        for volume in
            [ball(200.0, 0.0), builtin("chair", Some(32)).unwrap(), builtin("cloud", Some(32)).unwrap()]
        {
            let all = proposals(&volume);
            assert!((12..=14).contains(&all.len()), "{}", all.len());
            assert_eq!(all[0].settings, first_settings(&volume, &Histogram::from_volume(&volume)));
            for (at, one) in all.iter().enumerate() {
                let others = &all[at + 1..];
                assert!(others.iter().all(|other| other.name != one.name && other.settings != one.settings));
                let mut sane = one.settings.clone();
                sane.sanitise();
                assert_eq!(sane, one.settings, "{}", one.name);
                let points = &one.settings.layer().transfer.points;
                assert!(points.windows(2).all(|pair| pair[0].value <= pair[1].value), "{}", one.name);
            }
        }
    }

    #[test]
    fn lights_stay_beside_the_eye() {
        for LookProposal { name, settings, .. } in proposals(&builtin("chair", Some(32)).unwrap()) {
            let view = settings.camera.scene_from_view().transpose();
            let key = view * DVec3::from(settings.lights[0].position);
            assert!(key.x < 0.0 && key.y > 0.0, "{name}: {key}");
        }
    }

    #[test]
    fn the_inside_is_what_is_densest() {
        // A dense core in a ball.
        let n = 32usize;
        let value = |at: usize| {
            let p = DVec3::from([at % n, at / n % n, at / n / n].map(|c| c as f64 - 15.5));
            if p.length() < 8.0 {
                220u8
            } else if p.length() < 12.0 {
                90
            } else {
                0
            }
        };
        let voxels = chiaroscuro_volume::Samples::U8((0..n * n * n).map(value).collect());
        let volume = Volume::with_spacing("core", [n; 3], DVec3::ONE, voxels).unwrap();
        let all = proposals(&volume);
        let of = |name: &str| &all.iter().find(|one| one.name == name).expect("a look").settings;
        // The core is hidden: the first look has a veil around it, a skin that is transparent inside.
        let (inner, first) = (of("Inner structure"), &all[0].settings);
        assert_eq!(inner.layer().transfer.opacity_at(90.0), 0.0);
        assert!(
            inner.layer().transfer.opacity_at(220.0) > 0.5 && first.layer().transfer.opacity_at(220.0) > 0.5
        );
        let skin =
            (0..90).map(|value| first.layer().transfer.opacity_at(f64::from(value))).fold(0.0, f64::max);
        assert!(
            (0.001..MAX_VEIL_OPACITY).contains(&skin) && first.layer().transfer.opacity_at(90.0) < 0.5 * skin,
            "{skin}"
        );
        assert!(inner.camera.distance < first.camera.distance, "nearer to what is smaller");
        assert!(all.iter().all(|one| one.name != "Veil"), "it is the first");
    }

    #[test]
    fn values_that_are_no_densities_have_no_inside() {
        let volume = ball(200.0, 0.0);
        let histogram = Histogram::from_volume(&volume);
        let mut first = first_settings(&volume, &histogram);
        // Opaque at both ends, as for signed fields.
        let opaque =
            crate::ControlPoint::new(first.layer().transfer.points[0].value - 1.0, [0.2, 0.3, 0.9], 0.9);
        first.layer_mut().transfer.points.insert(0, opaque);
        let all = propose_looks(&first, &volume, &histogram);
        assert!(all.iter().all(|one| one.name != "Veil"));
    }

    #[test]
    fn a_number_is_the_same_look_whatever_is_shown() {
        let volume = builtin("chair", Some(32)).unwrap();
        let histogram = Histogram::from_volume(&volume);
        let names = |treated_as: Option<KindName>| -> Vec<&str> {
            let wishes = FirstLookOptions { data_kind: treated_as, ..FirstLookOptions::default() };
            let first = first_settings_with(&volume, &histogram, wishes);
            propose_looks(&first, &volume, &histogram).iter().map(|look| look.name).collect()
        };
        let all: Vec<_> = KindName::choices().map(names).collect();
        let longest = all.iter().max_by_key(|names| names.len()).unwrap();
        assert!(all.iter().all(|names| longest.starts_with(names)), "{all:?}");
        assert!(all.iter().any(|names| names.len() < longest.len()), "{all:?}");
    }
}
