//! Choice of the resolution level that is read, among copies of one image in several sizes.

use super::error::{LoadContext, LoadError};
use super::extent::ReadContext;
use super::level_rule::LevelRule;
use super::memory_estimate::VolumeSize;
use super::offer::{FileDimension, VolumeOffer};
use super::portion::Portion;
use crate::VoxelType;

/// Voxels along an edge that a 3-D texture of nearly every graphics adapter can hold; of a finer level only averages
/// would be shown.
const MAX_TEXTURE_EDGE: usize = 2048;

/// Resolution level of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResolutionLevel {
    /// Name in the file, possibly empty.
    pub name: String,
    /// Voxels along x, y, z.
    pub dims: [u64; 3],
    /// Type of the voxels.
    pub voxel_type: VoxelType,
}

impl ReadContext<'_> {
    /// Returns the index of the level to read: the one that the user has selected, by number or by name; or else the
    /// finest that fits into memory and on the graphics adapter, or the coarsest where none does. A portion without a
    /// level is one of the finest. `levels` are ordered, finest first.
    ///
    /// # Errors
    /// [`LoadError::Several`] if the selected level does not exist; its message lists the levels.
    pub fn choose_level(
        &self,
        context: LoadContext<'_>,
        levels: &[ResolutionLevel],
    ) -> Result<usize, LoadError> {
        let offers: Vec<VolumeOffer> = levels
            .iter()
            .enumerate()
            .map(|(index, level)| VolumeOffer::with_number(index, &level.name, level.dims))
            .collect();
        let automatic = || match self.choice.portion {
            Some(_) => 0,
            None => self.automatic_level(levels),
        };
        let choice = match self.choice.selected_key(FileDimension::Level) {
            Some(_) => self.choice.clone(),
            None => self.choice.clone().with_selected(FileDimension::Level, &automatic().to_string()),
        };
        context.resolve_choice(&choice, FileDimension::Level, offers)
    }

    /// Returns the index of the level that is read without a choice.
    fn automatic_level(&self, levels: &[ResolutionLevel]) -> usize {
        let last = levels.len().saturating_sub(1);
        let finest = levels.iter().position(|level| self.fits(level)).unwrap_or(last);
        let voxels = |level: &ResolutionLevel| level.dims.iter().fold(1u64, |all, &n| all.saturating_mul(n));
        match self.level {
            LevelRule::Finest => finest,
            LevelRule::BesidePages(_) if finest == 0 => 0,
            LevelRule::BesidePages(most) | LevelRule::AlwaysBesidePages(most) => {
                let is_small = |level: &ResolutionLevel| self.fits(level) && voxels(level) <= most;
                levels.iter().skip(1).position(is_small).map_or(last, |index| index + 1)
            }
        }
    }

    /// Returns true if a level can be read and shown as it is, without a question to the user.
    fn fits(&self, level: &ResolutionLevel) -> bool {
        let dims = level.dims.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        let size = VolumeSize { dims, voxel_type: level.voxel_type, is_read_whole: false };
        dims.iter().all(|&n| n <= MAX_TEXTURE_EDGE)
            && size.peak_bytes(&Portion::default()).is_some_and(|bytes| bytes <= self.budget_bytes)
            && self.control.is_size_comfortable(&size)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::choice::VolumeChoice;
    use super::super::control::LoadControl;
    use super::*;

    fn chosen(choice: &VolumeChoice, budget_bytes: u64, control: &LoadControl) -> Result<usize, LoadError> {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        let level = |name: &str, edge: u64| ResolutionLevel {
            name: name.to_owned(),
            dims: [edge; 3],
            voxel_type: VoxelType::U16,
        };
        let levels = [level("s0", 4096), level("s1", 256), level("s2", 128), level("s3", 64)];
        ReadContext { budget_bytes, choice, control, level: LevelRule::Finest }.choose_level(context, &levels)
    }

    #[test]
    fn beside_pages_a_small_level_is_in_memory() {
        let (choice, control) = (VolumeChoice::default(), LoadControl::new());
        let context = LoadContext { operation: "test", path: Path::new("t") };
        let chosen = |edges: &[u64], level: LevelRule| {
            let of_edge = |edge: &u64| ResolutionLevel {
                name: String::new(),
                dims: [*edge; 3],
                voxel_type: VoxelType::U8,
            };
            let levels: Vec<_> = edges.iter().map(of_edge).collect();
            let room = ReadContext { budget_bytes: u64::MAX, choice: &choice, control: &control, level };
            room.choose_level(context, &levels).unwrap()
        };
        let large = [4096, 2048, 1024, 512, 256];
        assert_eq!(chosen(&large, LevelRule::Finest), 1);
        assert_eq!(chosen(&large, LevelRule::BesidePages(LevelRule::CARD_VOXELS)), 3);
        assert_eq!(chosen(&[800, 400, 200], LevelRule::BesidePages(1)), 0, "the finest fits");
        assert_eq!(chosen(&[800, 400, 200], LevelRule::AlwaysBesidePages(1 << 27)), 1);
        assert_eq!(chosen(&[64], LevelRule::AlwaysBesidePages(1)), 0);
    }

    #[test]
    fn the_finest_level_that_fits_is_read() {
        let (nothing, control) = (VolumeChoice::default(), LoadControl::new());
        let mib = 1 << 20;
        // 256³ voxels of two bytes take 32 MiB, and their bricks' data 5.
        for (budget, level) in [(u64::MAX, 1), (40 * mib, 1), (36 * mib, 2), (mib, 3), (1, 3)] {
            assert_eq!(chosen(&nothing, budget, &control).unwrap(), level, "{budget}");
        }
        let small = LoadControl::new().with_comfortable_size(|size| size.dims[0] <= 64);
        assert_eq!(chosen(&nothing, u64::MAX, &small).unwrap(), 3, "the adapter is small");
        let region = VolumeChoice { portion: Some(Portion::default()), ..VolumeChoice::default() };
        assert_eq!(chosen(&region, 1, &control).unwrap(), 0, "a region counts in voxels of the finest level");
    }

    #[test]
    fn levels_are_selected_by_number_or_name() {
        let control = LoadControl::new();
        let select = |key: &str| VolumeChoice::default().with_selected(FileDimension::Level, key);
        assert_eq!(chosen(&select("0"), 1, &control).unwrap(), 0);
        assert_eq!(chosen(&select("s2"), u64::MAX, &control).unwrap(), 2);
        let error = chosen(&select("7"), u64::MAX, &control).unwrap_err().to_string();
        assert!(error.contains("--level") && error.contains("1 \"s1\" (256 x 256 x 256)"), "{error}");
    }
}
