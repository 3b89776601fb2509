//! What a volume takes of the memory and of the graphics adapter, before it is read, and how much of it has room.

use std::sync::{Arc, Mutex, PoisonError};

use crate::data::load::{LoadControl, Portion, Region, Size, Stretch, Thinning};
use crate::gpu::{Context, bytes_with_one_light, held_of};

/// Steps, and edges of blocks, that are offered: an eighth of the voxels each time. More would leave hardly anything to see.
const STEPS: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// What there is for a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Room {
    /// Bytes of memory that may be taken without a question: three quarters of those that are free.
    pub budget_bytes: u64,
    /// Voxels along x, y and z of what the adapter would show of all of it.
    pub held: [usize; 3],
    /// Whether the adapter takes its memory from the same.
    pub is_shared: bool,
}

/// How a volume, or a portion of it, fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fit {
    /// Not into the memory.
    No,
    /// It would be shown with blocks averaged, because the adapter cannot hold more.
    Averaged,
    /// It takes most of the memory that is free.
    Tight,
    /// Well.
    Well,
}

/// A volume that is not read before the user has said how much of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Weighed {
    /// What the file holds.
    pub size: Size,
    /// What there is for it.
    pub room: Room,
}

/// What there is to ask of a volume, once its header has been read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Question(Arc<Mutex<Option<Weighed>>>);

impl Question {
    fn ask(&self, weighed: Weighed) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(weighed);
    }

    /// What there is to ask, once.
    pub(crate) fn take(&self) -> Option<Weighed> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// A control that lets volumes pass that have room in memory and on the adapter, and keeps what there is to ask of others.
pub(crate) fn weighing(context: Context, budget_bytes: u64, question: Question) -> LoadControl {
    LoadControl::weighing(move |size| {
        // A device that is lost is spoken of when the volume is shown.
        let held = held_of(&context, size.dims, size.voxel_type).unwrap_or(size.dims);
        let room = Room { budget_bytes, held, is_shared: context.is_software() };
        let weighed = Weighed { size: *size, room };
        let is_well = weighed.is_well();
        if !is_well {
            question.ask(weighed);
        }
        is_well
    })
}

impl Room {
    /// Bytes that are free.
    pub(crate) fn free_bytes(&self) -> u64 {
        self.budget_bytes / 3 * 4
    }

    /// Whether the adapter holds so many voxels.
    fn adapter_holds(&self, size: &Size, dims: [usize; 3]) -> bool {
        let count = |dims: [usize; 3]| dims.into_iter().fold(1usize, usize::saturating_mul);
        let is_short = |axis: usize| self.held[axis] == size.dims[axis] || dims[axis] <= self.held[axis];
        count(dims) <= count(self.held) && (0..3).all(is_short)
    }
}

impl Weighed {
    /// Bytes of memory that a portion takes, and of the adapter's; nothing where it reaches beyond the grid.
    pub(crate) fn needs(&self, portion: &Portion) -> Option<[u64; 2]> {
        Some([self.size.host_bytes(portion)?, bytes_with_one_light(self.size.dims_of(portion)?)])
    }

    /// How a portion fits; nothing where it reaches beyond the grid.
    pub(crate) fn fit(&self, portion: &Portion) -> Option<Fit> {
        let [host, adapter] = self.needs(portion)?;
        let is_held = self.room.adapter_holds(&self.size, self.size.dims_of(portion)?);
        // What is averaged for the adapter takes as much of it as that holds.
        let taken = if is_held { adapter } else { bytes_with_one_light(self.room.held) };
        let needed = if self.room.is_shared { host.saturating_add(taken) } else { host };
        Some(if needed > self.room.free_bytes() {
            Fit::No
        } else if !is_held {
            Fit::Averaged
        } else if needed > self.room.budget_bytes {
            Fit::Tight
        } else {
            Fit::Well
        })
    }

    /// Whether all of it is read without a question.
    pub(crate) fn is_well(&self) -> bool {
        self.fit(&Portion::default()) == Some(Fit::Well)
    }

    /// The most voxels of a kind of thinning that have room.
    pub(crate) fn thinned(&self, thinning: fn(usize) -> Thinning) -> Option<Portion> {
        let portions = STEPS.map(|step| Portion { region: None, thinning: thinning(step) });
        portions.into_iter().find(|portion| self.fit(portion) == Some(Fit::Well))
    }

    /// The middle of it, as much as has room.
    pub(crate) fn middle(&self) -> Region {
        // A box of half the voxels each time: a region of few always has room.
        let shares = (0..40).map(|halvings| 0.5f64.powf(f64::from(halvings) / 3.0));
        let boxes = shares.map(|share| {
            Region(self.size.dims.map(|n| {
                let edge = ((n as f64 * share) as usize).clamp(1, n);
                let first = (n - edge) / 2;
                Stretch { first, end: Some(first + edge) }
            }))
        });
        let all = Region(self.size.dims.map(|n| Stretch { first: 0, end: Some(n) }));
        let has_room = |region: &Region| {
            self.fit(&Portion { region: Some(*region), thinning: Thinning::None }) == Some(Fit::Well)
        };
        boxes.skip(1).find(has_room).unwrap_or(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::VoxelType;

    const MIB: u64 = 1 << 20;

    fn weighed(budget_mib: u64, held: [usize; 3], is_shared: bool) -> Weighed {
        let size = Size { dims: [512; 3], voxel_type: VoxelType::U16, is_read_whole: false };
        Weighed { size, room: Room { budget_bytes: budget_mib * MIB, held, is_shared } }
    }

    fn whole(weighed: &Weighed) -> Fit {
        weighed.fit(&Portion::default()).unwrap()
    }

    #[test]
    fn memory_and_adapter_are_both_weighed() {
        // 512³ voxels of two bytes are 256 MiB, and what is found of their bricks 38; on the adapter they take 804.
        assert_eq!(whole(&weighed(300, [512; 3], false)), Fit::Well);
        assert_eq!(whole(&weighed(290, [512; 3], false)), Fit::Tight);
        assert_eq!(whole(&weighed(200, [512; 3], false)), Fit::No);
        assert_eq!(whole(&weighed(300, [256; 3], false)), Fit::Averaged);
        assert_eq!(whole(&weighed(1000, [512; 3], true)), Fit::Tight, "they share what there is");
        assert_eq!(whole(&weighed(1200, [512; 3], true)), Fit::Well);
    }

    #[test]
    fn as_much_is_offered_as_has_room() {
        let little = weighed(60, [512; 3], false);
        assert_eq!(little.thinned(Thinning::Every), Some(Portion::every(2)));
        // Means of 2³ take two times 32 MiB, and slices.
        assert_eq!(little.thinned(Thinning::Average), Some(Portion::average(4)));
        assert_eq!(weighed(300, [128; 3], false).thinned(Thinning::Every), Some(Portion::every(4)));
        assert_eq!(weighed(0, [512; 3], false).thinned(Thinning::Every), None);
        let region = little.middle();
        let portion = Portion { region: Some(region), ..Portion::default() };
        assert_eq!(little.fit(&portion), Some(Fit::Well));
        let edges = little.size.dims_of(&portion).unwrap();
        assert!(edges == [256; 3] || edges[0] > 256, "{edges:?}");
        let long = Size { dims: [20_000, 3, 3], voxel_type: VoxelType::U8, is_read_whole: false };
        let long =
            Weighed { size: long, room: Room { budget_bytes: MIB, held: [10_000, 3, 3], is_shared: false } };
        assert_eq!((whole(&long), long.thinned(Thinning::Every)), (Fit::Averaged, Some(Portion::every(2))));
    }
}
