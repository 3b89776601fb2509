//! NIfTI-1, NIfTI-2 and their predecessor Analyze 7.5: a binary header, and the voxels behind it or in a second file.
//!
//! After `nifti1.h` and `nifti2.h` (<https://nifti.nimh.nih.gov>), and *ANALYZE 7.5 File Format* of the Mayo
//! Foundation. World space is right-anterior-superior.

mod dimensions;
mod extensions;
mod geometry;
mod header;
mod hints;
mod masks;
mod number_type;
mod pair;
#[cfg(test)]
mod tests;
mod vector_magnitudes;

use super::content::FileContent;
use super::input::{FileChangeGuard, InputFile, name_without_extension};
use super::number::{ScalarReduction, VoxelEncoding};
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::rescale::rescale;
use super::samples::{ReadFault, VoxelLayout};
use super::voxels::{ReadVoxels, ValueMapping};
use super::{LoadControl, LoadError, LoadOptions, label_tables};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{FileDimension, GridExtent, LoadContext, Volume};
use dimensions::NiftiGrid;
use extensions::ExtensionLabels;
use header::{NiftiHeader, NiftiVersion};
pub(super) use masks::{load_masks, mask_files};
use number_type::NiftiNumberType;

/// File name endings, longest first, so that the longest match is cut from a name.
const ENDINGS: &[&str] = &[".nii.gz", ".hdr.gz", ".img.gz", ".nii", ".hdr", ".img"];

pub(super) const READER: FormatReader = FormatReader {
    name: "NIfTI, Analyze",
    extensions: ENDINGS,
    recognises: |start| NiftiVersion::detect(start.bytes()).is_some(),
    load,
};

/// Loads a `NIfTI` or Analyze volume from a single file, or from a pair of which either file may be named.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, control, .. } = source;
    let context = LoadContext { operation: "read the NIfTI volume", path };
    load_parts(source)?.into_volume(context, control)
}

/// Reads the parts of such a volume without assembling them.
fn load_parts(source: VolumeSource<'_>) -> Result<VolumeParts, LoadError> {
    let VolumeSource { path, input, start, options, control } = source;
    let context = LoadContext { operation: "read the NIfTI volume", path };
    let Some(form) = NiftiVersion::detect(start.bytes()) else {
        // The file holds voxels alone; the header lies in the file beside it.
        let header = pair::read_header_beside(context, control)?;
        return read(context, &header, FileContent::new(input, start.is_gzip()), options, control);
    };
    let header = NiftiHeader::parse(context, form, start.bytes())?;
    if header.has_data {
        return read(context, &header, FileContent::new(input, start.is_gzip()), options, control);
    }
    let data_path = pair::data_path_beside(context)?;
    let data_context = LoadContext { operation: "read the NIfTI volume's data file", path: &data_path };
    let mut input = InputFile::open(data_context)?;
    let guard = FileChangeGuard::new(data_context, &input, control)?;
    let is_gzip = pair::starts_as_gzip(data_context, &mut input)?;
    guard.check_unchanged(
        data_context,
        read(context, &header, FileContent::new(input, is_gzip), options, control),
    )
}

/// Reads the volume that a header describes from the content that holds its voxels.
fn read(
    context: LoadContext<'_>,
    header: &NiftiHeader,
    mut content: FileContent,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<VolumeParts, LoadError> {
    let number_type = NiftiNumberType::from_header(context, header)?;
    let grid = NiftiGrid::parse(context, header)?;
    let frame = context.resolve_choice(&options.choice, FileDimension::Frame, grid.offers(header))?;
    let components = if grid.components > 1 { grid.components } else { number_type.components };
    if grid.components > 1 && number_type.components > 1 {
        return Err(context.bad_input_error(
            "datatype",
            "vectors of colours or of complex numbers are not supported",
            "write its components as separate volumes",
        ));
    }
    let component = options.choice.resolve_component(components, number_type.is_color);
    let part = ScalarReduction::require(context, component, components, number_type.is_color)?;
    let stored =
        VoxelEncoding { number: number_type.number, endian: header.endian, components, reduction: part };
    let dims = grid.dims;
    // The magnitude of a vector needs all of its component volumes, so thinning applies after reading them whole.
    let is_planar = grid.components > 1;
    let checked = if is_planar && part == ScalarReduction::Magnitude {
        GridExtent::checked_whole
    } else {
        GridExtent::checked
    };
    let extent = checked(context, "dim", dims, stored.voxel_type(), options.limits(control))?;
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: header.endian };
    let failed = |fault: ReadFault| {
        fault.into_error(context, &layout, "bytes", "check the header, or copy the file again")
    };

    // Volumes are consecutive: all time steps of one component, then those of the next.
    let bytes = extent.voxels as u128 * (number_type.number.bytes() * number_type.components) as u128;
    let byte_offset = |component: usize| {
        let volumes = component as u128 * grid.frames as u128 + frame as u128;
        u64::try_from(u128::from(header.data_start) + volumes * bytes).unwrap_or(u64::MAX)
    };
    // Magnitude of vectors: each component is scaled before its square is added.
    let is_magnitude = is_planar && part == ScalarReduction::Magnitude;
    let (first, last) = match part {
        ScalarReduction::Component(at) if is_planar => (byte_offset(at), byte_offset(at)),
        _ => (byte_offset(0), byte_offset(grid.components - 1)),
    };
    content.check_length(context, "dim", last, bytes)?;
    let extension = ExtensionLabels::read(&mut content, header, control).map_err(failed)?;
    let voxels = if is_magnitude {
        let places = (0..grid.components).map(byte_offset);
        vector_magnitudes::read_magnitudes(&mut content, &stored, places, header.scale(), extent, control)
            .map(ReadVoxels::from)
    } else {
        let stored = if is_planar { VoxelEncoding::scalar(stored.number, stored.endian) } else { stored };
        let values = |samples| match applied_scale(header, &number_type, part) {
            Some(scale) => rescale(context, samples, scale, options.memory_budget_bytes),
            None => Ok(samples),
        };
        let meant = ValueMapping { padding: None, map: &values };
        content.seek_forward(first, control).and_then(|()| content.voxels(&stored, extent, &meant, control))
    };
    let voxels = voxels.and_then(|voxels| content.finish(control).map(|()| voxels)).map_err(failed)?;

    let mut placement = geometry::placement(header, dims);
    placement.remarks.extend(number_type.remark(part).map(str::to_owned));
    placement.remarks.extend(extension.remark);
    let mut hints = hints::hints_from_header(header);
    if components == 1 {
        label_tables::add_labels(extension.labels, voxels.stored_numbers(), &mut hints);
        label_tables::add_label_table(context, ENDINGS, voxels.stored_numbers(), &mut hints);
    }
    let name = sanitised(&name_without_extension(context.path, ENDINGS), 120);
    Ok(VolumeParts { name, extent, placement, voxels, hints })
}

/// Returns the slope and intercept to apply to the values shown. Colours are not scaled (`nifti1.h`, "data scaling").
fn applied_scale(
    header: &NiftiHeader,
    number_type: &NiftiNumberType,
    part: ScalarReduction,
) -> Option<[f64; 2]> {
    let (slope, intercept) = header.scale();
    match part {
        _ if number_type.is_color => None,
        // Magnitude of a complex number: the intercept, which applies to the real part, cannot be recovered from it.
        ScalarReduction::Magnitude => Some([slope.abs(), 0.0]),
        // Imaginary parts are scaled by the slope only.
        ScalarReduction::Component(at) if number_type.components > 1 && at > 0 => Some([slope, 0.0]),
        _ => Some([slope, intercept]),
    }
}
