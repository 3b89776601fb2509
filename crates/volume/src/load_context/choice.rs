//! Selection of the volume to open in a file or folder: series, array, channel, time step, component and portion.

use serde::{Deserialize, Serialize};

use super::file_contents::{
    ChoiceAspect, ContentsRecorder, DefaultComponent, FileContents, VolumeAlternatives, VoxelComponents,
};
use super::offer::{FileDimension, VolumeOffer};
use super::portion::Portion;

/// The user's selection among the volumes of a file, and the portion of the volume that is read. All fields are
/// `None` for a file with a single volume that is read completely.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct VolumeChoice {
    /// Index of the component of vectors and colours, from 0; without one the magnitude, or the luminance, is shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<usize>,
    /// Index of the time step, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<usize>,
    /// Index of the channel, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<usize>,
    /// Key of the series of a folder, as in [`VolumeOffer::key`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// Key of the array of an archive, as in [`VolumeOffer::key`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub array: Option<String>,
    /// Key of the resolution level, as in [`VolumeOffer::key`]; without one the finest that fits into memory is read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// Portion of the volume that is read; `None` reads all voxels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub portion: Option<Portion>,
    /// True if the volume to be averaged has turned out to hold labels: each block then gets its most frequent label.
    #[serde(skip)]
    pub are_labels: bool,
    /// Fall back to the first volume where nothing is selected or the selected one does not exist; set by callers in
    /// which the user can choose again.
    #[serde(skip)]
    pub fall_back_to_first: bool,
    /// Recorder into which readers write the volumes that were available.
    #[serde(skip)]
    pub recorder: Option<ContentsRecorder>,
}

impl VolumeChoice {
    /// Returns the selection in a dimension: a [`VolumeOffer::key`], or a name.
    pub fn selected_key(&self, dimension: FileDimension) -> Option<String> {
        match dimension {
            FileDimension::Frame => self.frame.map(|frame| frame.to_string()),
            FileDimension::Channel => self.channel.map(|channel| channel.to_string()),
            FileDimension::Series => self.series.clone(),
            FileDimension::Array => self.array.clone(),
            FileDimension::Level => self.level.clone(),
        }
    }

    /// Returns the selection in an aspect as text, like [`Self::selected_key`].
    pub(super) fn selected_in_aspect(&self, aspect: ChoiceAspect) -> Option<String> {
        match aspect {
            ChoiceAspect::Dimension(dimension) => self.selected_key(dimension),
            ChoiceAspect::Component => self.component.map(|component| component.to_string()),
        }
    }

    /// Returns this choice with the offer of the given key selected in a dimension.
    #[must_use]
    pub fn with_selected(mut self, dimension: FileDimension, key: &str) -> Self {
        let number = key.parse().ok();
        match dimension {
            FileDimension::Frame => self.frame = number,
            FileDimension::Channel => self.channel = number,
            FileDimension::Series => self.series = Some(key.to_owned()),
            FileDimension::Array => self.array = Some(key.to_owned()),
            FileDimension::Level => self.level = Some(key.to_owned()),
        }
        self
    }

    /// Returns this choice with the only array of single numbers selected, if none is selected and all others hold
    /// vectors, colours or series.
    #[must_use]
    pub fn with_only_scalar_array(&self, offers: &[VolumeOffer], is_scalar: impl Fn(usize) -> bool) -> Self {
        let mut scalars = (0..offers.len()).filter(|&at| is_scalar(at));
        let only = scalars.next().filter(|_| scalars.next().is_none());
        match (&self.array, only) {
            (None, Some(only)) => self.clone().with_selected(FileDimension::Array, &offers[only].key),
            _ => self.clone(),
        }
    }

    /// Returns the index of the selected offer: the only one, or the one whose key or name was given.
    ///
    /// # Errors
    /// [`ChoiceError::NotSelected`] if nothing is selected among several, [`ChoiceError::Unknown`] if the selected
    /// one does not exist.
    pub(super) fn resolve(
        &self,
        dimension: FileDimension,
        offers: &[VolumeOffer],
    ) -> Result<usize, ChoiceError> {
        if let Some(watch) = &self.recorder {
            watch.record_query(ChoiceAspect::Dimension(dimension));
        }
        let found = match self.selected_key(dimension) {
            None if offers.len() == 1 => Ok(0),
            None => Err(ChoiceError::NotSelected),
            Some(said) => {
                let find_by =
                    |what: fn(&VolumeOffer) -> &String| offers.iter().position(|offer| *what(offer) == said);
                find_by(|offer| &offer.key)
                    .or_else(|| find_by(|offer| &offer.name))
                    .ok_or(ChoiceError::Unknown(said))
            }
        };
        let (at, missed) = match found {
            Ok(at) => (at, None),
            Err(ChoiceError::NotSelected) if self.fall_back_to_first && !offers.is_empty() => (0, None),
            Err(ChoiceError::Unknown(said)) if self.fall_back_to_first && !offers.is_empty() => {
                (0, Some(said))
            }
            Err(unclear) => return Err(unclear),
        };
        if let Some(watch) = self.recorder.as_ref().filter(|_| offers.len() > 1) {
            watch.record_alternatives(VolumeAlternatives {
                dimension,
                offers: offers.to_vec(),
                selected: at,
                unmatched_selection: missed,
            });
        }
        Ok(at)
    }

    /// Returns the selected component of voxels with `count` numbers each, if one is selected.
    pub fn resolve_component(&self, count: usize, is_color: bool) -> Option<usize> {
        let whole = match (is_color, count) {
            (true, ..3) => DefaultComponent::First,
            (true, _) => DefaultComponent::Luminance,
            (false, _) => DefaultComponent::Magnitude,
        };
        self.record_component(VoxelComponents {
            count,
            is_color,
            default_component: whole,
            selected: self.component,
        })
    }

    /// Returns the selected layer out of `count`; layers are numbers of a voxel that form no vector or colour
    /// together.
    pub fn resolve_layer(&self, count: usize) -> Option<usize> {
        let (is_color, whole) = (false, DefaultComponent::First);
        self.record_component(VoxelComponents {
            count,
            is_color,
            default_component: whole,
            selected: self.component,
        })
    }

    fn record_component(&self, said: VoxelComponents) -> Option<usize> {
        if let Some(watch) = &self.recorder {
            watch.record_query(ChoiceAspect::Component);
        }
        let shown = said.selected.filter(|&at| at < said.count || !self.fall_back_to_first);
        if let Some(watch) = self.recorder.as_ref().filter(|_| said.count > 1) {
            watch.record_components(VoxelComponents { selected: shown, ..said });
        }
        shown
    }

    /// Records the name of the format that a file turns out to have; a later one, by a more specific reader, replaces
    /// it.
    pub fn record_format(&self, format: &'static str) {
        if let Some(watch) = &self.recorder {
            watch.record_format(format);
        }
    }

    /// Returns true if nothing is selected and the whole volume is read.
    pub fn is_empty(&self) -> bool {
        self.selects_nothing() && self.portion.is_none()
    }

    /// Returns true if no component, frame, channel, series, array or level is selected.
    fn selects_nothing(&self) -> bool {
        let Self { component, frame, channel, series, array, level, portion: _, .. } = self;
        [component, frame, channel].iter().all(|selected| selected.is_none())
            && [series, array, level].iter().all(|selected| selected.is_none())
    }

    /// Fills unset parts of this choice from `other`: the selected volume as a whole, and the portion separately.
    #[must_use]
    pub fn with_fallback(self, other: &Self) -> Self {
        let portion = self.portion.or(other.portion);
        let which = if self.selects_nothing() { other.clone() } else { self.clone() };
        let Self { are_labels, fall_back_to_first: otherwise_first, recorder: watch, .. } = self;
        Self { portion, are_labels, fall_back_to_first: otherwise_first, recorder: watch, ..which }
    }

    /// Returns this choice with [`otherwise_first`](Self::fall_back_to_first) set.
    #[must_use]
    pub fn with_first_as_fallback(self) -> Self {
        Self { fall_back_to_first: true, ..self }
    }

    /// Returns this choice with a recorder for one load; no two loads may share one.
    #[must_use]
    pub fn with_recorder(self, recorder: &ContentsRecorder) -> Self {
        Self { recorder: Some(recorder.clone()), ..self }
    }
}

/// Reason why a selection among several volumes fails.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum ChoiceError {
    /// Nothing was selected although there are several.
    NotSelected,
    /// The selection matches no offer; holds its text.
    Unknown(String),
}

impl FileContents {
    /// Returns the choice that opens the same volume again; empty if the file holds a single volume and all of it was
    /// read.
    pub fn choice(&self) -> VolumeChoice {
        let component = self.components.and_then(|components| components.selected);
        let portion = Some(self.portion).filter(|portion| !portion.is_whole());
        self.alternatives.iter().fold(
            VolumeChoice { component, portion, ..VolumeChoice::default() },
            |choice, several| match several.offers.get(several.selected) {
                Some(offer) => choice.with_selected(several.dimension, &offer.key),
                None => choice,
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selections_resolve_by_key_or_name() {
        let offers =
            [VolumeOffer::with_number(0, "DAPI", [4; 3]), VolumeOffer::with_number(1, "GFP", [4; 3])];
        let nothing = VolumeChoice::default();
        assert_eq!(nothing.resolve(FileDimension::Channel, &offers), Err(ChoiceError::NotSelected));
        assert_eq!(nothing.resolve(FileDimension::Channel, &offers[1..]), Ok(0), "there is but one");
        let second = nothing.clone().with_selected(FileDimension::Channel, "1");
        assert_eq!(second.resolve(FileDimension::Channel, &offers), Ok(1));
        assert_eq!(
            second.resolve(FileDimension::Channel, &offers[..1]),
            Err(ChoiceError::Unknown("1".to_owned()))
        );
        assert_eq!(
            second.resolve(FileDimension::Frame, &offers),
            Err(ChoiceError::NotSelected),
            "another dimension"
        );
        let series = nothing.with_selected(FileDimension::Series, "GFP");
        assert_eq!(series.resolve(FileDimension::Series, &offers), Ok(1), "by its name");
        assert_eq!(offers[0].to_string(), "0 \"DAPI\" (4 x 4 x 4)");
    }

    #[test]
    fn fallback_selects_the_first_and_records_alternatives() {
        let offers =
            [VolumeOffer::with_number(0, "DAPI", [4; 3]), VolumeOffer::with_number(1, "GFP", [4; 3])];
        let watch = ContentsRecorder::default();
        let strict = VolumeChoice::default().with_recorder(&watch);
        assert_eq!(strict.resolve(FileDimension::Channel, &offers), Err(ChoiceError::NotSelected));
        assert!(watch.contents().alternatives.is_empty());
        let watch = ContentsRecorder::default();
        let nothing = VolumeChoice::default().with_first_as_fallback().with_recorder(&watch);
        assert_eq!(nothing.resolve(FileDimension::Channel, &offers), Ok(0));
        assert_eq!(nothing.resolve(FileDimension::Frame, &offers[..1]), Ok(0));
        let held = watch.contents();
        assert_eq!(
            (held.alternatives.len(), held.choice().channel),
            (1, Some(0)),
            "one time step is no choice"
        );
        let watch = ContentsRecorder::default();
        let second = held.choice().with_selected(FileDimension::Channel, "1").with_recorder(&watch);
        assert!(watch.contents().choice().is_empty(), "no two loads share what they have found");
        assert_eq!(second.resolve(FileDimension::Channel, &offers), Ok(1));
        assert_eq!(
            watch.contents().alternatives_in(FileDimension::Channel).unwrap().unmatched_selection,
            None
        );
        let watch = ContentsRecorder::default();
        let late = VolumeChoice::default()
            .with_selected(FileDimension::Channel, "7")
            .with_first_as_fallback()
            .with_recorder(&watch);
        assert_eq!(late.resolve(FileDimension::Channel, &offers), Ok(0), "it is not there");
        assert_eq!(
            watch.contents().alternatives_in(FileDimension::Channel).unwrap().unmatched_selection.as_deref(),
            Some("7")
        );
        assert_eq!(late.resolve(FileDimension::Channel, &[]), Err(ChoiceError::Unknown("7".to_owned())));
    }

    #[test]
    fn new_choices_override_remembered_ones() {
        let third = VolumeChoice { frame: Some(2), ..VolumeChoice::default() };
        let half = VolumeChoice { portion: Some(Portion::with_stride(2)), ..VolumeChoice::default() };
        let both = VolumeChoice { portion: Some(Portion::with_stride(2)), ..third.clone() };
        assert_eq!(third.clone().with_fallback(&half), both);
        assert_eq!(half.clone().with_fallback(&third), both);
        let whole = VolumeChoice { portion: Some(Portion::default()), ..VolumeChoice::default() };
        assert_eq!(whole.with_fallback(&both).portion, Some(Portion::default()), "all of it was asked for");
        let first = VolumeChoice { channel: Some(0), ..VolumeChoice::default() };
        assert_eq!(first.clone().with_fallback(&third), first, "a channel and a time step of it go together");
        let held = FileContents { portion: Portion::with_stride(2), ..FileContents::default() };
        assert_eq!((held.choice(), FileContents::default().choice().portion), (half, None));
    }

    #[test]
    fn components_are_recorded() {
        let third = VolumeChoice { component: Some(2), ..VolumeChoice::default() };
        assert_eq!(third.resolve_component(2, false), Some(2), "which the reader refuses");
        let third = third.with_first_as_fallback();
        for (count, is_color, whole, shown) in [
            (3, true, DefaultComponent::Luminance, Some(2)),
            (2, true, DefaultComponent::First, None),
            (3, false, DefaultComponent::Magnitude, Some(2)),
        ] {
            let watch = ContentsRecorder::default();
            let choice = third.clone().with_recorder(&watch);
            assert_eq!(choice.resolve_component(count, is_color), shown);
            assert_eq!(
                watch.contents().components,
                Some(VoxelComponents { count, is_color, default_component: whole, selected: shown })
            );
            assert_eq!(watch.contents().choice().component, shown);
        }
        let watch = ContentsRecorder::default();
        let choice = third.with_recorder(&watch);
        assert_eq!((choice.resolve_component(1, false), watch.contents().components), (None, None));
        assert_eq!(choice.resolve_layer(4), Some(2));
        assert_eq!(watch.contents().components.unwrap().default_component, DefaultComponent::First);
    }
}
