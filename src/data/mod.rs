//! Volumes: their voxels, readers of file formats, built-in volumes, and statistics of their values.
//!
//! Independent of settings, the GPU and the window.

mod attempt;
mod bricks;
mod cells;
mod dataset;
mod foreign;
mod hints;
mod histogram;
mod interrupt;
pub mod load;
mod open;
mod surroundings;
pub mod synthetic;
mod values;
mod volume;

pub(crate) use attempt::address_bytes_left;
pub use bricks::Bricks;
pub use cells::{BOUNDED_SIGMA, BRICK_EDGE, CELL_EDGE, CellBounds, SIGMA_TOLERANCE};
pub use dataset::Dataset;
pub use foreign::{XmlError, fingerprint, one_line, plain, read_small, single_line, without_controls};
pub(crate) use foreign::{natural, read_bounded, xml};
pub use hints::{Hints, Label, Labels, MAX_LABEL_NAME, MAX_LABELS, Meaning, Modality};
pub use histogram::{HISTOGRAM_BINS, Histogram};
pub(crate) use interrupt::Interrupt;
pub use open::open;
pub use surroundings::{BrightLight, Surroundings, SurroundingsError, read_surroundings};
pub use values::range::ValueRange;
pub use values::robust::ValueRanges;
pub use values::samples::{Samples, VoxelType};
use volume::Blocks;
pub use volume::{
    AxisOrder, Corrections, CountedLabel, DataKind, Flips, Headings, KindFound, KindName, LabelSet,
    MAX_CLASSES, Missing, Orientation, PaddingValue, Shown, SpacingUnit, ValueScale, Volume, VolumeError,
    VolumeId, reduced_dims,
};
