//! The picture that is shown, and a spare one to draw into.

use crate::gpu::output::target::{Shape, ShownKey, Target};
use crate::gpu::resources::tools::Tools;
use crate::gpu::{Context, GpuError};
use crate::plan::FrameKeys;

/// Which of the two targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// What is shown.
    Front,
    /// The spare one.
    Back,
}

/// Both pictures; of a single pixel until something is drawn.
#[derive(Debug)]
pub(crate) struct Targets {
    pub front: Target,
    back: Target,
}

impl Targets {
    /// Pictures of nothing.
    ///
    /// # Errors
    /// When not even a texel can be had.
    pub(crate) fn new(context: &Context) -> Result<Self, GpuError> {
        let texel = Shape { size: [1; 2], samples: 1, deep: false };
        Ok(Self { front: Target::new(context, texel)?, back: Target::new(context, texel)? })
    }

    /// The target that holds the linear light of a picture already, if one does.
    pub(crate) fn holding(&self, keys: &FrameKeys, shape: Shape) -> Option<Role> {
        let holds = |target: &Target| target.shape == shape && target.holds_light(&keys.eye);
        [Role::Front, Role::Back].into_iter().find(|&role| holds(self.get(role)))
    }

    /// Makes the spare one fit, if it has another shape.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn fit_back(&mut self, tools: &Tools, shape: Shape) -> Result<(), GpuError> {
        if self.back.shape != shape {
            // Given back first: two large pictures may fit where three do not.
            self.back = Target::new(&tools.context, Shape { size: [1; 2], ..shape })?;
            tools.pool.forget_groups();
            self.back = Target::new(&tools.context, shape)?;
        }
        Ok(())
    }

    /// The target of a role.
    pub(crate) fn get(&self, role: Role) -> &Target {
        match role {
            Role::Front => &self.front,
            Role::Back => &self.back,
        }
    }

    /// The target of a role, to be drawn into.
    pub(crate) fn get_mut(&mut self, role: Role) -> &mut Target {
        match role {
            Role::Front => &mut self.front,
            Role::Back => &mut self.back,
        }
    }

    /// Shows what was drawn.
    pub(crate) fn show(&mut self, role: Role) {
        if role == Role::Back {
            std::mem::swap(&mut self.front, &mut self.back);
        }
    }

    /// Nothing of them may be shown again.
    pub(crate) fn forget(&mut self) {
        self.front.forget();
        self.back.forget();
    }

    /// Bytes of both.
    pub(crate) fn bytes(&self) -> u64 {
        self.front.bytes() + self.back.bytes()
    }
}

/// The key of what a picture shows.
pub(super) fn shown_key(keys: &FrameKeys) -> ShownKey {
    let FrameKeys { volume: _, tables: _, lights: _, combined: _, sky: _, bounces: _, eye, floor, display } =
        keys;
    ShownKey { eye: eye.clone(), floor: floor.clone(), display: display.clone() }
}
