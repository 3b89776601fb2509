//! What the window asks of the thread that renders its pictures.

use std::sync::Arc;

use crate::data::{Bricks, Volume};
use crate::gpu::Renderer;
use crate::model::Settings;

/// What is to be seen.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::app) struct Wanted {
    /// Counts the volumes, so that a picture of an earlier one is not taken for one of this.
    pub generation: u64,
    pub settings: Settings,
    /// To be compared with.
    pub other: Option<Settings>,
    /// Window pixels.
    pub size: [u32; 2],
}

/// What the painter works on.
#[derive(Debug)]
pub(in crate::app) struct Scene {
    pub renderer: Renderer,
    pub volume: Arc<Volume>,
    pub bricks: Arc<Bricks>,
}
