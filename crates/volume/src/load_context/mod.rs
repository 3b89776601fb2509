//! Infrastructure shared by readers and built-in volumes: memory limits, errors with advice, and a control for
//! progress and cancellation.

mod choice;
mod control;
mod error;
mod extent;
mod file_contents;
mod free_memory;
mod level_rule;
mod limits;
mod memory_estimate;
mod offer;
mod portion;
mod resolution_level;
mod resolved_portion;

pub use choice::VolumeChoice;
pub use control::LoadControl;
pub use error::{ErrorExplanation, LoadError, LoadErrorKind};
pub use error::{LoadContext, quoted};
pub use extent::{GridExtent, ReadContext};
pub use file_contents::{
    ChoiceAspect, ContentsRecorder, DefaultComponent, FileContents, MAX_FIELDS, VolumeAlternatives,
    VoxelComponents,
};
pub use free_memory::address_bytes_left;
pub use level_rule::LevelRule;
pub use limits::human_bytes;
pub use limits::memory_budget_bytes;
pub use limits::{is_usable_affine, is_usable_spacing, spacing_ratio_error};
pub use memory_estimate::VolumeSize;
pub use offer::{FileDimension, VolumeOffer};
pub use portion::{Downsampling, Portion, VoxelRegion, VoxelSpan};
pub use resolution_level::ResolutionLevel;
pub use resolved_portion::ResolvedPortion;
