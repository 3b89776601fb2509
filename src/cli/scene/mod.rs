//! Arguments that say what is rendered, common to most commands.

mod choices;
mod corrections;
mod load_args;
mod look;
mod overlay;
mod single_settings;
mod unfolding;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::Args;

use self::choices::{EngineArg, KindArg, QualityArg, ShadowArg};
pub(super) use self::corrections::{corrected, corrected_by};
pub(super) use self::load_args::{LoadArgs, parse_voxel_type};
pub(super) use self::look::Look;
use self::look::{Named, Proposed, proposal};
use self::overlay::Overlay;
pub(super) use self::unfolding::{open_for_a_glance, open_with_word};
use super::CliError;
use super::outputs::{keep_apart, warn_line};
use crate::data::{Dataset, KindName, Surroundings, ValueRanges, Volume, read_surroundings};
use crate::gpu::{Context, fitted, small_volume};
use crate::model::auto::Wishes;
use crate::model::{MAX_EDGE, SceneAxis, Settings, assign, auto};

/// How high the floor lies, by its path.
const FLOOR_HEIGHT: &str = "floor.height";

/// The volume as the adapter can hold it.
fn downsampled_to_fit(source: &Path, whole: Volume, context: &Context) -> Result<Volume, CliError> {
    let before = whole.dims();
    let volume = fitted(context, whole)?;
    if volume.dims() != before {
        let ([x, y, z], [a, b, c]) = (before, volume.dims());
        warn_line(&format!(
            "warning: {x} × {y} × {z} voxels were averaged to {a} × {b} × {c}: {} cannot hold more ({}); a \
             crop of it can be shown with all of its voxels",
            context.info.name,
            source.display()
        ));
    }
    Ok(volume)
}

/// `1920x1080`.
pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let expected = || format!("expected WIDTHxHEIGHT between 1x1 and {MAX_EDGE}x{MAX_EDGE}, found {text:?}");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let parse = |part: &str| part.trim().parse::<u32>().ok().filter(|n| (1..=MAX_EDGE).contains(n));
    Ok([parse(width).ok_or_else(expected)?, parse(height).ok_or_else(expected)?])
}

/// The look.
#[derive(Debug, Clone, Args)]
pub(super) struct LookArgs {
    /// The look that is proposed under this number instead of the first; `info --json` lists them
    #[arg(long, value_name = "N")]
    look: Option<usize>,
    /// Preset to lay over the automatic look: a name or a JSON file
    #[arg(long, value_name = "NAME|FILE")]
    preset: Option<PathBuf>,
    /// Session to restore: a JSON file, or a picture that was exported
    #[arg(long, value_name = "FILE")]
    session: Option<PathBuf>,
    /// Panorama to light the scene by (.hdr, .exr, .png, .jpg, twice as wide as high), over preset and session
    #[arg(long, value_name = "FILE")]
    surroundings: Option<PathBuf>,
    /// What kind of data the volume is shown as, whatever it seems to be
    #[arg(long = "as", value_name = "KIND", value_enum)]
    treat_as: Option<KindArg>,
    /// How truly light is computed; single settings and --shadows are laid over it
    #[arg(long, value_enum)]
    quality: Option<QualityArg>,
    /// One setting by its path, for instance shadows.strength=0.5; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// How shadows are made
    #[arg(long, value_enum)]
    shadows: Option<ShadowArg>,
    /// How sheets are filled
    #[arg(long, value_enum)]
    engine: Option<EngineArg>,
    #[command(flatten)]
    load: LoadArgs,
    /// Preset and session once they have been read, which a pipe allows once.
    #[arg(skip)]
    read: OnceLock<Vec<Overlay>>,
    /// The panorama, likewise.
    #[arg(skip)]
    lit_by: OnceLock<Option<Surroundings>>,
}

/// What is rendered, and how it looks.
#[derive(Debug, Clone, Args)]
pub(super) struct SceneArgs {
    #[arg(help = "Volume: a file, or builtin:NAME[:N]")]
    file: PathBuf,
    #[command(flatten)]
    look: LookArgs,
    /// Replace files that this program has not made
    #[arg(long)]
    force: bool,
}

/// A volume with what follows from it, after a word about values that are not finite.
fn checked(volume: Volume) -> Dataset {
    let missing = volume.non_finite_voxels();
    if missing > 0 {
        warn_line(&format!("warning: {missing} voxels are not finite and count as nothing"));
    }
    Dataset::new(volume)
}

impl SceneArgs {
    /// Loads the volume, and opens the adapter that shows it.
    pub(super) fn load(&self) -> Result<(Dataset, Context), CliError> {
        let (volume, context) = self.look.load.open(&self.file)?;
        Ok((checked(self.look.corrected(&self.file, volume)?), context))
    }

    /// What is to be loaded.
    pub(super) fn source(&self) -> &Path {
        &self.file
    }

    /// Refuses to write over what is read, or twice over one file, or over files of others unless that is wanted.
    pub(super) fn keep_apart(&self, outputs: &[&Path]) -> Result<(), CliError> {
        let LookArgs { preset, session, surroundings, .. } = &self.look;
        let named = [preset, session, surroundings].map(|path| path.as_deref());
        let inputs = named.into_iter().chain([Some(self.file.as_path())]);
        keep_apart(&inputs.flatten().collect::<Vec<_>>(), outputs, self.force)
    }

    /// Finds the look.
    pub(super) fn look(&self, loaded: &Dataset) -> Result<Look, CliError> {
        self.look.look(loaded)
    }
}

impl LookArgs {
    /// Reads a volume, whatever shows it.
    pub(super) fn read_volume(&self, source: &Path) -> Result<Volume, CliError> {
        Ok(open_with_word(source, &self.load.load_options()?)?)
    }

    /// What an adapter shows of a volume that was read.
    pub(super) fn shown(&self, source: &Path, whole: Volume, context: &Context) -> Result<Dataset, CliError> {
        let volume = downsampled_to_fit(source, whole, context)?;
        Ok(checked(self.corrected(source, volume)?))
    }

    /// The preset and the session that the arguments name, the one that counts last.
    fn overlays(&self) -> Result<Vec<Overlay>, CliError> {
        if let Some(read) = self.read.get() {
            return Ok(read.clone());
        }
        let named = [("preset", &self.preset), ("session", &self.session)];
        let read = named.into_iter().filter_map(|(what, path)| Some(Overlay::read(what, path.as_ref()?)));
        let read = read.collect::<Result<_, _>>()?;
        Ok(self.read.get_or_init(|| read).clone())
    }

    /// The panorama that the arguments name.
    fn lit_by(&self) -> Result<Option<&Surroundings>, CliError> {
        if self.lit_by.get().is_none() {
            let read = self.surroundings.as_deref().map(read_surroundings).transpose()?;
            return Ok(self.lit_by.get_or_init(|| read).as_ref());
        }
        Ok(self.lit_by.get().and_then(Option::as_ref))
    }

    /// A volume that was opened, corrected as its session and single settings say.
    fn corrected(&self, source: &Path, volume: Volume) -> Result<Volume, CliError> {
        let opened_id = volume.opened_id();
        let overlays = self.overlays()?;
        let of_session = overlays.iter().rev().find_map(|overlay| overlay.corrections_of(opened_id));
        let by = corrections::laid_over(of_session.unwrap_or_default(), &self.set)?;
        corrected(source, volume, &by)
    }

    /// The axis that is to point up, if preset, session or single settings name one.
    fn up(&self, overlays: &[Overlay], ranges: &ValueRanges) -> Option<SceneAxis> {
        let of_setting = |assignment: &String| {
            let (path, value) = assignment.split_once('=')?;
            let path = Some(path.trim()).filter(|path| ["camera", "camera.up"].contains(path))?;
            // What cannot be understood is said when it is its turn.
            let (settings, _) = assign(&Settings::default(), path, value.trim()).ok()?;
            Some(settings.camera.up)
        };
        let of_overlays = overlays.iter().filter_map(|overlay| overlay.up(ranges));
        of_overlays.chain(self.set.iter().filter_map(of_setting)).last()
    }

    /// The automatic look, of a volume that stands as somebody says: lights and floor are where they belong then.
    fn first_settings(&self, overlays: &[Overlay], loaded: &Dataset) -> Settings {
        let (volume, histogram) = (loaded.volume(), loaded.histogram());
        let treated_as = self.treat_as.map(KindName::from);
        let Some(up) = self.up(overlays, &volume.ranges()) else {
            return auto::first_settings_with(volume, histogram, Wishes { treated_as, ..Wishes::default() });
        };
        let mut settings = auto::first_settings_with(volume, histogram, Wishes { treated_as, up });
        // Against what the file says.
        auto::stand(&mut settings, volume, up);
        settings
    }

    /// The automatic look, with preset, session and single settings laid over it.
    /// All of them are checked here, before anything slow begins.
    pub(super) fn look(&self, loaded: &Dataset) -> Result<Look, CliError> {
        let overlays = self.overlays()?;
        let automatic = self.first_settings(&overlays, loaded);
        let (settings, named) = self.laid_over(automatic.clone(), &overlays, loaded, warn_line)?;
        let proposed = match self.look {
            None | Some(1) => None,
            Some(number) => {
                let small = small_volume(loaded)?;
                // Whether there is one; what it is made from is found later.
                proposal(number, &automatic, &small)?;
                Some(Proposed { number, automatic, small, overlays, of: self.clone() })
            }
        };
        Ok(Look::new(settings, named, proposed))
    }

    /// Settings with preset, session and single settings laid over them, and which open parts these name.
    fn laid_over(
        &self,
        mut settings: Settings,
        overlays: &[Overlay],
        loaded: &Dataset,
        warn: impl Fn(&str),
    ) -> Result<(Settings, Named), CliError> {
        let volume = loaded.volume();
        let before = settings.clone();
        let mut named = Named::default();
        for overlay in overlays {
            named.add(|part| overlay.names(part));
            settings = overlay.over(&settings, &volume.ranges(), &warn)?;
        }
        if let Some(surroundings) = self.lit_by()? {
            settings.surround(surroundings);
            named.add(|part| ["lights", "shadows.balance"].contains(&part));
        }
        let mut settings = self.single_settings(settings, warn)?;
        // It has been made into the volume.
        settings.volume = *volume.corrections();
        named.add(|part| self.sets(part));
        let says_how_high = self.sets(FLOOR_HEIGHT) || overlays.iter().any(|one| one.names(FLOOR_HEIGHT));
        let shows = |look: &Settings| (look.transfer.clone(), look.range, look.camera.up);
        if !says_how_high && shows(&settings) != shows(&before) {
            auto::lay_floor(&mut settings, volume);
        }
        Ok((settings, named))
    }

    /// Whether a single setting of the command line is one, or a part or the whole of it. Whoever names it means it.
    fn sets(&self, path: &str) -> bool {
        self.set.iter().any(|assignment| {
            let set = assignment.split('=').next().unwrap_or_default().trim();
            let is_within = |inner: &str, outer: &str| {
                inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            };
            is_within(set, path) || is_within(path, set)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_triples() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for bad in ["640", "0x10", "-1x4", "99999x1", "axb", ""] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }
}
