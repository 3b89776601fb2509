//! Eye pass and floor pass: from density and light volumes to the linear picture.

pub(super) mod floor;
pub(super) mod gather;
pub(super) mod looked_up;
