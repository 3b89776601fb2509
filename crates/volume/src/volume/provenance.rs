//! Provenance of a volume: the file or built-in volume that it comes from.

use std::sync::Arc;

use crate::load_context::FileContents;

/// Source of a volume, as it is shown to the user. It belongs to the file: all quantities that are read from one have
/// it in common.
#[derive(Debug, Clone, Default)]
pub(super) struct VolumeProvenance {
    /// Name of the file or the built-in volume.
    pub(super) name: String,
    /// Remarks about how the file was read.
    pub(super) remarks: Vec<String>,
    /// Inventory of the file.
    pub(super) contents: Arc<FileContents>,
}

impl VolumeProvenance {
    /// Creates the provenance of a volume of which nothing but the name is known.
    pub(super) fn new(name: String) -> Self {
        Self { name, ..Self::default() }
    }
}
