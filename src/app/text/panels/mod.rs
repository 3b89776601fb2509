//! Texts of the side panel, one module per section.

pub(crate) mod camera;
pub(crate) mod corrections;
pub(crate) mod cuts;
pub(crate) mod data;
pub(crate) mod floor;
pub(crate) mod labels;
pub(crate) mod lights;
pub(crate) mod sampling;
pub(crate) mod scattering;
pub(crate) mod sections;
pub(crate) mod shading;
pub(crate) mod shadows;
pub(crate) mod sky;
pub(crate) mod synonyms;
