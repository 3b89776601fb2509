//! Camera settings: the camera, scene axes and standard views.

pub(in crate::model) mod camera;
pub(in crate::model) mod scene_axis;
pub(in crate::model) mod view;
