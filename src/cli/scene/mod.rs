//! Arguments that say what is rendered, common to most commands.

mod choices;
mod corrections;
mod look;
mod overlay;
mod single_settings;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::{Args, ValueEnum};

use self::choices::{EngineArg, KindArg, QualityArg, ShadowArg};
pub(super) use self::corrections::{corrected, corrected_by};
pub(super) use self::look::Look;
use self::look::{Named, Proposed, proposal};
use self::overlay::Overlay;
use super::CliError;
use super::outputs::{keep_apart, warn_line};
use crate::data::load::{Choice, Endian, LoadControl, LoadOptions, Portion, RawFormat, Region, Thinning};
use crate::data::{Dataset, KindName, ValueRanges, Volume, VoxelType, open};
use crate::gpu::{Context, fitted, small_volume};
use crate::model::auto::Wishes;
use crate::model::{MAX_EDGE, SceneAxis, Settings, assign, auto};

/// How high the floor lies, by its path.
const FLOOR_HEIGHT: &str = "floor.height";

/// How a volume is read.
#[derive(Debug, Clone, Args)]
pub(super) struct LoadArgs {
    /// Average blocks of N × N × N voxels into one, for less memory and quicker pictures; 1 is all of them
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    reduce: Option<u16>,
    /// Read along each axis every Nth voxel alone, for less memory
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64), conflicts_with = "reduce")]
    every: Option<u16>,
    /// Voxels to read, along each axis from the first to before the last, counted from 0; an end may be left out
    #[arg(long, value_name = "X0:X1,Y0:Y1,Z0:Z1")]
    region: Option<Region>,
    /// RAW input: voxels along x, y, z
    #[arg(long, value_name = "WxHxD", global = false)]
    dims: Option<String>,
    /// RAW input: uint8, int8, uint16, int16, uint32, int32, float32 or float64
    #[arg(long = "type", value_name = "T", value_parser = parse_voxel_type)]
    voxel_type: Option<VoxelType>,
    /// RAW input: distance between voxels in millimetres
    #[arg(long, value_name = "SXxSYxSZ")]
    spacing: Option<String>,
    /// RAW input: byte order
    #[arg(long, value_enum)]
    endian: Option<EndianArg>,
    /// RAW input: bytes before the voxels
    #[arg(long, value_name = "BYTES")]
    offset: Option<u64>,
    /// Vectors and colours: the component that is shown, from 0, instead of their length or luminance
    #[arg(long, value_name = "N")]
    component: Option<usize>,
    /// Several time steps: the one that is shown, from 0
    #[arg(long, value_name = "N")]
    frame: Option<usize>,
    /// Several channels: the one that is shown, from 0
    #[arg(long, value_name = "N")]
    channel: Option<usize>,
    /// Several series in a folder: the one that is shown, by its number or name
    #[arg(long, value_name = "NAME")]
    series: Option<String>,
    /// Several arrays in a file: the one that is shown
    #[arg(long, value_name = "NAME")]
    array: Option<String>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EndianArg {
    Little,
    Big,
}

impl LoadArgs {
    /// The options for the reader.
    pub(super) fn load_options(&self) -> Result<LoadOptions, CliError> {
        let usage = |field: &str, text: &str, expected: &str| {
            CliError::Usage(format!(
                "--{field}: expected {expected}, found {text:?} (command line, --{field})"
            ))
        };
        let dims = match &self.dims {
            None => None,
            Some(text) => Some(
                triple::<usize>(text).ok_or_else(|| usage("dims", text, "three whole numbers, 64x64x32"))?,
            ),
        };
        let spacing_mm = match &self.spacing {
            None => None,
            Some(text) => {
                Some(triple::<f64>(text).ok_or_else(|| usage("spacing", text, "three numbers, 1x1x1.5"))?)
            }
        };
        let endian = self.endian.map(|endian| match endian {
            EndianArg::Little => Endian::Little,
            EndianArg::Big => Endian::Big,
        });
        let raw = RawFormat { dims, voxel_type: self.voxel_type, spacing_mm, endian, offset: self.offset };
        let choice = Choice {
            component: self.component,
            frame: self.frame,
            channel: self.channel,
            series: self.series.clone(),
            array: self.array.clone(),
            portion: self.portion(),
            ..Choice::default()
        };
        Ok(LoadOptions { raw, choice, ..LoadOptions::default() })
    }

    /// How much of the volume is read, where that is said.
    fn portion(&self) -> Option<Portion> {
        let thinning = match (self.every, self.reduce) {
            (Some(step), _) => Thinning::Every(step.into()),
            (None, Some(block)) => Thinning::Average(block.into()),
            (None, None) => Thinning::None,
        };
        let is_said = self.every.is_some() || self.reduce.is_some() || self.region.is_some();
        is_said.then_some(Portion { region: self.region, thinning })
    }

    /// Loads a volume, and opens the adapter.
    pub(super) fn open(&self, source: &Path) -> Result<(Volume, Context), CliError> {
        self.open_chosen(source, None)
    }

    /// As [`Self::open`]. Of several volumes it is that one, and as much of it as was read then, unless the command line
    /// says something else.
    pub(super) fn open_chosen(
        &self,
        source: &Path,
        choice: Option<&Choice>,
    ) -> Result<(Volume, Context), CliError> {
        let mut options = self.load_options()?;
        if let Some(choice) = choice {
            options.choice = options.choice.or(choice);
        }
        // What is wrong with a file is said first.
        let whole = open(source, &options, &LoadControl::new())?;
        let context = Context::headless()?;
        Ok((downsampled_to_fit(source, whole, &context)?, context))
    }
}

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

/// `uint8`
pub(super) fn parse_voxel_type(text: &str) -> Result<VoxelType, String> {
    let known = VoxelType::ALL.into_iter().find(|known| known.name() == text.to_lowercase());
    known.ok_or_else(|| format!("expected one of {}", VoxelType::ALL.map(VoxelType::name).join(", ")))
}

/// `1x2x3`.
fn triple<T: std::str::FromStr>(text: &str) -> Option<[T; 3]> {
    let parts: Vec<T> =
        text.split(['x', 'X', ',']).map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
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
        let LookArgs { preset, session, .. } = &self.look;
        let inputs = [Some(self.file.as_path()), preset.as_deref(), session.as_deref()];
        keep_apart(&inputs.into_iter().flatten().collect::<Vec<_>>(), outputs, self.force)
    }

    /// Finds the look.
    pub(super) fn look(&self, loaded: &Dataset) -> Result<Look, CliError> {
        self.look.look(loaded)
    }
}

impl LookArgs {
    /// Reads a volume, whatever shows it.
    pub(super) fn read_volume(&self, source: &Path) -> Result<Volume, CliError> {
        Ok(open(source, &self.load.load_options()?, &LoadControl::new())?)
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
        assert_eq!(triple("1x2x3"), Some([1usize, 2, 3]));
        assert_eq!(triple::<usize>("1x2"), None);
        assert_eq!(triple("0.5x1x2"), Some([0.5, 1.0, 2.0]));
    }
}
