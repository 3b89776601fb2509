//! Selection of the volume to open in a file or folder: series, array, channel, time step, component and portion.

use serde::{Deserialize, Serialize};

use super::held::{Aspect, Components, Held, Several, Watch, Whole};
use super::offer::{Dimension, Offer};
use super::portion::Portion;

/// The user's selection among the volumes of a file, and the portion of the volume that is read. All fields are
/// `None` for a file with a single volume that is read completely.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// Index of the component of vectors and colours, from 0; without one the magnitude, or the luminance, is shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<usize>,
    /// Index of the time step, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<usize>,
    /// Index of the channel, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<usize>,
    /// Key of the series of a folder, as in [`Offer::key`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// Key of the array of an archive, as in [`Offer::key`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub array: Option<String>,
    /// Portion of the volume that is read; `None` reads all voxels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub portion: Option<Portion>,
    /// True if the volume to be averaged has turned out to hold labels: each block then gets its most frequent label.
    #[serde(skip)]
    pub are_labels: bool,
    /// Fall back to the first volume where nothing is selected or the selected one does not exist; set by callers in
    /// which the user can choose again.
    #[serde(skip)]
    pub otherwise_first: bool,
    /// Recorder into which readers write the volumes that were available.
    #[serde(skip)]
    pub watch: Option<Watch>,
}

impl Choice {
    /// Returns the selection in a dimension: an [`Offer::key`], or a name.
    pub fn said(&self, dimension: Dimension) -> Option<String> {
        match dimension {
            Dimension::Frame => self.frame.map(|frame| frame.to_string()),
            Dimension::Channel => self.channel.map(|channel| channel.to_string()),
            Dimension::Series => self.series.clone(),
            Dimension::Array => self.array.clone(),
        }
    }

    /// Returns the selection in an aspect as text, like [`Self::said`].
    pub(super) fn said_of(&self, aspect: Aspect) -> Option<String> {
        match aspect {
            Aspect::Of(dimension) => self.said(dimension),
            Aspect::Component => self.component.map(|component| component.to_string()),
        }
    }

    /// Returns this choice with the offer of the given key selected in a dimension.
    #[must_use]
    pub fn with(mut self, dimension: Dimension, key: &str) -> Self {
        let number = key.parse().ok();
        match dimension {
            Dimension::Frame => self.frame = number,
            Dimension::Channel => self.channel = number,
            Dimension::Series => self.series = Some(key.to_owned()),
            Dimension::Array => self.array = Some(key.to_owned()),
        }
        self
    }

    /// Returns the index of the selected offer: the only one, or the one whose key or name was given.
    ///
    /// # Errors
    /// [`Unclear::Several`] if nothing is selected among several, [`Unclear::Unknown`] if the selected one does not
    /// exist.
    pub(super) fn of(&self, dimension: Dimension, offers: &[Offer]) -> Result<usize, Unclear> {
        if let Some(watch) = &self.watch {
            watch.asks(Aspect::Of(dimension));
        }
        let found = match self.said(dimension) {
            None if offers.len() == 1 => Ok(0),
            None => Err(Unclear::Several),
            Some(said) => {
                let by = |what: fn(&Offer) -> &String| offers.iter().position(|offer| *what(offer) == said);
                by(|offer| &offer.key).or_else(|| by(|offer| &offer.name)).ok_or(Unclear::Unknown(said))
            }
        };
        let (at, missed) = match found {
            Ok(at) => (at, None),
            Err(Unclear::Several) if self.otherwise_first && !offers.is_empty() => (0, None),
            Err(Unclear::Unknown(said)) if self.otherwise_first && !offers.is_empty() => (0, Some(said)),
            Err(unclear) => return Err(unclear),
        };
        if let Some(watch) = self.watch.as_ref().filter(|_| offers.len() > 1) {
            watch.saw_several(Several { dimension, offers: offers.to_vec(), at, missed });
        }
        Ok(at)
    }

    /// Returns the selected component of voxels with `count` numbers each, if one is selected.
    pub(in crate::data) fn component_among(&self, count: usize, is_color: bool) -> Option<usize> {
        let whole = match (is_color, count) {
            (true, ..3) => Whole::First,
            (true, _) => Whole::Luminance,
            (false, _) => Whole::Magnitude,
        };
        self.watched_component(Components { count, is_color, whole, shown: self.component })
    }

    /// Returns the selected layer out of `count`; layers are numbers of a voxel that form no vector or colour
    /// together.
    pub(in crate::data) fn layer_among(&self, count: usize) -> Option<usize> {
        let (is_color, whole) = (false, Whole::First);
        self.watched_component(Components { count, is_color, whole, shown: self.component })
    }

    fn watched_component(&self, said: Components) -> Option<usize> {
        if let Some(watch) = &self.watch {
            watch.asks(Aspect::Component);
        }
        let shown = said.shown.filter(|&at| at < said.count || !self.otherwise_first);
        if let Some(watch) = self.watch.as_ref().filter(|_| said.count > 1) {
            watch.saw_components(Components { shown, ..said });
        }
        shown
    }

    /// Returns true if nothing is selected and the whole volume is read.
    pub fn is_empty(&self) -> bool {
        self.names_none() && self.portion.is_none()
    }

    /// Returns true if no component, frame, channel, series or array is selected.
    fn names_none(&self) -> bool {
        let Self { component, frame, channel, series, array, portion: _, .. } = self;
        let numbers = [component, frame, channel];
        numbers.iter().all(|said| said.is_none()) && series.is_none() && array.is_none()
    }

    /// Fills unset parts of this choice from `other`: the selected volume as a whole, and the portion separately.
    #[must_use]
    pub fn or(self, other: &Self) -> Self {
        let portion = self.portion.or(other.portion);
        let which = if self.names_none() { other.clone() } else { self.clone() };
        let Self { are_labels, otherwise_first, watch, .. } = self;
        Self { portion, are_labels, otherwise_first, watch, ..which }
    }

    /// Returns this choice with [`otherwise_first`](Self::otherwise_first) set.
    #[must_use]
    pub fn or_first(self) -> Self {
        Self { otherwise_first: true, ..self }
    }

    /// Returns this choice with a new watch, and the watch; no two loads may share one.
    #[must_use]
    pub(in crate::data) fn watched(self) -> (Self, Watch) {
        let watch = Watch::default();
        (Self { watch: Some(watch.clone()), ..self }, watch)
    }
}

/// Reason why a selection among several volumes fails.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Unclear {
    /// Nothing was selected although there are several.
    Several,
    /// The selection matches no offer; holds its text.
    Unknown(String),
}

impl Held {
    /// Returns the choice that opens the same volume again; empty if the file holds a single volume and all of it was
    /// read.
    pub fn choice(&self) -> Choice {
        let component = self.components.and_then(|components| components.shown);
        let portion = Some(self.portion).filter(|portion| !portion.is_whole());
        self.several.iter().fold(Choice { component, portion, ..Choice::default() }, |choice, several| {
            match several.offers.get(several.at) {
                Some(offer) => choice.with(several.dimension, &offer.key),
                None => choice,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_several_is_named() {
        let offers = [Offer::numbered(0, "DAPI", [4; 3]), Offer::numbered(1, "GFP", [4; 3])];
        let nothing = Choice::default();
        assert_eq!(nothing.of(Dimension::Channel, &offers), Err(Unclear::Several));
        assert_eq!(nothing.of(Dimension::Channel, &offers[1..]), Ok(0), "there is but one");
        let second = nothing.clone().with(Dimension::Channel, "1");
        assert_eq!(second.of(Dimension::Channel, &offers), Ok(1));
        assert_eq!(second.of(Dimension::Channel, &offers[..1]), Err(Unclear::Unknown("1".to_owned())));
        assert_eq!(second.of(Dimension::Frame, &offers), Err(Unclear::Several), "another dimension");
        let series = nothing.with(Dimension::Series, "GFP");
        assert_eq!(series.of(Dimension::Series, &offers), Ok(1), "by its name");
        assert_eq!(offers[0].to_string(), "0 \"DAPI\" (4 x 4 x 4)");
    }

    #[test]
    fn who_can_choose_again_gets_the_first_and_hears_of_the_others() {
        let offers = [Offer::numbered(0, "DAPI", [4; 3]), Offer::numbered(1, "GFP", [4; 3])];
        let (strict, watch) = Choice::default().watched();
        assert_eq!(strict.of(Dimension::Channel, &offers), Err(Unclear::Several));
        assert!(watch.held().several.is_empty());
        let (nothing, watch) = Choice::default().or_first().watched();
        assert_eq!(nothing.of(Dimension::Channel, &offers), Ok(0));
        assert_eq!(nothing.of(Dimension::Frame, &offers[..1]), Ok(0));
        let held = watch.held();
        assert_eq!((held.several.len(), held.choice().channel), (1, Some(0)), "one time step is no choice");
        let (second, watch) = held.choice().with(Dimension::Channel, "1").watched();
        assert!(watch.held().choice().is_empty(), "no two loads share what they have found");
        assert_eq!(second.of(Dimension::Channel, &offers), Ok(1));
        assert_eq!(watch.held().of(Dimension::Channel).unwrap().missed, None);
        let (late, watch) = Choice::default().with(Dimension::Channel, "7").or_first().watched();
        assert_eq!(late.of(Dimension::Channel, &offers), Ok(0), "it is not there");
        assert_eq!(watch.held().of(Dimension::Channel).unwrap().missed.as_deref(), Some("7"));
        assert_eq!(late.of(Dimension::Channel, &[]), Err(Unclear::Unknown("7".to_owned())));
    }

    #[test]
    fn what_is_said_anew_counts_more_than_what_was_remembered() {
        let third = Choice { frame: Some(2), ..Choice::default() };
        let half = Choice { portion: Some(Portion::every(2)), ..Choice::default() };
        let both = Choice { portion: Some(Portion::every(2)), ..third.clone() };
        assert_eq!(third.clone().or(&half), both);
        assert_eq!(half.clone().or(&third), both);
        let whole = Choice { portion: Some(Portion::default()), ..Choice::default() };
        assert_eq!(whole.or(&both).portion, Some(Portion::default()), "all of it was asked for");
        let first = Choice { channel: Some(0), ..Choice::default() };
        assert_eq!(first.clone().or(&third), first, "a channel and a time step of it go together");
        let held = Held { portion: Portion::every(2), ..Held::default() };
        assert_eq!((held.choice(), Held::default().choice().portion), (half, None));
    }

    #[test]
    fn components_are_known_to_who_watches() {
        let third = Choice { component: Some(2), ..Choice::default() };
        assert_eq!(third.component_among(2, false), Some(2), "which the reader refuses");
        let third = third.or_first();
        for (count, is_color, whole, shown) in [
            (3, true, Whole::Luminance, Some(2)),
            (2, true, Whole::First, None),
            (3, false, Whole::Magnitude, Some(2)),
        ] {
            let (choice, watch) = third.clone().watched();
            assert_eq!(choice.component_among(count, is_color), shown);
            assert_eq!(watch.held().components, Some(Components { count, is_color, whole, shown }));
            assert_eq!(watch.held().choice().component, shown);
        }
        let (choice, watch) = third.watched();
        assert_eq!((choice.component_among(1, false), watch.held().components), (None, None));
        assert_eq!(choice.layer_among(4), Some(2));
        assert_eq!(watch.held().components.unwrap().whole, Whole::First);
    }
}
