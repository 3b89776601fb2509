//! Volumes: their voxels, readers of file formats, built-in volumes, and statistics of their values.
//!
//! Independent of settings, the GPU and the window.

mod bricks;
mod cancellation;
mod cells;
mod dataset;
mod environment_map;
mod histogram;
pub mod load;
mod load_context;
mod open;
pub mod synthetic;
mod untrusted;
mod value_metadata;
mod values;
mod volume;

pub use bricks::BrickBounds;
pub(crate) use cancellation::CancelToken;
pub use cells::{BOUNDED_SIGMA, BRICK_EDGE, CELL_EDGE, CellBounds, SIGMA_TOLERANCE};
pub use dataset::Dataset;
pub use environment_map::{BrightLight, EnvironmentMap, EnvironmentMapError, read_environment_map};
pub use histogram::{HISTOGRAM_BINS, Histogram};
pub(crate) use load_context::address_bytes_left;
pub use open::open;
pub use untrusted::{
    XmlError, fingerprint, one_line, read_small_file, sanitised, sanitised_line, without_controls,
};
pub(crate) use untrusted::{natural_sort_key, read_bounded, xml};
pub use value_metadata::{
    FileLabel, FileLabelTable, MAX_LABEL_NAME, MAX_LABELS, Modality, ValueMeaning, ValueMetadata,
};
pub use values::range::ValueRange;
pub use values::robust::ValueRanges;
pub use values::samples::{Samples, VoxelType};
use volume::BlockPartition;
pub use volume::{
    AnatomicalAxes, AxisOrder, Corrections, CountedLabel, DataKind, DensityMapping, DetectedKind, Flips,
    KindName, LabelSet, MAX_CLASSES, MissingVoxels, Orientation, PaddingValue, SpacingUnit, ValueScale,
    Volume, VolumeError, VolumeId, block_counts,
};
