//! Tests of records: round trips, unknown content, and rejected input.

use super::*;
use crate::{ControlPoint, PixelFormat, SavedEntry};

#[test]
fn records_are_read_as_they_were_written() {
    let mut settings = Settings::default();
    settings.shadows.gain = 1.25;
    assert!(settings.save_view_for_digit(3, "front"));
    let bone = SavedEntry::look("bone", &settings);
    assert!(settings.save_entry(bone));
    let volume = VolumeRecord::new("builtin:chair", 0x1234, None);
    let picture = ImageRecord {
        image: ImageSpec {
            transparent: true,
            samples: 2,
            depth: PixelFormat::Sixteen,
            ..ImageSpec::new([640, 480])
        },
        version: "0.1.0".to_owned(),
        adapter: "an adapter".to_owned(),
        finer_levels: Some(FinerLevelRecord { finest: "0".to_owned(), is_substituted: false }),
    };
    let text = LookRecord::to_json(&settings, Some(&volume), Some(&picture));
    let record = LookRecord::parse(&text).unwrap();
    assert_eq!((record.volume.as_ref(), record.image.as_ref()), (Some(&volume), Some(&picture)));
    let AppliedSettings { settings: read, warnings } =
        record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
    assert_eq!((read, warnings), (settings, vec![]));
    assert!(volume.matches_content(0x1234) && !volume.matches_content(0x1235));
}

#[test]
fn records_know_which_of_several_volumes_they_are_of() {
    let choice = VolumeChoice { frame: Some(3), series: Some("7".to_owned()), ..VolumeChoice::default() };
    let volume = VolumeRecord::new("a.nii", 1, None).with_choice(choice);
    let text = LookRecord::to_json(&Settings::default(), Some(&volume), None);
    assert_eq!(LookRecord::parse(&text).unwrap().volume, Some(volume.clone()));
    let only = VolumeRecord { choice: VolumeChoice::default(), ..volume };
    assert!(!LookRecord::to_json(&Settings::default(), Some(&only), None).contains("choice"));
    assert!(
        LookRecord::parse(r#"{"_volume": {"source": "a", "content_id": "", "choice": {"frame": -1}}}"#)
            .is_err()
    );
}

#[test]
fn corrections_go_with_the_volume_of_a_record_and_with_no_other() {
    let mut settings = Settings::default();
    settings.volume.spacing = Some([0.5, 0.5, 2.0]);
    settings.volume.flip.z = true;
    let volume = VolumeRecord::new("a.nrrd", 7, None);
    let record = LookRecord::parse(&LookRecord::to_json(&settings, Some(&volume), None)).unwrap();
    assert_eq!(record.corrections_for(7), Some(settings.volume));
    assert_eq!(record.corrections_for(8), None);
    let AppliedSettings { settings: applied, warnings } =
        record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
    assert!(applied.volume.is_none() && warnings.is_empty() && record.is_fully_understood(), "{warnings:?}");
    // A record from before corrections existed, and one without a volume.
    let before = r#"{"schema": 2, "_volume": {"source": "a.nrrd", "content_id": "0000000000000007"}}"#;
    assert_eq!(LookRecord::parse(before).unwrap().corrections_for(7), Some(Corrections::default()));
    let of_none = LookRecord::parse(&LookRecord::to_json(&settings, None, None)).unwrap();
    assert_eq!(of_none.corrections_for(7), None);
}

#[test]
fn pictures_of_earlier_versions_have_eight_bits_and_a_sample_per_pixel() {
    let text = r#"{"_picture": {"size": [4, 3], "transparent": true, "version": "0.1.0", "adapter": "a"}}"#;
    let picture = LookRecord::parse(text).unwrap().image.unwrap();
    assert_eq!(picture.image, ImageSpec { transparent: true, ..ImageSpec::new([4, 3]) });
}

#[test]
fn presets_are_records_of_nothing_and_nonsense_is_refused() {
    let record = LookRecord::parse(r#"{"shadows": {"gain": 2.0}}"#).unwrap();
    assert_eq!((&record.volume, &record.image), (&None, &None));
    assert_eq!(record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings.shadows.gain, 2.0);
    assert!(LookRecord::parse("[1]").is_err() && LookRecord::parse("{").is_err());
    assert!(LookRecord::parse(r#"{"_volume": {"source": 3}}"#).is_err());
}

#[test]
fn what_others_have_written_is_written_again() {
    let text =
        r#"{"schema": 2, "_notes": "mine", "shadows": {"gain": 2.0, "glow": 3}, "ground": {"on": true}}"#;
    let record = LookRecord::parse(text).unwrap();
    let settings = record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings;
    let again = LookRecord::to_json_with_unknown(&settings, None, None, &record.unknown_content());
    let read = LookRecord::parse(&again).unwrap();
    assert_eq!(read.overlay["_notes"], "mine");
    assert_eq!((&read.overlay["shadows"]["glow"], read.overlay.get("ground")), (&Value::from(3), None));
    assert_eq!(read.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings, settings);
    assert_eq!(record.schema(), Some(2));
}

#[test]
fn whether_a_record_is_understood_is_known() {
    let is_understood = |text: &str| LookRecord::parse(text).unwrap().is_fully_understood();
    let whole = LookRecord::to_json(&Settings::default(), None, None);
    assert!(is_understood(&whole) && is_understood(r#"{"_note": 1, "shadows": {"gain": 2.0}}"#));
    let nine = format!(r#"{{"lights": [{}{{}}]}}"#, "{},".repeat(8));
    for text in [r#"{"schema": 999}"#, r#"{"later": 1}"#, r#"{"shadows": {"gain": "much"}}"#, &nine] {
        assert!(!is_understood(text), "{text}");
    }
    let told =
        LookRecord::parse(&nine).unwrap().apply(&Settings::default(), &ValueRanges::UNIT).unwrap().warnings;
    assert_eq!(told, ["9 entries of `lights` were cut to 8"]);
}

#[test]
fn the_longest_transfer_function_is_read_again() {
    let mut settings = Settings::default();
    let point = |at| ControlPoint::new(f64::from(at) / 7.0 - 1e3, [1.0 / 3.0; 3], f64::from(at) / 4321.0);
    settings.layer_mut().transfer.points = (0..4096).map(point).collect();
    settings.layer_mut().lighting.curve.points = settings.layer().transfer.points[..2048].to_vec();
    let read = LookRecord::parse(&LookRecord::to_json(&settings, None, None)).unwrap();
    assert_eq!(
        read.apply(&Settings::default(), &ValueRanges::UNIT).unwrap(),
        AppliedSettings { settings, warnings: vec![] }
    );
}

#[test]
fn files_below_a_record_move_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("data/a.nrrd");
    let volume = VolumeRecord::new(&file, 7, Some(folder.path()));
    assert_eq!(Path::new(&volume.source), Path::new("data/a.nrrd"));
    assert_eq!(volume.location(Some(folder.path())), VolumeLocation::InRecordFolder(file.clone()));
    assert_eq!(VolumeRecord::new("data/a.nrrd", 7, Some(Path::new(""))).source, volume.source);
    let elsewhere = VolumeRecord::new(&file, 7, Some(Path::new("/no/such/folder")));
    assert_eq!(Path::new(&elsewhere.source), file);
}

/// Checks that a path that is not UTF-8 refers to the same file after a round trip; an encoded path that contradicts
/// the displayed one is ignored.
#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_kept() {
    use std::os::unix::ffi::OsStrExt as _;
    let file = Path::new(std::ffi::OsStr::from_bytes(b"/data/t\xfcr.nrrd"));
    for (folder, place) in [
        (None, VolumeLocation::OtherFolder(file.to_owned())),
        (Some(Path::new("/data")), VolumeLocation::InRecordFolder(file.to_owned())),
    ] {
        let volume = VolumeRecord::new(file, 7, folder);
        let text = LookRecord::to_json(&Settings::default(), Some(&volume), None);
        let read = LookRecord::parse(&text).unwrap().volume.unwrap();
        assert_eq!((&read, read.location(folder)), (&volume, place));
    }
    let told = VolumeRecord::new(file, 7, None);
    let other = VolumeRecord { source_bytes: Some("/etc/passwd".to_owned()), ..told.clone() };
    assert_eq!(other.location(None), VolumeLocation::OtherFolder(told.source.into()));
    assert_eq!(VolumeRecord::new("/data/tür.nrrd", 7, None).source_bytes, None);
}
