//! Look that the arguments describe, with the parts that are determined automatically.

use super::LookArgs;
use super::overlay::Overlay;
use crate::cli::CliError;
use crate::cli::outputs::warn_line;
use crate::data::Dataset;
use crate::gpu::{Open, Renderer, finish_look};
use crate::model::{Settings, auto};

/// Parts of a look that are determined automatically unless they are given, with the paths of their settings.
const OPEN: [(&str, Open); 4] = [
    ("lights", Open::Lights),
    ("floor", Open::Floor),
    ("shadows.balance", Open::Balance),
    ("output.exposure", Open::Exposure),
];

/// Automatic parts that a preset, session or single setting overrides.
#[derive(Debug, Default)]
pub(super) struct Named {
    paths: Vec<&'static str>,
}

impl Named {
    /// Adds the parts for whose path `is_named` is true.
    pub(super) fn add(&mut self, is_named: impl Fn(&str) -> bool) {
        self.paths.extend(OPEN.iter().map(|(path, _)| *path).filter(|path| is_named(path)));
    }

    /// Returns the parts that are still to be determined automatically.
    fn open(&self) -> Vec<Open> {
        OPEN.iter().filter(|(path, _)| !self.paths.contains(path)).map(|(_, part)| *part).collect()
    }
}

/// Returns a look of the list suggested for a volume, counted from 1; `small` is a small copy of the volume.
pub(super) fn proposal(number: usize, first: &Settings, small: &Dataset) -> Result<Settings, CliError> {
    let mut looks = auto::looks(first, small.volume(), small.histogram());
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
fn finished(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    open: &[Open],
) -> Result<Settings, CliError> {
    let mut look = finish_look(renderer, loaded, settings, open)?;
    if look.floor.on && !settings.floor.on {
        // The exposure, on which the floor's colour depends, has only now been determined.
        look.floor.color = auto::floor_color(look.output.exposure);
    }
    if renderer.context().is_software() && look.casts_rays_to_all_points() {
        warn_line(
            "warning: this driver, which draws with the processor, ends rays to lights that have a size before they \
             arrive: such lights are too dark; --quality fine shows them as they are",
        );
    }
    Ok(look)
}

/// Suggested look, which is derived from the finished first look.
#[derive(Debug)]
pub(super) struct Proposed {
    /// Number of the suggestion, counted from 1.
    pub(super) number: usize,
    /// First look before its open parts are determined.
    pub(super) automatic: Settings,
    /// Small copy of the volume.
    pub(super) small: Dataset,
    /// Presets and sessions to be applied.
    pub(super) overlays: Vec<Overlay>,
    /// Arguments with further settings to be applied.
    pub(super) of: LookArgs,
}

/// Look that is complete except for the parts that need the GPU.
#[derive(Debug)]
pub(in crate::cli) struct Look {
    settings: Settings,
    named: Named,
    /// Suggested look that replaces the settings, if one was selected.
    proposed: Option<Proposed>,
}

impl Look {
    /// Creates a look from settings to which the arguments have been applied, and the automatic parts that they
    /// override.
    pub(super) fn new(settings: Settings, named: Named, proposed: Option<Proposed>) -> Self {
        Self { settings, named, proposed }
    }

    /// Returns the final settings. Lights are placed and balanced, and the exposure is set, as in the viewer after
    /// loading, unless a preset, session or single setting overrides them.
    pub(in crate::cli) fn settings(
        &self,
        renderer: &mut Renderer,
        loaded: &Dataset,
    ) -> Result<Settings, CliError> {
        let open = self.named.open();
        let Some(Proposed { number, automatic, small, overlays, of }) = &self.proposed else {
            return finished(renderer, loaded, &self.settings, &open);
        };
        let first = finished(renderer, loaded, automatic, &Named::default().open())?;
        let proposed = proposal(*number, &first, small)?;
        // Warnings were printed when the arguments were first applied.
        let (settings, _) = of.laid_over(proposed, overlays, loaded, |_| {})?;
        let brightness = [Open::Balance, Open::Exposure].into_iter().filter(|part| open.contains(part));
        finished(renderer, loaded, &settings, &brightness.collect::<Vec<_>>())
    }
}
