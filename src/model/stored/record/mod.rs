//! A look together with what it is of: what a session file holds, and what an exported picture carries.
//!
//! Settings stand at the top, as in a preset; what is no setting has a name that begins with an underscore,
//! which readers of presets pass over.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::bounds::{self, Bounded, MAX_LOOK_BYTES};
use super::made_by::tells_maker;
use super::path_text::{decode_path, encode_path};
use super::renames::rename;
use super::schemas::complete;
use super::unknown;
use crate::data::load::Choice;
use crate::data::{Corrections, ValueRanges};
use crate::model::{ImageSpec, PresetError, SCHEMA, Settings, VolumePlace, apply_relative};

/// The name of the setting that is of the volume of a record, and not of its look.
const CORRECTIONS: &str = "volume";

/// The volume of a look.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VolumeRecord {
    /// A file, relative to that of the record where it lies below it, or `builtin:NAME`.
    pub source: String,
    /// Every byte of that file's path ([`encode_path`]), where `source` cannot say it: not all names are text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source_bytes: Option<String>,
    /// Identifies values and geometry of the file, in hexadecimal digits.
    pub content_id: String,
    /// Which of several volumes of the file it is.
    #[serde(default, skip_serializing_if = "Choice::is_empty")]
    pub choice: Choice,
}

/// How a picture was made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureRecord {
    /// Size and fineness.
    #[serde(flatten)]
    pub shot: ImageSpec,
    /// Version of this program.
    pub version: String,
    /// The graphics adapter and its driver.
    pub adapter: String,
}

/// What a file says beside the settings, and the settings as they are written there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    overlay: Value,
    /// What was cut when it was read.
    cuts: Vec<String>,
    /// What it is of.
    pub volume: Option<VolumeRecord>,
    /// How the picture that carries it was made.
    pub picture: Option<PictureRecord>,
}

impl VolumeRecord {
    /// A volume that was opened from `source`, for a record that is written to `folder`.
    pub fn new(source: impl AsRef<Path>, content_id: u64, folder: Option<&Path>) -> Self {
        let source = source.as_ref();
        let is_builtin = source.to_str().is_some_and(|name| name.starts_with("builtin:"));
        let path = if is_builtin { source.to_owned() } else { relative(source, folder) };
        let content_id = format!("{content_id:016x}");
        let (source_bytes, choice) = (encode_path(&path), Choice::default());
        Self { source: path.display().to_string(), source_bytes, content_id, choice }
    }

    /// Which of several volumes of the file it is.
    #[must_use]
    pub fn choosing(self, choice: Choice) -> Self {
        Self { choice, ..self }
    }

    /// What was opened. Bytes count only where they are what `source` shows as well as it can.
    fn path(&self) -> PathBuf {
        let bytes = self.source_bytes.as_deref().and_then(decode_path);
        let path = bytes.filter(|path| path.to_string_lossy() == self.source.as_str());
        path.unwrap_or_else(|| PathBuf::from(&self.source))
    }

    /// Where it is, for a record that was read from `folder`; without one, as for a record that is in no folder.
    pub fn place(&self, folder: Option<&Path>) -> VolumePlace {
        VolumePlace::of(&self.path(), folder)
    }

    /// Whether a volume has the values and the geometry that this one had.
    pub fn is_of(&self, content_id: u64) -> bool {
        self.content_id == format!("{content_id:016x}")
    }
}

impl PictureRecord {
    /// A picture that this version makes on an adapter.
    pub fn new(shot: ImageSpec, adapter: String) -> Self {
        Self { shot, version: env!("CARGO_PKG_VERSION").to_owned(), adapter }
    }
}

/// A path as seen from a folder, if it lies below it; else the whole of it.
fn relative(source: &Path, folder: Option<&Path>) -> PathBuf {
    let whole = std::path::absolute(source).unwrap_or_else(|_| source.to_owned());
    // The folder of a bare name is the current one.
    let here =
        |folder: &Path| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() };
    let folder = folder.and_then(|folder| std::path::absolute(here(folder)).ok());
    let below = folder.and_then(|folder| whole.strip_prefix(folder).ok().map(Path::to_owned));
    below.unwrap_or(whole)
}

impl Record {
    /// The text of a record.
    pub fn text(
        settings: &Settings,
        volume: Option<&VolumeRecord>,
        picture: Option<&PictureRecord>,
    ) -> String {
        Self::text_with(settings, volume, picture, &Value::Null)
    }

    /// The text of a record that takes the place of another, which said something that this version does not know;
    /// see [`Self::unknown`].
    pub fn text_with(
        settings: &Settings,
        volume: Option<&VolumeRecord>,
        picture: Option<&PictureRecord>,
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
        unknown::add(&mut tree, unknown);
        let tree = tells_maker(tree);
        let pretty = serde_json::to_string_pretty(&tree).unwrap_or_default();
        // The longest transfer functions are within what is read only without spaces.
        if pretty.len() > MAX_LOOK_BYTES { tree.to_string() } else { pretty }
    }

    /// Reads a record. Any preset is one, of no volume.
    ///
    /// # Errors
    /// When the text is not a JSON object, its remarks have the wrong form, or it has more than any look.
    pub fn read(text: &str) -> Result<Self, PresetError> {
        let Bounded { tree: overlay, cuts } = bounds::read(text)?;
        if !overlay.is_object() {
            return Err(PresetError::NotAnObject);
        }
        Ok(Self {
            volume: remark(&overlay, "_volume")?,
            picture: remark(&overlay, "_picture")?,
            overlay,
            cuts,
        })
    }

    /// Reads a record from the bytes of a file.
    ///
    /// # Errors
    /// As [`Self::read`], and when the bytes are no text.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PresetError> {
        Self::read(std::str::from_utf8(bytes).map_err(PresetError::NoText)?)
    }

    /// Whether all settings of the record are understood: nothing was cut, none is unknown or of a wrong form, and it
    /// is not of a newer version. What is not understood is lost where the record is written again.
    pub fn is_understood(&self) -> bool {
        let applied = self.apply(&Settings::default(), &ValueRanges::UNIT);
        applied.is_ok_and(|(_, warnings)| warnings.is_empty())
    }

    /// Whether something was cut, because it was more than a look has: it would be lost where the record is written
    /// again.
    pub fn was_cut(&self) -> bool {
        !self.cuts.is_empty()
    }

    /// The schema that the record names; a preset names none.
    pub fn schema(&self) -> Option<u64> {
        self.overlay.get("schema").and_then(Value::as_u64)
    }

    /// What the record says that this version does not know, and remarks of others; null if there is nothing.
    pub fn unknown(&self) -> Value {
        let understood = self.apply(&Settings::default(), &ValueRanges::UNIT).map(|(settings, _)| settings);
        let Ok(tree) = understood.map(|settings| serde_json::to_value(settings).unwrap_or_default()) else {
            return Value::Null;
        };
        let mut given = self.overlay.clone();
        rename("", &mut given);
        unknown::beyond(&given, &tree)
    }

    /// Whether the record is of an earlier schema, whose pictures this version may make a little differently.
    pub fn is_earlier(&self) -> bool {
        self.schema().is_some_and(|schema| schema < SCHEMA.into())
    }

    /// Whether the record says how the lights are balanced.
    pub fn names_balance(&self) -> bool {
        self.names("shadows.balance")
    }

    /// Whether the record says something of a setting, by its path: also by its schema alone.
    pub fn names(&self, path: &str) -> bool {
        let mut given = self.overlay.clone();
        rename("", &mut given);
        complete(&mut given);
        given.pointer(&format!("/{}", path.replace('.', "/"))).is_some()
    }

    /// How the volume of the record was corrected, if a volume is that one: `opened_id` is that of the file. Records from
    /// before there were corrections are of volumes without any.
    pub fn corrections_of(&self, opened_id: u64) -> Option<Corrections> {
        self.volume.as_ref().filter(|of| of.is_of(opened_id))?;
        let said = self.overlay.get(CORRECTIONS).and_then(|said| Corrections::deserialize(said).ok());
        let mut corrections = said.unwrap_or_default();
        corrections.sanitise();
        Some(corrections)
    }

    /// The settings of the record laid over others, for a volume with these values, and warnings of what was not
    /// understood. What is corrected of the volume stays as it is: see [`Self::corrections_of`].
    ///
    /// # Errors
    /// As [`apply_relative`].
    pub fn apply(
        &self,
        over: &Settings,
        ranges: &ValueRanges,
    ) -> Result<(Settings, Vec<String>), PresetError> {
        let (settings, warnings) = apply_relative(over, &self.overlay, ranges)?;
        Ok((settings, [self.cuts.clone(), warnings].concat()))
    }
}

fn remark<T: serde::de::DeserializeOwned>(overlay: &Value, name: &str) -> Result<Option<T>, PresetError> {
    let found = overlay.get(name).filter(|value| !value.is_null());
    found.map(|value| T::deserialize(value).map_err(PresetError::Form)).transpose()
}
