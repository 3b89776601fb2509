//! Eye pass and floor pass: from density and light volumes to the linear picture.

pub(super) mod antialiasing;
pub(super) mod eye_pass;
pub(super) mod eye_variant;
pub(super) mod floor;
pub(super) mod light_lookup;
pub(super) mod ray_target;
