//! First look for another kind of data than the detected one, applied over the user's existing settings.

use super::{FirstLookOptions, first_settings_with, set_up_axis};
use crate::{FloorSettings, SamplingSettings, SceneAxis, Settings};
use chiaroscuro_volume::{Histogram, KindName, Volume};

/// Returns the first look at a volume as the given kind of data (`None` for the detected kind), with the given scene
/// axis up, whatever the file says.
pub fn first_look_as_kind(
    volume: &Volume,
    histogram: &Histogram,
    treated_as: Option<KindName>,
    up: SceneAxis,
) -> Settings {
    let mut look = first_settings_with(volume, histogram, FirstLookOptions { data_kind: treated_as, up });
    set_up_axis(&mut look, volume, up);
    look
}

/// Returns a first look that replaces settings.
///
/// Settings that do not depend on the kind of data stay as they are: output, sampling, shadows, clipping, the floor's
/// appearance, and saved views and looks.
#[must_use]
pub fn replace_look(look: Settings, settings: &Settings) -> Settings {
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
    use super::*;
    use crate::first_look::first_settings;
    use crate::first_look::tests::ball;
    use crate::{ClassificationOrder, RenderEngine, SceneAxis, ShadowAlgorithm};

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
        let wishes = FirstLookOptions { data_kind: Some(KindName::LabelMap), up: SceneAxis::PlusY };
        let first = first_settings_with(&volume, &histogram, wishes);
        assert_eq!(
            (&labels.layer().transfer, labels.layer().range),
            (&first.layer().transfer, first.layer().range)
        );
        assert_eq!((&labels.camera, &labels.lights), (&first.camera, &first.lights));
        assert_eq!(labels.floor, FloorSettings { height: first.floor.height, ..mine.floor.clone() });
        assert_eq!(labels.sampling.classification, ClassificationOrder::Pre);
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
}
