//! A look together with what it is of: what a session file holds, and what an exported picture carries.
//!
//! Settings stand at the top, as in a preset; what is no setting has a name that begins with an underscore,
//! which readers of presets pass over.

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ControlPoint, Depth};

    #[test]
    fn records_are_read_as_they_were_written() {
        let mut settings = Settings::default();
        settings.shadows.gain = 1.25;
        settings.views.insert(3, settings.camera.clone());
        let volume = VolumeRecord::new("builtin:chair", 0x1234, None);
        let picture = PictureRecord {
            shot: ImageSpec {
                transparent: true,
                samples: 2,
                depth: Depth::Sixteen,
                ..ImageSpec::new([640, 480])
            },
            version: "0.1.0".to_owned(),
            adapter: "an adapter".to_owned(),
        };
        let text = Record::text(&settings, Some(&volume), Some(&picture));
        let record = Record::read(&text).unwrap();
        assert_eq!((record.volume.as_ref(), record.picture.as_ref()), (Some(&volume), Some(&picture)));
        let (read, warnings) = record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
        assert_eq!((read, warnings), (settings, vec![]));
        assert!(volume.is_of(0x1234) && !volume.is_of(0x1235));
    }

    #[test]
    fn records_know_which_of_several_volumes_they_are_of() {
        let choice = Choice { frame: Some(3), series: Some("7".to_owned()), ..Choice::default() };
        let volume = VolumeRecord::new("a.nii", 1, None).choosing(choice);
        let text = Record::text(&Settings::default(), Some(&volume), None);
        assert_eq!(Record::read(&text).unwrap().volume, Some(volume.clone()));
        let only = VolumeRecord { choice: Choice::default(), ..volume };
        assert!(!Record::text(&Settings::default(), Some(&only), None).contains("choice"));
        assert!(
            Record::read(r#"{"_volume": {"source": "a", "content_id": "", "choice": {"frame": -1}}}"#)
                .is_err()
        );
    }

    #[test]
    fn corrections_go_with_the_volume_of_a_record_and_with_no_other() {
        let mut settings = Settings::default();
        settings.volume.spacing = Some([0.5, 0.5, 2.0]);
        settings.volume.flip.z = true;
        let volume = VolumeRecord::new("a.nrrd", 7, None);
        let record = Record::read(&Record::text(&settings, Some(&volume), None)).unwrap();
        assert_eq!(record.corrections_of(7), Some(settings.volume));
        assert_eq!(record.corrections_of(8), None);
        let (applied, warnings) = record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
        assert!(applied.volume.is_none() && warnings.is_empty() && record.is_understood(), "{warnings:?}");
        // From before there were any, and of no volume.
        let before = r#"{"schema": 2, "_volume": {"source": "a.nrrd", "content_id": "0000000000000007"}}"#;
        assert_eq!(Record::read(before).unwrap().corrections_of(7), Some(Corrections::default()));
        let of_none = Record::read(&Record::text(&settings, None, None)).unwrap();
        assert_eq!(of_none.corrections_of(7), None);
    }

    #[test]
    fn pictures_of_earlier_versions_have_eight_bits_and_a_sample_per_pixel() {
        let text =
            r#"{"_picture": {"size": [4, 3], "transparent": true, "version": "0.1.0", "adapter": "a"}}"#;
        let picture = Record::read(text).unwrap().picture.unwrap();
        assert_eq!(picture.shot, ImageSpec { transparent: true, ..ImageSpec::new([4, 3]) });
    }

    #[test]
    fn presets_are_records_of_nothing_and_nonsense_is_refused() {
        let record = Record::read(r#"{"shadows": {"gain": 2.0}}"#).unwrap();
        assert_eq!((&record.volume, &record.picture), (&None, &None));
        assert_eq!(record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().0.shadows.gain, 2.0);
        assert!(Record::read("[1]").is_err() && Record::read("{").is_err());
        assert!(Record::read(r#"{"_volume": {"source": 3}}"#).is_err());
    }

    #[test]
    fn what_others_have_written_is_written_again() {
        let text =
            r#"{"schema": 2, "_notes": "mine", "shadows": {"gain": 2.0, "glow": 3}, "ground": {"on": true}}"#;
        let record = Record::read(text).unwrap();
        let (settings, _) = record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
        let again = Record::text_with(&settings, None, None, &record.unknown());
        let read = Record::read(&again).unwrap();
        assert_eq!(read.overlay["_notes"], "mine");
        assert_eq!((&read.overlay["shadows"]["glow"], read.overlay.get("ground")), (&Value::from(3), None));
        assert_eq!(read.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().0, settings);
        assert_eq!(record.schema(), Some(2));
    }

    #[test]
    fn whether_a_record_is_understood_is_known() {
        let is_understood = |text: &str| Record::read(text).unwrap().is_understood();
        let whole = Record::text(&Settings::default(), None, None);
        assert!(is_understood(&whole) && is_understood(r#"{"_note": 1, "shadows": {"gain": 2.0}}"#));
        let nine = format!(r#"{{"lights": [{}{{}}]}}"#, "{},".repeat(8));
        for text in [r#"{"schema": 999}"#, r#"{"later": 1}"#, r#"{"shadows": {"gain": "much"}}"#, &nine] {
            assert!(!is_understood(text), "{text}");
        }
        let told = Record::read(&nine).unwrap().apply(&Settings::default(), &ValueRanges::UNIT).unwrap().1;
        assert_eq!(told, ["9 entries of `lights` were cut to 8"]);
    }

    #[test]
    fn the_longest_transfer_function_is_read_again() {
        let mut settings = Settings::default();
        let point = |at| ControlPoint::new(f64::from(at) / 7.0 - 1e3, [1.0 / 3.0; 3], f64::from(at) / 4321.0);
        settings.transfer.points = (0..4096).map(point).collect();
        settings.lighting.curve.points = settings.transfer.points[..2048].to_vec();
        let read = Record::read(&Record::text(&settings, None, None)).unwrap();
        assert_eq!(read.apply(&Settings::default(), &ValueRanges::UNIT).unwrap(), (settings, vec![]));
    }

    #[test]
    fn files_below_a_record_move_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("data/a.nrrd");
        let volume = VolumeRecord::new(&file, 7, Some(folder.path()));
        assert_eq!(Path::new(&volume.source), Path::new("data/a.nrrd"));
        assert_eq!(volume.place(Some(folder.path())), VolumePlace::Beside(file.clone()));
        assert_eq!(VolumeRecord::new("data/a.nrrd", 7, Some(Path::new(""))).source, volume.source);
        let elsewhere = VolumeRecord::new(&file, 7, Some(Path::new("/no/such/folder")));
        assert_eq!(Path::new(&elsewhere.source), file);
    }

    /// A name that is no text is that of the same file afterwards; bytes that say something else than what is shown
    /// are not believed.
    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_are_kept() {
        use std::os::unix::ffi::OsStrExt as _;
        let file = Path::new(std::ffi::OsStr::from_bytes(b"/data/t\xfcr.nrrd"));
        for (folder, place) in [
            (None, VolumePlace::Elsewhere(file.to_owned())),
            (Some(Path::new("/data")), VolumePlace::Beside(file.to_owned())),
        ] {
            let volume = VolumeRecord::new(file, 7, folder);
            let text = Record::text(&Settings::default(), Some(&volume), None);
            let read = Record::read(&text).unwrap().volume.unwrap();
            assert_eq!((&read, read.place(folder)), (&volume, place));
        }
        let told = VolumeRecord::new(file, 7, None);
        let other = VolumeRecord { source_bytes: Some("/etc/passwd".to_owned()), ..told.clone() };
        assert_eq!(other.place(None), VolumePlace::Elsewhere(told.source.into()));
        assert_eq!(VolumeRecord::new("/data/tür.nrrd", 7, None).source_bytes, None);
    }
}
