//! What the window asks of the thread that renders its pictures.

use crate::data::Dataset;
use crate::gpu::{RenderOptions, Renderer};
use crate::model::Settings;
use crate::plan::{FrameKeys, Request};

/// A picture for the window, or two that are compared. Requests are the same when they need the same products:
/// names and saved views do not count.
#[derive(Debug, Clone)]
pub(in crate::app) struct FrameRequest {
    /// Counts the volumes, so that a picture of an earlier one is not taken for one of this.
    pub generation: u64,
    /// The look.
    pub settings: Settings,
    /// A look to be compared with.
    pub other: Option<Settings>,
    /// Window pixels.
    pub size: [u32; 2],
    /// What both pictures need at full quality.
    keys: (FrameKeys, Option<FrameKeys>),
}

impl PartialEq for FrameRequest {
    fn eq(&self, other: &Self) -> bool {
        self.generation == other.generation && self.keys == other.keys
    }
}

impl FrameRequest {
    /// A request for a volume.
    pub(in crate::app) fn new(
        generation: u64,
        dataset: &Dataset,
        (settings, other): (Settings, Option<Settings>),
        size: [u32; 2],
    ) -> Self {
        let volume = dataset.volume().content_id();
        let keys_of = |settings: &Settings| {
            let request = Request { volume, settings: settings.clone(), size, coarse: None };
            FrameKeys::of(&request, &RenderOptions::default())
        };
        let keys = (keys_of(&settings), other.as_ref().map(keys_of));
        Self { generation, settings, other, size, keys }
    }

    /// What the picture, or the left one of two, needs at full quality.
    pub(in crate::app) fn keys(&self) -> &FrameKeys {
        &self.keys.0
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
