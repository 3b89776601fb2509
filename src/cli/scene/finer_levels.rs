//! Command-line arguments for resolution levels that are finer than the one in memory, and reading of their pages.

use std::path::Path;
use std::sync::Arc;

use clap::Args;

use super::SceneArgs;
use crate::cli::CliError;
use crate::cli::output::warn_line;
use chiaroscuro_render::plan::{PagedView, fill_pages, shows_pages};
use chiaroscuro_scene::{FinerLevelRecord, ImageSpec, Settings};
use chiaroscuro_volume::{Dataset, LevelRule, PageCache};
use chiaroscuro_volume_io::{FilePages, LoadOptions, NoPages};

/// Arguments for the levels of an image that do not fit into memory.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct FinerLevelArgs {
    /// Memory for parts of finer resolution levels than the one in memory, such as 512MiB; also keeps a coarse level in
    /// memory where the finest would fit
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes)]
    pool: Option<u64>,
    /// Fail (exit code 1) if a coarser level is shown than the picture calls for
    #[arg(long)]
    require_full: bool,
    /// Draw the picture in parts whose finer levels fit into memory one after another, so that none is left out
    #[arg(long)]
    out_of_core: bool,
}

/// Volume with the pages of finer levels that a picture shows.
#[derive(Debug)]
pub(crate) struct PagedDataset {
    /// Volume in memory, with its pages unless each part of the picture reads its own.
    pub dataset: Dataset,
    /// Record of the levels; `None` if the level in memory is shown.
    pub record: Option<FinerLevelRecord>,
    /// Pages that are read for each part of the picture.
    pub of_parts: Option<PageCache>,
}

impl PagedDataset {
    /// Returns the level in memory alone.
    fn in_memory(dataset: Dataset) -> Self {
        Self { dataset, record: None, of_parts: None }
    }
}

impl FinerLevelArgs {
    /// Returns the rule for the level that is read.
    pub(crate) fn level_rule(&self) -> LevelRule {
        let most = LevelRule::CARD_VOXELS;
        if self.pool.is_some() { LevelRule::AlwaysBesidePages(most) } else { LevelRule::BesidePages(most) }
    }

    /// Returns the arguments by which a picture with a record is drawn again.
    #[must_use]
    pub(crate) fn for_record(self, record: &FinerLevelRecord) -> Self {
        // One that was drawn whole may have needed parts.
        Self { out_of_core: self.out_of_core || !record.is_substituted, ..self }
    }

    /// Reads the pages of finer levels that a picture shows, unless its parts read their own. Returns the dataset with them,
    /// and their record; nothing changes where the level in memory is fine enough.
    ///
    /// # Arguments
    /// * `options`: options with which the dataset was read from `source`.
    /// * `say`: function that prints progress.
    ///
    /// # Errors
    /// When the file cannot be read, or a level is called for that does not fit and `--require-full` is given.
    pub(crate) fn with_pages(
        &self,
        source: &Path,
        options: &LoadOptions,
        dataset: &Dataset,
        settings: &Settings,
        image: &ImageSpec,
        say: &dyn Fn(&str),
    ) -> Result<PagedDataset, CliError> {
        let budget = self.pool.unwrap_or_else(PageCache::default_bytes);
        // Densities of pages are those of the picture.
        let mapping = settings.shown_content(&dataset.volume().ranges());
        let dataset = dataset.with_density_mapping(mapping);
        let unshown = |why: &str| {
            self.warn_or_fail(
                source,
                format!("finer levels are not shown: {why}; --level puts one into memory"),
            )
        };
        let pages = match FilePages::new(source, options, &dataset, budget) {
            // The finest level is in memory, or the user has asked for a part.
            Err(NoPages::NoFinerLevel | NoPages::Portion) => return Ok(PagedDataset::in_memory(dataset)),
            Err(why) => {
                unshown(&why.to_string())?;
                return Ok(PagedDataset::in_memory(dataset));
            }
            Ok(_) if !settings.sampling.finer_levels => return Ok(PagedDataset::in_memory(dataset)),
            Ok(_) if !shows_pages(settings) => {
                unshown(
                    "the look has a projection, layers, a cut by a shape, the scattering engine, or the quality Exact",
                )?;
                return Ok(PagedDataset::in_memory(dataset));
            }
            Ok(pages) => pages,
        };
        let mut cache = dataset.page_cache(Arc::new(pages), budget);
        let size = image.size.map(|n| n * image.samples);
        if self.out_of_core {
            let levels = cache.resident().levels();
            let view = PagedView::new(levels, settings, &dataset.volume().scene(), size);
            let record = view.map(|view| view.record(levels));
            let of_parts = record.is_some().then_some(cache);
            return Ok(PagedDataset { dataset, record, of_parts });
        }
        let demand =
            fill_pages(&mut cache, &dataset, settings, size, |missing| say_missing_pages(say, missing))?;
        let Some(demand) = demand else { return Ok(PagedDataset::in_memory(dataset)) };
        let record = demand.record(cache.resident().levels());
        if demand.is_substituted {
            let text = format!(
                "level {} takes the place of a finer one, whose parts do not fit into {} MiB; --pool allows more, \
                 --out-of-core draws one part after another",
                record.finest,
                budget >> 20
            );
            self.warn_or_fail(source, text)?;
        }
        let dataset = dataset.with_pages(Some(Arc::new(cache.resident().clone())));
        Ok(PagedDataset { dataset, record: Some(record), of_parts: None })
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

impl SceneArgs {
    /// Returns the rule for the level that is read: a level that the arguments name is shown as it is.
    pub(crate) fn level_rule(&self, finer: &FinerLevelArgs) -> LevelRule {
        if self.look.load.names_level() && finer.pool.is_none() {
            LevelRule::Finest
        } else {
            finer.level_rule()
        }
    }

    /// Reads the pages of finer levels that a picture shows, unless a level was named.
    pub(crate) fn with_pages(
        &self,
        finer: &FinerLevelArgs,
        dataset: Dataset,
        settings: &Settings,
        image: &ImageSpec,
        say: &dyn Fn(&str),
    ) -> Result<PagedDataset, CliError> {
        if self.level_rule(finer) == LevelRule::Finest {
            return Ok(PagedDataset::in_memory(dataset));
        }
        finer.with_pages(&self.file, &self.load_options()?, &dataset, settings, image, say)
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
