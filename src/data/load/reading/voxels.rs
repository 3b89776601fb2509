//! Voxels that were read of a grid: all, a selection, or block averages, computed slab by slab.

use super::samples::{BLOCK_BYTES, Fault};
use super::{LoadControl, LoadError};
use crate::data::attempt::Kept;
use crate::data::{Blocks, Samples};

/// Bytes of slices that are averaged at a time, or one layer of blocks where that is more: enough for all cores,
/// small against a volume. In tests two slices of the smallest volumes, so that there are several slabs.
const SLAB_BYTES: usize = if cfg!(test) { 64 } else { 8 * BLOCK_BYTES };

/// Voxels that were read of a grid.
#[derive(Debug, PartialEq)]
pub(in crate::data::load) struct Voxels {
    /// Selected voxels, or block averages.
    pub(in crate::data::load) samples: Samples,
    /// First voxel of each block, where `samples` are averages: in a label map these are labels, unlike averages.
    pub(in crate::data::load) picked: Option<Samples>,
}

impl From<Samples> for Voxels {
    fn from(samples: Samples) -> Self {
        Self { samples, picked: None }
    }
}

impl Voxels {
    /// Numbers that occur in the file, which averages need not.
    pub(in crate::data::load) fn in_file(&self) -> &Samples {
        self.picked.as_ref().unwrap_or(&self.samples)
    }
}

/// Conversion of stored numbers to values.
pub(in crate::data::load) struct Meant<'a> {
    /// Padding value that is left out of averages, as the file declares it.
    pub(in crate::data::load) padding: Option<f64>,
    /// Function that converts numbers to values, one by one.
    pub(in crate::data::load) values: &'a dyn Fn(Samples) -> Result<Samples, LoadError>,
}

impl Meant<'_> {
    /// Identity: the stored numbers are the values.
    pub(in crate::data::load) fn as_stored(padding: Option<f64>) -> Self {
        Self { padding, values: &Ok }
    }
}

/// Reason why block averages could not be computed.
pub(in crate::data::load) enum NoMeans<E> {
    /// Reading the slices has failed.
    Unread(E),
    /// Allocation of memory for the averages has failed.
    NoMemory,
}

/// Averages the blocks of a box.
///
/// `read` supplies its slices in order, some at a time, as a half-open range that is counted from the first slice of
/// the box. `meant` gives the conversion to values, and the padding that is left out.
pub(in crate::data::load) fn averaged<E>(
    kept: &Kept,
    of_voxel: usize,
    meant: &Meant<'_>,
    control: &LoadControl,
    mut read: impl FnMut(std::ops::Range<usize>) -> Result<Samples, E>,
) -> Result<Voxels, NoMeans<E>>
where
    E: From<LoadError>,
{
    let [width, height, depth] = kept.edges();
    let step = kept.step[2];
    let slice_bytes = width.saturating_mul(height).saturating_mul(of_voxel).max(1);
    let at_once = (SLAB_BYTES / slice_bytes / step * step).max(step);
    let mut means = Joined::new(kept.count());
    let mut picked = (!kept.are_labels).then(|| Joined::new(kept.count()));
    for first in (0..depth).step_by(at_once) {
        control.check().map_err(|stopped| NoMeans::Unread(stopped.into()))?;
        let end = depth.min(first + at_once);
        let samples = (meant.values)(read(first..end).map_err(NoMeans::Unread)?)
            .map_err(|error| NoMeans::Unread(error.into()))?;
        let blocks = Blocks { dims: [width, height, end - first], block: kept.step, padding: meant.padding };
        means.add(&blocks.averaged(&samples, kept.are_labels)).map_err(|_full| NoMeans::NoMemory)?;
        if let Some(picked) = &mut picked {
            picked.add(&blocks.firsts(&samples)).map_err(|_full| NoMeans::NoMemory)?;
        }
    }
    Ok(Voxels { samples: means.samples, picked: picked.map(|picked| picked.samples) })
}

/// Concatenated values, in a number type that holds all of them.
struct Joined {
    samples: Samples,
    /// Number of values when complete.
    count: usize,
}

impl Joined {
    fn new(count: usize) -> Self {
        Self { samples: Samples::U8(Vec::new()), count }
    }

    fn add(&mut self, more: &Samples) -> Result<(), Fault> {
        let is_first = self.samples.is_empty();
        let wanted =
            if is_first { more.voxel_type() } else { self.samples.voxel_type().with(more.voxel_type()) };
        if is_first || self.samples.voxel_type() != wanted {
            self.samples = self.samples.in_type(wanted, self.count).ok_or(Fault::NoMemory)?;
        }
        self.samples.append(more);
        Ok(())
    }
}
