//! Record of a look together with its volume: the format of session files and of metadata in exported images.
//!
//! Settings are at the top level, as in a preset; everything else has a name that begins with an underscore, which
//! readers of presets ignore.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::json_limits::{self, BoundedTree};
use super::layer_fields::{full_path, move_into_layer};
use super::path_encoding::{decode_path, encode_path};
use super::renames::rename_old_names;
use super::schema_defaults::fill_in_defaults;
use super::unknown_content;
use crate::{AppliedSettings, ImageSpec, PresetError, Settings, VolumeLocation, apply_relative};
use chiaroscuro_files::{MAX_LOOK_BYTES, with_provenance_mark};
use chiaroscuro_volume::{Corrections, Dataset, FieldOrigin, ValueRanges, VolumeChoice};

/// Name of the setting that belongs to a record's volume, and not to its look.
const CORRECTIONS: &str = "volume";

/// Latest schema that changed images: later ones only move settings.
const PICTURE_SCHEMA: u64 = 3;

/// Reference to the volume of a look.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VolumeRecord {
    /// Path of the file, relative to the record's folder if it is inside, or `builtin:NAME`.
    pub source: String,
    /// Lossless encoding of that path ([`encode_path`]), if `source` cannot represent it: file names need not be
    /// text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source_bytes: Option<String>,
    /// Identifier of the file's values and geometry (its content ID), in 16 hexadecimal digits.
    pub content_id: String,
    /// Selected volume, if the file has several.
    #[serde(default, skip_serializing_if = "VolumeChoice::is_empty")]
    pub choice: VolumeChoice,
    /// Further volumes that are shown with it, one for each further layer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<Self>,
}

/// Metadata of a rendered image.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageRecord {
    /// Size, samples and format of the image.
    #[serde(flatten)]
    pub image: ImageSpec,
    /// Version of Chiaroscuro that rendered it.
    pub version: String,
    /// Name of the graphics adapter and its driver.
    pub adapter: String,
    /// Resolution levels that it shows beside the one in memory.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finer_levels: Option<FinerLevelRecord>,
}

/// Resolution levels of an image that were read page by page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FinerLevelRecord {
    /// Key of the finest of them.
    pub finest: String,
    /// True if a finer one was called for by the size of the image, and did not fit into the memory for pages.
    pub is_substituted: bool,
}

/// Settings and metadata as read from a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LookRecord {
    overlay: Value,
    /// Descriptions of what was cut while reading.
    cuts: Vec<String>,
    /// Volume of the look, if recorded.
    pub volume: Option<VolumeRecord>,
    /// Metadata of the image that contains the record.
    pub image: Option<ImageRecord>,
    /// File from which the record was read, in whose folder its volumes may be.
    pub file: Option<PathBuf>,
}

impl VolumeRecord {
    /// Creates a reference to a volume opened from `source`, for a record that will be written to `folder`.
    pub fn new(source: impl AsRef<Path>, content_id: u64, folder: Option<&Path>) -> Self {
        let source = source.as_ref();
        let is_builtin = source.to_str().is_some_and(|name| name.starts_with("builtin:"));
        let path = if is_builtin { source.to_owned() } else { relative_path(source, folder) };
        let content_id = format!("{content_id:016x}");
        let (source_bytes, choice) = (encode_path(&path), VolumeChoice::default());
        Self { source: path.display().to_string(), source_bytes, content_id, choice, layers: Vec::new() }
    }

    /// Creates a reference to a volume and to those that are shown with it as layers, for a record that will be
    /// written to `folder`; `None` if there is no volume.
    pub fn from_volumes(volumes: &[FieldOrigin], folder: Option<&Path>) -> Option<Self> {
        let (FieldOrigin { source, opened_id, choice }, further) = volumes.split_first()?;
        Some(
            Self::new(source, *opened_id, folder)
                .with_choice(choice.clone())
                .with_layers(further.iter(), folder),
        )
    }

    /// Adds the further fields of a dataset, for a record that will be written to `folder`.
    #[must_use]
    pub fn with_layers_of(self, dataset: &Dataset, folder: Option<&Path>) -> Self {
        self.with_layers(dataset.further_origins(), folder)
    }

    /// Adds further volumes that are shown as layers, for a record that will be written to `folder`.
    #[must_use]
    pub fn with_layers<'a>(
        self,
        origins: impl Iterator<Item = &'a FieldOrigin>,
        folder: Option<&Path>,
    ) -> Self {
        let record = |FieldOrigin { source, opened_id, choice }: &FieldOrigin| {
            Self::new(source, *opened_id, folder).with_choice(choice.clone())
        };
        Self { layers: origins.map(record).collect(), ..self }
    }

    /// Sets the selected volume of a file with several.
    #[must_use]
    pub fn with_choice(self, choice: VolumeChoice) -> Self {
        Self { choice, ..self }
    }

    /// Returns the path of the volume. The encoded path is used only if it matches `source`.
    fn path(&self) -> PathBuf {
        let bytes = self.source_bytes.as_deref().and_then(decode_path);
        let path = bytes.filter(|path| path.to_string_lossy() == self.source.as_str());
        path.unwrap_or_else(|| PathBuf::from(&self.source))
    }

    /// Returns the location of the volume, for a record read from `folder`; `None` stands for a record that is in no
    /// folder.
    pub fn location(&self, folder: Option<&Path>) -> VolumeLocation {
        VolumeLocation::classify(&self.path(), folder)
    }

    /// Returns the source of the volume as it was recorded, for a record read from `folder`.
    pub fn origin(&self, folder: Option<&Path>) -> FieldOrigin {
        let path = self.path();
        let is_builtin = path.to_str().is_some_and(|name| name.starts_with("builtin:"));
        let source = match folder.filter(|_| !is_builtin) {
            // An absolute path replaces the folder.
            Some(folder) => folder.join(path),
            None => path,
        };
        let opened_id = u64::from_str_radix(&self.content_id, 16).unwrap_or_default();
        FieldOrigin { source, opened_id, choice: self.choice.clone() }
    }

    /// Returns true if a volume has the recorded values and geometry.
    pub fn matches_content(&self, content_id: u64) -> bool {
        self.content_id == format!("{content_id:016x}")
    }
}

impl ImageRecord {
    /// Creates the metadata of an image rendered by this version on an adapter.
    pub fn new(image_spec: ImageSpec, adapter: String) -> Self {
        Self { image: image_spec, version: env!("CARGO_PKG_VERSION").to_owned(), adapter, finer_levels: None }
    }
}

/// Returns a path relative to a folder if it lies inside, else the absolute path.
fn relative_path(source: &Path, folder: Option<&Path>) -> PathBuf {
    let whole = std::path::absolute(source).unwrap_or_else(|_| source.to_owned());
    // An empty path stands for the current folder.
    let folder_or_current =
        |folder: &Path| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() };
    let folder = folder.and_then(|folder| std::path::absolute(folder_or_current(folder)).ok());
    let below = folder.and_then(|folder| whole.strip_prefix(folder).ok().map(Path::to_owned));
    below.unwrap_or(whole)
}

impl LookRecord {
    /// Serialises a record of settings, volume and image metadata.
    pub fn to_json(
        settings: &Settings,
        volume: Option<&VolumeRecord>,
        picture: Option<&ImageRecord>,
    ) -> String {
        Self::to_json_with_unknown(settings, volume, picture, &Value::Null)
    }

    /// Serialises a record that replaces another, with the unknown content of the other; see [`Self::unknown_content`].
    pub fn to_json_with_unknown(
        settings: &Settings,
        volume: Option<&VolumeRecord>,
        picture: Option<&ImageRecord>,
        unknown: &Value,
    ) -> String {
        let mut tree = serde_json::to_value(settings).unwrap_or_default();
        if let Value::Object(fields) = &mut tree {
            let remarks = [
                ("_volume", volume.and_then(|volume| serde_json::to_value(volume).ok())),
                ("_picture", picture.and_then(|picture| serde_json::to_value(picture).ok())),
            ];
            for (name, value) in remarks {
                fields.extend(value.map(|value| (name.to_owned(), value)));
            }
        }
        unknown_content::merge_unknown(&mut tree, unknown);
        let tree = with_provenance_mark(tree);
        let pretty = serde_json::to_string_pretty(&tree).unwrap_or_default();
        // The longest transfer functions fit into the limit only without whitespace.
        if pretty.len() > MAX_LOOK_BYTES { tree.to_string() } else { pretty }
    }

    /// Parses a record. Any preset is a record without a volume.
    ///
    /// # Errors
    /// Returns an error if the text is not a JSON object, its metadata have the wrong type, or the limits of a look
    /// are exceeded.
    pub fn parse(text: &str) -> Result<Self, PresetError> {
        let BoundedTree { tree: overlay, cuts } = json_limits::parse_bounded(text)?;
        if !overlay.is_object() {
            return Err(PresetError::NotAnObject);
        }
        Ok(Self {
            volume: parse_remark(&overlay, "_volume")?,
            image: parse_remark(&overlay, "_picture")?,
            overlay,
            cuts,
            file: None,
        })
    }

    /// Parses a record from the bytes of a file.
    ///
    /// # Errors
    /// As [`Self::parse`], and if the bytes are not UTF-8.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PresetError> {
        Self::parse(std::str::from_utf8(bytes).map_err(PresetError::Encoding)?)
    }

    /// Returns true if all of the record is understood: nothing was cut, no setting is unknown or of a wrong type,
    /// and the version is not newer. Other content is lost when the record is saved again.
    #[cfg(test)]
    fn is_fully_understood(&self) -> bool {
        let applied = self.apply(&Settings::default(), &ValueRanges::UNIT);
        applied.is_ok_and(|applied| applied.warnings.is_empty())
    }

    /// Returns true if content beyond a look's limits was cut, which is lost when the record is saved again.
    pub fn was_cut(&self) -> bool {
        !self.cuts.is_empty()
    }

    /// Returns the record's schema number; a preset has none.
    pub fn schema(&self) -> Option<u64> {
        self.overlay.get("schema").and_then(Value::as_u64)
    }

    /// Returns the unknown settings and the remarks of other programs; null if there are none.
    pub fn unknown_content(&self) -> Value {
        let understood = self.apply(&Settings::default(), &ValueRanges::UNIT).map(|applied| applied.settings);
        let Ok(tree) = understood.map(|settings| serde_json::to_value(settings).unwrap_or_default()) else {
            return Value::Null;
        };
        let mut given = self.overlay.clone();
        rename_old_names("", &mut given);
        move_into_layer(&mut given);
        unknown_content::unknown_content(&given, &tree)
    }

    /// Returns true if the record has an earlier schema, whose images this version may render a little differently.
    pub fn has_earlier_schema(&self) -> bool {
        self.schema().is_some_and(|schema| schema < PICTURE_SCHEMA)
    }

    /// Returns true if the record sets the balance of the lights.
    pub fn has_balance(&self) -> bool {
        self.has_setting("shadows.balance")
    }

    /// Returns true if the record sets the setting at a path, explicitly or by its schema.
    pub fn has_setting(&self, path: &str) -> bool {
        let mut given = self.overlay.clone();
        rename_old_names("", &mut given);
        move_into_layer(&mut given);
        fill_in_defaults(&mut given);
        given.pointer(&format!("/{}", full_path(path).replace('.', "/"))).is_some()
    }

    /// Returns the recorded corrections, if `opened_id` identifies the record's volume as opened from the file.
    /// Records from before corrections existed have none.
    pub fn corrections_for(&self, opened_id: u64) -> Option<Corrections> {
        self.volume.as_ref().filter(|of| of.matches_content(opened_id))?;
        let recorded = self.overlay.get(CORRECTIONS).and_then(|said| Corrections::deserialize(said).ok());
        let mut corrections = recorded.unwrap_or_default();
        corrections.sanitise();
        Some(corrections)
    }

    /// Applies the record's settings to others, for a volume with the given value ranges, and returns them with
    /// warnings about what was not understood. Corrections stay unchanged: see [`Self::corrections_for`].
    ///
    /// # Errors
    /// As [`apply_relative`].
    pub fn apply(&self, over: &Settings, ranges: &ValueRanges) -> Result<AppliedSettings, PresetError> {
        let applied = apply_relative(over, &self.overlay, ranges)?;
        Ok(AppliedSettings { warnings: [self.cuts.clone(), applied.warnings].concat(), ..applied })
    }
}

fn parse_remark<T: serde::de::DeserializeOwned>(
    overlay: &Value,
    name: &str,
) -> Result<Option<T>, PresetError> {
    let found = overlay.get(name).filter(|value| !value.is_null());
    found.map(|value| T::deserialize(value).map_err(PresetError::WrongType)).transpose()
}
