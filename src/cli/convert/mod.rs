//! Command `chiaroscuro convert`: writes a volume in another file format.

mod by_slabs;

use std::path::{Path, PathBuf};

use clap::Args;

use super::CliError;
use super::output::{check_overwrites, finish_output, open_destination, warn_line};
use super::scene::{LoadArgs, control_with_size_warning, parse_voxel_type};
use chiaroscuro_files::is_written_by_us;
use chiaroscuro_volume::{
    AnatomicalAxes, ErrorExplanation, LoadControl, LoadError, ValueRange, Volume, VoxelType,
};
use chiaroscuro_volume_io::{
    open,
    write::{
        ConvertError, ExportVolume, NumberRequest, OmeZarrWriter, PyramidSpec, VolumeFormat, write_volume,
    },
};

/// Name that stands for standard output.
const STANDARD_OUTPUT: &str = "-";

/// Arguments of `convert`.
#[derive(Debug, Args)]
// In this command, `--type` is the type that is written.
#[command(mut_arg("voxel_type", |arg| arg.long("input-type")))]
pub(super) struct ConvertArgs {
    #[arg(help = "Volume: a file, a folder of slices, or builtin:NAME[:N]")]
    input: PathBuf,
    #[arg(
        help = "File to write: .nrrd, .mha, .nii, .nii.gz, .tif, .npy, .vti, .ozx or .zarr.zip, or folder: .ome.zarr; \
                  - is standard output"
    )]
    output: PathBuf,
    /// Format of standard output, as a file extension such as nii.gz; NRRD if it is not given
    #[arg(long, value_name = "EXTENSION", value_parser = parse_format)]
    format: Option<VolumeFormat>,
    /// Number type to write: uint8, int8, uint16, int16, uint32, int32, float32 or float64
    #[arg(long = "type", value_name = "T", value_parser = parse_voxel_type, id = "written_type")]
    written_type: Option<VoxelType>,
    /// Range of values to map to the full range of an integer --type; values outside are clamped
    #[arg(long, value_name = "LOW:HIGH", value_parser = parse_value_range, allow_hyphen_values = true)]
    rescale: Option<ValueRange>,
    /// Number to write for missing voxels: those that are not finite or have the padding value of the file
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    padding: Option<f64>,
    /// Orientation to write: the sides of the body that the axes point to, fastest axis first, as RAS, LPS or another
    /// of the 48
    #[arg(long, value_name = "LETTERS")]
    orient: Option<AnatomicalAxes>,
    /// Compress the voxels in .nrrd (gzip) or .mha (zlib); .nii.gz and OME-Zarr are always compressed
    #[arg(long)]
    compress: bool,
    /// Replace files that were not written by this program, and folders of Zarr
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    load: LoadArgs,
}

/// Parses a range of values such as `-1000:3000`.
fn parse_value_range(text: &str) -> Result<ValueRange, String> {
    let parsed = text.split_once(':').and_then(|(low, high)| {
        let [low, high]: [f64; 2] = [low.trim().parse().ok()?, high.trim().parse().ok()?];
        ValueRange::non_degenerate(low, high).filter(|range| range.span().is_finite())
    });
    parsed.ok_or_else(|| format!("expected two values, the lower first, as in -1000:3000, found {text:?}"))
}

/// Parses a file name extension of a volume format, such as `nii.gz`.
fn parse_format(text: &str) -> Result<VolumeFormat, String> {
    let name = format!("volume.{}", text.trim_start_matches('.'));
    VolumeFormat::from_path(Path::new(&name)).ok_or_else(|| format!("expected {}", all_extensions()))
}

/// Lists the extensions of all volume formats, for messages.
fn all_extensions() -> String {
    let all: Vec<String> = VolumeFormat::ALL
        .iter()
        .flat_map(|format| format.extensions())
        .map(|ending| format!(".{ending}"))
        .collect();
    all.join(", ")
}

impl ConvertArgs {
    fn usage(&self, why: &dyn std::fmt::Display) -> CliError {
        CliError::Usage(format!("{}: {why}", self.input.display()))
    }

    /// Returns the format to be written.
    fn output_format(&self) -> Result<VolumeFormat, CliError> {
        let is_standard_output = self.output == Path::new(STANDARD_OUTPUT);
        let by_name = VolumeFormat::from_path(&self.output);
        let format = match (is_standard_output, by_name, self.format) {
            (true, _, format) => format.unwrap_or(VolumeFormat::Nrrd),
            (false, Some(by_name), None) => by_name,
            (false, Some(by_name), Some(format)) if by_name == format => by_name,
            (false, ..) if self.format.is_some() => {
                return Err(CliError::Usage(
                    "--format applies to standard output; files have the format of their extension (command line, \
                     --format)"
                        .to_owned(),
                ));
            }
            (false, ..) => {
                return Err(CliError::Usage(format!(
                    "{}: volumes are written as {}, depending on the file extension",
                    self.output.display(),
                    all_extensions()
                )));
            }
        };
        if is_standard_output && format.is_folder() {
            return Err(CliError::Usage(format!(
                "--format: .{} is a folder, which cannot be written to standard output; choose .{}, an archive of it \
                 (command line, --format)",
                format.extensions()[0],
                VolumeFormat::OmeZarrArchive.extensions()[0]
            )));
        }
        if self.compress && !format.may_be_compressed() && !format.is_always_compressed() {
            return Err(CliError::Usage(format!(
                "--compress: .{} files are not compressed; choose .nrrd, .mha or .nii.gz (command line, --compress)",
                format.extensions()[0]
            )));
        }
        Ok(format)
    }

    fn number_request(&self) -> NumberRequest {
        NumberRequest { voxel_type: self.written_type, rescaled: self.rescale, padding: self.padding }
    }

    /// Rejects an output folder that would take the place of another program's, which it may with `--force`.
    fn check_folder(&self, format: VolumeFormat) -> Result<(), CliError> {
        if self.force || !format.is_folder() || !self.output.is_dir() || is_written_by_us(&self.output) {
            return Ok(());
        }
        Err(CliError::Usage(format!(
            "{} exists already, and was not written by this program alone; choose another name, or use --force",
            self.output.display()
        )))
    }

    /// Rejects an output that would replace a file that was read: a header may refer to other files, a slice or folder
    /// belongs to a series, and an output folder may hold the input.
    fn check_inputs(&self, control: &LoadControl) -> Result<(), CliError> {
        let read = control.read_files();
        check_overwrites(
            &read.iter().map(PathBuf::as_path).collect::<Vec<_>>(),
            &[&self.output],
            self.force,
        )?;
        let Ok(folder) = self.output.canonicalize() else { return Ok(()) };
        let is_inside = |input: &&PathBuf| input.canonicalize().is_ok_and(|input| input.starts_with(&folder));
        match read.iter().find(is_inside) {
            Some(input) => Err(CliError::Usage(format!(
                "{} would replace {}, which is read; choose another name",
                self.output.display(),
                input.display()
            ))),
            None => Ok(()),
        }
    }

    /// Writes a volume that was read; returns the metadata that the format does not store.
    fn write(
        &self,
        format: VolumeFormat,
        output: &Path,
        volume: &Volume,
    ) -> Result<Vec<&'static str>, CliError> {
        let refused = |err: ConvertError| self.usage(&err);
        let mut outgoing =
            ExportVolume::new(volume).with_number_type(&self.number_request()).map_err(refused)?;
        if let Some(headings) = self.orient {
            outgoing = outgoing.reoriented(headings).map_err(refused)?;
        }
        if format.is_pyramid() {
            let mut writer = OmeZarrWriter::new(output, format, PyramidSpec::new(&outgoing), self.force)?;
            writer.write_slab(&outgoing)?;
            writer.finish()?;
        } else {
            write_volume(output, format, &outgoing, self.compress)?;
        }
        Ok(format.unsupported_metadata(&outgoing))
    }
}

/// Adapts the messages of readers to this command: the readers' `--type` is called `--input-type` here.
fn with_own_option_names(error: LoadError) -> LoadError {
    let own = |mut explanation: Box<ErrorExplanation>| {
        for text in [&mut explanation.why, &mut explanation.help] {
            *text = text.replace("--type", "--input-type");
        }
        // The file name before it may contain anything.
        if let Some(file) = explanation.place.strip_suffix(", --type") {
            explanation.place = format!("{file}, --input-type");
        }
        explanation
    };
    match error {
        LoadError::BadInput(explanation) => LoadError::BadInput(own(explanation)),
        LoadError::Limit(explanation) => LoadError::Limit(own(explanation)),
        other => other,
    }
}

/// Writes a volume in another format.
pub(super) fn run(args: &ConvertArgs) -> Result<(), CliError> {
    let format = args.output_format()?;
    check_overwrites(&[&args.input], &[&args.output], args.force)?;
    args.check_folder(format)?;
    let output = open_destination(&args.output, format.extensions()[0])?;
    // Checked before the input is read, which may take long.
    format.check_writable(output.path(), args.force)?;
    let control = control_with_size_warning(&args.input);
    let opened = open(&args.input, &args.load.load_options()?, &control).map_err(with_own_option_names);
    let lost = match opened {
        Err(limit @ LoadError::Limit(_)) => by_slabs::convert(args, format, output.path(), limit, &control)?,
        opened => {
            let volume = opened?;
            args.check_inputs(&control)?;
            args.write(format, output.path(), &volume)?
        }
    };
    if !lost.is_empty() {
        warn_line(&format!(
            "warning: .{} does not store {}; .nrrd does",
            format.extensions()[0],
            lost.join(", ")
        ));
    }
    finish_output(output)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_formats_are_understood() {
        assert_eq!(parse_value_range("-1000:3e3"), Ok(ValueRange::new(-1000.0, 3000.0)));
        for text in ["", "1", "2:1", "1:1", "nan:1", "0:inf", "0:1:2"] {
            assert!(parse_value_range(text).is_err(), "{text}");
        }
        assert_eq!(parse_format(".nii.gz"), Ok(VolumeFormat::NiftiGzip));
        assert_eq!(parse_format("tiff"), Ok(VolumeFormat::Tiff));
        assert!(parse_format("mhd").unwrap_err().contains(".vti"));
    }
}
