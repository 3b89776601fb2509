//! Operations on the volume itself: turning it upright, changing its kind of data, correcting metadata.
//!
//! Each is a pass over all voxels on a thread; so is the search for the outline of the object.

pub(in crate::app) mod corrected;
pub(in crate::app) mod framed;
pub(in crate::app) mod treat_as;
pub(in crate::app) mod upright;
