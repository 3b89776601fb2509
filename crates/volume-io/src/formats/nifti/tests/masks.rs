//! Tests of folders of masks, one file for each object.

use std::fs;

use tempfile::TempDir;

use super::{NiftiBuilder, assert_refused, gzip, load_path, nifti1_header, write};
use crate::tests::helpers;
use crate::{LoadOptions, load};
use chiaroscuro_volume::{LoadControl, LoadErrorKind, Portion, Samples, ValueMeaning, Volume, VolumeChoice};

/// Header of a mask of 4 x 1 x 1 bytes that is placed by a matrix.
fn header() -> NiftiBuilder {
    placed(nifti1_header(&[4, 1, 1], 2))
}

fn placed(header: NiftiBuilder) -> NiftiBuilder {
    let matrix = [2.0, 0.0, 0.0, -9.0, 0.0, 3.0, 0.0, 5.0, 0.0, 0.0, 4.0, 7.0];
    header.i16(254, &[1]).f32(280, &matrix)
}

fn floats(values: [f32; 4]) -> Vec<u8> {
    let data: Vec<u8> = values.into_iter().flat_map(f32::to_le_bytes).collect();
    placed(nifti1_header(&[4, 1, 1], 16)).with_data(&data)
}

fn load_folder(folder: &TempDir) -> Volume {
    load_path(folder.path(), VolumeChoice::default()).unwrap()
}

fn names(volume: &Volume) -> Vec<(i64, String)> {
    volume.metadata().labels.iter().map(|(number, label)| (number, label.name.clone())).collect()
}

#[track_caller]
fn refused(folder: &TempDir, words: &[&str]) {
    assert_refused(load_path(folder.path(), VolumeChoice::default()), LoadErrorKind::BadInput, words);
}

#[test]
fn masks_of_a_folder_are_one_label_map() {
    let folder = TempDir::new().unwrap();
    write(&folder, "spleen.nii.gz", &gzip(&header().with_data(&[0, 0, 255, 0])));
    write(&folder, "kidney_left.nii", &header().with_data(&[1, 0, 0, 0]));
    write(&folder, "rib_10.nii.gz", &gzip(&floats([0.0, 0.0, 0.0, 1.0])));
    write(&folder, "rib_9.NII.GZ", &gzip(&header().with_data(&[0; 4])));
    write(&folder, "statistics.json", b"{}");
    let volume = load_folder(&folder);
    assert_eq!(*volume.samples(), Samples::U8(vec![1, 0, 4, 3]));
    let expected = [(1, "kidney left"), (2, "rib 9"), (3, "rib 10"), (4, "spleen")];
    assert_eq!(names(&volume), expected.map(|(number, name)| (number, name.to_owned())));
    assert_eq!(volume.metadata().meaning, ValueMeaning::Labels);
    assert!(volume.is_anatomical() && volume.is_label_map());
    assert_eq!(volume.world_from_index().translation.to_array(), [-9.0, 5.0, 7.0]);
    assert_eq!(volume.name(), folder.path().file_name().unwrap().to_string_lossy());
    assert_eq!(volume.remarks(), &[] as &[String]);
}

#[test]
fn later_masks_cover_earlier_ones_and_this_is_said() {
    let folder = TempDir::new().unwrap();
    write(&folder, "a.nii", &header().with_data(&[1, 1, 1, 0]));
    write(&folder, "b.nii", &header().with_data(&[0, 1, 1, 1]));
    write(&folder, "c.nii", &header().with_data(&[0, 0, 0, 0]));
    let volume = load_folder(&folder);
    assert_eq!(*volume.samples(), Samples::U8(vec![1, 2, 2, 2]));
    let remarks = volume.remarks().join("; ");
    assert!(remarks.contains("masks overlap: 1 of them cover 2 voxels of earlier ones"), "{remarks}");
}

#[test]
fn more_masks_than_a_byte_can_count_have_labels_of_two() {
    let folder = TempDir::new().unwrap();
    for at in 0..256u32 {
        write(&folder, &format!("m{at}.nii"), &header().with_data(&[u8::from(at == 0), 0, 1, 0]));
    }
    let volume = load_folder(&folder);
    assert_eq!(*volume.samples(), Samples::U16(vec![1, 0, 256, 0]));
    fs::remove_file(folder.path().join("m255.nii")).unwrap();
    assert_eq!(*load_folder(&folder).samples(), Samples::U8(vec![1, 0, 255, 0]));
}

#[test]
fn masks_of_other_grids_are_refused() {
    let mask = header().with_data(&[1, 0, 0, 0]);
    for (other, words) in [
        (
            placed(nifti1_header(&[2, 2, 1], 2)).with_data(&[0; 4]),
            &["2 x 2 x 1 voxels, 4 x 1 x 1 were expected", "\"a.nii\"", "b.nii, dim", "another folder"][..],
        ),
        (header().f32(292, &[-8.9]).with_data(&[0; 4]), &["do not lie", "\"a.nii\"", "b.nii, sform, qform"]),
        (header().f32(280, &[2.1]).with_data(&[0; 4]), &["do not lie"]),
        (header().i16(254, &[0]).with_data(&[0; 4]), &["do not lie"]),
    ] {
        let folder = TempDir::new().unwrap();
        write(&folder, "a.nii", &mask);
        write(&folder, "b.nii", &other);
        refused(&folder, words);
    }
    let folder = TempDir::new().unwrap();
    write(&folder, "a.nii", &mask);
    write(&folder, "b.nii", &header().f32(292, &[-9.0001]).with_data(&[0; 4]));
    assert_eq!(*load_folder(&folder).samples(), Samples::U8(vec![1, 0, 0, 0]), "equal up to rounding");
}

#[test]
fn files_that_are_no_masks_are_refused() {
    let byte_mask = header().with_data(&[0, 1, 1, 0]);
    let long = placed(nifti1_header(&[4, 1, 1, 2], 2)).with_data(&[0; 8]);
    for (other, words) in [
        (header().with_data(&[0, 1, 2, 0]), &["0 and one other number", "1 and 2", "b.nii, data"][..]),
        (floats([0.0, 0.5, 0.0, 0.5]), &["0 and 1 were expected, 0.5 was found", "b.nii, data"]),
        (floats([0.0, 1.0, 0.5, 0.0]), &["1 and 0.5"]),
        (floats([0.0, f32::NAN, f32::NAN, 0.0]), &["NaN"]),
        (long, &["one number was expected for each voxel, it has 2", "b.nii, dim"]),
        (b"no header".to_vec(), &["no NIfTI header", "b.nii, header"]),
        (byte_mask[..355].to_vec(), &["truncated", "b.nii"]),
        (Vec::new(), &["b.nii, header"]),
    ] {
        let folder = TempDir::new().unwrap();
        write(&folder, "a.nii", &byte_mask);
        write(&folder, "b.nii", &other);
        refused(&folder, words);
    }
}

#[test]
fn other_folders_are_opened_as_before() {
    let mask = header().with_data(&[0, 1, 1, 0]);
    let picture = |folder: &TempDir, name: &str| {
        let path = folder.path().join(name);
        image::GrayImage::from_raw(2, 2, vec![1, 2, 3, 4]).unwrap().save(path).unwrap();
    };
    let folder = TempDir::new().unwrap();
    write(&folder, "a.nii", &mask);
    refused(&folder, &["none of its 1 files", "; open a single file"]);
    fs::create_dir(folder.path().join("masks")).unwrap();
    write(&folder, "masks/b.nii", &mask);
    refused(&folder, &["or of the 1 files in its subfolders", "the subfolder that holds the masks"]);
    picture(&folder, "p1.png");
    write(&folder, "b.nii", &header().with_data(&[1, 2, 3, 4]));
    assert_eq!(load_folder(&folder).dims(), [2, 2, 1], "a picture beside files that are no masks");
    write(&folder, "b.nii", &mask);
    assert_eq!(load_folder(&folder).dims(), [4, 1, 1], "a preview of the masks");
    picture(&folder, "p2.png");
    assert_eq!(load_folder(&folder).dims(), [2, 2, 2], "slices");
}

#[test]
fn portions_of_masks_are_those_of_the_label_map() {
    let folder = TempDir::new().unwrap();
    let cube = |inside: fn(usize) -> bool| {
        let data: Vec<u8> = (0..64).map(|at| u8::from(inside(at))).collect();
        gzip(&placed(nifti1_header(&[4, 4, 4], 2)).with_data(&data))
    };
    write(&folder, "a.nii.gz", &cube(|at| at % 4 < 2));
    write(&folder, "b.nii.gz", &cube(|at| at % 4 == 3 || at == 0));
    let part = |portion: Portion| {
        let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default() };
        load_path(folder.path(), choice).unwrap()
    };
    let every = part(Portion::with_stride(2));
    assert_eq!(*every.samples(), Samples::U8(vec![2, 0, 1, 0, 1, 0, 1, 0]));
    let region = part(Portion { region: "2:4,1:2,3:4".parse().ok(), ..Portion::default() });
    assert_eq!((region.dims(), region.samples()), ([2, 1, 1], &Samples::U8(vec![0, 2])));
    assert_eq!(region.world_from_index().translation.to_array(), [-5.0, 8.0, 19.0]);
    let reduced = part(Portion::with_block_average(2));
    assert_eq!(reduced.dims(), [2, 2, 2]);
    let Samples::U8(labels) = reduced.samples() else { panic!() };
    assert!(labels.iter().all(|label| [0, 1, 2].contains(label)), "labels have no means: {labels:?}");
    assert_eq!(labels[2], 1);
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    assert_refused(load_path(folder.path(), choice), LoadErrorKind::BadInput, &["--frame"]);
}

#[test]
fn memory_is_bounded_and_loading_can_be_cancelled() {
    let folder = TempDir::new().unwrap();
    let huge = || placed(nifti1_header(&[32767, 32767, 32767], 2)).with_data(&[0]);
    write(&folder, "a.nii", &huge());
    write(&folder, "b.nii", &huge());
    assert_refused(load_path(folder.path(), VolumeChoice::default()), LoadErrorKind::Limit, &["a.nii, dim"]);
    for name in ["a.nii", "b.nii"] {
        write(&folder, name, &placed(nifti1_header(&[10, 10, 10], 2)).with_data(&[1; 1000]));
    }
    let with_budget = |memory_budget_bytes: u64, control: &LoadControl| {
        let options = LoadOptions { memory_budget_bytes, ..LoadOptions::default() };
        load(folder.path(), &options, control)
    };
    // The labels, and one mask.
    let control = LoadControl::new();
    assert!(with_budget(2000, &control).is_ok());
    assert_eq!(control.fraction(), Some(1.0));
    assert_eq!(control.read_files().len(), 2, "no mask is replaced by what is written from it");
    assert_refused(with_budget(1999, &LoadControl::new()), LoadErrorKind::Limit, &["a.nii"]);
    for pieces in 0..control.pieces_begun() {
        let control = LoadControl::new();
        control.cancel_after(pieces);
        assert_eq!(with_budget(2000, &control).unwrap_err().kind(), LoadErrorKind::Cancelled, "{pieces}");
    }
    let alone = folder.path().join("a.nii");
    assert_eq!(helpers::load_path(&alone, VolumeChoice::default()).unwrap().name(), "a");
}
