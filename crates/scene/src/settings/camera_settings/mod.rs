//! Camera settings: the camera, scene axes and standard views.

pub(crate) mod camera;
pub(crate) mod scene_axis;
pub(crate) mod standard_view;
