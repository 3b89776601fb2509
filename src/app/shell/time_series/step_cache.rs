//! Cache of time steps that were read: those around the step that is shown.

use chiaroscuro_volume::{Corrections, Dataset, ValueRanges};

/// Facts about the dataset that is shown which all steps take over; steps with others are read again.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StepBasis {
    corrections: Corrections,
    /// Ranges of values, one for each field.
    ranges: Vec<ValueRanges>,
    /// Sources of the further fields.
    further: Vec<std::path::PathBuf>,
}

impl StepBasis {
    /// Returns the facts about a dataset.
    pub(super) fn new(shown: &Dataset) -> Self {
        Self {
            corrections: *shown.volume().corrections(),
            ranges: shown.fields().iter().map(|field| field.volume().ranges()).collect(),
            further: shown.further_origins().map(|origin| origin.source.clone()).collect(),
        }
    }
}

/// Datasets of time steps by their index, within a memory budget.
#[derive(Debug, Default)]
pub(super) struct StepCache {
    basis: Option<StepBasis>,
    steps: Vec<(usize, Dataset)>,
}

impl StepCache {
    /// Forgets steps that were read for a dataset with other facts than the one that is shown.
    pub(super) fn use_basis(&mut self, basis: StepBasis) {
        if self.basis.as_ref() != Some(&basis) {
            self.steps.clear();
            self.basis = Some(basis);
        }
    }

    /// Returns the facts that all steps have.
    pub(super) fn basis(&self) -> Option<&StepBasis> {
        self.basis.as_ref()
    }

    /// Returns the dataset of a step, if it is there.
    pub(super) fn get(&self, index: usize) -> Option<&Dataset> {
        self.steps.iter().find(|(at, _)| *at == index).map(|(_, dataset)| dataset)
    }

    /// Returns the index of the step that is there and nearest to another; of two, the earlier.
    pub(super) fn nearest_to(&self, index: usize) -> Option<usize> {
        self.steps.iter().map(|(at, _)| *at).min_by_key(|at| (at.abs_diff(index), *at))
    }

    /// Adds the dataset of a step in place of an earlier one.
    pub(super) fn insert(&mut self, index: usize, dataset: Dataset) {
        self.steps.retain(|(at, _)| *at != index);
        self.steps.push((index, dataset));
    }

    /// Drops the steps that are not wanted.
    pub(super) fn keep_only(&mut self, wanted: &[usize]) {
        self.steps.retain(|(at, _)| wanted.contains(at));
    }
}

/// Returns the memory of a dataset, in bytes: its voxels, and a quarter more for the bounds of bricks and cells.
pub(super) fn dataset_bytes(dataset: &Dataset) -> u64 {
    let voxels = dataset.fields().iter().map(|field| {
        let volume = field.volume();
        (volume.voxel_count() * volume.samples().voxel_type().bytes()) as u64
    });
    let voxels: u64 = voxels.sum();
    voxels + voxels / 4
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::synthetic::builtin;

    #[test]
    fn steps_are_kept_for_one_basis() {
        let dataset = Dataset::new(builtin("sphere", Some(8)).expect("a volume"));
        let mut cache = StepCache::default();
        cache.use_basis(StepBasis::new(&dataset));
        assert_eq!(cache.nearest_to(3), None);
        for at in [0, 4, 6] {
            cache.insert(at, dataset.clone());
        }
        assert_eq!(
            (cache.nearest_to(9), cache.nearest_to(5), cache.nearest_to(0)),
            (Some(6), Some(4), Some(0))
        );
        cache.keep_only(&[4, 5]);
        assert!(cache.get(4).is_some() && cache.get(0).is_none());
        cache.use_basis(StepBasis::new(&dataset));
        assert!(cache.get(4).is_some());
        let other =
            dataset.with_ranges(ValueRanges::without_outliers(chiaroscuro_volume::ValueRange::new(0.0, 9.0)));
        cache.use_basis(StepBasis::new(&other));
        assert!(cache.get(4).is_none(), "its colours would be others");
        assert!(dataset_bytes(&dataset) >= 8 * 8 * 8);
    }
}
