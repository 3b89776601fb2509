//! Series of files, with their volumes, in the order in which they are offered.

use rayon::prelude::*;

use super::header::DicomHeader;
use super::image_groups::{ImageGroup, ImageGroups};
use super::pixels::layout::PixelLayout;
use super::slice_layer::GapFill;
use super::stack::{SliceStack, StackedVolume};
use chiaroscuro_volume::VolumeOffer;

/// Images of one series with equal size and parallel planes: one volume, or one per phase.
#[derive(Debug)]
pub(super) struct DicomSeries {
    name: String,
    pub(super) layout: PixelLayout,
    pub(super) gap_fill: GapFill,
    pub(super) has_masks: bool,
    pub(super) stack: SliceStack,
}

impl DicomSeries {
    /// Collects all series of the files, largest volume first: a localiser of one slice, numbered before its scan,
    /// comes after it. Series without depth (cine, or images without positions) come last.
    pub(super) fn from_groups(grouping: ImageGroups, headers: &[DicomHeader]) -> Vec<Self> {
        let ImageGroups { groups, image_types, .. } = grouping;
        let of_group = |group: ImageGroup| {
            let name = group.name(headers);
            let ImageGroup { layout: shape, slices, gap_fill: filling, has_masks } = group;
            let stack = SliceStack::new(slices, filling, has_masks, &image_types);
            Self { name, layout: shape, gap_fill: filling, has_masks, stack }
        };
        let mut all: Vec<Self> = groups.into_par_iter().map(of_group).collect();
        // Equal ones keep the order of their numbers (stable sort).
        all.sort_by_key(|series| std::cmp::Reverse((series.stack.has_depth, series.voxels())));
        all
    }

    /// Returns the number of voxels of the first volume.
    fn voxels(&self) -> u128 {
        self.dims().into_iter().map(u128::from).product()
    }

    /// Returns the dimensions of the first volume, in voxels along x, y, z.
    fn dims(&self) -> [u64; 3] {
        let layers = self.stack.volumes.first().map_or(0, |volume| volume.layers.len());
        dims(&self.layout, layers)
    }

    /// Returns the series as an item to choose from.
    pub(super) fn offer(&self, number: usize) -> VolumeOffer {
        VolumeOffer::with_number(number, &self.name, self.dims())
    }

    /// Returns the volumes of the series as items to choose from.
    pub(super) fn volume_offers(&self) -> Vec<VolumeOffer> {
        let offer = |(number, volume): (usize, &StackedVolume)| {
            VolumeOffer::with_number(number, &volume.name, dims(&self.layout, volume.layers.len()))
        };
        self.stack.volumes.iter().enumerate().map(offer).collect()
    }

    /// Returns the index of the volume that contains a slice of the file.
    pub(super) fn volume_with_file(&self, file: usize) -> Option<usize> {
        let has = |volume: &StackedVolume| volume.slices.iter().any(|slice| slice.file == file);
        self.stack.volumes.iter().position(has)
    }

    /// Returns the file index of the first image.
    pub(super) fn first_file(&self) -> Option<usize> {
        self.stack.volumes.first()?.slices.first().map(|slice| slice.file)
    }

    /// Returns the number of images in all volumes.
    pub(super) fn image_count(&self) -> usize {
        self.stack.volumes.iter().map(|volume| volume.slices.len()).sum()
    }
}

fn dims(shape: &PixelLayout, layers: usize) -> [u64; 3] {
    [shape.columns as u64, shape.rows as u64, layers as u64]
}
