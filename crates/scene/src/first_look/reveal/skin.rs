//! Translucent skin around bones in CT: a veil that shows the body without hiding the bones.

use super::visibility::AveragedCells;
use super::{frame_object, transfer};
use crate::{LightingRig, Settings};
use chiaroscuro_volume::Volume;

/// Smallest share of the bones' visibility that must be left behind skin. Four layers of veil, two of skin and two of
/// the lungs, leave nine tenths; a bowel full of gas, or noise in air, is a fog.
const MIN_BONE_VISIBILITY: f64 = 0.75;

/// Returns the settings with skin around the visible bones, framed with it, unless that would hide the bones.
pub(crate) fn add_skin(settings: Settings, volume: &Volume, water: f64) -> Settings {
    let Some(first_bone) = settings.layer().transfer.points.first() else { return settings };
    let Some(cells) = AveragedCells::average(volume, settings.layer().opacity_unit) else { return settings };
    let with_skin = transfer::add_skin(&settings.layer().transfer, water);
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
    frame_object(&mut body, volume);
    body.lights = LightingRig::KeyAndFill.lights(&body.camera);
    body.with_transfer(with_skin)
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
}
