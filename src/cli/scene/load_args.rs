//! Command-line arguments for reading a volume.

use std::path::Path;
use std::time::Instant;

use clap::{Args, ValueEnum};

use super::{downsampled_to_fit, open_with_size_warning};
use crate::cli::CliError;
use crate::cli::process::StageTimes;
use chiaroscuro_render::{GpuContext, OpeningTimes};
use chiaroscuro_volume::{
    Downsampling, FileDimension, LevelRule, LoadError, Portion, Volume, VolumeChoice, VoxelRegion, VoxelType,
};
use chiaroscuro_volume_io::{Endian, LoadOptions, RawFormat};

/// Arguments for reading a volume.
#[derive(Debug, Clone, Args)]
pub(crate) struct LoadArgs {
    /// Average blocks of N × N × N voxels into one, for less memory and faster rendering; 1 keeps all voxels
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    reduce: Option<u16>,
    /// Read only every Nth voxel along each axis, for less memory
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64), conflicts_with = "reduce")]
    every: Option<u16>,
    /// Region of interest in voxels, counted from 0: first voxel and end (exclusive) along each axis, both optional
    #[arg(long, value_name = "X0:X1,Y0:Y1,Z0:Z1")]
    region: Option<VoxelRegion>,
    /// RAW input: number of voxels along x, y and z
    #[arg(long, value_name = "WxHxD", global = false)]
    dims: Option<String>,
    /// RAW input: uint8, int8, uint16, int16, uint32, int32, float32 or float64
    #[arg(long = "type", value_name = "T", value_parser = parse_voxel_type)]
    voxel_type: Option<VoxelType>,
    /// RAW input: distance between voxels in millimetres
    #[arg(long, value_name = "SXxSYxSZ")]
    spacing: Option<String>,
    /// RAW input: byte order
    #[arg(long, value_enum)]
    endian: Option<EndianArg>,
    /// RAW input: bytes before the voxels
    #[arg(long, value_name = "BYTES")]
    offset: Option<u64>,
    /// Component of vectors or colours to show, counted from 0, instead of their length or luminance
    #[arg(long, value_name = "N")]
    component: Option<usize>,
    /// Time step to show, counted from 0, if there are several
    #[arg(long, value_name = "N")]
    frame: Option<usize>,
    /// Channel to show, counted from 0, if there are several
    #[arg(long, value_name = "N")]
    channel: Option<usize>,
    /// Series to show, by number or name, if a folder holds several
    #[arg(long, value_name = "NAME")]
    series: Option<String>,
    /// Array to show, if a file holds several
    #[arg(long, value_name = "NAME")]
    array: Option<String>,
    /// Resolution level to open, by number from 0, the finest, or by name, instead of the finest that fits into memory
    #[arg(long, value_name = "NAME")]
    level: Option<String>,
    /// Graphics adapter to draw with, counted from the fastest, which is 0
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    adapter: usize,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EndianArg {
    Little,
    Big,
}

impl LoadArgs {
    /// Converts the arguments to the reader's options.
    pub(crate) fn load_options(&self) -> Result<LoadOptions, CliError> {
        let usage = |field: &str, text: &str, expected: &str| {
            CliError::Usage(format!(
                "--{field}: expected {expected}, found {text:?} (command line, --{field})"
            ))
        };
        let dims = match &self.dims {
            None => None,
            Some(text) => Some(
                parse_triple::<usize>(text)
                    .ok_or_else(|| usage("dims", text, "three whole numbers such as 64x64x32"))?,
            ),
        };
        let spacing_mm = match &self.spacing {
            None => None,
            Some(text) => Some(
                parse_triple::<f64>(text)
                    .ok_or_else(|| usage("spacing", text, "three numbers such as 1x1x1.5"))?,
            ),
        };
        let endian = self.endian.map(|endian| match endian {
            EndianArg::Little => Endian::Little,
            EndianArg::Big => Endian::Big,
        });
        let raw = RawFormat { dims, voxel_type: self.voxel_type, spacing_mm, endian, offset: self.offset };
        let choice = VolumeChoice {
            component: self.component,
            frame: self.frame,
            channel: self.channel,
            series: self.series.clone(),
            array: self.array.clone(),
            level: self.level.clone(),
            portion: self.portion(),
            ..VolumeChoice::default()
        };
        Ok(LoadOptions { raw, choice, ..LoadOptions::default() })
    }

    /// Returns the portion of the volume to be read, if one is given.
    fn portion(&self) -> Option<Portion> {
        let thinning = match (self.every, self.reduce) {
            (Some(step), _) => Downsampling::Every(step.into()),
            (None, Some(block)) => Downsampling::Average(block.into()),
            (None, None) => Downsampling::None,
        };
        let is_said = self.every.is_some() || self.reduce.is_some() || self.region.is_some();
        is_said.then_some(Portion { region: self.region, thinning })
    }

    /// Loads a volume, and opens the adapter; records in `times` what both of them took beside each other. `choice`
    /// selects one of several volumes and the portion that was read earlier, or lets the first one be read; arguments of
    /// the command line take precedence. `level` is the rule for a resolution level that neither names.
    pub(crate) fn open(
        &self,
        source: &Path,
        choice: Option<&VolumeChoice>,
        times: &mut StageTimes,
        level: LevelRule,
    ) -> Result<(Volume, GpuContext), CliError> {
        let read = |options: &LoadOptions| {
            Ok(open_with_size_warning(source, &LoadOptions { level, ..options.clone() })?)
        };
        self.open_by(source, choice, times, read)
    }

    /// Returns true if the arguments name a resolution level.
    pub(crate) fn names_level(&self) -> bool {
        self.level.is_some()
    }

    /// Loads like [`Self::open`], and of a file that holds several time steps the one with this number, unless the
    /// arguments name another.
    pub(crate) fn open_step(
        &self,
        source: &Path,
        choice: Option<&VolumeChoice>,
        step: usize,
    ) -> Result<(Volume, GpuContext), CliError> {
        let read = |options: &LoadOptions| read_step(source, options, step);
        self.open_by(source, choice, &mut StageTimes::from_now(), read)
    }

    /// Loads a volume by a function, and opens the adapter beside it.
    fn open_by(
        &self,
        source: &Path,
        choice: Option<&VolumeChoice>,
        times: &mut StageTimes,
        read: impl FnOnce(&LoadOptions) -> Result<Volume, CliError>,
    ) -> Result<(Volume, GpuContext), CliError> {
        let mut options = self.load_options()?;
        if let Some(choice) = choice {
            options.choice = options.choice.with_fallback(choice);
            options.choice.fall_back_to_first |= choice.fall_back_to_first;
        }
        // Drivers take up to half a second to open an adapter, meanwhile the file is read. Its errors are reported
        // before those of the adapter.
        let begin = Instant::now();
        let (whole, read_ms, context) = std::thread::scope(|scope| {
            let context = scope.spawn(|| GpuContext::headless_on(self.adapter));
            let whole = read(&options);
            let read_ms = begin.elapsed().as_secs_f64() * 1000.0;
            (whole, read_ms, context.join())
        });
        let whole = whole?;
        let context = context.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        let OpeningTimes { instance_ms, device_ms } = context.opening_times();
        times.add_parallel("volume", read_ms);
        times.add_parallel("instance", instance_ms);
        times.add_parallel("device", device_ms);
        Ok((downsampled_to_fit(source, whole, &context)?, context))
    }
}

/// Reads the time step with this number of a file that holds several, unless the options select one.
fn read_step(source: &Path, options: &LoadOptions, step: usize) -> Result<Volume, CliError> {
    if options.choice.frame.is_some() {
        return Ok(open_with_size_warning(source, options)?);
    }
    let mut options = options.clone();
    if options.choice.fall_back_to_first {
        // Readers do not ask then.
        options.choice.frame = Some(step);
    }
    let missing = |count: usize| {
        let (path, last) = (source.display(), count.saturating_sub(1));
        CliError::Usage(format!(
            "--steps: {path} holds the time steps 0 to {last}, and there is no step {step}; give steps among them"
        ))
    };
    let volume = match open_with_size_warning(source, &options) {
        Err(LoadError::Several { dimension: FileDimension::Frame, offers, .. }) => {
            let offer = offers.get(step).ok_or_else(|| missing(offers.len()))?;
            options.choice = options.choice.with_selected(FileDimension::Frame, &offer.key);
            open_with_size_warning(source, &options)?
        }
        read => read?,
    };
    match volume.contents().alternatives_in(FileDimension::Frame) {
        Some(steps) if steps.unmatched_selection.is_some() => Err(missing(steps.offers.len())),
        _ => Ok(volume),
    }
}

/// Parses a voxel type such as `uint8`.
pub(crate) fn parse_voxel_type(text: &str) -> Result<VoxelType, String> {
    let known = VoxelType::ALL.into_iter().find(|known| known.name() == text.to_lowercase());
    known.ok_or_else(|| format!("expected one of {}", VoxelType::ALL.map(VoxelType::name).join(", ")))
}

/// Parses three numbers such as `1x2x3`.
fn parse_triple<T: std::str::FromStr>(text: &str) -> Option<[T; 3]> {
    let parts: Vec<T> =
        text.split(['x', 'X', ',']).map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_numbers_are_read() {
        assert_eq!(parse_triple("1x2x3"), Some([1usize, 2, 3]));
        assert_eq!(parse_triple::<usize>("1x2"), None);
        assert_eq!(parse_triple("0.5x1x2"), Some([0.5, 1.0, 2.0]));
    }
}
