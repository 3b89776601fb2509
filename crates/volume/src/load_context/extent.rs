//! Extent of a volume's grid, checked against the memory budget before anything is allocated.

use super::choice::VolumeChoice;
use super::control::LoadControl;
use super::error::{LoadContext, LoadError};
use super::level_rule::LevelRule;
use super::limits::human_bytes;
use super::memory_estimate::{VolumeSize, needed_bytes};
use super::portion::{Downsampling, MAX_STRIDE, Portion};
use super::resolved_portion::ResolvedPortion;
use crate::VoxelType;

/// Memory budget, selection and control of one read.
#[derive(Debug, Clone, Copy)]
pub struct ReadContext<'a> {
    /// Maximum number of bytes for voxels.
    pub budget_bytes: u64,
    /// The user's selection of a volume and its portion.
    pub choice: &'a VolumeChoice,
    /// Control of the waiting thread: progress, cancellation and acceptance of the size.
    pub control: &'a LoadControl,
    /// Rule for the resolution level that is read where the user has chosen none.
    pub level: LevelRule,
}

/// Size of a grid with the portion that is wanted and the portion that is kept while reading, within the memory
/// budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GridExtent {
    /// Voxels of the file's grid along x, y, z, none of them 0.
    pub dims: [usize; 3],
    /// Number of voxels of the grid: the product of `dims`.
    pub voxels: usize,
    /// Bytes of all voxels of the grid.
    pub bytes: u64,
    /// Portion of the grid that the caller wants.
    pub wanted: ResolvedPortion,
    /// Portion that is kept while reading: the wanted one, or a larger one from which it is derived afterwards.
    pub read: ResolvedPortion,
}

impl GridExtent {
    /// Returns the extent of a grid that is read completely, without checking any limit.
    pub fn unchecked(dims: [usize; 3], voxel_type: VoxelType) -> Self {
        let kept = ResolvedPortion::whole_grid(dims);
        let bytes = (kept.count() as u64).saturating_mul(voxel_type.bytes() as u64);
        Self { dims, voxels: kept.count(), bytes, wanted: kept, read: kept }
    }

    /// Returns the extent of only the needed slices, treated as a grid of their own.
    pub fn restricted_to_slices(self, voxel_type: VoxelType) -> Self {
        let kept = self.read.relative_to_slices();
        Self { wanted: kept, read: kept, ..Self::unchecked(kept.grid, voxel_type) }
    }

    /// Returns the extent of only the box that is read, treated as a grid of its own.
    pub fn restricted_to_box(self, voxel_type: VoxelType) -> Self {
        let kept = self.read.relative_to_box();
        Self { wanted: kept, read: kept, ..Self::unchecked(kept.grid, voxel_type) }
    }

    /// Checks `dims`, which `field` gave, against zero, overflow and the budget, for a reader that keeps only the
    /// wanted voxels.
    ///
    /// Blocks are averaged after reading if all their voxels fit into the budget, otherwise while reading.
    pub fn checked(
        context: LoadContext<'_>,
        field: &str,
        dims: [u64; 3],
        voxel_type: VoxelType,
        room: ReadContext<'_>,
    ) -> Result<Self, LoadError> {
        let extent = Self::from_header(context, field, dims, voxel_type, room)?;
        extent.ask_acceptance(voxel_type, room, false)?;
        let Self { wanted, .. } = extent;
        let boxed = Self { read: wanted.full_box(), ..extent };
        let has_room = boxed.needed_bytes(voxel_type) <= u128::from(room.budget_bytes);
        if wanted.is_averaged && has_room && !room.control.is_memory_scarce() {
            return Ok(boxed);
        }
        let extent = extent.check_budget(context, field, voxel_type, room, false)?;
        if let Some(watch) = room.choice.recorder.as_ref().filter(|_| extent.read.is_averaged) {
            watch.record_averaging();
        }
        Ok(extent)
    }

    /// Does the check of [`Self::checked`] for a reader that decodes all voxels before any can be dropped.
    pub fn checked_whole(
        context: LoadContext<'_>,
        field: &str,
        dims: [u64; 3],
        voxel_type: VoxelType,
        room: ReadContext<'_>,
    ) -> Result<Self, LoadError> {
        let extent = Self::from_header(context, field, dims, voxel_type, room)?;
        extent.ask_acceptance(voxel_type, room, true)?;
        Self { read: ResolvedPortion::whole_grid(extent.dims), ..extent }
            .check_budget(context, field, voxel_type, room, true)
    }

    /// Computes the extent of a grid of which only the wanted portion is read.
    fn from_header(
        context: LoadContext<'_>,
        field: &str,
        dims: [u64; 3],
        voxel_type: VoxelType,
        room: ReadContext<'_>,
    ) -> Result<Self, LoadError> {
        let [x, y, z] = dims;
        if dims.contains(&0) {
            return Err(context.bad_input_error(
                field,
                format!("a volume of {x} x {y} x {z} voxels is empty"),
                "every dimension must be at least 1",
            ));
        }
        // The product of three 64-bit factors can overflow even 128 bits; the saturated value still exceeds any
        // budget.
        let voxels = dims.iter().fold(1u128, |product, &n| product.saturating_mul(u128::from(n)));
        let bytes = voxels.saturating_mul(voxel_type.bytes() as u128);
        // On a 32-bit system the budget may exceed the address space.
        let narrow = |n: u64| usize::try_from(n).ok();
        let (Some(x), Some(y), Some(z), Ok(voxels), Ok(bytes)) =
            (narrow(x), narrow(y), narrow(z), usize::try_from(voxels), u64::try_from(bytes))
        else {
            return Err(context.limit_error(
                field,
                format!(
                    "{x} x {y} x {z} voxels of {} need {}, {} are allowed",
                    voxel_type.name(),
                    human_bytes(bytes),
                    human_bytes(u128::from(room.budget_bytes))
                ),
                "check the dimensions",
            ));
        };
        let dims = [x, y, z];
        let portion = room.choice.portion.unwrap_or_default();
        let Some(wanted) = ResolvedPortion::resolve(&portion, dims, room.choice.are_labels) else {
            return Err(context.region_error(dims));
        };
        if let Some(watch) = &room.choice.recorder {
            watch.record_grid(dims);
        }
        Ok(Self { dims, voxels, bytes, wanted, read: wanted })
    }

    /// Asks the load control whether to read a volume of this size, unless the user has chosen a portion.
    fn ask_acceptance(
        &self,
        voxel_type: VoxelType,
        room: ReadContext<'_>,
        is_read_whole: bool,
    ) -> Result<(), LoadError> {
        if room.choice.portion.is_some()
            || room.control.accepts_size(&VolumeSize { dims: self.dims, voxel_type, is_read_whole })
        {
            Ok(())
        } else {
            Err(LoadError::Cancelled)
        }
    }

    /// Checks that the voxels that are read, and those derived from them, fit into the budget.
    fn check_budget(
        self,
        context: LoadContext<'_>,
        field: &str,
        voxel_type: VoxelType,
        room: ReadContext<'_>,
        is_read_whole: bool,
    ) -> Result<Self, LoadError> {
        let needed = self.needed_bytes(voxel_type);
        if needed <= u128::from(room.budget_bytes) {
            return Ok(self);
        }
        let [x, y, z] = self.dims;
        let portion = room.choice.portion.unwrap_or_default();
        let grid = format!("{x} x {y} x {z} voxels of {}", voxel_type.name());
        let what = if portion.is_whole() { grid } else { format!("{} {grid}", portion.in_words()) };
        Err(context.limit_error(
            field,
            format!(
                "{what} need {}, {} are allowed",
                human_bytes(needed),
                human_bytes(u128::from(room.budget_bytes))
            ),
            self.budget_advice(voxel_type, room, is_read_whole),
        ))
    }

    /// Help text for a volume that exceeds the budget: the finest subsampling and block size that fit.
    fn budget_advice(&self, voxel_type: VoxelType, room: ReadContext<'_>, is_read_whole: bool) -> String {
        const OTHERWISE: &str =
            "check the dimensions, close other programs, or load a smaller or cropped volume";
        if is_read_whole {
            return OTHERWISE.to_owned();
        }
        let fits = |thinning: fn(usize) -> Downsampling| {
            let region = room.choice.portion.and_then(|portion| portion.region);
            let portions = (2..=MAX_STRIDE).map(|n| Portion { region, thinning: thinning(n) });
            let mut kept =
                portions.filter_map(|portion| ResolvedPortion::resolve(&portion, self.dims, false));
            kept.find(|&kept| {
                let extent = Self { wanted: kept, read: kept, ..*self };
                extent.needed_bytes(voxel_type) <= u128::from(room.budget_bytes)
            })
        };
        let step = |kept: ResolvedPortion| kept.stride.into_iter().max().unwrap_or(1);
        let said = |kept: ResolvedPortion| {
            let [x, y, z] = kept.dims();
            let bytes = kept.count() as u128 * voxel_type.bytes() as u128;
            format!("{x} x {y} x {z} voxels in {}", human_bytes(bytes))
        };
        let Some(every) = fits(Downsampling::Every) else { return OTHERWISE.to_owned() };
        let means = fits(Downsampling::Average).map_or_else(String::new, |average| {
            format!("--reduce {} averages blocks into {}, ", step(average), said(average))
        });
        let every = format!("--every {} reads {}, ", step(every), said(every));
        every
            + &means
            + "--region X0:X1,Y0:Y1,Z0:Z1 reads a part; `chiaroscuro convert` writes an .ome.zarr, whose full detail is \
               shown part by part; or check the dimensions, or close other programs"
    }

    /// Returns the bytes for voxels kept while reading, for voxels derived from them, and for buffers in use at a
    /// time.
    fn needed_bytes(&self, voxel_type: VoxelType) -> u128 {
        needed_bytes(&self.read, &self.wanted, voxel_type)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::error::LoadErrorKind;
    use super::*;

    fn extent(dims: [u64; 3], budget_bytes: u64, portion: Portion) -> Result<GridExtent, LoadError> {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default() };
        let room = ReadContext {
            budget_bytes,
            choice: &choice,
            control: &LoadControl::new(),
            level: LevelRule::default(),
        };
        GridExtent::checked(context, "sizes", dims, VoxelType::U16, room)
    }

    fn kind_of(dims: [u64; 3], budget: u64) -> Result<GridExtent, LoadErrorKind> {
        extent(dims, budget, Portion::default()).map_err(|error| error.kind())
    }

    #[test]
    fn sizes_are_checked_without_overflow() {
        let ok = GridExtent::unchecked([2, 3, 4], VoxelType::U16);
        assert_eq!((ok.voxels, ok.bytes), (24, 48));
        assert_eq!(kind_of([2, 3, 4], 48), Ok(ok));
        assert_eq!(kind_of([2, 3, 4], 47), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([2, 0, 4], 48), Err(LoadErrorKind::BadInput));
        assert_eq!(kind_of([u64::MAX; 3], u64::MAX), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([1 << 32, 1 << 32, 1], u64::MAX), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([1_000_000; 3], u64::MAX / 16), Err(LoadErrorKind::Limit));
    }

    #[test]
    fn portions_need_less_memory() {
        // 8000 voxels of 2 bytes; a stride of 2 keeps 1000.
        let dims = [20, 20, 20];
        assert!(extent(dims, 2000, Portion::with_stride(2)).is_ok_and(|extent| extent.wanted == extent.read));
        assert!(extent(dims, 1999, Portion::with_stride(2)).is_err());
        let region = |text: &str| Portion { region: text.parse().ok(), ..Portion::default() };
        assert!(extent(dims, 400, region("0:10,0:10,0:2")).is_ok());
        let outside = extent(dims, 400, region("0:21,:,:")).unwrap_err();
        assert_eq!(outside.kind(), LoadErrorKind::BadInput);
        // Averaged after reading if all voxels fit beside the means, otherwise two slices at a time, of 10 bytes per
        // voxel, beside the means and one voxel of each block.
        assert!(
            extent(dims, 18_000, Portion::with_block_average(2))
                .is_ok_and(|extent| extent.read.is_whole_grid())
        );
        assert!(
            extent(dims, 17_999, Portion::with_block_average(2))
                .is_ok_and(|extent| extent.wanted == extent.read)
        );
        assert!(extent(dims, 2 * 2000 + 800 * 10, Portion::with_block_average(2)).is_ok());
        assert!(extent(dims, 2 * 2000 + 800 * 10 - 1, Portion::with_block_average(2)).is_err());
    }

    #[test]
    fn limit_errors_suggest_portions_that_fit() {
        let said = extent([2000, 2000, 1000], 1 << 30, Portion::default()).unwrap_err().to_string();
        for words in [
            "need 7.5 GiB, 1.0 GiB are allowed",
            "--every 2 reads 1000 x 1000 x 500 voxels in 953.7 MiB",
            "--reduce 3 ",
            "`chiaroscuro convert` writes an .ome.zarr",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        let endless = extent([1 << 40, 1 << 20, 1], 1 << 20, Portion::default()).unwrap_err().to_string();
        assert!(endless.contains("check the dimensions"), "{endless}");
    }
}
