//! Where the eye is, and which way up things stand.

pub(in crate::model) mod camera;
pub(in crate::model) mod scene_axis;
pub(in crate::model) mod view;
