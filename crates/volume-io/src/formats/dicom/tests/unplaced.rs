//! Tests of images without positions: their order and spacing.

use super::*;

/// A slice v = x + 10 y + `base` without position and orientation.
fn file_without_position(base: u16, set: impl FnOnce(DataSetBuilder) -> DataSetBuilder) -> DicomFileBuilder {
    ramp_file(base).with(|all| set(all.without(tags::POSITION).without(tags::ORIENTATION)))
}

fn spacing(volume: &Volume) -> [f64; 3] {
    volume.spacing_mm().to_array().map(|length| (length * 1e6).round() / 1e6)
}

#[test]
fn slice_locations_say_order_and_distance() {
    // File names and instance numbers imply another order.
    let files: Vec<DicomFileBuilder> = [3u16, 0, 2, 1]
        .into_iter()
        .enumerate()
        .map(|(number, n)| {
            file_without_position(100 * n, |set| {
                let location = 5.0 + 1.5 * f64::from(n);
                set.decimal(tags::SLICE_LOCATION, &location.to_string()).text(
                    tags::INSTANCE_NUMBER,
                    *b"IS",
                    &number.to_string(),
                )
            })
        })
        .collect();
    let at = folder(&files);
    for path in [at.path().to_owned(), at.path().join("1")] {
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200, 300])));
        assert_eq!(spacing(&volume), [0.25, 0.5, 1.5]);
        assert!(!volume.has_unknown_scale());
        assert_remark(&volume, "1.5000 mm apart, are taken from Slice Location");
    }
    // With one slice missing.
    let at = folder(&[files[0].clone(), files[1].clone(), files[3].clone()]);
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200, 300])));
}

#[test]
fn thickness_and_distance_come_before_the_pixels() {
    let frames = |set: fn(DataSetBuilder) -> DataSetBuilder| {
        let words: Vec<u16> = ramp_values(&[0, 100, 200]);
        file_without_position(0, set).frames("3").words(&words).load().unwrap()
    };
    let volume = frames(|set| set);
    assert_eq!((spacing(&volume), volume.has_unknown_scale()), ([0.25, 0.5, 2.5], false));
    assert_remark(&volume, "2.5 mm, is taken from Slice Thickness");
    let volume = frames(|set| set.decimal(tags::SPACING_BETWEEN_SLICES, "3.5"));
    assert_eq!(spacing(&volume), [0.25, 0.5, 3.5]);
    assert_remark(&volume, "3.5 mm, is taken from Spacing Between Slices");
    let volume = frames(|set| set.without(tags::SLICE_THICKNESS));
    assert_eq!((spacing(&volume), volume.has_unknown_scale()), ([0.25, 0.5, 0.5], true));
    // Frames that follow each other in time have no spacing.
    let increment = [0x18, 0, 0x63, 0x10];
    let film = file_without_position(0, |set| set.value(tags::FRAME_INCREMENT, *b"AT", &increment));
    let volume = film.frames("3").words(&ramp_values(&[0, 100, 200])).load().unwrap();
    assert!(volume.has_unknown_scale());
    let locations = |set: DataSetBuilder| set.decimal(tags::SLICE_LOCATIONS, "4\\0\\2");
    let file = file_without_position(0, locations).frames("3").words(&ramp_values(&[200, 0, 100]));
    let volume = file.load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
    assert_eq!(spacing(&volume)[2], 2.0);
}

#[test]
fn without_locations_numbers_and_then_names_are_the_order() {
    let numbered = |base: u16, number: &str| {
        file_without_position(base, |set| set.text(tags::INSTANCE_NUMBER, *b"IS", number))
    };
    let at = folder(&[numbered(200, "10"), numbered(0, "2"), numbered(100, "3")]);
    for path in [at.path().to_owned(), at.path().join("0")] {
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
        assert_remark(&volume, "is taken from Slice Thickness");
    }
    let at = TempDir::new().unwrap();
    for (name, base) in [("i10", 200), ("i9", 100), ("i1", 0)] {
        file_without_position(base, |set| set).write(&at, name);
    }
    for path in [at.path().to_owned(), at.path().join("i10")] {
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])), "{path:?}");
    }
}

#[test]
fn other_elements_say_how_far_pixels_lie_apart() {
    let without = |set: DataSetBuilder| set.without(tags::PIXEL_SPACING);
    let volume = file_without_position(0, |set| without(set).decimal(tags::DETECTOR_SPACING, "0.2\\0.1"))
        .load()
        .unwrap();
    assert_eq!(spacing(&volume), [0.1, 0.2, 2.5]);
    assert_remark(&volume, "is taken from Imager Pixel Spacing");
    let region = DataSetBuilder::default()
        .value(tags::REGION_UNITS_X, *b"US", &3u16.to_le_bytes())
        .value(tags::REGION_UNITS_Y, *b"US", &3u16.to_le_bytes())
        .value(tags::REGION_DELTA_X, *b"FD", &0.01f64.to_le_bytes())
        .value(tags::REGION_DELTA_Y, *b"FD", &0.02f64.to_le_bytes());
    let seconds = region.clone().value(tags::REGION_UNITS_X, *b"US", &4u16.to_le_bytes());
    let ultrasound = |region: DataSetBuilder| {
        file_without_position(0, |set| without(set).items(tags::REGIONS, vec![region], false))
    };
    assert_eq!(spacing(&ultrasound(region).load().unwrap()), [0.1, 0.2, 2.5]);
    assert!(ultrasound(seconds).load().unwrap().has_unknown_scale());
}

#[test]
fn volumes_of_ultrasound_lie_in_a_space_of_their_own() {
    let doubles = |numbers: &[f64]| -> Vec<u8> { numbers.iter().flat_map(|n| n.to_le_bytes()).collect() };
    let one = |tag: DicomTag, set: DataSetBuilder| DataSetBuilder::default().items(tag, vec![set], false);
    let frame = |z: f64| {
        let position =
            DataSetBuilder::default().value(tags::VOLUME_POSITION, *b"FD", &doubles(&[1.0, 2.0, z]));
        one(tags::VOLUME_PLANE_POSITION, position)
    };
    let orientation = doubles(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let orientation = DataSetBuilder::default().value(tags::VOLUME_ORIENTATION, *b"FD", &orientation);
    let file =
        file_without_position(0, |set| {
            set.items(tags::SHARED_GROUPS, vec![one(tags::VOLUME_PLANE_ORIENTATION, orientation)], false)
                .items(tags::FRAME_GROUPS, [8.0, 0.0, 4.0].map(frame).to_vec(), false)
        });
    let volume = file.frames("3").words(&ramp_values(&[200, 0, 100])).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
    assert_eq!(spacing(&volume), [0.25, 0.5, 4.0]);
    assert!(!volume.is_anatomical(), "nobody says where the patient is");
}

#[test]
fn positions_without_directions_say_order_and_distance() {
    let at = |base: u16, z: &str| {
        file_without_position(base, |set| set.decimal(tags::POSITION, &format!("7\\8\\{z}")))
    };
    let volume =
        load_path(folder(&[at(100, "3"), at(0, "0"), at(200, "6")]).path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
    assert_eq!((spacing(&volume)[2], volume.is_anatomical()), (3.0, false));
}
