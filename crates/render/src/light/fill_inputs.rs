//! Inputs of filling a light volume that the march, the rays and the scattering engine share.

use crate::volume::transfer_tables::TransferTables;
use chiaroscuro_scene::{SceneLight, Settings};

/// Transfer tables by which light is attenuated: for white light, or for one of its colours.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightTables<'a> {
    pub tables: &'a TransferTables,
    /// Index of the colour; `None` for white light.
    pub color: Option<usize>,
}

/// Light, or a point of an area light, with the settings of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LightWithSettings<'a> {
    pub light: &'a SceneLight,
    pub settings: &'a Settings,
}
