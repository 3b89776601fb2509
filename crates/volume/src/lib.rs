//! Volumes: their voxels, built-in volumes, statistics of their values, bricks, and what opening one needs to say.
//!
//! Independent of file formats, settings, the GPU and the window.
//!
//! Spaces: *index* (voxel centres at integers) → *world* (millimetres) → *scene* (the volume's longest edge spans
//! [−1, 1]).
//!
//! Begin with [`Volume`] in `volume/mod.rs`, and with [`Dataset`], which adds what is derived from a volume's
//! densities: bounds of bricks and cells, and a histogram. Values become densities in
//! `volume/density_mapping.rs`. `load_context/` has what readers of files share with built-in volumes: choices, memory
//! limits, progress, and errors with advice.

mod cancellation;
mod dataset;
mod histogram;
mod load_context;
pub mod math;
mod occupancy;
mod pages;
mod presence;
mod resample;
pub mod synthetic;
mod value_metadata;
mod values;
mod volume;

pub use cancellation::{CancelOnDrop, CancelToken, PIECE_VALUES};
pub use dataset::{AddFieldError, Dataset, DatasetField, FieldOrigin, StepError};
pub use histogram::changes::ChangeHistogram;
pub use histogram::{HISTOGRAM_BINS, Histogram};
pub use load_context::{
    ChoiceAspect, ContentsRecorder, DefaultComponent, Downsampling, ErrorExplanation, FileContents,
    FileDimension, GridExtent, LevelRule, LoadContext, LoadControl, LoadError, LoadErrorKind, MAX_FIELDS,
    Portion, ReadContext, ResolutionLevel, ResolvedPortion, VolumeAlternatives, VolumeChoice, VolumeOffer,
    VolumeSize, VoxelComponents, VoxelRegion, VoxelSpan, address_bytes_left, human_bytes, is_usable_affine,
    is_usable_spacing, memory_budget_bytes, quoted, spacing_ratio_error,
};
pub use occupancy::bricks::{BrickBounds, CellRanges};
pub use occupancy::cells::{BOUNDED_SIGMA, BRICK_EDGE, CELL_EDGE, CellBounds, SIGMA_TOLERANCE};
pub use occupancy::label_cells::CellOccupancy;
pub use pages::{
    FinerLevel, FinerLevels, PAGE_BORDER, PAGE_EDGE, PAGE_READ_MARGIN, PAGE_STORED_EDGE, PAGES_PER_BATCH,
    Page, PageAddress, PageCache, PageSource, PoolLayout, ResidentPages, read_pages,
};
pub use value_metadata::{
    FileLabel, FileLabelTable, MAX_LABEL_NAME, MAX_LABELS, Modality, ValueMeaning, ValueMetadata,
};
pub use values::fill_value::find_fill_value;
pub use values::range::ValueRange;
pub use values::robust::ValueRanges;
pub use values::samples::{FiniteRange, Samples, VoxelType};
pub use values::voxel_mask::{Observer, VoxelMask};
pub use volume::{
    AnatomicalAxes, AxisOrder, BlockPartition, Corrections, CountedLabel, DataKind, DensityMapping,
    DetectedKind, Flips, KindName, LabelSet, MAX_CLASSES, MissingVoxels, Orientation, PaddingValue, PagesId,
    PatientTable, SpacingUnit, ValueScale, Volume, VolumeError, VolumeId, block_counts,
};
