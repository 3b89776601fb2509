//! What the window asks of the thread that renders its pictures.

use crate::data::Dataset;
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

/// A picture for the window, or two that are compared. Requests are the same when they need the same products:
/// names and saved views do not count.
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
