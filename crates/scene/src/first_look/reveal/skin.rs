//! Translucent skin around bones in CT: a veil that shows the body without hiding the bones.

use super::optical_depth::VeilDepths;
use super::visibility::AveragedCells;
use super::{frame_largest_part, transfer};
use crate::{LightingRig, Settings};
use chiaroscuro_volume::Volume;
use transfer::SkinVeil;

/// Smallest share of the bones' visibility that must be left behind skin: its front half has at most a tenth of the
/// light, unless it is a fog; a bowel full of gas, or noise in air, is one.
const MIN_BONE_VISIBILITY: f64 = 0.75;

/// Transmittance of the skin's front and back together, with the fat and the lungs between them, along half of the
/// rays through the body: enough to distinguish bones behind it, and little enough that the body shows.
const TRANSMITTANCE: f64 = 0.7;

/// Depth of the veil in opacity units below which there is no skin but only the kernel's blur between air and body,
/// 1.5 through a ball of flesh; scans of bodies have 3.5 and more. And the largest opacity of that blur: it is ten
/// times as deep along an outline as at its front, and would be opaque there.
const BLUR_DEPTH: f64 = 2.2;
const MAX_BLUR_OPACITY: f64 = 0.045;

/// Largest depth of the veil beside the body, as a share of that through it: what is there is the noise of air, its
/// padding, or a bed, and no skin.
const MAX_DEPTH_BESIDE: f64 = 0.25;

/// Returns the settings with skin around the visible bones, framed with it, unless that would hide the bones.
pub(crate) fn add_skin(settings: Settings, volume: &Volume, water: f64) -> Settings {
    let Some(first_bone) = settings.layer().transfer.points.first() else { return settings };
    let Some(opacity) = skin_opacity(&settings, volume, SkinVeil { water }) else { return settings };
    let Some(cells) = AveragedCells::average(volume, settings.layer().opacity_unit) else { return settings };
    let with_skin = SkinVeil { water }.add_to(&settings.layer().transfer, opacity);
    let bones = |function| -> f64 {
        cells
            .visibility_by_bin(function, &settings.camera)
            .iter()
            .skip(cells.value_bin(first_bone.value))
            .sum()
    };
    if bones(&with_skin) < MIN_BONE_VISIBILITY * bones(&settings.layer().transfer) {
        return settings;
    }
    let mut body = settings.with_transfer(transfer::opaque_transfer(&with_skin));
    frame_largest_part(&mut body, volume);
    body.lights = LightingRig::KeyAndRim.lights(&body.camera);
    body.with_transfer(with_skin)
}

/// Returns the opacity of skin at its peak with which the body has a transmittance of [`TRANSMITTANCE`], however large
/// voxels are; `None` where what looks like skin surrounds the body as well.
fn skin_opacity(settings: &Settings, volume: &Volume, skin: SkinVeil) -> Option<f64> {
    let depths = VeilDepths::measure(
        volume,
        &settings.camera,
        settings.layer().opacity_unit,
        |value| skin.relative_extinction(value),
        |value| skin.is_body(value),
    )?;
    if depths.beside_body > MAX_DEPTH_BESIDE * depths.through_body || depths.through_body <= 0.0 {
        return None;
    }
    let opacity = 1.0 - TRANSMITTANCE.powf(1.0 / depths.through_body);
    Some(if depths.through_body < BLUR_DEPTH { opacity.min(MAX_BLUR_OPACITY) } else { opacity })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::first_look::{FirstLookOptions, first_settings_with};
    use chiaroscuro_volume::{Histogram, KindName, Samples, Volume};

    /// Returns the opacities of skin and of bone around a bone in flesh, with the given background.
    fn opacities(around: impl Fn(usize) -> i16) -> [f64; 2] {
        const N: usize = 40;
        let value = |at: usize| {
            let p = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 19.5));
            match p.length() {
                r if r < 7.0 => 900,
                r if r < 15.0 => 40,
                _ => around(at),
            }
        };
        let samples = Samples::I16((0..N * N * N).map(value).collect());
        let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        let wishes =
            FirstLookOptions { data_kind: Some(KindName::HounsfieldCt), ..FirstLookOptions::default() };
        let first = first_settings_with(&volume, &Histogram::from_volume(&volume), wishes);
        [-300.0, 900.0].map(|value| first.layer().transfer.opacity_at(value))
    }

    #[test]
    fn skin_is_a_veil_unless_it_is_a_fog() {
        let [skin, bone] = opacities(|_| -1000);
        assert!((0.01..0.05).contains(&skin) && bone > 0.5, "{skin} {bone}");
        let [skin, bone] = opacities(|at| if at % 12 == 0 { -1000 } else { -300 });
        assert!(skin == 0.0 && bone > 0.5, "{skin} {bone}");
    }

    /// Returns the share of the light that skin lets through along half of the lines through a body of 120 mm, with
    /// 12 mm of fat around its flesh and soft edges, in voxels of the given edge.
    fn transmittance(edge_mm: f64, around: f64) -> f64 {
        let n = (150.0 / edge_mm) as usize;
        let middle = (n as f64 - 1.0) / 2.0;
        let value = |place: DVec3| {
            let radius = (place - middle).length() * edge_mm;
            let within = |end: f64| 1.0 / (1.0 + (radius - end).exp());
            around + (-100.0 - around) * within(60.0) + 140.0 * within(48.0) + 860.0 * within(15.0)
        };
        let place = |at: usize| DVec3::from([at % n, at / n % n, at / n / n].map(|c| c as f64));
        let samples = Samples::I16((0..n * n * n).map(|at| value(place(at)).round() as i16).collect());
        let volume = Volume::with_spacing("t", [n; 3], DVec3::splat(edge_mm), samples).unwrap();
        let wishes =
            FirstLookOptions { data_kind: Some(KindName::HounsfieldCt), ..FirstLookOptions::default() };
        let first = first_settings_with(&volume, &Histogram::from_volume(&volume), wishes);
        // Half of the section of a ball lies within 0.7 of its radius.
        let aside = middle + 0.7 * 60.0 / edge_mm;
        // Voxel by voxel, to which opacities refer.
        let left =
            |y: usize| 1.0 - first.layer().transfer.opacity_at(value(DVec3::new(aside, y as f64, middle)));
        (0..n).map(left).product()
    }

    #[test]
    fn skin_lets_as_much_light_through_whatever_the_size_of_voxels() {
        for edge_mm in [1.5, 2.0, 3.0, 4.0] {
            let left = transmittance(edge_mm, -1000.0);
            assert!((left - 0.7).abs() < 0.06, "{edge_mm} mm: {left}");
        }
        // Padding below air, which is no veil.
        let left = transmittance(3.0, -3000.0);
        assert!((left - 0.7).abs() < 0.1, "{left}");
        // Values around the body that would be one.
        assert_eq!(transmittance(3.0, -400.0), 1.0);
    }
}
