//! Look that the arguments describe, with the parts that are determined automatically.

use super::LookArgs;
use super::preset_or_session::PresetOrSession;
use crate::cli::CliError;
use crate::cli::output::warn_line;
use chiaroscuro_render::{Renderer, UndecidedPart, complete_first_look};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::Dataset;

/// Automatic parts that a preset, session or single setting overrides.
#[derive(Debug, Default)]
pub(super) struct OverriddenParts {
    parts: Vec<UndecidedPart>,
}

impl OverriddenParts {
    /// Adds the parts for whose path `is_named` is true.
    pub(super) fn add(&mut self, is_named: impl Fn(&str) -> bool) {
        self.parts.extend(UndecidedPart::ALL.into_iter().filter(|part| is_named(part.path())));
    }

    /// Returns the parts that are still to be determined automatically.
    fn remaining(&self) -> Vec<UndecidedPart> {
        UndecidedPart::ALL.into_iter().filter(|part| !self.parts.contains(part)).collect()
    }
}

/// Returns a look of the list suggested for a volume, counted from 1; `small` is a small copy of the volume.
pub(super) fn suggested_look(number: usize, first: &Settings, small: &Dataset) -> Result<Settings, CliError> {
    let mut looks = first_look::propose_looks(first, small.volume(), small.histogram());
    let count = looks.len();
    let at = number.checked_sub(1).filter(|&at| at < count);
    let Some(at) = at else {
        return Err(CliError::Usage(format!(
            "--look: expected 1 to {count}, found {number}; `info --json` lists the looks of a volume (command \
             line, --look)"
        )));
    };
    Ok(looks.swap_remove(at).settings)
}

/// Determines the open parts of a look automatically.
fn determine_open_parts(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    open: &[UndecidedPart],
) -> Result<Settings, CliError> {
    let look = complete_first_look(renderer, loaded, settings, open)?;
    if renderer.context().is_software() && look.casts_rays_to_all_samples() {
        warn_line(
            "warning: this software driver (CPU rendering) ends shadow rays to area lights too early, so that these \
             lights are too dark; --quality fine renders them correctly",
        );
    }
    Ok(look)
}

/// Suggested look, which is derived from the finished first look.
#[derive(Debug)]
pub(super) struct SuggestedLook {
    /// Number of the suggestion, counted from 1.
    pub(super) number: usize,
    /// First look before its open parts are determined.
    pub(super) automatic: Settings,
    /// Small copy of the volume.
    pub(super) small: Dataset,
    /// Presets and sessions to be applied.
    pub(super) overlays: Vec<PresetOrSession>,
    /// Arguments with further settings to be applied.
    pub(super) args: LookArgs,
}

/// Look that is complete except for the parts that need the GPU.
#[derive(Debug)]
pub(crate) struct SceneLook {
    settings: Settings,
    named: OverriddenParts,
    /// Suggested look that replaces the settings, if one was selected.
    proposed: Option<SuggestedLook>,
}

impl SceneLook {
    /// Creates a look from settings to which the arguments have been applied, and the automatic parts that they
    /// override.
    pub(super) fn new(settings: Settings, named: OverriddenParts, proposed: Option<SuggestedLook>) -> Self {
        Self { settings, named, proposed }
    }

    /// Returns the final settings. Lights are placed and balanced, and the exposure is set, as in the viewer after
    /// loading, unless a preset, session or single setting overrides them.
    pub(crate) fn settings(&self, renderer: &mut Renderer, loaded: &Dataset) -> Result<Settings, CliError> {
        let open = self.named.remaining();
        let Some(SuggestedLook { number, automatic, small, overlays, args: of }) = &self.proposed else {
            return determine_open_parts(renderer, loaded, &self.settings, &open);
        };
        let first =
            determine_open_parts(renderer, loaded, automatic, &OverriddenParts::default().remaining())?;
        let proposed = suggested_look(*number, &first, small)?;
        // Warnings were printed when the arguments were first applied.
        let (settings, _) = of.apply_to(proposed, overlays, loaded, |_| {})?;
        let brightness =
            [UndecidedPart::Balance, UndecidedPart::Exposure].into_iter().filter(|part| open.contains(part));
        determine_open_parts(renderer, loaded, &settings, &brightness.collect::<Vec<_>>())
    }
}
