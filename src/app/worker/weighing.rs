//! Memory estimate of a volume before it is read: its needs in main memory and on the graphics adapter, and portions
//! that fit.

use std::sync::{Arc, Mutex, PoisonError};

use crate::data::load::{LoadControl, Portion, Region, Size, Stretch, Thinning};
use crate::gpu::{Context, bytes_with_one_light, held_of};

/// Strides and block edges that are offered: each leaves an eighth of the previous voxels. Larger ones would leave
/// hardly anything to see.
const STEPS: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Memory available for a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Room {
    /// Bytes of main memory that may be used without asking the user: three quarters of the free ones.
    pub budget_bytes: u64,
    /// Voxels along x, y and z that the adapter would hold of the whole volume.
    pub held: [usize; 3],
    /// True if the adapter uses main memory too.
    pub is_shared: bool,
}

/// Degree to which a volume, or a portion of it, fits into memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fit {
    /// It does not fit into main memory.
    No,
    /// It fits after block averaging, since the adapter cannot hold all voxels.
    Averaged,
    /// It takes most of the free memory.
    Tight,
    /// It fits with memory to spare.
    Well,
}

/// Memory estimate of a volume that needs a decision of the user before it is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Weighed {
    /// Dimensions and voxel type of the file.
    pub size: Size,
    /// Memory available for the volume.
    pub room: Room,
}

/// Shared cell for the memory estimate that the user must decide on, set once the header has been read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Question(Arc<Mutex<Option<Weighed>>>);

impl Question {
    fn ask(&self, weighed: Weighed) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(weighed);
    }

    /// Takes the estimate, if there is one; returns it only once.
    pub(crate) fn take(&self) -> Option<Weighed> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Returns a load control that admits volumes which fit into memory and on the adapter, and stores the estimate of
/// others in `question`.
pub(crate) fn weighing(context: Context, budget_bytes: u64, question: Question) -> LoadControl {
    LoadControl::weighing(move |size| {
        // A lost device is reported when the volume is displayed.
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
    /// Bytes of free memory, of which the budget is three quarters.
    pub(crate) fn free_bytes(&self) -> u64 {
        self.budget_bytes / 3 * 4
    }

    /// Returns true if the adapter can hold a volume of these dimensions.
    fn adapter_holds(&self, size: &Size, dims: [usize; 3]) -> bool {
        let count = |dims: [usize; 3]| dims.into_iter().fold(1usize, usize::saturating_mul);
        let is_short = |axis: usize| self.held[axis] == size.dims[axis] || dims[axis] <= self.held[axis];
        count(dims) <= count(self.held) && (0..3).all(is_short)
    }
}

impl Weighed {
    /// Returns the bytes that a portion needs in main memory and on the adapter; `None` if it exceeds the grid.
    pub(crate) fn needs(&self, portion: &Portion) -> Option<[u64; 2]> {
        Some([self.size.host_bytes(portion)?, bytes_with_one_light(self.size.dims_of(portion)?)])
    }

    /// Returns how well a portion fits; `None` if it exceeds the grid.
    pub(crate) fn fit(&self, portion: &Portion) -> Option<Fit> {
        let [host, adapter] = self.needs(portion)?;
        let is_held = self.room.adapter_holds(&self.size, self.size.dims_of(portion)?);
        // A volume averaged for the adapter takes as much as the adapter holds.
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

    /// Returns true if the whole volume is read without asking the user.
    pub(crate) fn is_well(&self) -> bool {
        self.fit(&Portion::default()) == Some(Fit::Well)
    }

    /// Returns the finest portion of a kind of thinning that fits well; `None` if none does.
    pub(crate) fn thinned(&self, thinning: fn(usize) -> Thinning) -> Option<Portion> {
        let portions = STEPS.map(|step| Portion { region: None, thinning: thinning(step) });
        portions.into_iter().find(|portion| self.fit(portion) == Some(Fit::Well))
    }

    /// Returns the largest central region that fits well.
    pub(crate) fn middle(&self) -> Region {
        // Each box has half the voxels of the one before; regions with few voxels always fit.
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
        // 512³ voxels of two bytes are 256 MiB, and the bricks' bounds 38 MiB; on the adapter they take 804 MiB.
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
        // Averages of 2³ blocks take two times 32 MiB, plus slices.
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
