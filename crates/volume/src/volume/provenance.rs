//! Provenance of a volume: the file or built-in volume that it comes from, and what was done to it since.

use std::sync::Arc;
use std::time::Duration;

use super::corrections::Corrections;
use crate::load_context::FileContents;

/// Source of a volume, as it is shown to the user. It belongs to the file: all quantities that are read from one have
/// it in common.
#[derive(Debug, Clone, Default)]
pub struct VolumeProvenance {
    /// Name of the file or the built-in volume.
    pub(super) name: String,
    /// Remarks about how the file was read.
    pub(super) remarks: Vec<String>,
    /// Inventory of the file.
    pub(super) contents: Arc<FileContents>,
    /// Corrections that the user made of the file's metadata.
    pub(super) corrections: Corrections,
    /// Time for ranges and hash when the file was read, which `bench` reports as statistics; zero without a file.
    pub(super) analysis_time: Duration,
}

impl VolumeProvenance {
    /// Creates the provenance of a volume of which nothing but the name is known.
    pub(super) fn new(name: String) -> Self {
        Self { name, ..Self::default() }
    }

    /// Returns the provenance of a part or a reduction of the volume, which takes corrections of its own and was not
    /// timed.
    pub(super) fn for_derived_volume(&self) -> Self {
        Self { corrections: Corrections::default(), analysis_time: Duration::ZERO, ..self.clone() }
    }

    /// Returns the name shown to the user: that of the file or the built-in volume.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns remarks for the user about how the file was read: impossible statements in it, and the values used
    /// instead.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Returns the inventory of the file: the other volumes that could be opened of it.
    pub fn contents(&self) -> &FileContents {
        &self.contents
    }

    /// Returns the corrections of the file's metadata that the user made.
    pub fn corrections(&self) -> &Corrections {
        &self.corrections
    }
}
