//! Further volumes that are shown with the first one, as layers.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::open_with_size_warning;
use crate::cli::CliError;
use chiaroscuro_scene::{Settings, set_value};
use chiaroscuro_volume::{
    Dataset, FileContents, FileDimension, MAX_FIELDS, Volume, VolumeAlternatives, VolumeChoice,
};
use chiaroscuro_volume_io::{LoadOptions, is_same_file};

/// Volume to be shown as a layer: `FILE[:key=value,…]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct LayerArg {
    source: PathBuf,
    /// Selected volume, if the file has several.
    choice: VolumeChoice,
    /// Settings of the layer by their paths in it.
    settings: Vec<(String, String)>,
}

impl FromStr for LayerArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // A colon may also belong to the path, or to the name of a built-in volume.
        let (source, options) = match text.rsplit_once(':') {
            Some((source, options)) if options.contains('=') => (source, options),
            _ => (text, ""),
        };
        let mut layer = Self { source: source.into(), choice: VolumeChoice::default(), settings: Vec::new() };
        for option in options.split(',').filter(|option| !option.is_empty()) {
            let (key, value) = option
                .split_once('=')
                .ok_or_else(|| format!("expected FILE:key=value,key=value, found {option:?} in {text:?}"))?;
            let (key, value) = (key.trim(), value.trim());
            let number = || {
                let parsed = value.parse::<usize>();
                parsed.map(Some).map_err(|_not_a_number| {
                    format!("expected a whole number from 0 for {key}, found {value:?}")
                })
            };
            match key {
                "channel" => layer.choice.channel = number()?,
                "component" => layer.choice.component = number()?,
                "frame" => layer.choice.frame = number()?,
                "series" => layer.choice.series = Some(value.to_owned()),
                "array" => layer.choice.array = Some(value.to_owned()),
                "level" => layer.choice.level = Some(value.to_owned()),
                _ => layer.settings.push((key.to_owned(), value.to_owned())),
            }
        }
        Ok(layer)
    }
}

impl LayerArg {
    /// Path or built-in name of the volume.
    pub(super) fn source(&self) -> &Path {
        &self.source
    }

    /// Returns the layer with the time step of an opened volume, if it is of the same file and names none itself.
    pub(super) fn at_step_of(&self, source: &Path, opened: &Volume) -> Self {
        let mut layer = self.clone();
        if layer.choice.frame.is_none() && is_same_file(&layer.source, source) {
            layer.choice.frame = opened.contents().choice().frame;
        }
        layer
    }

    /// Applies the settings of the layer, which is the one at `index`.
    pub(super) fn apply_to(&self, settings: Settings, index: usize) -> Result<Settings, CliError> {
        self.settings.iter().try_fold(settings, |settings, (key, value)| {
            let applied = set_value(&settings, &format!("layers.{index}.{key}"), value);
            applied.map(|applied| applied.settings).map_err(|err| CliError::Usage(format!("--layer: {err}")))
        })
    }
}

/// Time steps of a file that one picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShownSteps {
    /// Few steps are shown together, as channels are.
    Several,
    /// One step is shown, as a frame of an animation does.
    One,
}

/// Opens the volumes of layers, and adds them to a dataset.
pub(super) fn with_layers(dataset: Dataset, layers: &[LayerArg]) -> Result<Dataset, CliError> {
    layers.iter().try_fold(dataset, |dataset, layer| add_layer(&dataset, &layer.source, &layer.choice))
}

/// Adds the channels of a file that are not shown to a dataset, the components of its voxels, or its few time steps if
/// several of them are shown, as far as there is room.
pub(super) fn with_all_channels(
    source: &Path,
    dataset: &Dataset,
    steps: ShownSteps,
) -> Result<Dataset, CliError> {
    let held = dataset.volume().contents();
    let unmatched = held.alternatives.iter().find_map(|several| {
        several.unmatched_selection.as_ref().map(|said| (several.dimension.option(), said))
    });
    if let Some((option, said)) = unmatched {
        let why = format!("{option}: {} has no {said:?}", source.display());
        return Err(CliError::Usage(why));
    }
    let choices = other_channels(held, steps);
    if choices.is_empty() {
        let why = format!("--all-channels: {} has a single channel; leave this option out", source.display());
        return Err(CliError::Usage(why));
    }
    let room = MAX_FIELDS.saturating_sub(dataset.fields().len());
    let (first, rest) = (dataset.clone(), choices.iter().take(room));
    rest.clone().try_fold(first, |dataset, choice| add_layer(&dataset, source, choice))
}

/// Returns the choices of the channels that are not shown, or else of the components, or else of the time steps that
/// are shown together.
fn other_channels(held: &FileContents, steps: ShownSteps) -> Vec<VolumeChoice> {
    let shown = held.choice();
    let others_in = |several: &VolumeAlternatives| {
        let others = several.offers.iter().enumerate().filter(|(at, _)| *at != several.selected);
        others.map(|(_, offer)| shown.clone().with_selected(several.dimension, &offer.key)).collect()
    };
    if let Some(channels) = held.alternatives_in(FileDimension::Channel) {
        others_in(channels)
    } else if let Some(components) = held.components {
        let others = (0..components.count).filter(|at| Some(*at) != components.selected);
        others.map(|at| VolumeChoice { component: Some(at), ..shown.clone() }).collect()
    } else {
        let frames = held.alternatives_in(FileDimension::Frame).filter(|_| steps == ShownSteps::Several);
        frames.filter(|frames| frames.offers.len() <= MAX_FIELDS).map_or_else(Vec::new, others_in)
    }
}

/// Opens a volume, and adds it to a dataset.
pub(crate) fn add_layer(
    dataset: &Dataset,
    source: &Path,
    choice: &VolumeChoice,
) -> Result<Dataset, CliError> {
    let options = LoadOptions { choice: choice.clone(), ..LoadOptions::default() };
    let volume = open_with_size_warning(source, &options)?;
    dataset
        .with_field(&volume, source)
        .map_err(|err| CliError::Layer { path: source.to_owned(), source: err })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_is_a_file_with_options() {
        let plain: LayerArg = "builtin:cells:64".parse().unwrap();
        assert_eq!((plain.source(), plain.settings.len()), (Path::new("builtin:cells:64"), 0));
        let parsed: LayerArg = r"C:\data\a.tif:channel=2,blend=gate,lighting.scale=0.5".parse().unwrap();
        assert_eq!(parsed.source(), Path::new(r"C:\data\a.tif"));
        assert_eq!(parsed.choice.channel, Some(2));
        assert_eq!(parsed.settings[1], ("lighting.scale".to_owned(), "0.5".to_owned()));
        assert!("a:channel=x".parse::<LayerArg>().unwrap_err().contains("whole number"));
        let mut settings = Settings::default();
        settings.layers.push(settings.layer().clone());
        let applied = parsed.apply_to(settings.clone(), 1).unwrap();
        assert_eq!(applied.layers.get(1).unwrap().lighting.scale, 0.5);
        assert!(parsed.apply_to(settings, 2).is_err());
    }
}
