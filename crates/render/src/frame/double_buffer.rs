//! Double-buffered render targets: the displayed picture, and a spare one to draw into.

use crate::output::render_target::{DisplayedKey, RenderTarget, TargetShape};
use crate::plan::FrameKeys;
use crate::resources::gpu_tools::GpuTools;
use crate::{GpuContext, GpuError};

/// Role of a render target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TargetRole {
    /// Target with the displayed picture.
    Front,
    /// Spare target that is drawn into.
    Back,
}

/// Pair of render targets; of a single pixel until something is drawn.
#[derive(Debug)]
pub(crate) struct DoubleBuffer {
    pub front: RenderTarget,
    back: RenderTarget,
}

impl DoubleBuffer {
    /// Creates two targets of one pixel.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext) -> Result<Self, GpuError> {
        let texel = TargetShape { size: [1; 2], samples: 1, is_deep: false };
        Ok(Self { front: RenderTarget::new(context, texel)?, back: RenderTarget::new(context, texel)? })
    }

    /// Returns the target that already holds the linear light of a picture, if any.
    pub(crate) fn find(&self, keys: &FrameKeys, shape: TargetShape) -> Option<TargetRole> {
        let holds = |target: &RenderTarget| target.shape == shape && target.has_light(&keys.eye);
        [TargetRole::Front, TargetRole::Back].into_iter().find(|&role| holds(self.get(role)))
    }

    /// Reallocates the spare target if it has another shape.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn resize_back(&mut self, tools: &GpuTools, shape: TargetShape) -> Result<(), GpuError> {
        if self.back.shape != shape {
            // The old textures are dropped first: two large pictures may fit where three do not.
            self.back = RenderTarget::new(&tools.context, TargetShape { size: [1; 2], ..shape })?;
            tools.pool.drop_bind_groups();
            self.back = RenderTarget::new(&tools.context, shape)?;
        }
        Ok(())
    }

    /// Returns the target with this role.
    pub(crate) fn get(&self, role: TargetRole) -> &RenderTarget {
        match role {
            TargetRole::Front => &self.front,
            TargetRole::Back => &self.back,
        }
    }

    /// Returns the target with this role, to be drawn into.
    pub(crate) fn get_mut(&mut self, role: TargetRole) -> &mut RenderTarget {
        match role {
            TargetRole::Front => &mut self.front,
            TargetRole::Back => &mut self.back,
        }
    }

    /// Swaps the targets if the picture was drawn into the spare one.
    pub(crate) fn show(&mut self, role: TargetRole) {
        if role == TargetRole::Back {
            std::mem::swap(&mut self.front, &mut self.back);
        }
    }

    /// Drops the textures of the spare target, of which some may be missing after an error. They stay if there is not
    /// even memory for a pixel: the next picture reports that.
    pub(crate) fn drop_back(&mut self, context: &GpuContext) {
        let texel = TargetShape { size: [1; 2], ..self.back.shape };
        if let Ok(texel) = RenderTarget::new(context, texel) {
            self.back = texel;
        }
    }

    /// Invalidates the pictures in both targets.
    pub(crate) fn invalidate(&mut self) {
        self.front.invalidate();
        self.back.invalidate();
    }

    /// Returns the size of both targets, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.front.bytes() + self.back.bytes()
    }
}

/// Returns the key of the displayed picture.
pub(super) fn display_key(keys: &FrameKeys) -> DisplayedKey {
    let FrameKeys {
        volume: _,
        tables: _,
        lights: _,
        combined: _,
        sky: _,
        bounces: _,
        eye,
        antialiased,
        floor,
        display,
    } = keys;
    DisplayedKey {
        eye: eye.clone(),
        antialiased: antialiased.clone(),
        floor: floor.clone(),
        display: display.clone(),
    }
}
