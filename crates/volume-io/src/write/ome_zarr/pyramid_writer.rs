//! Writer of all levels of a pyramid, each of which is made of the slices of the finer one.

use std::io::{Error, Result};

use super::PyramidSpec;
use super::hierarchy_sink::HierarchySink;
use super::level_writer::{LevelWriter, ShardGrid};
use super::metadata;
use super::pyramid_levels::{LevelGrid, plan_levels};
use super::slab_samples::SliceAverager;

/// Writer of a pyramid into a sink.
#[derive(Debug)]
pub(super) struct PyramidWriter<S> {
    sink: S,
    spec: PyramidSpec,
    levels: Vec<LevelWriter>,
    /// Averager to the next coarser level, for each level but the last.
    averagers: Vec<SliceAverager>,
}

impl<S: HierarchySink> PyramidWriter<S> {
    /// Creates a writer, and writes the metadata.
    ///
    /// # Errors
    /// When the sink refuses.
    pub(super) fn new(mut sink: S, spec: PyramidSpec) -> Result<Self> {
        let planned = plan_levels(spec.dims, spec.spacing, spec.translation);
        sink.append("zarr.json", &metadata::group_document(&spec, &planned))?;
        let mut levels = Vec::new();
        for (number, level) in planned.iter().enumerate() {
            let grid = ShardGrid::new(level.dims);
            sink.append(&format!("{number}/zarr.json"), &metadata::array_document(&spec, &grid))?;
            levels.push(LevelWriter::new(number.to_string(), grid, &spec.fill()));
        }
        let averager = |(fine, coarse): (&LevelGrid, &LevelGrid)| SliceAverager {
            voxel_type: spec.voxel_type,
            slice_dims: [fine.dims[0], fine.dims[1]],
            block: coarse.block,
            padding: spec.padding,
            has_label_numbers: spec.has_label_numbers,
        };
        let averagers = planned.iter().zip(planned.iter().skip(1)).map(averager).collect();
        Ok(Self { sink, spec, levels, averagers })
    }

    /// Description of the image.
    pub(super) fn spec(&self) -> &PyramidSpec {
        &self.spec
    }

    /// Writes the next slices of the finest level: little-endian numbers, x fastest.
    ///
    /// # Errors
    /// When the sink refuses, or there are more slices than the image has.
    pub(super) fn write_slab(&mut self, slices: &[u8]) -> Result<()> {
        self.push(0, slices)
    }

    fn push(&mut self, number: usize, mut slices: &[u8]) -> Result<()> {
        while !slices.is_empty() {
            let level = &mut self.levels[number];
            if level.is_complete() {
                return Err(Error::other("the volume has more slices than were announced"));
            }
            slices = level.take(slices);
            let Some(layer) = level.write_layer(&mut self.sink)? else { break };
            if let Some(averager) = self.averagers.get(number) {
                let coarse = averager.average(&layer);
                drop(layer);
                self.push(number + 1, &coarse)?;
            }
        }
        Ok(())
    }

    /// Returns the sink with the finished pyramid.
    ///
    /// # Errors
    /// When slices are missing.
    pub(super) fn finish(self) -> Result<S> {
        if self.levels.iter().all(LevelWriter::is_complete) {
            return Ok(self.sink);
        }
        Err(Error::other("the volume has fewer slices than were announced"))
    }
}
