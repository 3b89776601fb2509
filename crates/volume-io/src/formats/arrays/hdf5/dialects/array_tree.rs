//! Tree of a file's groups: paths to objects, and a list of all arrays.

use std::collections::BTreeSet;

use super::super::container::{Hdf5File, Hdf5Link, Hdf5Object, LinkTarget};
use super::super::storage::Hdf5Array;
use chiaroscuro_volume::LoadError;

/// Maximum number of arrays that are listed, of groups that are searched, and of groups within groups.
const MAX_ARRAYS: usize = 1024;
const MAX_GROUPS: usize = 1 << 14;
const MAX_DEPTH: usize = 32;

/// Maximum number of links that are followed to one object.
const MAX_FOLLOWED: usize = 16;

/// Array of a file with its path.
#[derive(Debug, Clone)]
pub(super) struct FoundArray {
    /// Path from the root, without a slash before it.
    pub(super) path: String,
    pub(super) object: Hdf5Object,
    pub(super) array: Hdf5Array,
}

/// Arrays of a file.
#[derive(Debug, Default)]
pub(super) struct ArrayTree {
    pub(super) arrays: Vec<FoundArray>,
    /// Errors of arrays and groups that cannot be read.
    pub(super) refused: Vec<LoadError>,
}

/// Passes on errors that concern the whole load, and returns those of a part.
pub(super) fn partial<T>(result: Result<T, LoadError>) -> Result<Result<T, LoadError>, LoadError> {
    match result {
        Err(error @ (LoadError::BadInput(_) | LoadError::Limit(_))) => Ok(Err(error)),
        Err(error) => Err(error),
        Ok(found) => Ok(Ok(found)),
    }
}

impl ArrayTree {
    /// Lists the arrays below a group, except in groups whose names begin with a number sign: MATLAB stores there what
    /// variables refer to.
    pub(super) fn list(file: &Hdf5File<'_>, root: &Hdf5Object) -> Result<Self, LoadError> {
        let mut found = Self::default();
        let mut visited = BTreeSet::from([root.address]);
        let mut waiting = vec![(String::new(), root.clone(), 0)];
        while let Some((path, group, depth)) = waiting.pop() {
            let links = match partial(group.links(file))? {
                Ok(links) => links,
                Err(error) => {
                    found.refused.push(error);
                    continue;
                }
            };
            let mut groups = Vec::new();
            for Hdf5Link { name, target } in links {
                let LinkTarget::Object(address) = target else { continue };
                let is_full =
                    found.arrays.len() + found.refused.len() >= MAX_ARRAYS || visited.len() >= MAX_GROUPS;
                if is_full || name.starts_with('#') || !visited.insert(address) {
                    continue;
                }
                file.control().check()?;
                let path = if path.is_empty() { name } else { format!("{path}/{name}") };
                let object = match partial(Hdf5Object::read(file, address))? {
                    Ok(object) => object,
                    Err(error) => {
                        found.refused.push(error);
                        continue;
                    }
                };
                if object.is_dataset() {
                    match partial(Hdf5Array::open(file, &object, &path))? {
                        Ok(array) => found.arrays.push(FoundArray { path, object, array }),
                        Err(error) => found.refused.push(error),
                    }
                } else if depth < MAX_DEPTH {
                    groups.push((path, object, depth + 1));
                }
            }
            waiting.extend(groups.into_iter().rev());
        }
        Ok(found)
    }
}

/// Returns the object at a path from a group, or from the root where the path begins with a slash; `None` if there is
/// none in this file.
pub(super) fn object_at(
    file: &Hdf5File<'_>,
    from: &Hdf5Object,
    path: &str,
) -> Result<Option<Hdf5Object>, LoadError> {
    let start = |path: &str| if path.starts_with('/') { file.root() } else { Ok(from.clone()) };
    let mut object = start(path)?;
    let parts = |path: &str| -> Vec<String> {
        path.split('/').filter(|part| !part.is_empty() && *part != ".").rev().map(str::to_owned).collect()
    };
    let mut left = parts(path);
    let mut followed = 0;
    while let Some(name) = left.pop() {
        file.control().check()?;
        let links = object.links(file)?;
        match links.into_iter().find(|link| link.name == name).map(|link| link.target) {
            Some(LinkTarget::Object(address)) => object = Hdf5Object::read(file, address)?,
            Some(LinkTarget::Path(path)) if followed < MAX_FOLLOWED => {
                followed += 1;
                if path.starts_with('/') {
                    object = file.root()?;
                }
                left.extend(parts(&path));
            }
            _ => return Ok(None),
        }
    }
    Ok(Some(object))
}
