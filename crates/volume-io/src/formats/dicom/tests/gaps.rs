//! Tests of missing and unevenly spaced slices: each keeps its position.

use super::*;
use chiaroscuro_volume::VoxelType;

/// A series of slices of 4 x 3 pixels v = x + 10 y + 100 n, at n times a distance.
fn series(at: &[u16], distance_mm: f64) -> Vec<DicomFileBuilder> {
    let slice = |&n: &u16| {
        let position = format!("0\\0\\{}", f64::from(n) * distance_mm);
        ramp_file(100 * n).with(|set| set.decimal(tags::POSITION, &position))
    };
    at.iter().map(slice).collect()
}

#[test]
fn a_missing_slice_is_interpolated_and_said() {
    let volume =
        load_path(folder(&series(&[0, 1, 2, 4, 5, 6, 7, 8], 2.0)).path(), VolumeChoice::default()).unwrap();
    let expected: Vec<u16> = (0..9).map(|n| 100 * n).collect();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&expected)));
    assert_eq!((volume.dims(), affine_columns(&volume)[8]), ([4, 3, 9], 2.0));
    assert_remark(&volume, "1 slice is missing of 9, 2.0000 mm apart: interpolated");
}

#[test]
fn several_gaps_keep_every_slice_at_its_place() {
    for missing in [&[1u16][..], &[1, 6], &[2, 3], &[2, 3, 4], &[1, 3, 5, 7]] {
        let there: Vec<u16> = (0..9).filter(|n| !missing.contains(n)).collect();
        let volume = load_path(folder(&series(&there, 1.5)).path(), VolumeChoice::default()).unwrap();
        if *missing == [1, 3, 5, 7] {
            assert_eq!(
                (volume.dims()[2], affine_columns(&volume)[8]),
                (5, 3.0),
                "those are even by themselves"
            );
            continue;
        }
        let expected: Vec<u16> = (0..9).map(|n| 100 * n).collect();
        assert_eq!(volume.samples(), &Samples::U16(ramp_values(&expected)), "{missing:?}");
        assert_eq!(affine_columns(&volume)[8], 1.5);
    }
}

#[test]
fn a_block_of_missing_slices_is_left_empty() {
    let there: Vec<u16> = (0..4).chain(12..16).collect();
    let volume = load_path(folder(&series(&there, 2.0)).path(), VolumeChoice::default()).unwrap();
    assert_eq!((volume.dims(), affine_columns(&volume)[8]), ([4, 3, 16], 2.0));
    assert_eq!(volume.samples().voxel_type(), VoxelType::F32, "only real numbers have one that is none");
    for z in 0..16u16 {
        for (at, pixel) in ramp_values(&[100 * z]).into_iter().enumerate() {
            let found = volume.samples().value(12 * usize::from(z) + at);
            let is_right = if there.contains(&z) { found == f64::from(pixel) } else { found.is_nan() };
            assert!(is_right, "{z} {at}: {found}");
        }
    }
    assert_eq!(volume.missing().map(chiaroscuro_volume::MissingVoxels::count), Some(8 * 12));
    assert_remark(&volume, "8 slices are missing of 16, 2.0000 mm apart: left empty");
}

#[test]
fn rescaled_values_are_interpolated_and_empty_alike() {
    let there: Vec<u16> = [0, 1, 3].into_iter().chain(12..15).collect();
    let files: Vec<DicomFileBuilder> = series(&there, 1.0)
        .into_iter()
        .map(|file| file.with(|set| set.decimal(tags::SLOPE, "2").decimal(tags::INTERCEPT, "-1000")))
        .collect();
    let volume = load_path(folder(&files).path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples().value(0), -1000.0);
    assert_eq!(volume.samples().value(24), 2.0 * 200.0 - 1000.0);
    assert!(volume.samples().value(12 * 5).is_nan());
}

#[test]
fn what_was_not_measured_is_not_mixed() {
    let files = series(&[0, 1, 3, 4], 1.0);
    let files: Vec<DicomFileBuilder> = files.into_iter().map(|file| file.short(tags::PADDING, 100)).collect();
    let volume = load_path(folder(&files).path(), VolumeChoice::default()).unwrap();
    // The first pixel of the slice at 1 is padding, and so is the interpolated one beside it.
    assert_eq!(volume.samples().value(24), 100.0);
    assert_eq!(volume.samples().value(25), 201.0);
}

#[test]
fn uneven_slices_are_interpolated_to_their_places() {
    // Values are ten times the height.
    let heights = [0.0, 1.0, 2.4, 3.4, 4.4, 5.4, 7.0];
    let slice = |&z: &f64| {
        let position = format!("0\\0\\{z}");
        DicomFileBuilder::new(EXPLICIT)
            .size(1, 1)
            .words(&[(z * 100.0).round() as u16])
            .with(|set| set.decimal(tags::POSITION, &position).decimal(tags::SLOPE, "0.1"))
    };
    let files: Vec<DicomFileBuilder> = heights.iter().map(slice).collect();
    let volume = load_path(folder(&files).path(), VolumeChoice::default()).unwrap();
    let distance = affine_columns(&volume)[8];
    assert_eq!(volume.dims()[2], 8);
    for z in 0..8 {
        let (found, right) = (volume.samples().value(z), z as f64 * distance * 10.0);
        // Up to the tolerance of an even grid: a twentieth of the spacing.
        assert!((found - right).abs() <= 0.051 * distance * 10.0, "{z}: {found}, {right} expected");
    }
    assert_remark(&volume, "1.0000 mm to 1.6000 mm apart: they are interpolated to layers 1.0000 mm apart");
}

#[test]
fn slices_of_one_file_are_gathered_alike() {
    let heights = ["0", "2", "6", "8"];
    let frame = |z: &&str| {
        let position = DataSetBuilder::default().decimal(tags::POSITION, &format!("0\\0\\{z}"));
        DataSetBuilder::default().items(tags::PLANE_POSITION, vec![position], false)
    };
    let file = DicomFileBuilder::new(EXPLICIT)
        .size(1, 1)
        .frames("4")
        .words(&[0, 20, 60, 80])
        .with(|set| set.without(tags::POSITION))
        .with(|set| set.items(tags::FRAME_GROUPS, heights.iter().map(frame).collect(), false));
    assert_eq!(file.load().unwrap().samples(), &Samples::U16(vec![0, 20, 40, 60, 80]));
}

#[test]
fn places_that_cannot_be_are_no_harm() {
    for heights in [
        ["0", "1", "1e300"],
        ["0", "1", "nan"],
        ["0", "1", "inf"],
        ["-1e308", "0", "1e308"],
        ["0", "1e-300", "1"],
        ["0", "1", "1000000"],
    ] {
        let slice = |z: &str| ramp_file(1).with(|set| set.decimal(tags::POSITION, &format!("0\\0\\{z}")));
        let volume = load_path(folder(&heights.map(slice)).path(), VolumeChoice::default()).unwrap();
        assert!(volume.dims()[2] <= 3 * 4 + 256, "{heights:?}: {:?}", volume.dims());
        assert!(!volume.remarks().is_empty(), "{heights:?}");
    }
}

#[test]
fn slices_without_positions_among_others_are_left_out() {
    let mut files = series(&[0, 1, 2], 1.0);
    files.push(ramp_file(9).with(|set| set.without(tags::POSITION)));
    let volume = load_path(folder(&files).path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
    assert_remark(&volume, "1 of 4 images have no position");
}

/// Layers of a part of a volume are those of the whole.
#[test]
fn parts_of_a_volume_with_gaps_are_parts_of_it() {
    let at = folder(&series(&[0, 1, 2, 4, 5], 2.0));
    let portion = chiaroscuro_volume::Portion { region: "1:3,0:2,3:5".parse().ok(), ..Default::default() };
    let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default() };
    let part = load_path(at.path(), choice).unwrap();
    assert_eq!(part.samples(), &Samples::U16(vec![301, 302, 311, 312, 401, 402, 411, 412]));
}
