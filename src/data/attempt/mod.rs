//! What reading files and making built-in volumes share: memory limits, errors in words that help, and a control to
//! watch and to cancel the work.

mod choice;
mod control;
mod error;
mod free_memory;
mod held;
mod limits;
mod offer;

pub use choice::Choice;
pub use control::LoadControl;
pub(super) use error::{Attempt, quoted};
pub use error::{Explanation, LoadError, LoadErrorKind};
pub(crate) use free_memory::address_bytes_left;
pub use held::{Aspect, Components, Held, Several, Watch, Whole};
pub(crate) use limits::default_budget_bytes as memory_budget_bytes;
pub(super) use limits::{Extent, human_bytes, is_usable_affine, is_usable_spacing, unlike_spacings};
pub use offer::{Dimension, Offer};
