//! Pages of the finer levels of a file, for a volume in memory that is a coarser one.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use rayon::prelude::*;

use crate::{LoadOptions, load, open};
use chiaroscuro_volume::{
    CancelToken, Corrections, Dataset, DensityMapping, FileDimension, FinerLevels, LevelRule, LoadControl,
    LoadError, PageSource, Portion, Samples, Volume, VolumeChoice, VoxelRegion, VoxelSpan,
};

/// Edge of the blocks that are read together, in voxels: two chunks of the usual 64³, so that pages, which are read with a
/// border, do not have every chunk decoded again.
const BLOCK_EDGE: usize = 128;

/// Reader of the finer levels of a file.
#[derive(Debug)]
pub struct FilePages {
    path: PathBuf,
    options: LoadOptions,
    levels: FinerLevels,
    mapping: DensityMapping,
    blocks: Mutex<BlockCache>,
    token: CancelToken,
}

/// Level and position of a block.
type BlockKey = (usize, [usize; 3]);

/// Densities of a block, as normalised integers; empty until it is read.
type Block = Arc<Mutex<Option<Arc<[u16]>>>>;

/// Blocks that were read last.
#[derive(Debug)]
struct BlockCache {
    blocks: HashMap<BlockKey, (Block, u64)>,
    /// Number of look-ups, by which blocks were used last.
    clock: u64,
    most: usize,
}

impl BlockCache {
    /// Returns a block, and drops the ones that were not used for longest.
    fn get(&mut self, key: BlockKey) -> Block {
        self.clock += 1;
        let clock = self.clock;
        let (block, used) = self.blocks.entry(key).or_default();
        *used = clock;
        let found = Arc::clone(block);
        if self.blocks.len() > self.most {
            let oldest = self.blocks.iter().min_by_key(|(_, (_, used))| *used).map(|(key, _)| *key);
            oldest.and_then(|oldest| self.blocks.remove(&oldest));
        }
        found
    }
}

/// Number of blocks along each axis whose values stand for those of a level, and their edge in voxels: with chunks of 64³,
/// some seven million voxels.
const SAMPLED_BLOCKS: usize = 3;
const SAMPLED_EDGE: usize = 64;

/// Returns the levels of its file that are finer than a volume.
fn finer_levels(volume: &Volume) -> Result<FinerLevels, NoPages> {
    let contents = volume.contents();
    let Some(offers) = contents.alternatives_in(FileDimension::Level) else {
        return Err(NoPages::NoFinerLevel);
    };
    let finer = offers.offers.iter().filter_map(|offer| {
        let dims = offer.dims?.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        Some((dims, offer.key.clone()))
    });
    let levels = FinerLevels::of_volume(volume.dims(), finer);
    // Spacings move no voxel.
    let moved = Corrections { spacing: None, unit: None, ..*volume.corrections() };
    if levels.is_empty() {
        Err(NoPages::NoFinerLevel)
    } else if !contents.portion.is_whole() {
        Err(NoPages::Portion)
    } else if volume.has_absent_voxels() {
        Err(NoPages::MissingVoxels)
    } else if moved != Corrections::default() {
        Err(NoPages::Corrected)
    } else {
        Ok(levels)
    }
}

/// Prepares a volume beside which pages of finer levels are read. Where they cannot be shown, and the user has chosen no
/// level, the finest one that fits is read in its place.
pub(crate) fn beside_pages(
    path: &Path,
    options: &LoadOptions,
    control: &LoadControl,
    volume: Volume,
) -> Result<Volume, LoadError> {
    let Some(levels) = volume.contents().alternatives_in(FileDimension::Level) else { return Ok(volume) };
    let (number, count) = (levels.selected + 1, levels.offers.len());
    if number == 1 {
        return Ok(volume);
    }
    if finer_levels(&volume).is_err() || volume.is_label_map() {
        let is_chosen = options.choice.level.is_some();
        return if is_chosen {
            Ok(volume)
        } else {
            load(path, &LoadOptions { level: LevelRule::Finest, ..options.clone() }, control)
        };
    }
    let remark = format!(
        "level {number} of {count} is in memory; of the finer ones the parts that a picture shows are read, except for \
         projections, layers, cuts by shapes and the quality Exact: choose a finer level for these"
    );
    let volume = with_ranges_of_finest_level(path, options, control, volume);
    let remarks = [volume.remarks(), &[remark]].concat();
    Ok(volume.with_remarks(remarks))
}

/// Returns a coarse level with ranges of values that cover a sample of the finest one: means of voxels have a narrower range,
/// and what lies beyond it could not be told apart where pages of finer levels are shown. A sample that cannot be read
/// changes nothing; reading its pages will say why.
fn with_ranges_of_finest_level(
    path: &Path,
    options: &LoadOptions,
    control: &LoadControl,
    volume: Volume,
) -> Volume {
    let contents = volume.contents();
    let levels = contents.alternatives_in(FileDimension::Level).filter(|levels| levels.selected > 0);
    let Some((key, dims)) =
        levels.and_then(|levels| Some((levels.offers[0].key.clone(), levels.offers[0].dims?)))
    else {
        return volume;
    };
    let token = control.token().clone();
    let read = |at: usize| {
        let place = [at % SAMPLED_BLOCKS, at / SAMPLED_BLOCKS % SAMPLED_BLOCKS, at / SAMPLED_BLOCKS.pow(2)];
        let spans = std::array::from_fn(|axis| {
            let length = usize::try_from(dims[axis]).unwrap_or(usize::MAX);
            // Blocks in the middle of a third each, which begin with a chunk.
            let middle = length / (2 * SAMPLED_BLOCKS) * (2 * place[axis] + 1);
            let first = middle / SAMPLED_EDGE * SAMPLED_EDGE;
            VoxelSpan { first, end: Some(first.saturating_add(SAMPLED_EDGE).min(length)) }
        });
        let choice = VolumeChoice {
            level: Some(key.clone()),
            portion: Some(Portion { region: Some(VoxelRegion(spans)), ..Portion::default() }),
            ..contents.choice()
        };
        let options = LoadOptions { choice, level: LevelRule::Finest, ..options.clone() };
        let block = open(path, &options, &LoadControl::with_token(token.clone())).ok()?;
        Some((0..block.voxel_count()).map(|at| block.samples().value(at) as f32).collect::<Vec<_>>())
    };
    let values: Vec<f32> = (0..SAMPLED_BLOCKS.pow(3)).into_par_iter().filter_map(read).flatten().collect();
    // All blocks together: what is rare in the whole may be frequent in one of them.
    let sample = Volume::with_spacing("", [values.len(), 1, 1], DVec3::ONE, Samples::F32(values));
    let ranges = sample.map_or(volume.ranges(), |sample| volume.ranges().union(sample.ranges()));
    volume.with_ranges(ranges)
}

/// Reason why the finer levels of a file are not shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoPages {
    /// Finest level is in memory, or there are no others on its grid.
    #[error("no finer level lies on the grid of the volume")]
    NoFinerLevel,
    /// Volume is a part of the file, or a subsample.
    #[error("only a part of the file was read")]
    Portion,
    /// Voxels are missing or hidden.
    #[error("voxels are missing")]
    MissingVoxels,
    /// Values or axes were corrected.
    #[error("its values or axes were corrected")]
    Corrected,
    /// Densities stand for labels.
    #[error("it shows labels")]
    Labels,
}

impl FilePages {
    /// Creates a reader of the levels that are finer than a dataset which was opened from a path with these options; blocks
    /// that were read take at most `cache_bytes`.
    ///
    /// # Errors
    /// Says why finer levels are not shown.
    pub fn new(
        path: &Path,
        options: &LoadOptions,
        dataset: &Dataset,
        cache_bytes: u64,
    ) -> Result<Self, NoPages> {
        let volume = dataset.volume();
        let levels = finer_levels(volume)?;
        if volume.density_mapping() == DensityMapping::Labels {
            return Err(NoPages::Labels);
        }
        let block_bytes = 2 * (BLOCK_EDGE as u64).pow(3);
        let most = (cache_bytes / block_bytes).max(8) as usize;
        Ok(Self {
            path: path.to_owned(),
            options: LoadOptions { choice: volume.contents().choice(), ..options.clone() },
            levels,
            mapping: volume.density_mapping(),
            blocks: Mutex::new(BlockCache { blocks: HashMap::new(), clock: 0, most }),
            token: CancelToken::new(),
        })
    }

    /// Returns the token by which reads are cancelled.
    pub fn token(&self) -> &CancelToken {
        &self.token
    }

    /// Reads a block, or finds it among those that were read.
    fn block(&self, level: usize, at: [usize; 3]) -> Result<Arc<[u16]>, LoadError> {
        let block = self.blocks.lock().unwrap_or_else(PoisonError::into_inner).get((level, at));
        // Other readers of the same block wait, those of others do not.
        let mut block = block.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = &*block {
            return Ok(Arc::clone(known));
        }
        let read = self.read_block(level, at)?;
        *block = Some(Arc::clone(&read));
        Ok(read)
    }

    fn read_block(&self, level: usize, at: [usize; 3]) -> Result<Arc<[u16]>, LoadError> {
        let FinerLevels(levels) = &self.levels;
        let spans = std::array::from_fn(|axis| {
            let first = at[axis] * BLOCK_EDGE;
            VoxelSpan { first, end: Some((first + BLOCK_EDGE).min(levels[level].dims[axis])) }
        });
        let choice = VolumeChoice {
            level: Some(levels[level].key.clone()),
            portion: Some(Portion { region: Some(VoxelRegion(spans)), ..Portion::default() }),
            ..self.options.choice.clone()
        };
        let options = LoadOptions { choice, ..self.options.clone() };
        let volume = open(&self.path, &options, &LoadControl::with_token(self.token.clone()))?;
        let volume = volume.with_density_mapping(self.mapping);
        let stored = |density: f32| (density.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
        let mut block = Vec::with_capacity(volume.voxel_count());
        for z in 0..volume.dims()[2] {
            block.extend(volume.slice_densities(z).into_iter().map(stored));
        }
        Ok(block.into())
    }
}

impl PageSource for FilePages {
    fn levels(&self) -> &FinerLevels {
        &self.levels
    }

    fn read(&self, level: usize, region: &[Range<usize>; 3]) -> Result<Vec<f32>, LoadError> {
        let dims = self.levels.0[level].dims;
        let size = region.each_ref().map(ExactSizeIterator::len);
        let mut densities = vec![0.0; size.iter().product()];
        let blocks = region.each_ref().map(|span| span.start / BLOCK_EDGE..span.end.div_ceil(BLOCK_EDGE));
        for z in blocks[2].clone() {
            for y in blocks[1].clone() {
                for x in blocks[0].clone() {
                    let at = [x, y, z];
                    let block = self.block(level, at)?;
                    let first = at.map(|c| c * BLOCK_EDGE);
                    let edges: [usize; 3] =
                        std::array::from_fn(|axis| BLOCK_EDGE.min(dims[axis] - first[axis]));
                    let overlap: [Range<usize>; 3] = std::array::from_fn(|axis| {
                        let end = (first[axis] + edges[axis]).min(region[axis].end);
                        first[axis].max(region[axis].start)..end
                    });
                    for z in overlap[2].clone() {
                        for y in overlap[1].clone() {
                            let row = edges[0] * (y - first[1] + edges[1] * (z - first[2]));
                            let from = &block[row + overlap[0].start - first[0]..][..overlap[0].len()];
                            let to = size[0] * (y - region[1].start + size[1] * (z - region[2].start));
                            let target = &mut densities[to + overlap[0].start - region[0].start..];
                            for (target, stored) in target.iter_mut().zip(from) {
                                *target = f32::from(*stored) / 65535.0;
                            }
                        }
                    }
                }
            }
        }
        Ok(densities)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::{ExportVolume, VolumeFormat, write_volume};
    use chiaroscuro_volume::synthetic;

    /// Writes a volume of 160³ voxels with a level of 80³.
    fn two_levels(folder: &Path, volume: &Volume) -> PathBuf {
        let path = folder.join("v.ome.zarr");
        write_volume(&path, VolumeFormat::OmeZarr, &ExportVolume::new(volume), true).unwrap();
        path
    }

    fn beside_pages(path: &Path) -> Volume {
        let options = LoadOptions { level: LevelRule::AlwaysBesidePages(1 << 24), ..LoadOptions::default() };
        load(path, &options, &LoadControl::new()).unwrap()
    }

    #[test]
    fn finer_levels_are_read_in_blocks_with_the_densities_of_the_one_in_memory() {
        let folder = tempfile::tempdir().unwrap();
        let chair = synthetic::builtin("chair", Some(160)).unwrap();
        let path = two_levels(folder.path(), &chair);
        let coarse = beside_pages(&path);
        assert_eq!(coarse.dims(), [80; 3]);
        assert!(
            coarse.remarks().iter().any(|remark| remark.contains("level 2 of 2")),
            "{:?}",
            coarse.remarks()
        );
        let dataset = Dataset::new(coarse);
        let pages = FilePages::new(&path, &LoadOptions::default(), &dataset, 0).unwrap();
        assert_eq!(pages.levels().0.iter().map(|level| level.dims).collect::<Vec<_>>(), [[160; 3]]);
        // Over the border of blocks along x and y.
        let region = [100..140, 120..131, 40..44];
        let read = pages.read(0, &region).unwrap();
        let fine = chair.with_density_mapping(dataset.volume().density_mapping());
        let mut found = read.into_iter();
        for z in region[2].clone() {
            let slice = fine.slice_densities(z);
            for y in region[1].clone() {
                for x in region[0].clone() {
                    let (read, wanted) = (found.next().unwrap(), slice[x + 160 * y]);
                    assert!((read - wanted).abs() < 1e-5, "{x} {y} {z}: {read} instead of {wanted}");
                }
            }
        }
    }

    #[test]
    fn ranges_cover_what_means_have_lost() {
        let folder = tempfile::tempdir().unwrap();
        // Every eighth voxel is bright, which means of 2³ voxels know only as an eighth of that.
        let value = |at: usize| {
            let place = [at % 160, at / 160 % 160, at / (160 * 160)];
            if place.iter().all(|c| c % 2 == 0) { 800 } else { 0 }
        };
        let samples = Samples::U16((0..160 * 160 * 160).map(value).collect());
        let volume = Volume::with_spacing("dots", [160; 3], DVec3::ONE, samples).unwrap();
        let coarse = beside_pages(&two_levels(folder.path(), &volume));
        assert_eq!((coarse.dims(), coarse.value(3, 4, 5)), ([80; 3], 100.0));
        assert_eq!(coarse.ranges().robust.high, 800.0);
    }

    #[test]
    fn what_has_no_pages_is_read_as_finely_as_it_fits() {
        let folder = tempfile::tempdir().unwrap();
        let value = |at: usize| if at % 160 < 30 { f32::NAN } else { (at % 97) as f32 };
        let samples = Samples::F32((0..160 * 160 * 160).map(value).collect());
        let volume = Volume::with_spacing("missing", [160; 3], DVec3::ONE, samples).unwrap();
        let path = two_levels(folder.path(), &volume);
        let loaded = beside_pages(&path);
        assert_eq!(loaded.dims(), [160; 3], "the finest level fits");
        let unshown = FilePages::new(&path, &LoadOptions::default(), &Dataset::new(loaded), 0).unwrap_err();
        assert_eq!(unshown, NoPages::NoFinerLevel);
    }
}
