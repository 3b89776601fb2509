//! Metadata of OME-Zarr (OME-NGFF 0.1 to 0.5): images in several resolutions, labels, and plates.
//!
//! After <https://ngff.openmicroscopy.org/specifications/index.html>. Files are read leniently: writers differ, and a
//! missing name or unit is no reason to refuse an image.

mod axes;
mod channels;
mod image_label;
mod transforms;

use serde_json::Value;

use super::LoadError;
use super::store::checked_path;
use chiaroscuro_volume::{FileLabelTable, LoadContext};

pub(super) use axes::{AxisRole, ImageAxis, axes_by_names, axes_by_position};
pub(super) use channels::OmeChannel;
pub(super) use transforms::AxisScale;

/// Maximum number of resolution levels: each has an eighth of the voxels of the one before.
const MAX_LEVELS: usize = 64;

/// Image in several resolutions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OmeImage {
    /// Axes, slowest first; empty where the metadata do not describe them.
    pub(super) axes: Vec<ImageAxis>,
    pub(super) levels: Vec<OmeLevel>,
    pub(super) channels: Vec<OmeChannel>,
    /// Names and colours of labels, if the image holds labels.
    pub(super) labels: Option<FileLabelTable>,
}

/// Resolution level of an image.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OmeLevel {
    /// Path of its array below that of the image.
    pub(super) path: String,
    /// Scale and translation of each axis; empty where they are 1 and 0.
    pub(super) scales: Vec<AxisScale>,
}

/// Returns the attributes of OME: below `ome` since version 0.5.
pub(super) fn ome_attributes(attributes: &Value) -> &Value {
    if attributes["ome"].is_object() { &attributes["ome"] } else { attributes }
}

impl OmeImage {
    /// Creates an image of a single array, of which no metadata of an image are known.
    pub(super) fn without_metadata() -> Self {
        let level = OmeLevel { path: String::new(), scales: Vec::new() };
        Self { axes: Vec::new(), levels: vec![level], channels: Vec::new(), labels: None }
    }

    /// Parses the attributes of a group; `None` if it is no image.
    ///
    /// # Errors
    /// `BadInput` for an image without levels, or with paths that lead out of the folder.
    pub(super) fn parse(
        context: LoadContext<'_>,
        path: &str,
        attributes: &Value,
    ) -> Result<Option<Self>, LoadError> {
        let attributes = ome_attributes(attributes);
        let Some(image) = attributes["multiscales"].as_array().and_then(|list| list.first()) else {
            return Ok(None);
        };
        let axes = axes::parse_axes(&image["axes"]);
        let field = format!("{}, multiscales", if path.is_empty() { "attributes" } else { path });
        let mut levels = Vec::new();
        for level in image["datasets"].as_array().into_iter().flatten().take(MAX_LEVELS) {
            let Some(name) = level["path"].as_str() else { continue };
            // The transforms of the image as a whole come after those of a level.
            let all = [&level["coordinateTransformations"], &image["coordinateTransformations"]];
            let scales = transforms::parse_transforms(&all, axes.len());
            levels.push(OmeLevel { path: checked_path(context, &field, name)?, scales });
        }
        if levels.is_empty() {
            return Err(context.bad_input_error(
                &field,
                "the image has no levels: datasets with a path were expected",
                "check the metadata, or write the image again",
            ));
        }
        let label = &attributes["image-label"];
        Ok(Some(Self {
            axes,
            levels,
            channels: channels::parse_channels(&attributes["omero"]["channels"]),
            labels: label.is_object().then(|| image_label::parse_labels(label)),
        }))
    }
}
