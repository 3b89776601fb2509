//! Occupancy: bounds of the densities in bricks and cells, by which passes skip what a transfer function does not show.

pub(crate) mod bricks;
pub(crate) mod cells;
pub(crate) mod label_cells;
