//! NumPy arrays: one in a file (`.npy`), or several in an archive (`.npz`).
//!
//! After the definition at <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, versions 1 to 3.

mod dictionary;
mod grid;
mod header;
#[cfg(test)]
mod tests;
mod zip;

use std::io::Read as _;

use flate2::CrcReader;

use super::input::stem;
use super::number::{Part, Stored};
use super::placement::{Parts, Placement};
use super::reader::{After, Reader, Source};
use super::samples::{Fault, Layout, is_corruption, skip_bytes};
use super::voxels::Voxels;
use super::{Dimension, LoadError, Offer};
use crate::data::attempt::{Attempt, Extent, quoted};
use crate::data::{Hints, Volume, plain};
use grid::Grid;
use header::{Header, MAGIC};
use zip::Entry;

pub(super) const NPY: Reader = Reader {
    name: "NumPy",
    endings: &[".npy", ".npy.gz"],
    recognises: |start| start.has(MAGIC, 0),
    load: load_array,
};

pub(super) const NPZ: Reader = Reader {
    name: "NumPy archive",
    endings: &[".npz"],
    recognises: |start| zip::begins_with_entry(start.stored(), ENDING),
    load: load_archive,
};

/// Extension of arrays in an archive.
const ENDING: &str = ".npy";

const HELP: &str = "save the array again, or copy the file again";

/// Maximum number of arrays of an archive whose headers are read.
const MOST_ARRAYS: usize = 1024;

/// Selected volume of an array, and how it is stored.
struct Wanted {
    stored: Stored,
    extent: Extent,
    /// Offset of its first voxel in the array's file, in bytes.
    at: u64,
    placement: Placement,
}

/// Selects the volume of an array by the user's choice.
fn wanted(
    source: &Source<'_>,
    attempt: Attempt<'_>,
    header: &Header,
    grid: &Grid,
) -> Result<Wanted, LoadError> {
    let part = source.part(attempt, grid.components, grid.is_color)?;
    let stored = Stored { number: grid.number, endian: grid.endian, components: grid.components, part };
    let mut number = 0u64;
    for &(dimension, count) in &grid.outer {
        let chosen = source.numbered(attempt, dimension, count, grid.dims, |_| String::new())?;
        number = number.saturating_mul(count).saturating_add(chosen as u64);
    }
    let extent = Extent::checked(
        attempt,
        "shape",
        grid.dims,
        stored.voxel_type(),
        source.options.room(source.control),
    )?;
    let before = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel()).saturating_mul(number);
    let remark = match part {
        Part::Magnitude => Some("complex numbers are shown by their length"),
        other => other.remark(),
    };
    let placement = Placement::unknown().remarked(remark);
    Ok(Wanted { stored, extent, at: header.bytes.saturating_add(before), placement })
}

/// Loads a file of a single array.
fn load_array(mut source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the NumPy array", path: source.path };
    let header = Header::read(attempt, &mut source.content())?;
    let grid = Grid::of(attempt, &header)?;
    let Wanted { stored, extent, at, placement } = wanted(&source, attempt, &header, &grid)?;
    let voxels = source.voxels(attempt, at, (&stored, extent), After::More, HELP)?;
    let name = stem(source.path);
    Parts { name, extent, placement, voxels, hints: Hints::default() }.volume(attempt)
}

/// Loads an array of an archive.
fn load_archive(mut source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the NumPy archive", path: source.path };
    let entries = zip::entries(attempt, &mut source.input)?;
    let mut arrays: Vec<(Entry, Header, Grid)> = Vec::new();
    let mut refused = Vec::new();
    for entry in
        entries.into_iter().filter(|entry| entry.name.strip_suffix(ENDING).is_some()).take(MOST_ARRAYS)
    {
        source.control.check()?;
        let header = zip::open(attempt, &mut source.input, &entry)
            .and_then(|mut content| Header::read(attempt, &mut content));
        match header.and_then(|header| Grid::of(attempt, &header).map(|grid| (header, grid))) {
            Ok((header, grid)) => arrays.push((entry, header, grid)),
            Err(error @ LoadError::Io { .. }) => return Err(error),
            Err(error) => refused.push(error),
        }
    }
    // Beside a volume, matrices and tables (an affine, directions, a list of points) are no images. One that the user
    // has named is still read.
    let named = source.options.choice.array.as_deref();
    let is_table = |header: &Header, grid: &Grid| grid.is_table(header.shape.len());
    if arrays.iter().any(|(_, header, grid)| !is_table(header, grid)) {
        arrays.retain(|(entry, header, grid)| !is_table(header, grid) || named == Some(key(entry).as_str()));
    }
    // Nor are one-dimensional arrays offered beside a volume; without any volume, the errors of the arrays are
    // reported.
    if arrays.is_empty() {
        let count = refused.len();
        return Err(match refused.pop() {
            Some(only) if count == 1 => only,
            _ => attempt.bad_input(
                "arrays",
                format!("none of its {count} arrays is a volume"),
                "save an array of numbers with three axes: z, y, x",
            ),
        });
    }
    let offers = arrays.iter().map(|(entry, _, grid)| {
        let key = key(entry);
        Offer { name: key.clone(), key, dims: Some(grid.dims) }
    });
    let chosen = attempt.chosen(&source.options.choice, Dimension::Array, offers.collect())?;
    let (entry, header, grid) = arrays.swap_remove(chosen);
    let wanted = wanted(&source, attempt, &header, &grid)?;
    let voxels = inflated(&mut source, attempt, &entry, &wanted)?;
    let Wanted { extent, placement, .. } = wanted;
    let name = plain(&format!("{} {}", stem(source.path), entry.name.trim_end_matches(ENDING)), 120);
    Parts { name, extent, placement, voxels, hints: Hints::default() }.volume(attempt)
}

/// Key by which an array is chosen: its name.
fn key(entry: &Entry) -> String {
    plain(entry.name.trim_end_matches(ENDING), 80)
}

/// Reads the selected volume of an archive entry.
fn inflated(
    source: &mut Source<'_>,
    attempt: Attempt<'_>,
    entry: &Entry,
    wanted: &Wanted,
) -> Result<Voxels, LoadError> {
    let Wanted { stored, extent, at, .. } = wanted;
    let needed = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel()).saturating_add(*at);
    // Before memory is allocated.
    if needed > entry.bytes {
        return Err(attempt.bad_input(
            "shape",
            format!(
                "the data of {} are truncated: {needed} bytes expected, {} found",
                quoted(&entry.name),
                entry.bytes
            ),
            HELP,
        ));
    }
    let control = source.control;
    let layout = Layout { extent: *extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    let mut content = CrcReader::new(zip::open(attempt, &mut source.input, entry)?);
    let mut read = || {
        if skip_bytes(&mut content, *at, control)? < *at {
            return Err(Fault::Short { got: 0 });
        }
        stored.read(&mut content, *extent, control)
    };
    let voxels = read().map_err(|fault| match fault {
        Fault::Io(error) if is_corruption(&error) => {
            broken(attempt, entry, &format!("they cannot be inflated: {error}"))
        }
        fault => fault.into_error(attempt, &layout, "bytes", HELP),
    })?;
    // The checksum covers the whole array, and can be verified only if all of it was read.
    let is_all = needed == entry.bytes && content.by_ref().read(&mut [0]).is_ok_and(|more| more == 0);
    if is_all && content.crc().sum() != entry.checksum {
        return Err(broken(attempt, entry, "their checksum is another"));
    }
    Ok(voxels)
}

fn broken(attempt: Attempt<'_>, entry: &Entry, why: &str) -> LoadError {
    attempt.bad_input("data", format!("the data of {} are broken: {why}", quoted(&entry.name)), HELP)
}
