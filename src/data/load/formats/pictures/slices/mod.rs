//! Image stacks: volumes whose slices are files of their own, numbered pictures, and single pictures.
//!
//! PNG (<https://www.w3.org/TR/png-3/>), JPEG (ITU-R T.81), BMP and TIFF. The distance of the slices is unknown.

mod counters;
mod groups;
mod picture;
#[cfg(test)]
mod tests;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::pile::read_pile;
use super::tiff;
use crate::data::attempt::{Attempt, Extent, quoted};
use crate::data::load::reading::input::{Input, stem};
use crate::data::load::reading::placement::{Parts, Placement};
use crate::data::load::reading::reader::{Reader, Source, Start};
use crate::data::load::reading::voxels::Meant;
use crate::data::load::{Dimension, LoadControl, LoadError, LoadOptions, Offer};
use crate::data::{Hints, Volume, plain};
use groups::{Group, groups, pattern};
use picture::{Header, Kind, look};

/// Maximum number of series whose sizes are looked up for the list: as many as a screen has lines for.
const MOST_LOOKED_UP: usize = 24;

/// Reader of a single picture, as a volume of one slice.
pub(in crate::data::load) const READER: Reader = Reader {
    name: "PNG, JPEG, BMP",
    endings: &[".png", ".jpg", ".jpeg", ".bmp"],
    recognises: |start| Kind::of(start.stored()).is_some_and(|kind| kind != Kind::Tiff),
    load: load_one,
};

fn load_one(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, start, options, control, .. } = source;
    let attempt = Attempt { what: "read the picture", path };
    let Some(kind) = Kind::of(start.stored()) else {
        return Err(attempt.bad_input("header", "it does not begin as pictures do", "copy the file again"));
    };
    volume(attempt, kind, &[path.to_owned()], stem(path), Vec::new(), options, control)
}

/// Loads the volume whose slices are among the files of a folder, in natural order; `None` where none is a picture.
///
/// # Errors
/// [`LoadError::Several`] where there are several volumes, `BadInput` for slices that do not match each other or are
/// broken.
pub(in crate::data::load) fn load(
    attempt: Attempt<'_>,
    files: &[PathBuf],
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Option<Volume>, LoadError> {
    let (mut pictures, mut others) = (Vec::new(), Vec::new());
    for path in files {
        control.check()?;
        match Kind::of_file(of_slice(path))? {
            Some(kind) => pictures.push((path.as_path(), kind)),
            None => others.push(path.as_path()),
        }
    }
    if pictures.iter().all(|&(_, kind)| kind == Kind::Tiff)
        && let Some(set) = tiff_set(&pictures, control)?
    {
        return load_tiff(set, options, control).map(Some);
    }
    let mut groups = groups(pictures.iter().copied());
    let mut remarks = Vec::new();
    if options.choice.series.is_none() {
        leave_out_strays(&mut groups, &mut remarks);
    }
    if groups.is_empty() {
        return Ok(None);
    }
    let is_one = groups.len() == 1;
    let offers = offers(&groups, &pictures, options, control);
    let group = groups.swap_remove(attempt.chosen(&options.choice, Dimension::Series, offers)?);
    remarks.extend(damaged(&others, &group, &pictures));
    let members: Vec<PathBuf> = group.files.iter().map(|&file| pictures[file].0.to_owned()).collect();
    if group.kind == Kind::Tiff
        && let [one] = members.as_slice()
    {
        let volume = load_tiff(one, options, control)?;
        let remarks = volume.remarks().iter().cloned().chain(remarks).collect();
        return Ok(Some(volume.with_remarks(remarks)));
    }
    remarks.extend(group.gap);
    let folder = attempt.path.file_name().unwrap_or_default().to_string_lossy();
    let name = if is_one && !folder.is_empty() { plain(&folder, 120) } else { plain(&group.name, 120) };
    volume(attempt, group.kind, &members, name, remarks, options, control).map(Some)
}

fn of_slice(path: &Path) -> Attempt<'_> {
    Attempt { what: "read the slice", path }
}

/// Remark about files that are named like slices of a group, or at least like pictures, but are none: truncated or
/// damaged copies.
fn damaged(others: &[&Path], group: &Group, pictures: &[(&Path, Kind)]) -> Option<String> {
    // As many as fit into a line.
    const MOST_NAMED: usize = 3;
    let own = group.files.first().map(|&file| pattern(pictures[file].0));
    let known: HashSet<String> = pictures.iter().map(|(path, _)| pattern(path)).collect();
    let is_meant = |path: &&&Path| {
        let name = pattern(path);
        Some(&name) == own.as_ref() || (is_named_like_a_picture(path) && !known.contains(&name))
    };
    let mut names: Vec<String> = others
        .iter()
        .filter(is_meant)
        .map(|path| quoted(&path.file_name().unwrap_or_default().to_string_lossy()))
        .collect();
    let count = names.len();
    if count > MOST_NAMED {
        names.truncate(MOST_NAMED);
        names.push(format!("and {} more", count - MOST_NAMED));
    }
    (count > 0).then(|| {
        let (is, they) =
            if count == 1 { ("is", "it is no picture") } else { ("are", "they are no pictures") };
        format!("{} {is} left out: {they}; copy the file again if a slice is missing", names.join(", "))
    })
}

fn is_named_like_a_picture(path: &Path) -> bool {
    let endings = READER.endings.iter().chain(&[".tif", ".tiff"]);
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    endings.into_iter().any(|ending| name.ends_with(ending))
}

/// Leaves out single pictures beside the slices of one volume: previews and the like.
fn leave_out_strays(groups: &mut Vec<Group>, remarks: &mut Vec<String>) {
    // With fewer slices, strays cannot be distinguished from them.
    const FEWEST_SLICES: usize = 3;
    let is_stray = |group: &Group| group.files.len() == 1;
    let stacks = groups.iter().filter(|group| !is_stray(group)).count();
    let is_clear = stacks == 1 && groups.iter().any(|group| group.files.len() >= FEWEST_SLICES);
    if is_clear && groups.len() > 1 {
        remarks.push(format!("{} single pictures beside the slices are left out", groups.len() - 1));
        groups.retain(|group| !is_stray(group));
    }
}

/// List of the volumes to choose from, where there are several.
fn offers(
    groups: &[Group],
    pictures: &[(&Path, Kind)],
    options: &LoadOptions,
    control: &LoadControl,
) -> Vec<Offer> {
    let dims = |group: &Group| {
        let &first = group.files.first()?;
        let (path, kind) = *pictures.get(first)?;
        let (Header { size: [width, height], .. }, _) =
            look(of_slice(path), kind, options, control, false).ok()?;
        Some([width, height, group.files.len() as u64])
    };
    let is_long = groups.len() > MOST_LOOKED_UP || groups.len() == 1;
    groups
        .iter()
        .enumerate()
        .map(|(at, group)| Offer {
            key: at.to_string(),
            name: plain(&group.name, 80),
            dims: if is_long { None } else { dims(group) },
        })
        .collect()
}

/// Returns the first file if its metadata describe the whole set of files: it is read in place of all.
fn tiff_set<'a>(pictures: &[(&'a Path, Kind)], control: &LoadControl) -> Result<Option<&'a Path>, LoadError> {
    let [(first, _), (second, _), ..] = *pictures else { return Ok(None) };
    let name = second.file_name().unwrap_or_default().to_string_lossy();
    let is_set = tiff::Picture::open(of_slice(first), control)?.names(&name);
    Ok(is_set.then_some(first))
}

fn load_tiff(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let attempt = of_slice(path);
    let mut input = Input::open(attempt)?;
    let start = Start::of(&mut input).map_err(|error| attempt.io(error))?;
    (tiff::READER.load)(Source { path, input, start, options, control })
}

/// Reads the volume from slices of one format.
fn volume(
    attempt: Attempt<'_>,
    kind: Kind,
    files: &[PathBuf],
    name: String,
    remarks: Vec<String>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let look_at = |path: &PathBuf, is_decoded| look(of_slice(path), kind, options, control, is_decoded);
    let headers: Vec<Header> = files
        .par_iter()
        .map(|path| look_at(path, false).map(|(header, _)| header))
        .collect::<Result<_, _>>()?;
    let (Some(&model), Some(first)) = (headers.first(), files.first()) else {
        return Err(attempt.bad_input("files", "there is no slice", "name one file"));
    };
    for (header, path) in headers.iter().zip(files) {
        check(attempt, [(&model, first), (header, path)])?;
    }
    let stored = model.stored;
    let dims = [model.size[0], model.size[1], files.len() as u64];
    let extent = Extent::checked(attempt, "files", dims, stored.voxel_type(), options.room(control))?;
    let voxels = read_pile(attempt, &stored, extent, &Meant::as_stored(None), control, |some| {
        some.par_iter()
            .map(|&slice| {
                let path = &files[slice];
                let (header, bytes) = look_at(path, true)?;
                check(attempt, [(&model, first), (&header, path)])?;
                Ok(bytes)
            })
            .collect()
    })?;
    let mut placement = Placement::unknown();
    placement.remarks = remarks;
    placement.remarks.extend(stored.part.remark().map(str::to_owned));
    Parts { name, extent, placement, voxels, hints: Hints::default() }.volume(attempt)
}

/// Checks that two slices have equal size and type, and that each file holds only one.
fn check(attempt: Attempt<'_>, slices: [(&Header, &PathBuf); 2]) -> Result<(), LoadError> {
    let [(model, _), (header, _)] = slices;
    let [first, path] =
        slices.map(|(_, path)| quoted(&path.file_name().unwrap_or_default().to_string_lossy()));
    if header.pages > 1 {
        return Err(attempt.bad_input(
            "files",
            format!("{path} alone holds {} slices", header.pages),
            "name that file, or choose another series with --series",
        ));
    }
    if header.size == model.size && header.stored == model.stored {
        return Ok(());
    }
    let say = |header: &Header| {
        let [width, height] = header.size;
        let Header { stored, .. } = header;
        format!("{width} x {height} pixels of {} x {} bits", stored.components, stored.number.bytes() * 8)
    };
    Err(attempt.bad_input(
        "files",
        format!("{path} has {}, {first} has {}", say(header), say(model)),
        "put slices of one size and type into a folder of their own",
    ))
}
