//! Infrastructure shared by readers and built-in volumes: memory limits, errors with advice, and a control for
//! progress and cancellation.

mod choice;
mod control;
mod error;
mod extent;
mod free_memory;
mod held;
mod kept;
mod limits;
mod offer;
mod portion;
mod size;

pub use choice::Choice;
pub use control::LoadControl;
pub(super) use error::{Attempt, quoted};
pub use error::{Explanation, LoadError, LoadErrorKind};
#[cfg(test)]
pub(super) use extent::in_little_room;
pub(super) use extent::{Extent, Room};
pub(crate) use free_memory::address_bytes_left;
pub use held::{Aspect, Components, Held, Several, Watch, Whole};
pub(super) use kept::Kept;
pub(crate) use limits::default_budget_bytes as memory_budget_bytes;
pub(crate) use limits::human_bytes;
pub(super) use limits::{is_usable_affine, is_usable_spacing, unlike_spacings};
pub use offer::{Dimension, Offer};
pub use portion::{Portion, Region, Stretch, Thinning};
pub use size::Size;
