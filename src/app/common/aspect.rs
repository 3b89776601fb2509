//! Alternatives of the open file for menus, panels and the chooser.
//!
//! They are its series, arrays, channels, time steps and components.

use crate::app::text;
use crate::data::load::{Aspect, Choice, Components, Held, Several, Whole};

/// Alternatives to choose from in one aspect of the open file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Alternatives<'a> {
    held: &'a Held,
    of: Of<'a>,
}

#[derive(Debug, Clone, Copy)]
enum Of<'a> {
    Several(&'a Several),
    Components(Components),
}

impl<'a> Alternatives<'a> {
    /// Returns the alternatives of a file in an aspect; `None` if the file holds only one.
    pub(crate) fn of(held: &'a Held, aspect: Aspect) -> Option<Self> {
        let of = match aspect {
            Aspect::Of(dimension) => Of::Several(held.of(dimension)?),
            Aspect::Component => Of::Components(held.components?),
        };
        Some(Self { held, of })
    }

    /// Number of alternatives in this aspect.
    pub(crate) fn count(&self) -> usize {
        match self.of {
            Of::Several(several) => several.offers.len(),
            Of::Components(components) => components.count + first_component(components),
        }
    }

    /// Index of the alternative that is shown.
    pub(crate) fn at(&self) -> usize {
        match self.of {
            Of::Several(several) => several.at,
            Of::Components(components) => {
                components.shown.map_or(0, |shown| shown + first_component(components))
            }
        }
    }

    /// Name of an alternative in the file, if it has one.
    pub(crate) fn name_in_file(&self, at: usize) -> Option<&'a str> {
        let Of::Several(several) = self.of else { return None };
        several.offers.get(at).map(|offer| offer.name.as_str()).filter(|name| !name.is_empty())
    }

    /// Name of an alternative for display.
    pub(crate) fn name(&self, at: usize) -> String {
        match self.of {
            Of::Several(several) => self
                .name_in_file(at)
                .map_or_else(|| text::chooser::numbered(several.dimension, at), str::to_owned),
            Of::Components(components) => match at.checked_sub(first_component(components)) {
                None => text::chooser::whole(components.whole).to_owned(),
                Some(component) => text::chooser::component(component, &components),
            },
        }
    }

    /// Number of voxels of an alternative along x, y and z, where known.
    pub(crate) fn dims(&self, at: usize) -> Option<[u64; 3]> {
        match self.of {
            Of::Several(several) => several.offers.get(at).and_then(|offer| offer.dims),
            Of::Components(_) => None,
        }
    }

    /// Number of voxels of an alternative along x, y and z in the file, of which a part can be read.
    pub(crate) fn grid(&self, at: usize) -> Option<[usize; 3]> {
        match self.dims(at) {
            Some([x, y, z]) => {
                Some([usize::try_from(x).ok()?, usize::try_from(y).ok()?, usize::try_from(z).ok()?])
            }
            None => self.held.grid,
        }
    }

    /// Choice that opens an alternative; all other aspects stay as shown.
    pub(crate) fn choice(&self, at: usize) -> Choice {
        let shown = self.held.choice();
        match self.of {
            Of::Several(several) => match several.offers.get(at) {
                Some(offer) => shown.with(several.dimension, &offer.key),
                None => shown,
            },
            Of::Components(components) => {
                Choice { component: at.checked_sub(first_component(components)), ..shown }
            }
        }
    }

    /// Returns true if the file has colours, which are shown as luminance.
    pub(crate) fn has_colors(&self) -> bool {
        matches!(self.of, Of::Components(Components { is_color: true, whole: Whole::Luminance, .. }))
    }
}

/// Index of the first component in the list: after the scalar computed from all components, if there is one.
fn first_component(components: Components) -> usize {
    usize::from(components.whole != Whole::First)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::load::{Dimension, Offer};

    fn held(whole: Whole, shown: Option<usize>) -> Held {
        let offers = [Offer::numbered(0, "", [4; 3]), Offer::numbered(1, "GFP", [4; 3])].to_vec();
        let several = vec![Several { dimension: Dimension::Channel, offers, at: 1, missed: None }];
        let components = Some(Components { count: 3, is_color: false, whole, shown });
        Held { several, components, ..Held::default() }
    }

    #[test]
    fn each_alternative_opens_itself() {
        let held = held(Whole::Magnitude, Some(2));
        assert!(Alternatives::of(&held, Aspect::Of(Dimension::Frame)).is_none());
        for aspect in [Aspect::Of(Dimension::Channel), Aspect::Component] {
            let all = Alternatives::of(&held, aspect).unwrap();
            assert_eq!(all.choice(all.at()), held.choice());
            assert!((0..all.count()).all(|at| at == all.at() || all.choice(at) != held.choice()));
            assert_eq!(all.choice(99).channel, Some(1), "there is no such one");
        }
        let channels = Alternatives::of(&held, Aspect::Of(Dimension::Channel)).unwrap();
        assert_eq!((channels.name(0), channels.name(1)), ("Channel 1".to_owned(), "GFP".to_owned()));
        assert_eq!((channels.name_in_file(0), channels.name_in_file(1)), (None, Some("GFP")));
        let other = channels.choice(0);
        assert_eq!((other.channel, other.component), (Some(0), Some(2)), "all else stays");
    }

    #[test]
    fn what_components_make_is_offered_where_they_make_something() {
        let vectors = held(Whole::Magnitude, None);
        let all = Alternatives::of(&vectors, Aspect::Component).unwrap();
        assert_eq!((all.count(), all.at(), all.choice(0).component), (4, 0, None));
        assert_eq!(all.choice(1).component, Some(0));
        let layers = held(Whole::First, None);
        let all = Alternatives::of(&layers, Aspect::Component).unwrap();
        assert_eq!((all.count(), all.at(), all.choice(0).component), (3, 0, Some(0)));
    }
}
