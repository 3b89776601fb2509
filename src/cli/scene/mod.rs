//! Command-line arguments that describe the scene, common to most commands.

mod corrections;
mod decompression_warning;
mod finer_levels;
mod layers;
mod load_args;
mod look;
mod option_values;
mod preset_or_session;
mod single_settings;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::Args;

pub(super) use self::corrections::{apply_command_line_corrections, apply_corrections};
pub(super) use self::decompression_warning::{
    control_with_size_warning, open_for_overview, open_with_size_warning,
};
pub(super) use self::finer_levels::{FinerLevelArgs, PageReader, PagedDataset, PoolArgs, say_missing_pages};
pub(super) use self::layers::add_layer;
use self::layers::{LayerArg, ShownSteps, with_all_channels, with_layers};
pub(super) use self::load_args::{LoadArgs, parse_voxel_type};
pub(super) use self::look::SceneLook;
use self::look::{OverriddenParts, SuggestedLook, suggested_look};
use self::option_values::{EngineArg, KindArg, QualityArg, ShadowArg};
use self::preset_or_session::PresetOrSession;
use super::CliError;
use super::output::{check_overwrites, warn_line};
use super::process::StageTimes;
use chiaroscuro_media::read_environment_map;
use chiaroscuro_render::{GpuContext, downsample_to_fit, downsampled_volume};
use chiaroscuro_scene::{
    EnvironmentMap, MAX_IMAGE_EDGE, SceneAxis, Settings,
    first_look::{self, FirstLookOptions},
    set_value,
};
use chiaroscuro_volume::{Dataset, KindName, LevelRule, LoadControl, ValueRanges, Volume, VolumeChoice};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Path of the setting for the floor's height.
const FLOOR_HEIGHT: &str = "floor.height";

/// Downsamples the volume if the adapter cannot hold it, with a warning.
fn downsampled_to_fit(source: &Path, whole: Volume, context: &GpuContext) -> Result<Volume, CliError> {
    let before = whole.dims();
    let volume = downsample_to_fit(context, whole)?;
    if volume.dims() != before {
        let ([x, y, z], [a, b, c]) = (before, volume.dims());
        warn_line(&format!(
            "warning: {x} × {y} × {z} voxels were averaged to {a} × {b} × {c}, because {} cannot hold more ({}); \
             --region shows a part of the volume with all of its voxels",
            context.info.name,
            source.display()
        ));
    }
    Ok(volume)
}

/// Parses a picture size such as `1920x1080`.
pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let expected =
        || format!("expected WIDTHxHEIGHT between 1x1 and {MAX_IMAGE_EDGE}x{MAX_IMAGE_EDGE}, found {text:?}");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let parse = |part: &str| part.trim().parse::<u32>().ok().filter(|n| (1..=MAX_IMAGE_EDGE).contains(n));
    Ok([parse(width).ok_or_else(expected)?, parse(height).ok_or_else(expected)?])
}

/// Arguments that describe the look.
#[derive(Debug, Clone, Args)]
pub(super) struct LookArgs {
    /// Number of a suggested look to use instead of the first; `info --json` lists them
    #[arg(long, value_name = "N")]
    look: Option<usize>,
    /// Preset to apply to the automatic look: a name or a JSON file
    #[arg(long, value_name = "NAME|FILE")]
    preset: Option<PathBuf>,
    /// Session to restore: a JSON file or an exported picture
    #[arg(long, value_name = "FILE")]
    session: Option<PathBuf>,
    /// Environment map that lights the scene: a panorama twice as wide as high (.hdr, .exr, .png, .jpg); overrides
    /// preset and session
    #[arg(long, value_name = "FILE")]
    surroundings: Option<PathBuf>,
    /// Kind of data to show the volume as, instead of the detected kind
    #[arg(long = "as", value_name = "KIND", value_enum)]
    treat_as: Option<KindArg>,
    /// Accuracy of lighting; --set and --shadows override parts of it
    #[arg(long, value_enum)]
    quality: Option<QualityArg>,
    /// Set a single setting by its path, for instance shadows.strength=0.5; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Show up to four channels or components of the file together
    #[arg(long)]
    all_channels: bool,
    /// Further volume to show with the first, with options such as :channel=1 or :blend=tint (add, tint, gate); may be
    /// repeated
    #[arg(long = "layer", value_name = "FILE[:KEY=VALUE,...]")]
    layers: Vec<LayerArg>,
    /// Algorithm of light volumes and shadows
    #[arg(long, value_enum)]
    shadows: Option<ShadowArg>,
    /// Method of filling the sheets
    #[arg(long, value_enum)]
    engine: Option<EngineArg>,
    #[command(flatten)]
    load: LoadArgs,
    /// Preset and session after they have been read: a pipe can be read only once.
    #[arg(skip)]
    overlay_cache: OnceLock<Vec<PresetOrSession>>,
    /// Panorama after it has been read, cached for the same reason.
    #[arg(skip)]
    environment_cache: OnceLock<Option<EnvironmentMap>>,
}

/// Arguments for the volume and its look.
#[derive(Debug, Clone, Args)]
pub(super) struct SceneArgs {
    #[arg(help = "Volume: a file, or builtin:NAME[:N]")]
    file: PathBuf,
    #[command(flatten)]
    look: LookArgs,
    /// Replace files that were not written by this program
    #[arg(long)]
    force: bool,
}

/// Remark where a table was to be hidden that is not there.
pub(super) const NO_TABLE: &str = "no table was found under a body, so nothing is hidden";

/// Computes a volume's dataset, and warns of values that are not finite, and of a table that was not found.
fn dataset_with_warning(volume: Volume) -> Dataset {
    let missing = volume.non_finite_voxels();
    if missing > 0 {
        warn_line(&format!("warning: {missing} voxels are not finite and are treated as missing"));
    }
    if volume.lacks_table() {
        warn_line(&format!("warning: {NO_TABLE}"));
    }
    Dataset::new(volume)
}

impl SceneArgs {
    /// Loads the volume, and opens the adapter that renders it.
    pub(super) fn load(&self) -> Result<(Dataset, GpuContext), CliError> {
        self.load_timed(&mut StageTimes::from_now(), LevelRule::Finest)
    }

    /// Loads like [`Self::load`], and records in `times` what volume and adapter took beside each other.
    pub(super) fn load_timed(
        &self,
        times: &mut StageTimes,
        level: LevelRule,
    ) -> Result<(Dataset, GpuContext), CliError> {
        let choice = self.look.first_choice();
        let (volume, context) = self.look.load.open(&self.file, choice.as_ref(), times, level)?;
        let dataset = dataset_with_warning(self.look.corrected(&self.file, volume)?);
        Ok((self.look.with_layers(&self.file, dataset, ShownSteps::Several)?, context))
    }

    /// Loads like [`Self::load`], and of a file that holds several time steps the one with this number, unless the
    /// arguments name another.
    pub(super) fn load_step(&self, step: usize) -> Result<(Dataset, GpuContext), CliError> {
        let first = self.look.first_choice();
        let (volume, context) = self.look.load.open_step(&self.file, first.as_ref(), step)?;
        let dataset = dataset_with_warning(self.look.corrected(&self.file, volume)?);
        Ok((self.look.with_layers(&self.file, dataset, ShownSteps::One)?, context))
    }

    /// Returns the options with which the volume is read.
    pub(super) fn load_options(&self) -> Result<LoadOptions, CliError> {
        self.look.load.load_options()
    }

    /// Path or built-in name of the volume.
    pub(super) fn source(&self) -> &Path {
        &self.file
    }

    /// Rejects outputs that would replace an input, another output or, without `--force`, a file that this program
    /// has not made.
    pub(super) fn keep_apart(&self, outputs: &[&Path]) -> Result<(), CliError> {
        self.keep_apart_from([], outputs)
    }

    /// Rejects outputs as [`Self::keep_apart`] does, also those that would replace a `further` input.
    pub(super) fn keep_apart_from<'p>(
        &'p self,
        further: impl IntoIterator<Item = &'p Path>,
        outputs: &[&Path],
    ) -> Result<(), CliError> {
        let LookArgs { preset, session, surroundings, .. } = &self.look;
        let named = [preset, session, surroundings].map(|path| path.as_deref());
        let layers = self.look.layers.iter().map(|layer| Some(layer.source()));
        let inputs = named.into_iter().chain([Some(self.file.as_path())]).chain(layers).flatten();
        check_overwrites(&inputs.chain(further).collect::<Vec<_>>(), outputs, self.force)
    }

    /// Applies the arguments of the look to the automatic look.
    pub(super) fn look(&self, loaded: &Dataset) -> Result<SceneLook, CliError> {
        self.look.look(loaded)
    }
}

impl LookArgs {
    /// Reads a volume, without regard to an adapter.
    pub(super) fn read_volume(&self, source: &Path, control: &LoadControl) -> Result<Volume, CliError> {
        let mut options = self.load.load_options()?;
        options.choice.fall_back_to_first |= self.all_channels;
        Ok(open(source, &options, control)?)
    }

    /// Choice of the first channel, if all are shown.
    fn first_choice(&self) -> Option<VolumeChoice> {
        self.all_channels.then(|| VolumeChoice::default().with_first_as_fallback())
    }

    /// Returns the corrected dataset of a volume, downsampled if the adapter cannot hold it.
    pub(super) fn adapter_dataset(
        &self,
        source: &Path,
        whole: Volume,
        context: &GpuContext,
    ) -> Result<Dataset, CliError> {
        let volume = downsampled_to_fit(source, whole, context)?;
        let dataset = dataset_with_warning(self.corrected(source, volume)?);
        self.with_layers(source, dataset, ShownSteps::Several)
    }

    /// Adds the other channels of a file, if they are wanted, and the volumes of further layers.
    fn with_layers(&self, source: &Path, dataset: Dataset, steps: ShownSteps) -> Result<Dataset, CliError> {
        let dataset = if self.all_channels { with_all_channels(source, &dataset, steps)? } else { dataset };
        match steps {
            ShownSteps::Several => with_layers(dataset, &self.layers),
            ShownSteps::One => {
                let layers: Vec<_> =
                    self.layers.iter().map(|layer| layer.at_step_of(source, dataset.volume())).collect();
                with_layers(dataset, &layers)
            }
        }
    }

    /// Returns the preset and the session that the arguments name; the later one takes precedence.
    fn overlays(&self) -> Result<Vec<PresetOrSession>, CliError> {
        if let Some(read) = self.overlay_cache.get() {
            return Ok(read.clone());
        }
        let named = [("preset", &self.preset), ("session", &self.session)];
        let read =
            named.into_iter().filter_map(|(what, path)| Some(PresetOrSession::read(what, path.as_ref()?)));
        let read = read.collect::<Result<_, _>>()?;
        Ok(self.overlay_cache.get_or_init(|| read).clone())
    }

    /// Returns the panorama that the arguments name.
    fn environment_map(&self) -> Result<Option<&EnvironmentMap>, CliError> {
        if self.environment_cache.get().is_none() {
            let read = self.surroundings.as_deref().map(read_environment_map).transpose()?;
            return Ok(self.environment_cache.get_or_init(|| read).as_ref());
        }
        Ok(self.environment_cache.get().and_then(Option::as_ref))
    }

    /// Applies the corrections of the session and of single settings to an opened volume.
    fn corrected(&self, source: &Path, volume: Volume) -> Result<Volume, CliError> {
        let opened_id = volume.opened_id();
        let overlays = self.overlays()?;
        let of_session = overlays.iter().rev().find_map(|overlay| overlay.corrections_of(opened_id));
        let by = corrections::with_assignments(of_session.unwrap_or_default(), &self.set)?;
        apply_corrections(source, volume, &by)
    }

    /// Returns the scene axis that points up, if a preset, session or single setting names one.
    fn requested_up(&self, overlays: &[PresetOrSession], ranges: &ValueRanges) -> Option<SceneAxis> {
        let of_setting = |assignment: &String| {
            let (path, value) = assignment.split_once('=')?;
            let path = Some(path.trim()).filter(|path| ["camera", "camera.up"].contains(path))?;
            // Errors are reported when the setting is applied.
            let settings = set_value(&Settings::default(), path, value.trim()).ok()?.settings;
            Some(settings.camera.up)
        };
        let of_overlays = overlays.iter().filter_map(|overlay| overlay.up(ranges));
        of_overlays.chain(self.set.iter().filter_map(of_setting)).last()
    }

    /// Returns the automatic look, for the up axis that was requested, so that lights and floor match it.
    fn first_settings(&self, overlays: &[PresetOrSession], loaded: &Dataset) -> Settings {
        let (volume, histogram) = (loaded.volume(), loaded.histogram());
        let treated_as = self.treat_as.map(KindName::from);
        let Some(up) = self.requested_up(overlays, &volume.ranges()) else {
            return first_look::first_settings_with(
                volume,
                histogram,
                FirstLookOptions { data_kind: treated_as, ..FirstLookOptions::default() },
            );
        };
        let mut settings = first_look::first_settings_with(
            volume,
            histogram,
            FirstLookOptions { data_kind: treated_as, up: Some(up) },
        );
        // Overrides the orientation from the file.
        first_look::set_up_axis(&mut settings, volume, up);
        settings
    }

    /// Applies preset, session and single settings to the automatic look. All of them are validated here, before
    /// anything slow begins.
    pub(super) fn look(&self, loaded: &Dataset) -> Result<SceneLook, CliError> {
        let overlays = self.overlays()?;
        let mut automatic = self.first_settings(&overlays, loaded);
        first_look::add_layers(&mut automatic, loaded);
        let (settings, named) = self.apply_to(automatic.clone(), &overlays, loaded, warn_line)?;
        let proposed = match self.look {
            None | Some(1) => None,
            Some(number) => {
                let small = downsampled_volume(loaded)?;
                // Validates the number; the look itself is derived later.
                suggested_look(number, &automatic, &small)?;
                Some(SuggestedLook { number, automatic, small, overlays, args: self.clone() })
            }
        };
        Ok(SceneLook::new(settings, named, proposed))
    }

    /// Applies preset, session and single settings, and returns the automatic parts that they override.
    fn apply_to(
        &self,
        mut settings: Settings,
        overlays: &[PresetOrSession],
        loaded: &Dataset,
        warn: impl Fn(&str),
    ) -> Result<(Settings, OverriddenParts), CliError> {
        let volume = loaded.volume();
        let before = settings.clone();
        let mut named = OverriddenParts::default();
        for overlay in overlays {
            named.add(|part| overlay.contains_setting(part));
            settings = overlay.apply_to(&settings, &volume.ranges(), &warn)?;
        }
        if let Some(surroundings) = self.environment_map()? {
            settings.apply_environment_map(surroundings);
            named.add(|part| ["lights", "shadows.balance"].contains(&part));
        }
        // Channels of the file come before other layers.
        let first = loaded.fields().len().saturating_sub(self.layers.len());
        for (layer, index) in self.layers.iter().zip(first..) {
            settings = layer.apply_to(settings, index)?;
        }
        let mut settings = self.apply_single_settings(settings, warn)?;
        // The volume already has these corrections.
        settings.volume = *volume.corrections();
        named.add(|part| self.is_set(part));
        let says_how_high =
            self.is_set(FLOOR_HEIGHT) || overlays.iter().any(|one| one.contains_setting(FLOOR_HEIGHT));
        let shows = |look: &Settings| (look.layer().transfer.clone(), look.layer().range, look.camera.up);
        if !says_how_high && shows(&settings) != shows(&before) {
            first_look::lay_floor(&mut settings, volume);
        }
        Ok((settings, named))
    }

    /// Returns true if an assignment of the command line refers to a setting, to a part of it or to a group that
    /// contains it.
    fn is_set(&self, path: &str) -> bool {
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
