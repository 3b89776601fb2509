//! The eye pass: from density and light volumes to the linear picture, and the floor under it.

pub(super) mod floor;
pub(super) mod gather;
pub(super) mod looked_up;
