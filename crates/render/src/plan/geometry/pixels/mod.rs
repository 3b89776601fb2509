//! Pixels of a picture: the part that is drawn, and the rays through each.

pub(crate) mod rays;
pub(crate) mod window;
