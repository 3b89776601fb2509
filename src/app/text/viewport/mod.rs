//! Texts on the picture and around it.

pub(crate) mod comparison;
pub(crate) mod cut_handles;
pub(crate) mod picture;
pub(crate) mod probe;
pub(crate) mod time_series;
