//! Memory estimate of a volume before it is read: its needs in main memory and on the graphics adapter, and portions
//! that fit.

use std::sync::{Arc, Mutex, PoisonError};

use chiaroscuro_render::{GpuContext, bytes_with_one_light, downsampled_dims};
use chiaroscuro_volume::{Downsampling, LoadControl, Portion, VolumeSize, VoxelRegion, VoxelSpan};

/// Strides and block edges that are offered: each leaves an eighth of the previous voxels. Larger ones would leave
/// hardly anything to see.
const OFFERED_STRIDES: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Memory available for a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AvailableMemory {
    /// Bytes of main memory that may be used without asking the user: three quarters of the free ones.
    pub budget_bytes: u64,
    /// Voxels along x, y and z that the adapter would hold of the whole volume.
    pub adapter_dims: [usize; 3],
    /// True if the adapter uses main memory too.
    pub shares_main_memory: bool,
}

/// Degree to which a volume, or a portion of it, fits into memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum MemoryFit {
    /// It does not fit into main memory.
    TooLarge,
    /// It fits after block averaging, since the adapter cannot hold all voxels.
    Downsampled,
    /// It takes most of the free memory.
    Tight,
    /// It fits with memory to spare.
    Comfortable,
}

/// Memory estimate of a volume that needs a decision of the user before it is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MemoryEstimate {
    /// Dimensions and voxel type of the file.
    pub size: VolumeSize,
    /// Memory available for the volume.
    pub available: AvailableMemory,
}

/// Shared cell for the memory estimate that the user must decide on, set once the header has been read.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingMemoryDecision(Arc<Mutex<Option<MemoryEstimate>>>);

impl PendingMemoryDecision {
    fn set(&self, weighed: MemoryEstimate) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(weighed);
    }

    /// Takes the estimate, if there is one; returns it only once.
    pub(crate) fn take(&self) -> Option<MemoryEstimate> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Returns a load control that admits volumes which fit into memory and on the adapter, and stores the estimate of
/// others in `question`.
pub(crate) fn memory_checking_control(
    context: GpuContext,
    budget_bytes: u64,
    question: PendingMemoryDecision,
) -> LoadControl {
    let estimate = move |size: &VolumeSize| {
        // A lost device is reported when the volume is displayed.
        let held = downsampled_dims(&context, size.dims, size.voxel_type).unwrap_or(size.dims);
        let room =
            AvailableMemory { budget_bytes, adapter_dims: held, shares_main_memory: context.is_software() };
        MemoryEstimate { size: *size, available: room }
    };
    let estimate_level = estimate.clone();
    LoadControl::with_size_check(move |size| {
        let weighed = estimate(size);
        let is_well = weighed.fits_comfortably();
        if !is_well {
            question.set(weighed);
        }
        is_well
    })
    .with_comfortable_size(move |size| estimate_level(size).fits_comfortably())
}

impl AvailableMemory {
    /// Bytes of free memory, of which the budget is three quarters.
    pub(crate) fn free_bytes(&self) -> u64 {
        self.budget_bytes / 3 * 4
    }

    /// Returns true if the adapter can hold a volume of these dimensions.
    fn fits_adapter(&self, size: &VolumeSize, dims: [usize; 3]) -> bool {
        let count = |dims: [usize; 3]| dims.into_iter().fold(1usize, usize::saturating_mul);
        let is_short =
            |axis: usize| self.adapter_dims[axis] == size.dims[axis] || dims[axis] <= self.adapter_dims[axis];
        count(dims) <= count(self.adapter_dims) && (0..3).all(is_short)
    }
}

impl MemoryEstimate {
    /// Returns the bytes that a portion needs in main memory and on the adapter; `None` if it exceeds the grid.
    pub(crate) fn required_bytes(&self, portion: &Portion) -> Option<[u64; 2]> {
        Some([self.size.peak_bytes(portion)?, bytes_with_one_light(self.size.portion_dims(portion)?)])
    }

    /// Returns how well a portion fits; `None` if it exceeds the grid.
    pub(crate) fn fit(&self, portion: &Portion) -> Option<MemoryFit> {
        let [host, adapter] = self.required_bytes(portion)?;
        let is_held = self.available.fits_adapter(&self.size, self.size.portion_dims(portion)?);
        // A volume averaged for the adapter takes as much as the adapter holds.
        let taken = if is_held { adapter } else { bytes_with_one_light(self.available.adapter_dims) };
        let needed = if self.available.shares_main_memory { host.saturating_add(taken) } else { host };
        Some(if needed > self.available.free_bytes() {
            MemoryFit::TooLarge
        } else if !is_held {
            MemoryFit::Downsampled
        } else if needed > self.available.budget_bytes {
            MemoryFit::Tight
        } else {
            MemoryFit::Comfortable
        })
    }

    /// Returns true if the whole volume is read without asking the user.
    pub(crate) fn fits_comfortably(&self) -> bool {
        self.fit(&Portion::default()) == Some(MemoryFit::Comfortable)
    }

    /// Returns the finest portion of a kind of thinning that fits well; `None` if none does.
    pub(crate) fn finest_thinning(&self, thinning: fn(usize) -> Downsampling) -> Option<Portion> {
        let portions = OFFERED_STRIDES.map(|step| Portion { region: None, thinning: thinning(step) });
        portions.into_iter().find(|portion| self.fit(portion) == Some(MemoryFit::Comfortable))
    }

    /// Returns the largest central region that fits well.
    pub(crate) fn largest_central_region(&self) -> VoxelRegion {
        // Each box has half the voxels of the one before; regions with few voxels always fit.
        let shares = (0..40).map(|halvings| 0.5f64.powf(f64::from(halvings) / 3.0));
        let boxes = shares.map(|share| {
            VoxelRegion(self.size.dims.map(|n| {
                let edge = ((n as f64 * share) as usize).clamp(1, n);
                let first = (n - edge) / 2;
                VoxelSpan { first, end: Some(first + edge) }
            }))
        });
        let all = VoxelRegion(self.size.dims.map(|n| VoxelSpan { first: 0, end: Some(n) }));
        let has_room = |region: &VoxelRegion| {
            self.fit(&Portion { region: Some(*region), thinning: Downsampling::None })
                == Some(MemoryFit::Comfortable)
        };
        boxes.skip(1).find(has_room).unwrap_or(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::VoxelType;

    const MIB: u64 = 1 << 20;

    fn weighed(budget_mib: u64, held: [usize; 3], is_shared: bool) -> MemoryEstimate {
        let size = VolumeSize { dims: [512; 3], voxel_type: VoxelType::U16, is_read_whole: false };
        MemoryEstimate {
            size,
            available: AvailableMemory {
                budget_bytes: budget_mib * MIB,
                adapter_dims: held,
                shares_main_memory: is_shared,
            },
        }
    }

    fn whole(weighed: &MemoryEstimate) -> MemoryFit {
        weighed.fit(&Portion::default()).unwrap()
    }

    #[test]
    fn memory_and_adapter_are_both_weighed() {
        // 512³ voxels of two bytes are 256 MiB, and the bricks' bounds 38 MiB; on the adapter they take 804 MiB.
        assert_eq!(whole(&weighed(300, [512; 3], false)), MemoryFit::Comfortable);
        assert_eq!(whole(&weighed(290, [512; 3], false)), MemoryFit::Tight);
        assert_eq!(whole(&weighed(200, [512; 3], false)), MemoryFit::TooLarge);
        assert_eq!(whole(&weighed(300, [256; 3], false)), MemoryFit::Downsampled);
        assert_eq!(whole(&weighed(1000, [512; 3], true)), MemoryFit::Tight, "they share what there is");
        assert_eq!(whole(&weighed(1200, [512; 3], true)), MemoryFit::Comfortable);
    }

    #[test]
    fn as_much_is_offered_as_has_room() {
        let little = weighed(60, [512; 3], false);
        assert_eq!(little.finest_thinning(Downsampling::Every), Some(Portion::with_stride(2)));
        // Averages of 2³ blocks take two times 32 MiB, plus slices.
        assert_eq!(little.finest_thinning(Downsampling::Average), Some(Portion::with_block_average(4)));
        assert_eq!(
            weighed(300, [128; 3], false).finest_thinning(Downsampling::Every),
            Some(Portion::with_stride(4))
        );
        assert_eq!(weighed(0, [512; 3], false).finest_thinning(Downsampling::Every), None);
        let region = little.largest_central_region();
        let portion = Portion { region: Some(region), ..Portion::default() };
        assert_eq!(little.fit(&portion), Some(MemoryFit::Comfortable));
        let edges = little.size.portion_dims(&portion).unwrap();
        assert!(edges == [256; 3] || edges[0] > 256, "{edges:?}");
        let long = VolumeSize { dims: [20_000, 3, 3], voxel_type: VoxelType::U8, is_read_whole: false };
        let long = MemoryEstimate {
            size: long,
            available: AvailableMemory {
                budget_bytes: MIB,
                adapter_dims: [10_000, 3, 3],
                shares_main_memory: false,
            },
        };
        assert_eq!(
            (whole(&long), long.finest_thinning(Downsampling::Every)),
            (MemoryFit::Downsampled, Some(Portion::with_stride(2)))
        );
    }
}
