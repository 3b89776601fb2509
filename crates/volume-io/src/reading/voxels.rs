//! Voxels that were read of a grid: all, a selection, or block averages, computed slab by slab.

use super::samples::{BLOCK_BYTES, ReadFault};
use super::{LoadControl, LoadError};
use chiaroscuro_volume::{BlockPartition, ResolvedPortion, Samples};

/// Bytes of slices that are averaged at a time, or one layer of blocks where that is more: enough for all cores,
/// small against a volume. In tests two slices of the smallest volumes, so that there are several slabs.
const SLAB_BYTES: usize = if cfg!(test) { 64 } else { 8 * BLOCK_BYTES };

/// Voxels that were read of a grid.
#[derive(Debug, PartialEq)]
pub(crate) struct ReadVoxels {
    /// Selected voxels, or block averages.
    pub(crate) samples: Samples,
    /// First voxel of each block, where `samples` are averages: in a label map these are labels, unlike averages.
    pub(crate) block_firsts: Option<Samples>,
}

impl From<Samples> for ReadVoxels {
    fn from(samples: Samples) -> Self {
        Self { samples, block_firsts: None }
    }
}

impl ReadVoxels {
    /// Numbers that occur in the file, which averages need not.
    pub(crate) fn stored_numbers(&self) -> &Samples {
        self.block_firsts.as_ref().unwrap_or(&self.samples)
    }
}

/// Conversion of stored numbers to values.
pub(crate) struct ValueMapping<'a> {
    /// Padding value that is left out of averages, as the file declares it.
    pub(crate) padding: Option<f64>,
    /// Function that converts numbers to values, one by one.
    pub(crate) map: &'a dyn Fn(Samples) -> Result<Samples, LoadError>,
}

impl ValueMapping<'_> {
    /// Identity: the stored numbers are the values.
    pub(crate) fn identity(padding: Option<f64>) -> Self {
        Self { padding, map: &Ok }
    }
}

/// Reason why block averages could not be computed.
pub(crate) enum AveragingError<E> {
    /// Reading the slices has failed.
    Read(E),
    /// Allocation of memory for the averages has failed.
    NoMemory,
}

/// Averages the blocks of a box.
///
/// `read` supplies its slices in order, some at a time, as a half-open range that is counted from the first slice of
/// the box. `meant` gives the conversion to values, and the padding that is left out.
pub(crate) fn average_blocks<E>(
    kept: &ResolvedPortion,
    voxel_bytes: usize,
    meant: &ValueMapping<'_>,
    control: &LoadControl,
    mut read: impl FnMut(std::ops::Range<usize>) -> Result<Samples, E>,
) -> Result<ReadVoxels, AveragingError<E>>
where
    E: From<LoadError>,
{
    let [width, height, depth] = kept.box_dims();
    let step = kept.stride[2];
    let slice_bytes = width.saturating_mul(height).saturating_mul(voxel_bytes).max(1);
    let at_once = (SLAB_BYTES / slice_bytes / step * step).max(step);
    let mut means = ConcatenatedSamples::new(kept.count());
    let mut picked = (!kept.are_labels).then(|| ConcatenatedSamples::new(kept.count()));
    for first in (0..depth).step_by(at_once) {
        control.check().map_err(|stopped| AveragingError::Read(stopped.into()))?;
        let end = depth.min(first + at_once);
        let samples = (meant.map)(read(first..end).map_err(AveragingError::Read)?)
            .map_err(|error| AveragingError::Read(error.into()))?;
        let blocks =
            BlockPartition { dims: [width, height, end - first], block: kept.stride, padding: meant.padding };
        means.add(&blocks.average(&samples, kept.are_labels)).map_err(|_full| AveragingError::NoMemory)?;
        if let Some(picked) = &mut picked {
            picked.add(&blocks.first_voxels(&samples)).map_err(|_full| AveragingError::NoMemory)?;
        }
    }
    Ok(ReadVoxels { samples: means.samples, block_firsts: picked.map(|picked| picked.samples) })
}

/// Concatenated values, in a number type that holds all of them.
struct ConcatenatedSamples {
    samples: Samples,
    /// Number of values when complete.
    count: usize,
}

impl ConcatenatedSamples {
    fn new(count: usize) -> Self {
        Self { samples: Samples::U8(Vec::new()), count }
    }

    fn add(&mut self, more: &Samples) -> Result<(), ReadFault> {
        let is_first = self.samples.is_empty();
        let wanted = if is_first {
            more.voxel_type()
        } else {
            self.samples.voxel_type().common_type(more.voxel_type())
        };
        if is_first || self.samples.voxel_type() != wanted {
            self.samples = self.samples.converted_to(wanted, self.count).ok_or(ReadFault::NoMemory)?;
        }
        self.samples.append(more);
        Ok(())
    }
}
