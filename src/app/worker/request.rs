//! What the window asks of the thread that renders its pictures.

use crate::data::{Dataset, Shown, ValueRange, ValueRanges};
use crate::gpu::{RenderOptions, Renderer};
use crate::model::Settings;
use crate::plan::{FrameKeys, Request};

/// One look, or two that are compared.
#[derive(Debug, Clone)]
pub(in crate::app) struct Looks {
    /// The only look, or the one left of the divider.
    pub left: Settings,
    /// The look right of the divider.
    pub right: Option<Settings>,
}

impl Looks {
    /// Two looks with densities for the values of both: the volume is uploaded for a range, and would be for each of
    /// the two in each picture.
    fn over_one_range(self, ranges: &ValueRanges) -> Self {
        let Some(right) = &self.right else { return self };
        let (Shown::Range(a), Shown::Range(b)) = (self.left.shown(ranges), right.shown(ranges)) else {
            return self;
        };
        let both = ValueRange::new(a.low.min(b.low), a.high.max(b.high));
        Self { left: self.left.over(both, ranges), right: Some(right.over(both, ranges)) }
    }
}

/// A picture for the window, or two that are compared. Requests are the same when they need the same products:
/// names and what is kept do not count.
#[derive(Debug, Clone)]
pub(in crate::app) struct FrameRequest {
    /// Counts the volumes, so that a picture of an earlier one is not taken for one of this.
    pub generation: u64,
    /// What is to be seen.
    pub looks: Looks,
    /// Window pixels.
    pub size: [u32; 2],
    /// What the picture, or the left one of two, needs at full quality.
    left_keys: FrameKeys,
    /// What the right picture needs at full quality.
    right_keys: Option<FrameKeys>,
}

impl PartialEq for FrameRequest {
    fn eq(&self, other: &Self) -> bool {
        self.generation == other.generation
            && self.left_keys == other.left_keys
            && self.right_keys == other.right_keys
    }
}

impl FrameRequest {
    /// A request for a volume.
    pub(in crate::app) fn new(generation: u64, dataset: &Dataset, looks: Looks, size: [u32; 2]) -> Self {
        let volume = dataset.volume().id();
        let looks = looks.over_one_range(&volume.ranges);
        let keys_of = |settings: &Settings| {
            let request = Request { volume, settings: settings.clone(), size, coarse: None };
            FrameKeys::of(&request, &RenderOptions::default())
        };
        let (left_keys, right_keys) = (keys_of(&looks.left), looks.right.as_ref().map(keys_of));
        Self { generation, looks, size, left_keys, right_keys }
    }

    /// What the picture, or the left one of two, needs at full quality.
    pub(in crate::app) fn keys(&self) -> &FrameKeys {
        &self.left_keys
    }
}

/// What the thread works on.
#[derive(Debug)]
pub(in crate::app) struct Scene {
    /// Of a device of its own.
    pub renderer: Renderer,
    /// The volume.
    pub dataset: Dataset,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::synthetic::builtin;
    use crate::model::DensityRange;

    #[test]
    fn looks_that_are_compared_share_an_upload() {
        let dataset = Dataset::new(builtin("sphere", Some(8)).expect("a volume"));
        let all = dataset.volume().value_range();
        let typed = |low: f64, high: f64| DensityRange::Typed(ValueRange::new(all.at(low), all.at(high)));
        let look = |range| {
            let mut look = Settings { range, ..Settings::default() };
            look.transfer.points.clear();
            look
        };
        let [left, right] = [look(typed(0.0, 0.5)), look(typed(0.25, 1.0))];
        let alone = FrameRequest::new(1, &dataset, Looks { left: left.clone(), right: None }, [8; 2]);
        assert_eq!(alone.looks.left, left);
        let both = FrameRequest::new(1, &dataset, Looks { left, right: Some(right) }, [8; 2]);
        let right_keys = both.right_keys.as_ref().expect("two looks");
        assert_eq!(both.left_keys.volume, right_keys.volume);
        assert_eq!(both.left_keys.volume.shown, ValueRange::new(all.at(0.0), all.at(1.0)).into());
    }
}
