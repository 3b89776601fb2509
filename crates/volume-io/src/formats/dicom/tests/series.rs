//! Tests of folders with slices of one or several series.

use super::*;

/// A slice of one pixel at a height.
fn slice(z: &str, value: u16, number: &str) -> DicomFileBuilder {
    DicomFileBuilder::new(EXPLICIT).size(1, 1).words(&[value]).with(|set| {
        set.decimal(tags::POSITION, &format!("0\\0\\{z}")).text(tags::INSTANCE_NUMBER, *b"IS", number).text(
            tags::SOP_INSTANCE,
            *b"UI",
            &format!("1.{number}"),
        )
    })
}

fn load_all(files: &[DicomFileBuilder]) -> Result<Volume, LoadError> {
    load_path(folder(files).path(), VolumeChoice::default())
}

#[test]
fn slices_are_in_the_order_in_which_they_lie() {
    let files = [slice("4", 3, "1"), slice("0", 1, "3"), slice("2", 2, "2")];
    let at = folder(&files);
    std::fs::write(at.path().join("notes.txt"), "not a slice").unwrap();
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![1, 2, 3]));
    assert_eq!((volume.name(), volume.dims()), ("Head", [1, 1, 3]));
    assert_eq!(affine_columns(&volume)[6..], [0.0, 0.0, 2.0, 0.0, 0.0, 0.0]);
    assert!(volume.remarks().is_empty(), "{:?}", volume.remarks());
    // Naming one slice loads the whole series.
    let volume = load_path(&at.path().join("0"), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![1, 2, 3]));
    assert_remark(&volume, "3 slices of its series");
}

#[test]
fn what_is_odd_about_a_series_is_said() {
    for (files, expected, words) in [
        (
            vec![slice("0", 1, "1"), slice("1", 2, "2"), slice("3", 4, "3"), slice("4", 5, "4")],
            vec![1, 2, 3, 4, 5],
            "1 slice is missing of 5",
        ),
        (
            vec![slice("0", 100, "1"), slice("1", 200, "2"), slice("2.4", 340, "3")],
            vec![100, 220, 340],
            "1.0000 mm to 1.4000 mm apart: they are interpolated to layers 1.2000 mm apart",
        ),
        (vec![slice("0", 1, "1"), slice("1", 2, "2"), slice("1", 2, "2")], vec![1, 2], "copies of others"),
        (
            vec![slice("0", 1, "1"), slice("1", 2, "2"), slice("1", 3, "3")],
            vec![1, 2],
            "1 of 3 images share their position with others",
        ),
    ] {
        let volume = load_all(&files).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(expected));
        assert_remark(&volume, words);
    }
    let film = ["2", "1"].map(|number| {
        slice("0", number.parse().unwrap(), number).with(|set| set.decimal(tags::SPACING_BETWEEN_SLICES, "4"))
    });
    let volume = load_all(&film).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![1, 2]));
    assert!(volume.has_unknown_scale());
    assert_remark(&volume, "all have the same position");
    let tilted = [("0", 1), ("1", 2), ("2", 3)].map(|(z, value)| {
        let position = format!("0\\{z}\\{z}");
        slice(z, value, &value.to_string()).with(|set| set.decimal(tags::POSITION, &position))
    });
    let volume = load_all(&tilted).unwrap();
    assert_remark(&volume, "tilted gantry");
    assert_eq!(affine_columns(&volume)[6..9], [0.0, -1.0, 1.0]);
}

#[test]
fn slices_at_the_same_places_are_time_steps() {
    let files: Vec<DicomFileBuilder> = (0..6u16)
        .map(|n| {
            slice(&(n % 2).to_string(), n, &n.to_string())
                .with(|set| set.decimal(tags::TRIGGER_TIME, &(n / 2 * 40).to_string()))
        })
        .collect();
    assert_refused(load_all(&files), LoadErrorKind::BadInput, &["3 time steps", "2 \"trigger time 80 ms\""]);
    let at = folder(&files);
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    assert_eq!(load_path(at.path(), choice).unwrap().samples(), &Samples::U16(vec![2, 3]));
    let choice = VolumeChoice { frame: Some(3), ..VolumeChoice::default() };
    assert_refused(load_path(at.path(), choice), LoadErrorKind::BadInput, &["\"3\" is not one of its 3"]);
}

#[test]
fn series_of_a_folder_are_offered() {
    let other =
        |z: &str, value: u16| {
            slice(z, value, &value.to_string()).with(|set| {
                set.text(tags::SERIES_INSTANCE_UID, *b"UI", "9.9")
                    .text(tags::SERIES_NUMBER, *b"IS", "7")
                    .text(tags::SERIES_DESCRIPTION, *b"LO", "Neck")
            })
        };
    let files = [slice("0", 1, "1"), other("0", 7), slice("1", 2, "2"), other("1", 8), other("2", 9)];
    let at = folder(&files);
    let words = ["2 series", "0 \"CT Neck axial\" (1 x 1 x 3)", "1 \"CT Head axial\" (1 x 1 x 2)"];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    let choice = VolumeChoice { series: Some("1".to_owned()), ..VolumeChoice::default() };
    assert_eq!(load_path(at.path(), choice).unwrap().samples(), &Samples::U16(vec![1, 2]));
    let own = load_path(&at.path().join("1"), VolumeChoice::default()).unwrap();
    assert_eq!(own.samples(), &Samples::U16(vec![7, 8, 9]), "a file says which series is meant");
    // An image of another size in the same series.
    let wide = slice("5", 1, "5").size(2, 1).words(&[1, 2]);
    let at = folder(&[slice("0", 1, "1"), slice("1", 2, "2"), wide]);
    assert_refused(
        load_path(at.path(), VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["2 series", "0 \"CT Head axial\" (1 x 1 x 2)", "1 \"CT Head axial\" (2 x 1 x 1)"],
    );
    assert_remark(
        &load_path(&at.path().join("0"), VolumeChoice::default()).unwrap(),
        "their size or direction differs",
    );
}

#[test]
fn files_that_are_no_slices_do_not_disturb() {
    let report = slice("0", 1, "8").with(|set| set.without(tags::PIXELS));
    let at = folder(&[slice("0", 1, "1"), slice("1", 2, "2"), report.clone()]);
    let broken = slice("2", 3, "3").bytes();
    std::fs::write(at.path().join("broken"), &broken[..165]).unwrap();
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![1, 2]));
    assert_remark(&volume, "1 of 3 files is left out: cannot read the DICOM file");
    assert_refused(load_all(&[report]), LoadErrorKind::BadInput, &["1 DICOM files have no pixels"]);
}

/// A truncated slice is missing from the volume, with a remark.
#[test]
fn what_is_left_out_is_said() {
    let cut = slice("2", 3, "3").size(2, 2);
    let at = folder(&[slice("0", 1, "1"), slice("1", 2, "2"), cut]);
    for path in [at.path().to_owned(), at.path().join("0")] {
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(vec![1, 2]));
        assert_remark(&volume, "1 of 3 slices is left out");
        assert_remark(&volume, "truncated");
    }
}

#[test]
fn scales_of_slices_may_differ() {
    let scaled = |z: &str, value: u16, slope: &str| {
        slice(z, value, z).with(|set| set.decimal(tags::SLOPE, slope).text(tags::UNITS, *b"CS", "BQML"))
    };
    let volume = load_all(&[scaled("0", 10, "0.5"), scaled("1", 10, "2")]).unwrap();
    assert_eq!(volume.samples(), &Samples::F32(vec![5.0, 20.0]));
    assert_eq!(volume.metadata().unit(), Some("BQML"));
}

/// A localiser is numbered before the scan that it was made for.
#[test]
fn the_largest_volume_comes_first() {
    let scout = ramp_file(7).with(|set| {
        set.text(tags::SERIES_INSTANCE_UID, *b"UI", "9.9")
            .text(tags::SERIES_NUMBER, *b"IS", "1")
            .text(tags::SERIES_DESCRIPTION, *b"LO", "Topogram")
            .decimal(tags::ORIENTATION, "1\\0\\0\\0\\0\\-1")
    });
    let scan = ["0", "1", "2"].map(|z| {
        let set = slice(z, 5, z).size(4, 3).words(&ramp_values(&[100]));
        set.with(|set| set.text(tags::SERIES_NUMBER, *b"IS", "2"))
    });
    // An image sequence with more images than the scan has slices.
    let film =
        (0..6).map(|n| {
            ramp_file(n).with(|set| {
                set.text(tags::SERIES_INSTANCE_UID, *b"UI", "9.8")
                    .text(tags::SERIES_NUMBER, *b"IS", "0")
                    .text(tags::SERIES_DESCRIPTION, *b"LO", "Fluoroscopy")
            })
        });
    let at = folder(&[scout].into_iter().chain(scan).chain(film).collect::<Vec<_>>());
    let words =
        ["0 \"CT Head axial\" (4 x 3 x 3)", "1 \"CT Topogram coronal\"", "2 \"CT Fluoroscopy axial\""];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    let opened = load_path(at.path(), VolumeChoice::default().with_first_as_fallback()).unwrap();
    assert_eq!(opened.dims(), [4, 3, 3], "the window opens the first");
}
