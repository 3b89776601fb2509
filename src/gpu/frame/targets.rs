//! Double-buffered render targets: the displayed picture, and a spare one to draw into.

use crate::gpu::output::target::{Shape, ShownKey, Target};
use crate::gpu::resources::tools::Tools;
use crate::gpu::{Context, GpuError};
use crate::plan::FrameKeys;

/// Role of a render target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Target with the displayed picture.
    Front,
    /// Spare target that is drawn into.
    Back,
}

/// Pair of render targets; of a single pixel until something is drawn.
#[derive(Debug)]
pub(crate) struct Targets {
    pub front: Target,
    back: Target,
}

impl Targets {
    /// Creates two targets of one pixel.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &Context) -> Result<Self, GpuError> {
        let texel = Shape { size: [1; 2], samples: 1, deep: false };
        Ok(Self { front: Target::new(context, texel)?, back: Target::new(context, texel)? })
    }

    /// Returns the target that already holds the linear light of a picture, if any.
    pub(crate) fn holding(&self, keys: &FrameKeys, shape: Shape) -> Option<Role> {
        let holds = |target: &Target| target.shape == shape && target.holds_light(&keys.eye);
        [Role::Front, Role::Back].into_iter().find(|&role| holds(self.get(role)))
    }

    /// Reallocates the spare target if it has another shape.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn fit_back(&mut self, tools: &Tools, shape: Shape) -> Result<(), GpuError> {
        if self.back.shape != shape {
            // The old textures are dropped first: two large pictures may fit where three do not.
            self.back = Target::new(&tools.context, Shape { size: [1; 2], ..shape })?;
            tools.pool.forget_groups();
            self.back = Target::new(&tools.context, shape)?;
        }
        Ok(())
    }

    /// Returns the target with this role.
    pub(crate) fn get(&self, role: Role) -> &Target {
        match role {
            Role::Front => &self.front,
            Role::Back => &self.back,
        }
    }

    /// Returns the target with this role, to be drawn into.
    pub(crate) fn get_mut(&mut self, role: Role) -> &mut Target {
        match role {
            Role::Front => &mut self.front,
            Role::Back => &mut self.back,
        }
    }

    /// Swaps the targets if the picture was drawn into the spare one.
    pub(crate) fn show(&mut self, role: Role) {
        if role == Role::Back {
            std::mem::swap(&mut self.front, &mut self.back);
        }
    }

    /// Invalidates the pictures in both targets.
    pub(crate) fn forget(&mut self) {
        self.front.forget();
        self.back.forget();
    }

    /// Returns the size of both targets, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.front.bytes() + self.back.bytes()
    }
}

/// Returns the key of the displayed picture.
pub(super) fn shown_key(keys: &FrameKeys) -> ShownKey {
    let FrameKeys { volume: _, tables: _, lights: _, combined: _, sky: _, bounces: _, eye, floor, display } =
        keys;
    ShownKey { eye: eye.clone(), floor: floor.clone(), display: display.clone() }
}
