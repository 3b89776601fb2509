//! Images and arrays of a hierarchy, one of which is opened.

use serde_json::Value;

use super::array::ZarrNode;
use super::ome::{OmeImage, ome_attributes};
use super::store::{Store, checked_path, join};
use super::{FileDimension, LoadControl, LoadError, LoadOptions, VolumeOffer};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::LoadContext;

/// Maximum number of images and arrays that are offered.
const MAX_OFFERS: usize = 1024;

/// Maximum depth at which arrays are looked for below a group.
const MAX_DEPTH: usize = 4;

/// Maximum number of groups that are looked into.
const MAX_GROUPS: usize = 2048;

/// Image, or array without the metadata of one.
#[derive(Debug)]
pub(super) struct HierarchyEntry {
    /// Path of its group or array.
    pub(super) path: String,
    /// Metadata of an image; `None` for an array.
    pub(super) image: Option<OmeImage>,
}

/// Hierarchy that is searched for images.
pub(super) struct Hierarchy<'a> {
    context: LoadContext<'a>,
    store: &'a dyn Store,
    options: &'a LoadOptions,
    control: &'a LoadControl,
}

impl<'a> Hierarchy<'a> {
    pub(super) fn new(
        context: LoadContext<'a>,
        store: &'a dyn Store,
        options: &'a LoadOptions,
        control: &'a LoadControl,
    ) -> Self {
        Self { context, store, options, control }
    }

    /// Returns the image or array to open, by the user's choice where there are several. An image comes before its
    /// labels.
    ///
    /// # Errors
    /// [`LoadError::Several`] for several images of which none is selected, `BadInput` for a hierarchy without any.
    pub(super) fn choose(&self) -> Result<HierarchyEntry, LoadError> {
        let Some(root) = self.node("")? else {
            return Err(self.context.bad_input_error(
                "",
                "it has no metadata of Zarr: zarr.json, .zgroup or .zarray was expected",
                "open the folder of the image, which holds one of them",
            ));
        };
        let attributes = ome_attributes(root.attributes());
        if let Some(image) = self.image("", root.attributes())? {
            return self.choose_labels(image);
        }
        if matches!(root, ZarrNode::Array(_)) {
            return Ok(HierarchyEntry { path: String::new(), image: None });
        }
        let paths = if attributes["plate"].is_object() {
            self.plate_paths(&attributes["plate"])?
        } else if attributes["well"].is_object() {
            self.paths_in(&attributes["well"]["images"], "")?
        } else if attributes["bioformats2raw.layout"].is_number() {
            self.series_paths()?
        } else {
            Vec::new()
        };
        if paths.is_empty() { self.choose_found() } else { self.choose_image(&paths) }
    }

    fn node(&self, path: &str) -> Result<Option<ZarrNode>, LoadError> {
        ZarrNode::read(self.context, self.store, path)
    }

    fn image(&self, path: &str, attributes: &Value) -> Result<Option<OmeImage>, LoadError> {
        OmeImage::parse(self.context, path, attributes)
    }

    /// Chooses between the image at the root and its labels.
    fn choose_labels(&self, image: OmeImage) -> Result<HierarchyEntry, LoadError> {
        let labels = self.node("labels")?;
        let names = labels.as_ref().map(|node| ome_attributes(node.attributes())["labels"].clone());
        let paths = self.paths_in(&names.unwrap_or_default(), "labels")?;
        if paths.is_empty() {
            return Ok(HierarchyEntry { path: String::new(), image: Some(image) });
        }
        let keys = std::iter::once("image".to_owned()).chain(paths);
        let offers: Vec<VolumeOffer> = keys.map(offer).collect();
        let choice = match self.options.choice.array {
            None => self.options.choice.clone().with_selected(FileDimension::Array, "image"),
            Some(_) => self.options.choice.clone(),
        };
        let chosen = self.context.resolve_choice(&choice, FileDimension::Array, offers.clone())?;
        if chosen == 0 {
            return Ok(HierarchyEntry { path: String::new(), image: Some(image) });
        }
        self.image_at(&offers[chosen].key)
    }

    /// Chooses one of several images by their paths.
    fn choose_image(&self, paths: &[String]) -> Result<HierarchyEntry, LoadError> {
        let offers: Vec<VolumeOffer> = paths.iter().take(MAX_OFFERS).cloned().map(offer).collect();
        let chosen = self.context.resolve_choice(&self.options.choice, FileDimension::Array, offers)?;
        self.image_at(&paths[chosen])
    }

    fn image_at(&self, path: &str) -> Result<HierarchyEntry, LoadError> {
        let node = self.node(path)?;
        let image = node.map(|node| self.image(path, node.attributes())).transpose()?.flatten();
        let image = image.ok_or_else(|| {
            self.context.bad_input_error(
                path,
                "no image is there: attributes with multiscales were expected",
                "copy the folder again, or choose another image with --array",
            )
        })?;
        Ok(HierarchyEntry { path: path.to_owned(), image: Some(image) })
    }

    /// Chooses one of the images and arrays that are found below the root.
    fn choose_found(&self) -> Result<HierarchyEntry, LoadError> {
        let mut found = Vec::new();
        let mut refused = None;
        let mut groups = vec![(String::new(), 0)];
        let mut looked_into = 0;
        while let Some((group, depth)) = groups.pop() {
            self.control.check()?;
            looked_into += 1;
            let children = self.store.children(&group);
            for name in children.map_err(|error| error.into_load_error(self.context, &group))? {
                let path = join(&group, &name);
                match self.node(&path) {
                    Ok(Some(ZarrNode::Array(array))) if array.shape.len() >= 2 => {
                        found.push(HierarchyEntry { path, image: None });
                    }
                    Ok(Some(ZarrNode::Group(attributes))) => match self.image(&path, &attributes)? {
                        Some(image) => found.push(HierarchyEntry { path, image: Some(image) }),
                        None if depth < MAX_DEPTH => groups.push((path, depth + 1)),
                        None => {}
                    },
                    // The array of a type that is not supported does not hide the others.
                    Err(error @ LoadError::BadInput(_)) => refused = Some(error),
                    Err(error) => return Err(error),
                    Ok(_) => {}
                }
            }
            if found.len() >= MAX_OFFERS || looked_into >= MAX_GROUPS {
                break;
            }
        }
        if found.is_empty() {
            return Err(refused.unwrap_or_else(|| {
                self.context.bad_input_error(
                    "",
                    "it holds no image, and no array of two or more dimensions",
                    "open the folder of an image or of an array",
                )
            }));
        }
        found.sort_by(|a, b| a.path.cmp(&b.path));
        let offers = found.iter().map(|entry| offer(entry.path.clone())).collect();
        let chosen = self.context.resolve_choice(&self.options.choice, FileDimension::Array, offers)?;
        Ok(found.swap_remove(chosen))
    }

    /// Paths of the images of a plate: those of each well.
    fn plate_paths(&self, plate: &Value) -> Result<Vec<String>, LoadError> {
        let mut paths = Vec::new();
        for well in self.paths_in(&plate["wells"], "")? {
            let Some(node) = self.node(&well)? else { continue };
            paths.extend(self.paths_in(&ome_attributes(node.attributes())["well"]["images"], &well)?);
            if paths.len() >= MAX_OFFERS {
                break;
            }
        }
        Ok(paths)
    }

    /// Paths of the images of a converted file: as the group `OME` lists them, or else by their numbers.
    fn series_paths(&self) -> Result<Vec<String>, LoadError> {
        if let Some(listed) = self.node("OME")? {
            let paths = self.paths_in(&ome_attributes(listed.attributes())["series"], "")?;
            if !paths.is_empty() {
                return Ok(paths);
            }
        }
        let names = self.store.children("").map_err(|error| error.into_load_error(self.context, ""))?;
        let mut numbers: Vec<u64> = names.iter().filter_map(|name| name.parse().ok()).collect();
        numbers.sort_unstable();
        Ok(numbers.iter().map(u64::to_string).collect())
    }

    /// Paths in a list of names, or of objects with a path, below a group.
    fn paths_in(&self, list: &Value, group: &str) -> Result<Vec<String>, LoadError> {
        let names = list.as_array().into_iter().flatten().take(MAX_OFFERS);
        let names = names.filter_map(|entry| entry["path"].as_str().or_else(|| entry.as_str()));
        let field = join(group, "attributes");
        names.map(|name| checked_path(self.context, &field, name).map(|path| join(group, &path))).collect()
    }
}

/// Offer of an image or array at a path.
fn offer(path: String) -> VolumeOffer {
    VolumeOffer { name: sanitised(&path, 80), key: path, dims: None, color: None }
}
