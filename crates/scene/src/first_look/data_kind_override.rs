//! First look for another kind of data than the detected one, applied over the user's existing settings.

use super::transfer::{self, FirstTransfer};
use super::{FirstLookOptions, first_settings_with, opacity_unit, set_up_axis, with_robust_range};
use crate::{FloorSettings, LabelTable, SamplingSettings, SceneAxis, Settings, TransferFunction};
use chiaroscuro_volume::{DataKind, Histogram, KindName, Volume};

/// Returns the data kind for a name, or the volume's own if it is `None`.
pub(super) fn data_kind(volume: &Volume, treated_as: Option<KindName>) -> DataKind {
    let own = volume.kind().kind;
    match treated_as {
        Some(name) if name != own.name() => DataKind::from_name(name, volume),
        _ => own,
    }
}

/// Finds the transfer function for the given kind of data; `None` for the detected kind.
///
/// Scalars that the user asks for are plain: a ramp of opacity also for few slices and for distances.
pub(super) fn find_transfer_as_kind(
    volume: &Volume,
    histogram: &Histogram,
    treated_as: Option<KindName>,
) -> FirstTransfer {
    match treated_as {
        Some(KindName::Scalar) => transfer::find_scalar(volume, histogram),
        _ => transfer::find_transfer(volume, histogram, data_kind(volume, treated_as)),
    }
}

/// Returns the first look at a volume as the given kind of data (`None` for the detected kind), with the given scene
/// axis up, whatever the file says.
pub fn first_look_as_kind(
    volume: &Volume,
    histogram: &Histogram,
    treated_as: Option<KindName>,
    up: SceneAxis,
) -> Settings {
    let mut look =
        first_settings_with(volume, histogram, FirstLookOptions { data_kind: treated_as, up: Some(up) });
    set_up_axis(&mut look, volume, up);
    look
}

/// Returns the transfer function that shows the object and hides the background, for the given kind of data; `None`
/// for the detected kind.
pub fn transfer_for_kind(
    volume: &Volume,
    histogram: &Histogram,
    treated_as: Option<KindName>,
) -> TransferFunction {
    with_robust_range(volume, histogram, |volume, histogram| {
        find_transfer_as_kind(volume, histogram, treated_as).transfer
    })
}

/// Returns the label table for the given kind of data; `None` for the detected kind. Empty for all but label maps.
pub fn labels_for_kind(volume: &Volume, treated_as: Option<KindName>) -> LabelTable {
    match data_kind(volume, treated_as) {
        DataKind::LabelMap { .. } => {
            let mut labels = transfer::label_table(volume);
            transfer::make_cover_translucent(&mut labels, volume, opacity_unit(volume));
            labels
        }
        _ => LabelTable::default(),
    }
}

/// Returns a first look that replaces settings.
///
/// Settings that do not depend on the kind of data stay as they are: output, sampling, shadows, clipping, the floor's
/// appearance, and saved views and looks.
#[must_use]
pub fn replace_look(mut look: Settings, settings: &Settings) -> Settings {
    look.layers.replace_further(&settings.layers);
    let Settings { cuts, output, shadows, sampling, floor, kept, volume, .. } = settings.clone();
    Settings {
        sampling: SamplingSettings { classification: look.sampling.classification, ..sampling },
        floor: FloorSettings { height: look.floor.height, ..floor },
        cuts,
        output,
        shadows,
        kept,
        volume,
        ..look
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::first_settings;
    use crate::first_look::tests::ball;
    use crate::{ClassificationOrder, RenderEngine, SceneAxis, ShadowAlgorithm};
    use chiaroscuro_volume::Samples;

    #[test]
    fn only_what_the_kind_decides_is_another() {
        let volume = ball(200.0, 0.0);
        let histogram = Histogram::from_volume(&volume);
        let mut mine = first_settings(&volume, &histogram);
        mine.camera.up = SceneAxis::PlusY;
        mine.cuts.crop.on = true;
        (mine.output.exposure, mine.output.background.top) = (1.4, [1.0; 3]);
        (mine.shadows.algorithm, mine.shadows.strength) = (ShadowAlgorithm::Raycast, 0.5);
        (mine.sampling.engine, mine.sampling.slab) = (RenderEngine::Scatter, 2.0);
        (mine.floor.on, mine.floor.color, mine.floor.height) = (true, [0.2; 3], 3.0);
        mine.save_view_for_digit(3, "front");
        let treated = |kind: Option<KindName>, mine: &Settings| {
            replace_look(first_look_as_kind(&volume, &histogram, kind, mine.camera.up), mine)
        };
        let labels = treated(Some(KindName::LabelMap), &mine);
        let wishes = FirstLookOptions { data_kind: Some(KindName::LabelMap), up: Some(SceneAxis::PlusY) };
        let first = first_settings_with(&volume, &histogram, wishes);
        assert_eq!(
            (&labels.layer().transfer, labels.layer().range),
            (&first.layer().transfer, first.layer().range)
        );
        assert_eq!((&labels.camera, &labels.lights), (&first.camera, &first.lights));
        assert_eq!(labels.floor, FloorSettings { height: first.floor.height, ..mine.floor.clone() });
        assert_eq!(labels.sampling.classification, ClassificationOrder::PreCrisp);
        assert_eq!(labels.sampling.engine, RenderEngine::Scatter);
        let kept = |look: &Settings| {
            (look.cuts.clone(), look.output.clone(), look.shadows.clone(), look.kept.clone())
        };
        assert_eq!(kept(&labels), kept(&mine));
        // Back to the detected kind.
        let again = treated(None, &labels);
        assert_eq!(again.sampling, mine.sampling);
        assert_eq!(again.layer().transfer, mine.layer().transfer);
    }

    /// Returns opacities as scalars that the user asks for at the ends of the values, and of the detected kind.
    fn opacities_at_ends(volume: &Volume, treated_as: Option<KindName>) -> [f64; 2] {
        let look = first_look_as_kind(volume, &Histogram::from_volume(volume), treated_as, SceneAxis::PlusZ);
        let range = volume.value_range();
        [range.low, range.high].map(|value| look.layer().transfer.opacity_at(value))
    }

    #[test]
    fn scalars_that_are_asked_for_are_plain() {
        const N: usize = 48;
        let volume_of = |layers: usize, value: &dyn Fn(DVec3) -> f64| {
            let middle = DVec3::new(N as f64 - 1.0, N as f64 - 1.0, layers as f64 - 1.0) / 2.0;
            let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64)) - middle;
            let samples = Samples::F32((0..N * N * layers).map(|at| value(place(at)) as f32).collect());
            Volume::with_spacing("t", [N, N, layers], DVec3::ONE, samples).unwrap()
        };
        let hill = |p: DVec3| 100.0 * (-p.length_squared() / 90.0).exp();
        for layers in [1, 2, 4] {
            let slices = volume_of(layers, &hill);
            assert!(opacities_at_ends(&slices, None).iter().all(|opacity| *opacity > 0.99), "a picture");
            let [low, high] = opacities_at_ends(&slices, Some(KindName::Scalar));
            assert!(low == 0.0 && high > 0.5, "{layers} slices: {low} {high}");
            let look = first_look_as_kind(
                &slices,
                &Histogram::from_volume(&slices),
                Some(KindName::Scalar),
                SceneAxis::PlusZ,
            );
            assert!(look.shading.diffuse > 0.0, "with relief");
        }
        let distances = volume_of(N, &|p| p.length() - 12.0);
        let [inside, outside] = opacities_at_ends(&distances, None);
        assert!(inside > 0.5 && outside == 0.0, "shown at zero: {inside} {outside}");
        let [inside, outside] = opacities_at_ends(&distances, Some(KindName::Scalar));
        assert!(inside == 0.0 && outside > 0.5, "a ramp: {inside} {outside}");
        // A neighbour: what is detected as a scalar is the same either way.
        let ball = ball(200.0, 0.0);
        assert_eq!(opacities_at_ends(&ball, Some(KindName::Scalar)), opacities_at_ends(&ball, None));
    }
}
