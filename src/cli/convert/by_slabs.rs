//! Conversion of volumes that are larger than the memory: some slices at a time are read, and written to a pyramid.

use std::path::Path;

use super::{ConvertArgs, with_own_option_names};
use crate::cli::CliError;
use chiaroscuro_volume::{Downsampling, LoadControl, LoadError, Portion, Volume, VoxelRegion, VoxelSpan};
use chiaroscuro_volume_io::{
    LoadOptions, open,
    write::{ExportVolume, OmeZarrWriter, PyramidSpec, SLAB_SLICES, VolumeFormat},
};

/// Strides at which an overview of the volume is read, the finest that fits.
const OVERVIEW_STRIDES: [usize; 6] = [4, 8, 16, 32, 64, 128];

/// Part of the memory budget that the slices of one reading take: they are analysed, and encoded as bytes.
const BUDGET_SHARE: u64 = 4;

/// Reader of a volume in parts.
struct PartReader<'a> {
    input: &'a Path,
    options: &'a LoadOptions,
    /// Spans of the voxels that are wanted.
    spans: [VoxelSpan; 3],
}

impl PartReader<'_> {
    fn read(
        &self,
        spans: [VoxelSpan; 3],
        thinning: Downsampling,
        control: &LoadControl,
    ) -> Result<Volume, LoadError> {
        let mut options = self.options.clone();
        options.choice.portion = Some(Portion { region: Some(VoxelRegion(spans)), thinning });
        open(self.input, &options, control).map_err(with_own_option_names)
    }

    /// Reads some voxels of the whole, by which its size, missing voxels and labels are known.
    fn read_overview(&self, control: &LoadControl) -> Result<Option<Volume>, LoadError> {
        for stride in OVERVIEW_STRIDES {
            match self.read(self.spans, Downsampling::Every(stride), control) {
                Err(LoadError::Limit(_)) => {}
                read => return read.map(Some),
            }
        }
        Ok(None)
    }

    /// Reads slices, counted from the first of the file.
    fn read_slices(&self, slices: std::ops::Range<usize>) -> Result<Volume, LoadError> {
        let [x, y, _] = self.spans;
        let z = VoxelSpan { first: slices.start, end: Some(slices.end) };
        self.read([x, y, z], Downsampling::None, &LoadControl::new())
    }
}

/// Writes a volume, reading some slices at a time; returns the metadata that the format does not store. `limit` is the
/// error of reading the whole, which remains where parts of the file cannot be read.
pub(super) fn convert(
    args: &ConvertArgs,
    format: VolumeFormat,
    output: &Path,
    limit: LoadError,
    control: &LoadControl,
) -> Result<Vec<&'static str>, CliError> {
    let options = &args.load.load_options()?;
    let portion = options.choice.portion.unwrap_or_default();
    if !format.is_pyramid() || portion.thinning.stride() > 1 {
        return Err(limit.into());
    }
    if args.rescale.is_some() || args.padding.is_some() || args.orient.is_some() {
        let why = "it is larger than the memory, so that its slices are converted in parts, and --rescale, --padding \
                   and --orient need the whole; leave them out, or give a --region or --reduce";
        return Err(args.usage(&why));
    }
    let open_span = VoxelSpan { first: 0, end: None };
    let spans = portion.region.map_or([open_span; 3], |region| region.0);
    let parts = PartReader { input: &args.input, options, spans };
    let Some(overview) = parts.read_overview(control)? else { return Err(limit.into()) };
    let Some(grid) = overview.contents().grid else { return Err(limit.into()) };
    args.check_inputs(control)?;
    let wish = args.number_request();
    let overview = ExportVolume::new(&overview).with_number_type(&wish).map_err(|why| args.usage(&why))?;
    let lost = format.unsupported_metadata(&overview);
    let [x, y, z] = [0, 1, 2].map(|axis| spans[axis].first..spans[axis].end.unwrap_or(grid[axis]));
    let slice_bytes = (x.len() * y.len() * overview.voxel_type().bytes()).max(1) as u64;
    let at_once = options.memory_budget_bytes / BUDGET_SHARE / slice_bytes;
    let at_once = usize::try_from(at_once).unwrap_or(usize::MAX).clamp(SLAB_SLICES, z.len().max(SLAB_SLICES));
    // Whole layers of chunks, so that none is held back.
    let at_once = at_once / SLAB_SLICES * SLAB_SLICES;
    let mut writer: Option<OmeZarrWriter> = None;
    for first in z.clone().step_by(at_once) {
        let part = match parts.read_slices(first..z.end.min(first + at_once)) {
            // Formats that are decoded whole can be thinned, but not read in parts.
            Err(LoadError::Limit(_)) => return Err(limit.into()),
            read => read?,
        };
        let part = ExportVolume::new(&part).with_number_type(&wish).map_err(|why| args.usage(&why))?;
        if part.voxel_type() != overview.voxel_type() {
            let why =
                "its slices, which are read in parts, have different number types; choose one with --type";
            return Err(args.usage(&why));
        }
        if writer.is_none() {
            let spec = PyramidSpec::new(&part).with_whole(z.len(), &overview);
            writer = Some(OmeZarrWriter::new(output, format, spec, args.force)?);
        }
        if let Some(writer) = &mut writer {
            writer.write_slab(&part)?;
        }
    }
    match writer {
        Some(writer) => writer.finish()?,
        None => return Err(limit.into()),
    }
    Ok(lost)
}
