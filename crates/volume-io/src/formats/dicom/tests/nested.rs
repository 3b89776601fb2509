//! Tests of nested folders, as disks and archive exports have them.

use super::*;

/// Writes a slice at a height to a file in a nested folder.
fn write(at: &TempDir, name: &str, z: u16, set: impl FnOnce(DataSetBuilder) -> DataSetBuilder) {
    let path = at.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let file = ramp_file(100 * z).with(|all| set(all.decimal(tags::POSITION, &format!("0\\0\\{z}"))));
    std::fs::write(path, file.bytes()).unwrap();
}

fn other_series(set: DataSetBuilder) -> DataSetBuilder {
    set.text(tags::SERIES_INSTANCE_UID, *b"UI", "9.9").text(tags::SERIES_DESCRIPTION, *b"LO", "Neck")
}

#[test]
fn slices_of_one_series_in_several_folders_are_a_volume() {
    let at = TempDir::new().unwrap();
    for z in 0..8u16 {
        let folder = if z < 4 { "A" } else { "B/deeper/still" };
        write(&at, &format!("{folder}/IM{z}"), z, |set| set);
    }
    let directory = DicomFileBuilder::new(EXPLICIT)
        .with(|set| set.without(tags::PIXELS).items(tags::DIRECTORY_RECORDS, Vec::new(), false));
    directory.write(&at, "DICOMDIR");
    std::fs::write(at.path().join("AUTORUN.INF"), "x").unwrap();
    std::fs::write(at.path().join("logo.png"), "x").unwrap();
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    let expected: Vec<u16> = (0..8).map(|z| 100 * z).collect();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&expected)));
    assert!(volume.remarks().is_empty(), "{:?}", volume.remarks());
}

#[test]
fn series_in_several_folders_are_offered() {
    let at = TempDir::new().unwrap();
    for z in 0..2 {
        write(&at, &format!("{z}"), z, |set| set);
        write(&at, &format!("S1/{z}"), z + 2, |set| set);
        write(&at, &format!("S2/{z}"), z, other_series);
    }
    write(&at, "S2/2", 2, other_series);
    let words = ["2 series", "0 \"CT Head axial\" (4 x 3 x 4)", "1 \"CT Neck axial\" (4 x 3 x 3)"];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    let choice = VolumeChoice { series: Some("1".to_owned()), ..VolumeChoice::default() };
    let neck = load_path(at.path(), choice).unwrap();
    assert_eq!(neck.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
}

#[test]
fn each_slice_may_have_a_folder() {
    let at = TempDir::new().unwrap();
    for z in 0..40 {
        write(&at, &format!("{z}/IM"), z, |set| set);
    }
    assert_eq!(load_path(at.path(), VolumeChoice::default()).unwrap().dims(), [4, 3, 40]);
}

#[test]
fn folders_of_other_things_change_nothing() {
    let at = TempDir::new().unwrap();
    let picture = |name: &str| {
        image::GrayImage::from_fn(2, 2, |x, y| image::Luma([(x + 2 * y) as u8]))
            .save(at.path().join(name))
            .unwrap();
    };
    for name in ["s1.png", "s2.png", "s3.png"] {
        picture(name);
    }
    std::fs::create_dir(at.path().join("within")).unwrap();
    picture("within/other.png");
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.dims(), [2, 2, 3]);
    // A single DICOM file in a subfolder is ignored beside images.
    write(&at, "within/IM", 0, |set| set);
    assert_eq!(load_path(at.path(), VolumeChoice::default()).unwrap().dims(), [2, 2, 3]);
    // Several of them outnumber the images, and are loaded.
    for z in 0..4 {
        write(&at, &format!("scan/{z}"), z, |set| set);
    }
    assert_eq!(load_path(at.path(), VolumeChoice::default()).unwrap().dims(), [4, 3, 4]);
}

#[test]
fn copies_in_other_folders_are_left_out() {
    let at = TempDir::new().unwrap();
    for (folder, z) in [("a", 0), ("a", 1), ("b", 0), ("b", 1)] {
        let instance = format!("1.{z}");
        write(&at, &format!("{folder}/{z}"), z, |set| set.text(tags::SOP_INSTANCE, *b"UI", &instance));
    }
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.dims(), [4, 3, 2]);
    assert_remark(&volume, "2 files are copies of others");
}

#[test]
fn thousands_of_folders_are_looked_through() {
    let at = TempDir::new().unwrap();
    for n in 0..3000 {
        std::fs::create_dir(at.path().join(format!("{n}"))).unwrap();
    }
    let nothing = load_path(at.path(), VolumeChoice::default());
    assert_refused(nothing, LoadErrorKind::BadInput, &["none of its 0 files"]);
    write(&at, "2999/IM", 0, |set| set);
    assert_eq!(load_path(at.path(), VolumeChoice::default()).unwrap().dims(), [4, 3, 1]);
}
