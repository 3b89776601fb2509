//! Reasons why volumes or time steps cannot be shown together.

use crate::{MAX_FIELDS, VolumeError};

/// Reason why a volume cannot be shown together with another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AddFieldError {
    /// All channels of a texel are in use.
    #[error("{MAX_FIELDS} volumes are shown already, which is the largest number; remove one first")]
    TooMany,
    /// Boxes of the two grids have no point in common.
    #[error(
        "the two volumes do not meet: no voxel of one lies inside the other; check the positions in their files"
    )]
    Apart,
}

/// Reason why another time step cannot be shown.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StepError {
    /// Corrections of the open volume do not apply to the step.
    #[error("the corrections of the open volume do not apply to the step: {0}")]
    Correction(#[from] VolumeError),
    /// Boxes of the step and of a volume that is shown with it have no point in common.
    #[error("a volume that is shown with the step does not meet it; remove its layer")]
    Apart,
}
