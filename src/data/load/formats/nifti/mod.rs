//! NIfTI-1, NIfTI-2 and their predecessor Analyze 7.5: a binary header, and the voxels behind it or in a second file.
//!
//! After `nifti1.h` and `nifti2.h` (<https://nifti.nimh.nih.gov>), and *ANALYZE 7.5 File Format* of the Mayo
//! Foundation. World space is right-anterior-superior.

mod geometry;
mod grid;
mod header;
mod hints;
mod number_type;
mod pair;
#[cfg(test)]
mod tests;
mod vectors;

use super::content::Content;
use super::input::{Input, Witness, bare_name};
use super::number::{Part, Stored};
use super::placement::Parts;
use super::reader::{Reader, Source};
use super::rescaled::rescaled;
use super::samples::{Fault, Layout};
use super::voxels::{Meant, Voxels};
use super::{LoadControl, LoadError, LoadOptions, label_files};
use crate::data::attempt::{Attempt, Dimension, Extent};
use crate::data::{Volume, plain};
use grid::Grid;
use header::{Form, Header};
use number_type::NumberType;

/// File name endings, longest first, so that the longest match is cut from a name.
const ENDINGS: &[&str] = &[".nii.gz", ".hdr.gz", ".img.gz", ".nii", ".hdr", ".img"];

pub(super) const READER: Reader = Reader {
    name: "NIfTI, Analyze",
    endings: ENDINGS,
    recognises: |start| Form::of(start.bytes()).is_some(),
    load,
};

/// Loads a `NIfTI` or Analyze volume from a single file, or from a pair of which either file may be named.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, input, start, options, control } = source;
    let attempt = Attempt { what: "read the NIfTI volume", path };
    let Some(form) = Form::of(start.bytes()) else {
        // The file holds voxels alone; the header lies in the file beside it.
        let header = pair::header(attempt)?;
        return read(attempt, &header, Content::of(input, start.is_gzip()), options, control);
    };
    let header = Header::of(attempt, form, start.bytes())?;
    if header.is_single {
        return read(attempt, &header, Content::of(input, start.is_gzip()), options, control);
    }
    let data_path = pair::data(attempt)?;
    let of_data = Attempt { what: "read the NIfTI volume's data file", path: &data_path };
    let mut input = Input::open(of_data)?;
    let witness = Witness::of(of_data, &input)?;
    let is_gzip = pair::starts_as_gzip(of_data, &mut input)?;
    witness.vouch(of_data, read(attempt, &header, Content::of(input, is_gzip), options, control))
}

/// Reads the volume that a header describes from the content that holds its voxels.
fn read(
    attempt: Attempt<'_>,
    header: &Header,
    mut content: Content,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let number_type = NumberType::of(attempt, header)?;
    let grid = Grid::of(attempt, header)?;
    let frame = attempt.chosen(&options.choice, Dimension::Frame, grid.offers(header))?;
    let components = if grid.components > 1 { grid.components } else { number_type.components };
    if grid.components > 1 && number_type.components > 1 {
        return Err(attempt.bad_input(
            "datatype",
            "vectors of colours or of complex numbers are not read",
            "write its components as volumes of their own",
        ));
    }
    let component = options.choice.component_among(components, number_type.is_color);
    let part = Part::asked(attempt, component, components, number_type.is_color)?;
    let stored = Stored { number: number_type.number, endian: header.endian, components, part };
    let dims = grid.dims;
    // The magnitude of a vector needs all of its component volumes, so thinning applies after reading them whole.
    let is_planar = grid.components > 1;
    let checked = if is_planar && part == Part::Magnitude { Extent::checked_whole } else { Extent::checked };
    let extent = checked(attempt, "dim", dims, stored.voxel_type(), options.room(control))?;
    let layout = Layout { extent, voxel_type: stored.voxel_type(), endian: header.endian };
    let failed = |fault: Fault| {
        fault.into_error(attempt, &layout, "bytes", "check the header, or copy the file again")
    };

    // Volumes are consecutive: all time steps of one component, then those of the next.
    let bytes = extent.voxels as u128 * (number_type.number.bytes() * number_type.components) as u128;
    let place = |component: usize| {
        let volumes = component as u128 * grid.frames as u128 + frame as u128;
        u64::try_from(u128::from(header.data_start) + volumes * bytes).unwrap_or(u64::MAX)
    };
    let is_planar = grid.components > 1;
    // Magnitude of vectors: each component is scaled before its square is added.
    let are_lengths = is_planar && part == Part::Magnitude;
    let (first, last) = match part {
        Part::Component(at) if is_planar => (place(at), place(at)),
        _ => (place(0), place(grid.components - 1)),
    };
    content.check_room(attempt, "dim", last, bytes)?;
    let voxels = if are_lengths {
        let places = (0..grid.components).map(place);
        vectors::lengths(&mut content, &stored, places, header.scale(), extent, control).map(Voxels::from)
    } else {
        let stored = if is_planar { Stored::scalar(stored.number, stored.endian) } else { stored };
        let values = |samples| match scale_of(header, &number_type, part) {
            Some(scale) => rescaled(attempt, samples, scale, options.memory_budget_bytes),
            None => Ok(samples),
        };
        let meant = Meant { padding: None, values: &values };
        content.go_to(first, control).and_then(|()| content.voxels(&stored, extent, &meant, control))
    };
    let voxels = voxels.and_then(|voxels| content.finish(control).map(|()| voxels)).map_err(failed)?;

    let mut placement = geometry::placement(header, dims);
    placement.remarks.extend(number_type.remark(part).map(str::to_owned));
    let mut hints = hints::of(header);
    if components == 1 {
        label_files::add(attempt, ENDINGS, voxels.in_file(), &mut hints);
    }
    let name = plain(&bare_name(attempt.path, ENDINGS), 120);
    Parts { name, extent, placement, voxels, hints }.volume(attempt)
}

/// Returns the slope and intercept to apply to the values shown. Colours are not scaled (`nifti1.h`, "data scaling").
fn scale_of(header: &Header, number_type: &NumberType, part: Part) -> Option<[f64; 2]> {
    let (slope, intercept) = header.scale();
    match part {
        _ if number_type.is_color => None,
        // Magnitude of a complex number: the intercept, which applies to the real part, cannot be recovered from it.
        Part::Magnitude => Some([slope.abs(), 0.0]),
        // Imaginary parts are scaled by the slope only.
        Part::Component(at) if number_type.components > 1 && at > 0 => Some([slope, 0.0]),
        _ => Some([slope, intercept]),
    }
}
