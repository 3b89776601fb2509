//! Tests of the hints that `NIfTI` headers give on values.

use tempfile::TempDir;

use super::{gzip, load_path, nifti1_header, read, write};
use chiaroscuro_volume::{Modality, ValueMeaning, VolumeChoice};

#[test]
fn descriptions_windows_and_intents_are_told() {
    let header = nifti1_header(&[2, 1, 1], 2).text(148, b"a chest, CT\0rest").f32(124, &[300.0, -100.0]);
    let volume = read(&header.with_data(&[1, 2]));
    let hints = volume.metadata();
    assert_eq!(hints.acquisition(), Some("a chest, CT"));
    assert_eq!(hints.modality, Modality::Ct);
    assert_eq!(hints.window, Some([-100.0, 300.0]));
    assert_eq!(hints.meaning, ValueMeaning::Unknown);
    assert!(read(&nifti1_header(&[2, 1, 1], 2).with_data(&[1, 2])).metadata().is_empty());
    let labels = read(&nifti1_header(&[2, 1, 1], 2).i16(68, &[1002]).with_data(&[1, 2]));
    assert_eq!(labels.metadata().meaning, ValueMeaning::Labels);
}

#[test]
fn labels_have_names_beside_the_volume() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "seg.nii.gz", &gzip(&nifti1_header(&[2, 1, 1], 2).with_data(&[1, 2])));
    write(&folder, "seg.txt", b"1 255 0 0 1 1 1 \"Bone\"\n2 0 255 0 1 1 1 \"Skin\"\n");
    let volume = load_path(&path, VolumeChoice::default()).unwrap();
    assert_eq!(volume.name(), "seg");
    assert_eq!(volume.metadata().meaning, ValueMeaning::Labels);
    assert_eq!(volume.metadata().labels.get(2).map(|label| label.name.as_str()), Some("Skin"));
}
