//! Texts on the picture and around it.

pub(in crate::app) mod compared;
pub(in crate::app) mod cut_handles;
pub(in crate::app) mod picture;
pub(in crate::app) mod probe;
