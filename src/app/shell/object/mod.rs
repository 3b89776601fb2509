//! Operations on the volume itself: turning it upright, changing its kind of data, correcting metadata.
//!
//! Each is a pass over all voxels on a thread; so is the search for the outline of the object.

pub(crate) mod corrections;
pub(crate) mod data_kind;
pub(crate) mod orientation;
pub(crate) mod outline;
