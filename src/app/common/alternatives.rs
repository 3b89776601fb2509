//! Alternatives of the open file for menus, panels and the chooser.
//!
//! They are its series, arrays, channels, time steps, resolution levels and components.

use crate::app::text;
use chiaroscuro_volume::{
    ChoiceAspect, DefaultComponent, FileContents, VolumeAlternatives, VolumeChoice, VoxelComponents,
};

/// Alternatives to choose from in one aspect of the open file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Alternatives<'a> {
    held: &'a FileContents,
    of: AlternativeSource<'a>,
}

#[derive(Debug, Clone, Copy)]
enum AlternativeSource<'a> {
    Several(&'a VolumeAlternatives),
    Components(VoxelComponents),
}

impl<'a> Alternatives<'a> {
    /// Returns the alternatives of a file in an aspect; `None` if the file holds only one.
    pub(crate) fn new(held: &'a FileContents, aspect: ChoiceAspect) -> Option<Self> {
        let of = match aspect {
            ChoiceAspect::Dimension(dimension) => {
                AlternativeSource::Several(held.alternatives_in(dimension)?)
            }
            ChoiceAspect::Component => AlternativeSource::Components(held.components?),
        };
        Some(Self { held, of })
    }

    /// Number of alternatives in this aspect.
    pub(crate) fn count(&self) -> usize {
        match self.of {
            AlternativeSource::Several(several) => several.offers.len(),
            AlternativeSource::Components(components) => components.count + first_component(components),
        }
    }

    /// Index of the alternative that is shown.
    pub(crate) fn current(&self) -> usize {
        match self.of {
            AlternativeSource::Several(several) => several.selected,
            AlternativeSource::Components(components) => {
                components.selected.map_or(0, |shown| shown + first_component(components))
            }
        }
    }

    /// Name of an alternative in the file, if it has one.
    pub(crate) fn name_in_file(&self, at: usize) -> Option<&'a str> {
        let AlternativeSource::Several(several) = self.of else { return None };
        several.offers.get(at).map(|offer| offer.name.as_str()).filter(|name| !name.is_empty())
    }

    /// Name of an alternative for display.
    pub(crate) fn name(&self, at: usize) -> String {
        match self.of {
            AlternativeSource::Several(several) => self
                .name_in_file(at)
                .map_or_else(|| text::chooser::default_name(several.dimension, at), str::to_owned),
            AlternativeSource::Components(components) => match at.checked_sub(first_component(components)) {
                None => text::chooser::scalar_name(components.default_component).to_owned(),
                Some(component) => text::chooser::component_name(component, &components),
            },
        }
    }

    /// Number of voxels of an alternative along x, y and z, where known.
    pub(crate) fn dims(&self, at: usize) -> Option<[u64; 3]> {
        match self.of {
            AlternativeSource::Several(several) => several.offers.get(at).and_then(|offer| offer.dims),
            AlternativeSource::Components(_) => None,
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
    pub(crate) fn choice(&self, at: usize) -> VolumeChoice {
        let shown = self.held.choice();
        match self.of {
            AlternativeSource::Several(several) => match several.offers.get(at) {
                Some(offer) => shown.with_selected(several.dimension, &offer.key),
                None => shown,
            },
            AlternativeSource::Components(components) => {
                VolumeChoice { component: at.checked_sub(first_component(components)), ..shown }
            }
        }
    }

    /// Returns true if the file has colours, of which the luminance is shown.
    pub(crate) fn has_colors(&self) -> bool {
        matches!(
            self.of,
            AlternativeSource::Components(VoxelComponents {
                is_color: true,
                default_component: DefaultComponent::Luminance,
                selected: None,
                ..
            })
        )
    }
}

/// Index of the first component in the list: after the scalar computed from all components, if there is one.
fn first_component(components: VoxelComponents) -> usize {
    usize::from(components.default_component != DefaultComponent::First)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::{FileDimension, VolumeOffer};

    fn held(whole: DefaultComponent, shown: Option<usize>) -> FileContents {
        let offers =
            [VolumeOffer::with_number(0, "", [4; 3]), VolumeOffer::with_number(1, "GFP", [4; 3])].to_vec();
        let several = vec![VolumeAlternatives {
            dimension: FileDimension::Channel,
            offers,
            selected: 1,
            unmatched_selection: None,
        }];
        let components =
            Some(VoxelComponents { count: 3, is_color: false, default_component: whole, selected: shown });
        FileContents { alternatives: several, components, ..FileContents::default() }
    }

    #[test]
    fn each_alternative_opens_itself() {
        let held = held(DefaultComponent::Magnitude, Some(2));
        assert!(Alternatives::new(&held, ChoiceAspect::Dimension(FileDimension::Frame)).is_none());
        for aspect in [ChoiceAspect::Dimension(FileDimension::Channel), ChoiceAspect::Component] {
            let all = Alternatives::new(&held, aspect).unwrap();
            assert_eq!(all.choice(all.current()), held.choice());
            assert!((0..all.count()).all(|at| at == all.current() || all.choice(at) != held.choice()));
            assert_eq!(all.choice(99).channel, Some(1), "there is no such one");
        }
        let channels = Alternatives::new(&held, ChoiceAspect::Dimension(FileDimension::Channel)).unwrap();
        assert_eq!((channels.name(0), channels.name(1)), ("Channel 1".to_owned(), "GFP".to_owned()));
        assert_eq!((channels.name_in_file(0), channels.name_in_file(1)), (None, Some("GFP")));
        let other = channels.choice(0);
        assert_eq!((other.channel, other.component), (Some(0), Some(2)), "all else stays");
    }

    #[test]
    fn what_components_make_is_offered_where_they_make_something() {
        let vectors = held(DefaultComponent::Magnitude, None);
        let all = Alternatives::new(&vectors, ChoiceAspect::Component).unwrap();
        assert_eq!((all.count(), all.current(), all.choice(0).component), (4, 0, None));
        assert_eq!(all.choice(1).component, Some(0));
        let layers = held(DefaultComponent::First, None);
        let all = Alternatives::new(&layers, ChoiceAspect::Component).unwrap();
        assert_eq!((all.count(), all.current(), all.choice(0).component), (3, 0, Some(0)));
    }
}
