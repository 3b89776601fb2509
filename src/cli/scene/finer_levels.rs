//! Command-line arguments for resolution levels that are finer than the one in memory, and reading of their pages.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::SceneArgs;
use crate::cli::CliError;
use crate::cli::output::warn_line;
use chiaroscuro_render::plan::{PagedView, fill_pages, shows_pages};
use chiaroscuro_scene::{FinerLevelRecord, ImageSpec, Settings};
use chiaroscuro_volume::{Dataset, LevelRule, PageCache};
use chiaroscuro_volume_io::{FilePages, LoadOptions, NoPages};

/// Reason why a look shows the level in memory alone.
const UNSHOWN_LOOK: &str =
    "the look has a projection, layers, a cut by a shape, the scattering engine, or the quality Exact";

/// Argument for the memory of finer levels.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct PoolArgs {
    /// Memory for parts of finer resolution levels than the one in memory, such as 512MiB; also keeps a coarse level in
    /// memory where the finest would fit
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes)]
    pool: Option<u64>,
}

/// Arguments for the levels of an image that do not fit into memory.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct FinerLevelArgs {
    #[command(flatten)]
    pool: PoolArgs,
    /// Fail (exit code 1) if a coarser level is shown than the picture calls for
    #[arg(long)]
    require_full: bool,
    /// Draw the picture in parts whose finer levels fit into memory one after another, so that none is left out
    #[arg(long)]
    out_of_core: bool,
}

impl PoolArgs {
    /// Returns the rule for the level that is read.
    pub(crate) fn level_rule(&self) -> LevelRule {
        let most = LevelRule::CARD_VOXELS;
        if self.pool.is_some() { LevelRule::AlwaysBesidePages(most) } else { LevelRule::BesidePages(most) }
    }

    /// Returns the arguments by which pictures are drawn in parts, so that no level is left out.
    pub(crate) fn in_parts(&self) -> FinerLevelArgs {
        FinerLevelArgs { pool: self.clone(), require_full: false, out_of_core: true }
    }
}

impl FinerLevelArgs {
    /// Returns the rule for the level that is read.
    pub(crate) fn level_rule(&self) -> LevelRule {
        self.pool.level_rule()
    }

    /// Returns the argument for the memory.
    pub(crate) fn pool(&self) -> &PoolArgs {
        &self.pool
    }

    /// Returns the arguments by which a picture with a record is drawn again.
    #[must_use]
    pub(crate) fn for_record(self, record: &FinerLevelRecord) -> Self {
        // One that was drawn whole may have needed parts.
        Self { out_of_core: self.out_of_core || !record.is_substituted, ..self }
    }

    /// Warns that a coarser level is shown than a picture calls for; an error if that is not to be.
    fn warn_or_fail(&self, source: &Path, text: String) -> Result<(), CliError> {
        if self.require_full {
            return Err(CliError::LevelSubstituted(text));
        }
        warn_line(&format!("warning: {text} ({})", source.display()));
        Ok(())
    }
}

/// Volume with the pages of finer levels that a picture shows.
#[derive(Debug)]
pub(crate) struct PagedDataset<'a> {
    /// Volume in memory, with its pages unless each part of the picture reads its own.
    pub dataset: Dataset,
    /// Record of the levels; `None` if the level in memory is shown.
    pub record: Option<FinerLevelRecord>,
    /// Pages that are read for each part of the picture.
    pub of_parts: Option<&'a mut PageCache>,
}

impl PagedDataset<'_> {
    /// Returns a volume without finer levels.
    pub(crate) fn in_memory(dataset: Dataset) -> Self {
        Self { dataset, record: None, of_parts: None }
    }
}

/// Reader of the finer levels of a volume, for one picture after another.
#[derive(Debug)]
pub(crate) struct PageReader {
    args: FinerLevelArgs,
    source: PathBuf,
    dataset: Dataset,
    /// Memory for pages, in bytes.
    budget: u64,
    /// Pages that were read; `None` if the level in memory is shown alone.
    cache: Option<PageCache>,
}

impl PageReader {
    /// Creates a reader for pictures of a dataset that show the quantity of these settings.
    ///
    /// # Arguments
    /// * `options`: options with which the dataset was read from `source`.
    ///
    /// # Errors
    /// When finer levels cannot be shown, and `--require-full` is given.
    pub(crate) fn new(
        args: &FinerLevelArgs,
        source: &Path,
        options: &LoadOptions,
        dataset: &Dataset,
        settings: &Settings,
    ) -> Result<Self, CliError> {
        let budget = args.pool.pool.unwrap_or_else(PageCache::default_bytes);
        // Densities of pages are those of the picture.
        let mapping = settings.shown_content(&dataset.volume().ranges());
        let dataset = dataset.with_density_mapping(mapping);
        let pages = match FilePages::new(source, options, &dataset, budget) {
            // The finest level is in memory, or the user has asked for a part.
            Err(NoPages::NoFinerLevel | NoPages::Portion) => None,
            Ok(_) if !settings.sampling.finer_levels => None,
            Ok(pages) if shows_pages(settings) => Some(pages),
            unshown => {
                let why = unshown.map_or_else(|why| why.to_string(), |_| UNSHOWN_LOOK.to_owned());
                let text = format!("finer levels are not shown: {why}; --level puts one into memory");
                args.warn_or_fail(source, text)?;
                None
            }
        };
        let cache = pages.map(|pages| dataset.page_cache(Arc::new(pages), budget));
        Ok(Self { args: args.clone(), source: source.to_owned(), dataset, budget, cache })
    }

    /// Returns a reader that reads nothing: the dataset is shown as it is.
    fn in_memory(dataset: Dataset) -> Self {
        let (args, source) = (FinerLevelArgs::default(), PathBuf::new());
        Self { args, source, dataset, budget: 0, cache: None }
    }

    /// Reads the pages of finer levels that a picture shows, unless its parts read their own; `say` prints progress.
    ///
    /// # Errors
    /// When the file cannot be read, or a level is called for that does not fit and `--require-full` is given.
    pub(crate) fn read_for(
        &mut self,
        settings: &Settings,
        image: &ImageSpec,
        say: &dyn Fn(&str),
    ) -> Result<PagedDataset<'_>, CliError> {
        let Self { args, source, dataset, budget, cache } = self;
        let in_memory = || PagedDataset::in_memory(dataset.clone());
        let Some(cache) = cache else { return Ok(in_memory()) };
        let size = image.size.map(|n| n * image.samples);
        if args.out_of_core {
            let levels = cache.resident().levels();
            let view = PagedView::new(levels, settings, &dataset.volume().scene(), size);
            let Some(record) = view.map(|view| view.record(levels)) else { return Ok(in_memory()) };
            return Ok(PagedDataset { record: Some(record), of_parts: Some(cache), ..in_memory() });
        }
        let demand = fill_pages(cache, dataset, settings, size, |missing| say_missing_pages(say, missing))?;
        let Some(demand) = demand else { return Ok(in_memory()) };
        let record = demand.record(cache.resident().levels());
        if demand.is_substituted {
            let text = format!(
                "level {} takes the place of a finer one, whose parts do not fit into {} MiB; --pool allows more, \
                 --out-of-core draws one part after another",
                record.finest,
                *budget >> 20
            );
            args.warn_or_fail(source, text)?;
        }
        let dataset = dataset.clone().with_pages(Some(Arc::new(cache.resident().clone())));
        Ok(PagedDataset { dataset, record: Some(record), of_parts: None })
    }
}

impl SceneArgs {
    /// Returns the rule for the level that is read: a level that the arguments name is shown as it is.
    pub(crate) fn level_rule(&self, finer: &PoolArgs) -> LevelRule {
        if self.look.load.names_level() && finer.pool.is_none() {
            LevelRule::Finest
        } else {
            finer.level_rule()
        }
    }

    /// Creates a reader of finer levels for pictures of a dataset, which reads none if a level was named.
    pub(crate) fn page_reader(
        &self,
        finer: &FinerLevelArgs,
        dataset: Dataset,
        settings: &Settings,
    ) -> Result<PageReader, CliError> {
        if self.level_rule(&finer.pool) == LevelRule::Finest {
            return Ok(PageReader::in_memory(dataset));
        }
        PageReader::new(finer, &self.file, &self.load_options()?, &dataset, settings)
    }
}

/// Prints the number of pages that have yet to be read; returns true, because reading goes on.
pub(crate) fn say_missing_pages(say: &dyn Fn(&str), missing: usize) -> bool {
    say(&format!("reading {missing} parts of finer levels"));
    true
}

/// Parses a size such as `512MiB`, `2GiB`, or a number of bytes.
fn parse_bytes(text: &str) -> Result<u64, String> {
    let expected = || "expected a size such as 512MiB or 2GiB".to_owned();
    let text = text.trim();
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let number: u64 = number.parse().ok().ok_or_else(expected)?;
    let factor = match unit.trim().to_ascii_lowercase().as_str() {
        "" | "b" => 1,
        "k" | "kib" => 1 << 10,
        "m" | "mib" => 1 << 20,
        "g" | "gib" => 1 << 30,
        _ => return Err(expected()),
    };
    number.checked_mul(factor).ok_or_else(expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_binary_units() {
        assert_eq!(
            ["64MiB", "2 g", "1000", "3kib"].map(parse_bytes).map(Result::unwrap),
            [64 << 20, 2 << 30, 1000, 3 << 10]
        );
        for wrong in ["", "MiB", "1.5GiB", "2TB", "99999999999999999999", "99999999999999999g"] {
            assert!(parse_bytes(wrong).is_err(), "{wrong}");
        }
    }
}
