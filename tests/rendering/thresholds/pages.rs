//! Tolerances of pictures that read pages of finer levels.

use crate::compare::ErrorLimit;

/// Displayed picture through pages of a finer level against that of the fine volume in memory, without light from volumes: pages are
/// normalised integers, and filters have few bits. Adaptive slabs are halved above a bound that rounding decides in single
/// pixels, which differ by more than a step of 8 bits then.
pub(crate) const PAGED_MATTER: ErrorLimit = ErrorLimit { max: 2.0 / 255.0, rmse: 0.05 / 255.0 };

/// Displayed picture through pages where kernels are stretched over two levels: levels of a file are means of 2³ voxels, those of a pyramid in memory
/// have a wider kernel.
pub(crate) const PAGED_STRETCHED: ErrorLimit = ErrorLimit { max: 10.0 / 255.0, rmse: 0.3 / 255.0 };

/// Displayed picture through pages with shadows, which are those of the coarse volume behind the near field.
pub(crate) const PAGED_LIGHT: ErrorLimit = ErrorLimit { max: 20.0 / 255.0, rmse: 0.8 / 255.0 };
