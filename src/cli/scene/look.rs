//! The look that arguments describe, with what the program decides where nobody else does.

use super::LookArgs;
use crate::cli::CliError;
use crate::data::Dataset;
use crate::gpu::{Open, Renderer, finish_look, small_volume};
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

/// A look of a list that is proposed for a volume, counted from 1.
pub(super) fn proposal(number: usize, first: &Settings, loaded: &Dataset) -> Result<Settings, CliError> {
    let small = small_volume(loaded)?;
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

/// A look that is complete but for what needs the GPU to be decided.
#[derive(Debug)]
pub(in crate::cli) struct Look {
    settings: Settings,
    named: Named,
    /// What it is laid over.
    automatic: Settings,
    of: LookArgs,
}

impl Look {
    /// Settings that are laid over automatic ones, as the arguments say, and the parts that these name.
    pub(super) fn new(settings: Settings, named: Named, automatic: Settings, of: LookArgs) -> Self {
        Self { settings, named, automatic, of }
    }

    /// The settings. Lights are placed and balanced, and the picture exposed, as the viewer does on load, unless preset,
    /// session or a single setting say how.
    pub(in crate::cli) fn settings(
        &self,
        renderer: &mut Renderer,
        loaded: &Dataset,
    ) -> Result<Settings, CliError> {
        let open = self.named.open();
        let number = self.of.look.unwrap_or(1);
        if number == 1 {
            return Ok(finish_look(renderer, loaded, &self.settings, &open)?);
        }
        // Others are made from the finished first look.
        let first = finish_look(renderer, loaded, &self.automatic, &Named::default().open())?;
        let proposed = proposal(number, &first, loaded)?;
        // Warnings have been given.
        let (settings, _) = self.of.laid_over(proposed, loaded, |_| {})?;
        let brightness = [Open::Balance, Open::Exposure].into_iter().filter(|part| open.contains(part));
        Ok(finish_look(renderer, loaded, &settings, &brightness.collect::<Vec<_>>())?)
    }
}
