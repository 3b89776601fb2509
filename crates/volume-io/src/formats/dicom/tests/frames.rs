//! Tests of files with several frames.

use super::*;

/// A file with frames of 1 x 1 pixels of these values.
fn cine_file(values: &[u16]) -> DicomFileBuilder {
    let count = values.len().to_string();
    DicomFileBuilder::new(EXPLICIT).size(1, 1).frames(&count).words(values)
}

/// An enhanced file with shared and per-frame functional groups: position, time and slope.
fn enhanced(
    syntax: &'static str,
    values: &[u16],
    frames: &[(&str, u32, &str)],
    is_marked: bool,
) -> DicomFileBuilder {
    let one = |tag: DicomTag, set: DataSetBuilder| DataSetBuilder::default().items(tag, vec![set], is_marked);
    let join = |sets: Vec<DataSetBuilder>| DataSetBuilder(sets.into_iter().flat_map(|set| set.0).collect());
    let shared = join(vec![
        one(
            tags::PLANE_ORIENTATION,
            DataSetBuilder::default().decimal(tags::ORIENTATION, "0\\1\\0\\0\\0\\-1"),
        ),
        one(tags::PIXEL_MEASURES, DataSetBuilder::default().decimal(tags::PIXEL_SPACING, "3\\2")),
    ]);
    let each = frames.iter().map(|(x, time, slope)| {
        join(vec![
            one(
                tags::PLANE_POSITION,
                DataSetBuilder::default().decimal(tags::POSITION, &format!("{x}\\0\\0")),
            ),
            one(
                tags::FRAME_CONTENT,
                DataSetBuilder::default().value(tags::TEMPORAL_POSITION_INDEX, *b"UL", &time.to_le_bytes()),
            ),
            one(
                tags::VALUE_TRANSFORMATION,
                DataSetBuilder::default().decimal(tags::SLOPE, slope).decimal(tags::INTERCEPT, "1"),
            ),
        ])
    });
    let each = each.collect();
    let count = values.len().to_string();
    let drop = [tags::POSITION, tags::ORIENTATION, tags::PIXEL_SPACING, tags::SLICE_THICKNESS];
    DicomFileBuilder::new(syntax)
        .size(1, 1)
        .frames(&count)
        .words(values)
        .with(|set| drop.into_iter().fold(set, DataSetBuilder::without))
        .with(|set| set.items(tags::SHARED_GROUPS, vec![shared], is_marked))
        .with(|set| set.items(tags::FRAME_GROUPS, each, is_marked))
}

#[test]
fn frames_are_put_in_order_by_what_is_said_of_each() {
    // Sagittal: the normal is −x, so slices go from right to left.
    let frames = [("5", 2, "1"), ("1", 1, "1"), ("5", 1, "1"), ("1", 2, "1"), ("3", 1, "1"), ("3", 2, "1")];
    for syntax in [EXPLICIT, IMPLICIT, DEFLATED] {
        for is_marked in [false, true] {
            let file = enhanced(syntax, &[1, 2, 3, 4, 5, 6], &frames, is_marked);
            assert_refused(
                file.load(),
                LoadErrorKind::BadInput,
                &["2 time steps", "--frame", "temporal position 2"],
            );
            let of = |frame| {
                file.load_with(VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }).unwrap()
            };
            assert_eq!(of(0).samples(), &Samples::U8(vec![4, 6, 3]), "{syntax} {is_marked}");
            assert_eq!(of(1).samples(), &Samples::U8(vec![2, 7, 5]), "{syntax} {is_marked}");
            let expected = [0.0, -2.0, 0.0, 0.0, 0.0, -3.0, 2.0, 0.0, 0.0, -5.0, 0.0, 0.0];
            assert_eq!(affine_columns(&of(0)), expected);
        }
    }
}

#[test]
fn each_frame_has_its_own_scale() {
    let frames = [("1", 1, "0.5"), ("2", 1, "1"), ("3", 1, "2")];
    let volume = enhanced(EXPLICIT, &[10, 10, 10], &frames, false).load().unwrap();
    assert_eq!(volume.samples(), &Samples::F32(vec![21.0, 11.0, 6.0]));
}

#[test]
fn frames_without_places_are_stacked_and_that_is_said() {
    let thick = cine_file(&[1, 2, 3]).load().unwrap();
    assert_eq!(affine_columns(&thick)[6..], [0.0, 0.0, 2.5, -1.0, -2.0, 3.0]);
    assert_remark(&thick, "2.5 mm, is taken from Slice Thickness");
    let volume = cine_file(&[1, 2, 3]).with(|set| set.without(tags::SLICE_THICKNESS)).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![1, 2, 3]));
    assert!(volume.has_unknown_scale());
    assert_remark(&volume, "stacked in their order");
    assert_eq!(volume.spacing_mm(), glam::DVec3::new(0.25, 0.5, 0.5), "pixels keep their shape");
    let volume =
        cine_file(&[1, 2, 3]).with(|set| set.decimal(tags::SPACING_BETWEEN_SLICES, "-4")).load().unwrap();
    assert_eq!(affine_columns(&volume)[6..], [0.0, 0.0, -4.0, -1.0, -2.0, 3.0]);
    assert_remark(&volume, "4 mm, is taken from Spacing Between Slices");
    let offsets =
        |set: DataSetBuilder| set.decimal(tags::FRAME_OFFSETS, "0\\3\\6").decimal(tags::DOSE_SCALING, "0.5");
    let volume = cine_file(&[1, 2, 3]).with(offsets).load().unwrap();
    assert_eq!(affine_columns(&volume)[8], 3.0);
    assert_eq!(volume.samples(), &Samples::F32(vec![0.5, 1.0, 1.5]));
}

#[test]
fn directions_of_one_file_are_series() {
    let mut file = enhanced(EXPLICIT, &[1, 2], &[("1", 1, "1"), ("2", 1, "1")], false);
    let Some(TestContent::Items(items, _)) = file.set.0.get_mut(&tags::FRAME_GROUPS) else { panic!() };
    let turned = DataSetBuilder::default().decimal(tags::ORIENTATION, "1\\0\\0\\0\\1\\0");
    items[1] = items[1].clone().items(tags::PLANE_ORIENTATION, vec![turned], false);
    assert_refused(file.load(), LoadErrorKind::BadInput, &["2 series", "CT Head sagittal", "CT Head axial"]);
    let choice =
        VolumeChoice::default().with_selected(chiaroscuro_volume::FileDimension::Series, "CT Head axial");
    assert_eq!(file.load_with(choice).unwrap().samples().value(0), 3.0);
}
