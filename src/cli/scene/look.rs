//! The look that arguments describe, with what the program decides where nobody else does.

use super::LookArgs;
use super::overlay::Overlay;
use crate::cli::CliError;
use crate::cli::outputs::warn_line;
use crate::data::Dataset;
use crate::gpu::{Open, Renderer, finish_look};
use crate::model::{Settings, auto};

/// Parts of a look that the program decides where nobody else does, by the paths of their settings.
const OPEN: [(&str, Open); 4] = [
    ("lights", Open::Lights),
    ("floor", Open::Floor),
    ("shadows.balance", Open::Balance),
    ("output.exposure", Open::Exposure),
];

/// Those that preset, session or single settings name.
#[derive(Debug, Default)]
pub(super) struct Named {
    paths: Vec<&'static str>,
}

impl Named {
    /// Adds those of which something says so, by their paths.
    pub(super) fn add(&mut self, is_named: impl Fn(&str) -> bool) {
        self.paths.extend(OPEN.iter().map(|(path, _)| *path).filter(|path| is_named(path)));
    }

    /// Those that are left open.
    fn open(&self) -> Vec<Open> {
        OPEN.iter().filter(|(path, _)| !self.paths.contains(path)).map(|(_, part)| *part).collect()
    }
}

/// A look of a list that is proposed for a volume, counted from 1; `small` is a small copy of the volume.
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

/// Settings with those parts decided that are open.
fn finished(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    open: &[Open],
) -> Result<Settings, CliError> {
    let mut look = finish_look(renderer, loaded, settings, open)?;
    if look.floor.on && !settings.floor.on {
        // How long the picture is exposed has been found since the floor was laid.
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

/// A look that is made from the finished first one.
#[derive(Debug)]
pub(super) struct Proposed {
    /// Which one, counted from 1.
    pub(super) number: usize,
    /// The first look before it is finished.
    pub(super) automatic: Settings,
    /// A small copy of the volume.
    pub(super) small: Dataset,
    /// What is laid over it.
    pub(super) overlays: Vec<Overlay>,
    /// The arguments.
    pub(super) of: LookArgs,
}

/// A look that is complete but for what needs the GPU to be decided.
#[derive(Debug)]
pub(in crate::cli) struct Look {
    settings: Settings,
    named: Named,
    /// Instead of the settings, where another look than the first was asked for.
    proposed: Option<Proposed>,
}

impl Look {
    /// Settings that are laid over automatic ones, as the arguments say, and the parts that these name.
    pub(super) fn new(settings: Settings, named: Named, proposed: Option<Proposed>) -> Self {
        Self { settings, named, proposed }
    }

    /// The settings. Lights are placed and balanced, and the picture exposed, as the viewer does on load, unless preset,
    /// session or a single setting say how.
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
        // Warnings have been given.
        let (settings, _) = of.laid_over(proposed, overlays, loaded, |_| {})?;
        let brightness = [Open::Balance, Open::Exposure].into_iter().filter(|part| open.contains(part));
        finished(renderer, loaded, &settings, &brightness.collect::<Vec<_>>())
    }
}
