//! Gaussian cubes: densities and orbitals of molecules as text, z fastest.
//!
//! After Gaussian's description of cubegen, <https://gaussian.com/cubegen/>.

mod header;
#[cfg(test)]
mod tests;
mod word_reader;

use super::input::stem;
use super::placement::VolumeParts;
use super::reader::{FormatReader, VolumeSource};
use super::samples::{ReadFault, VoxelLayout, alloc_with_capacity, is_corruption};
use super::{Endian, FileDimension, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext, Samples, ValueMetadata, Volume, VoxelType, quoted};
use header::CubeHeader;
use word_reader::{CubeWordReader, parse_fortran_real};

pub(super) const READER: FormatReader = FormatReader {
    name: "Gaussian cube",
    extensions: &[".cube", ".cube.gz", ".cub", ".cub.gz"],
    recognises: |_| false,
    load,
};

const HELP: &str = "check the header against the data, or copy the file again";

/// Loads a Gaussian cube file.
fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the Gaussian cube", path: source.path };
    let header = {
        let control = source.control;
        CubeHeader::read(context, &mut CubeWordReader::new(source.content(), control))?
    };
    let voxel_type = VoxelType::F32;
    // x is slowest in the file, so that its slices are not those of the volume: all of it is read before a selection
    // is made.
    let room = source.options.limits(source.control);
    let extent = GridExtent::checked_whole(context, "numbers of voxels", header.dims, voxel_type, room)?;
    let layout = VoxelLayout { extent, voxel_type, endian: Endian::Little };
    let values = header.values.len();
    let chosen =
        source.choose_numbered(context, FileDimension::Channel, values as u64, header.dims, |at| {
            header.values[at].clone()
        })?;
    // At least a digit and a space each: shorter data are refused before memory is allocated.
    let needed = (extent.voxels as u64).saturating_mul(values as u64);
    let room = source.input.len.div_ceil(2);
    if !source.start.is_gzip() && room < needed {
        return Err(context.bad_input_error(
            "data",
            format!("the data are truncated: {needed} numbers expected, at most {room} found"),
            HELP,
        ));
    }
    let name = stem(source.path);
    let control = source.control;
    control.start(extent.bytes);
    // From the beginning again, because the first reader has buffered data.
    source.input.seek(0).map_err(|error| context.io_error(error))?;
    let mut words = CubeWordReader::new(source.content(), control);
    header.skip(context, &mut words)?;
    let samples = read(&mut words, extent, values, chosen).map_err(|fault| match fault {
        ReadFault::Io(error) if is_corruption(&error) => {
            ReadFault::Corrupt(error).into_error(context, &layout, "numbers", HELP)
        }
        ReadFault::Short { got } => context.bad_input_error(
            "data",
            format!("the data are truncated: {needed} numbers expected, {got} found"),
            HELP,
        ),
        fault => fault.into_error(context, &layout, "numbers", HELP),
    })?;
    let mut hints = ValueMetadata::default();
    hints.set_acquisition(&header.title);
    VolumeParts { name, extent, placement: header.placement, voxels: samples.into(), hints }
        .into_volume(context, control)
}

/// Reads one value of each voxel, transposing the grid: x is slowest in the file, and fastest in memory.
fn read(
    words: &mut CubeWordReader<'_>,
    extent: GridExtent,
    values: usize,
    chosen: usize,
) -> Result<Samples, ReadFault> {
    let [nx, ny, nz] = extent.dims;
    let mut samples = alloc_with_capacity(extent.voxels)?;
    samples.resize(extent.voxels, 0.0f32);
    let mut got = 0;
    let mut word = String::new();
    for x in 0..nx {
        for y in 0..ny {
            for z in 0..nz {
                for value in 0..values {
                    if !words.word(&mut word)? {
                        return Err(ReadFault::Short { got });
                    }
                    got += 1;
                    if value == chosen {
                        let number = parse_fortran_real(&word)
                            .ok_or_else(|| ReadFault::NotANumber { text: word.clone() })?;
                        samples[x + nx * (y + ny * z)] = number;
                    }
                }
            }
            words.advance((nz * size_of::<f32>()) as u64);
        }
    }
    Ok(Samples::F32(samples))
}

/// Error for a header line with unexpected content.
fn bad_line(context: LoadContext<'_>, field: &str, line: &str, expected: &str) -> LoadError {
    context.bad_input_error(
        field,
        format!("{expected} was expected, {} was found", quoted(line)),
        "check that the file is a Gaussian cube",
    )
}
