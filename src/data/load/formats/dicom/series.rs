//! The series of files: which volumes each has, and which of them comes first.

use rayon::prelude::*;

use super::groups::{Group, Grouping};
use super::header::Header;
use super::layer::Filling;
use super::pixels::shape::Shape;
use super::stack::{Stack, StackedVolume};
use crate::data::attempt::Offer;

/// Pictures of one series that are of one size and lie in parallel: one volume, or one for each phase.
#[derive(Debug)]
pub(super) struct Series {
    name: String,
    pub(super) shape: Shape,
    pub(super) filling: Filling,
    pub(super) has_masks: bool,
    pub(super) stack: Stack,
}

impl Series {
    /// All series of files, the largest volume first: a scout of one slice, numbered before the scan that it was taken
    /// for, comes behind that. Films and pictures without depth come last.
    pub(super) fn all(grouping: Grouping, headers: &[Header]) -> Vec<Self> {
        let Grouping { groups, image_types, .. } = grouping;
        let of_group = |group: Group| {
            let name = group.name(headers);
            let Group { shape, slices, filling, has_masks } = group;
            let stack = Stack::new(slices, filling, has_masks, &image_types);
            Self { name, shape, filling, has_masks, stack }
        };
        let mut all: Vec<Self> = groups.into_par_iter().map(of_group).collect();
        // Equal ones stay in the order of their numbers.
        all.sort_by_key(|series| std::cmp::Reverse((series.stack.has_depth, series.voxels())));
        all
    }

    /// Voxels of its first volume.
    fn voxels(&self) -> u128 {
        self.dims().into_iter().map(u128::from).product()
    }

    /// Voxels of its first volume along x, y, z.
    fn dims(&self) -> [u64; 3] {
        let layers = self.stack.volumes.first().map_or(0, |volume| volume.layers.len());
        dims(&self.shape, layers)
    }

    /// What users are offered it as.
    pub(super) fn offer(&self, number: usize) -> Offer {
        Offer::numbered(number, &self.name, self.dims())
    }

    /// What users are offered its volumes as.
    pub(super) fn volume_offers(&self) -> Vec<Offer> {
        let offer = |(number, volume): (usize, &StackedVolume)| {
            Offer::numbered(number, &volume.name, dims(&self.shape, volume.layers.len()))
        };
        self.stack.volumes.iter().enumerate().map(offer).collect()
    }

    /// The number of the volume that has a slice of a file.
    pub(super) fn volume_of(&self, file: usize) -> Option<usize> {
        let has = |volume: &StackedVolume| volume.slices.iter().any(|slice| slice.file == file);
        self.stack.volumes.iter().position(has)
    }

    /// The file of its first picture.
    pub(super) fn first_file(&self) -> Option<usize> {
        self.stack.volumes.first()?.slices.first().map(|slice| slice.file)
    }

    /// How many pictures it has.
    pub(super) fn pictures(&self) -> usize {
        self.stack.volumes.iter().map(|volume| volume.slices.len()).sum()
    }
}

fn dims(shape: &Shape, layers: usize) -> [u64; 3] {
    [shape.columns as u64, shape.rows as u64, layers as u64]
}
