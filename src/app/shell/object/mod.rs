//! What is done with the volume itself, which goes through all voxels on a thread of its own: standing it up, treating it
//! as another kind of data, correcting what its file says.

pub(in crate::app) mod corrected;
pub(in crate::app) mod framed;
pub(in crate::app) mod treat_as;
pub(in crate::app) mod upright;
