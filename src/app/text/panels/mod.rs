//! Texts of the side panel, one module per section.

pub(in crate::app) mod camera;
pub(in crate::app) mod corrections;
pub(in crate::app) mod cuts;
pub(in crate::app) mod data;
pub(in crate::app) mod floor;
pub(in crate::app) mod found;
pub(in crate::app) mod labels;
pub(in crate::app) mod lights;
pub(in crate::app) mod sampling;
pub(in crate::app) mod scattering;
pub(in crate::app) mod sections;
pub(in crate::app) mod shading;
pub(in crate::app) mod shadows;
pub(in crate::app) mod sky;
