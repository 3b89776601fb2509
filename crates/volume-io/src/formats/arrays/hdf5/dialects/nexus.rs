//! `NeXus`: the array that a file means to be shown, and the coordinates along its dimensions.
//!
//! After <https://manual.nexusformat.org/datarules.html>: attributes `default` lead from the root to a group `NXdata`,
//! whose attribute `signal` names the array, and `axes` its coordinates.

use super::super::container::{Hdf5File, Hdf5Object, LinkTarget};
use super::array_tree::object_at;
use super::coordinates::{AxisCoordinates, attribute_text};
use chiaroscuro_volume::LoadError;

/// Groups between the root and the array, and members of a group that are searched.
const MAX_DEPTH: usize = 8;
const MAX_MEMBERS: usize = 64;

/// Array to be shown.
#[derive(Debug)]
pub(super) struct NexusSignal {
    /// Address of its object.
    pub(super) address: u64,
    /// Coordinates along each dimension, slowest first.
    pub(super) coordinates: Vec<Option<AxisCoordinates>>,
}

/// Finds the array that a file means to be shown; `None` if it is no `NeXus` file, or names none.
pub(super) fn default_signal(
    file: &Hdf5File<'_>,
    root: &Hdf5Object,
) -> Result<Option<NexusSignal>, LoadError> {
    let mut group = root.clone();
    for _ in 0..MAX_DEPTH {
        let attributes = group.attributes(file)?;
        let signal = attribute_text(file, &attributes, "signal")?;
        if !signal.is_empty() {
            let Some(array) = object_at(file, &group, &signal)? else { return Ok(None) };
            let axes = attributes.iter().find(|attribute| attribute.name == "axes");
            let names = axes.map_or_else(|| Ok(Vec::new()), |axes| axes.texts(file))?;
            let mut coordinates = Vec::new();
            for name in names {
                let object = if name == "." { None } else { object_at(file, &group, &name)? };
                coordinates.push(match object {
                    Some(object) => Some(AxisCoordinates::read(file, &object, &name)?),
                    None => None,
                });
            }
            return Ok(Some(NexusSignal { address: array.address, coordinates }));
        }
        let default = attribute_text(file, &attributes, "default")?;
        let next = if default.is_empty() { None } else { object_at(file, &group, &default)? };
        let wanted: &[&str] = match attribute_text(file, &attributes, "NX_class")?.as_str() {
            "NXroot" | "" => &["NXentry"],
            "NXentry" | "NXsubentry" => &["NXdata"],
            "NXdata" => return old_signal(file, &group),
            _ => return Ok(None),
        };
        match next {
            Some(next) => group = next,
            None => match member_of_class(file, &group, wanted)? {
                Some(next) => group = next,
                None => return Ok(None),
            },
        }
    }
    Ok(None)
}

/// First member of a group that has one of the classes.
fn member_of_class(
    file: &Hdf5File<'_>,
    group: &Hdf5Object,
    classes: &[&str],
) -> Result<Option<Hdf5Object>, LoadError> {
    for link in group.links(file)?.into_iter().take(MAX_MEMBERS) {
        let LinkTarget::Object(address) = link.target else { continue };
        let member = Hdf5Object::read(file, address)?;
        let class = attribute_text(file, &member.attributes(file)?, "NX_class")?;
        if classes.contains(&class.as_str()) {
            return Ok(Some(member));
        }
    }
    Ok(None)
}

/// Array of a group of older files, which has an attribute `signal` itself.
fn old_signal(file: &Hdf5File<'_>, group: &Hdf5Object) -> Result<Option<NexusSignal>, LoadError> {
    for link in group.links(file)?.into_iter().take(MAX_MEMBERS) {
        let LinkTarget::Object(address) = link.target else { continue };
        let member = Hdf5Object::read(file, address)?;
        let attributes = member.attributes(file)?;
        if !attributes.iter().any(|attribute| attribute.name == "signal") {
            continue;
        }
        let mut coordinates = Vec::new();
        for name in attribute_text(file, &attributes, "axes")?.trim_matches(['[', ']']).split([':', ',']) {
            coordinates.push(match object_at(file, group, name.trim())? {
                Some(object) if object.is_dataset() => Some(AxisCoordinates::read(file, &object, name)?),
                _ => None,
            });
        }
        return Ok(Some(NexusSignal { address, coordinates }));
    }
    Ok(None)
}
