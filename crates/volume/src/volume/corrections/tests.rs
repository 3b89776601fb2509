//! Tests of corrections: what they preserve, that they can be undone, and that they match a file with the corrected
//! metadata.

use glam::{DAffine3, DMat3, DVec3};

use super::*;
use crate::{Dataset, DensityMapping, Samples, ValueMetadata, Volume, VolumeError};

const DIMS: [usize; 3] = [5, 4, 3];

/// Makes a volume whose voxels all differ, with a sheared grid away from the origin, as in some files.
fn volume() -> Volume {
    let axes =
        DMat3::from_cols(DVec3::new(0.5, 0.1, 0.0), DVec3::new(-0.2, 0.7, 0.1), DVec3::new(0.0, 0.3, -2.0));
    let world_from_index = DAffine3 { matrix3: axes, translation: DVec3::new(-30.0, 12.0, 7.0) };
    Volume::new("t", DIMS, world_from_index, Samples::I16((0..60).map(|value| 7 * value - 90).collect()))
        .unwrap()
}

fn spaced(spacing: [f64; 3]) -> Volume {
    Volume::with_spacing("t", DIMS, spacing.into(), Samples::U8((0..60).collect())).unwrap()
}

fn with(change: impl FnOnce(&mut Corrections)) -> Corrections {
    let mut corrections = Corrections::default();
    change(&mut corrections);
    corrections
}

/// Returns one example of each kind of correction.
fn all() -> Vec<Corrections> {
    vec![
        with(|by| by.spacing = Some([0.25, 1.5, 3.0])),
        with(|by| by.unit = Some(SpacingUnit::Nm)),
        with(|by| by.unit = Some(SpacingUnit::Voxels)),
        with(|by| by.flip.x = true),
        with(|by| by.flip = Flips { x: true, y: false, z: true }),
        with(|by| by.axis_order = AxisOrder::Zyx),
        with(|by| by.orientation = Some(Orientation::Unknown)),
        with(|by| by.orientation = Some("LPS".parse().unwrap())),
        with(|by| by.padding_value = PaddingValue::Value(-90.0)),
        with(|by| by.padding_value = PaddingValue::Nothing),
        with(|by| by.value_scale = ValueScale { slope: 2.0, intercept: -1024.0 }),
    ]
}

/// Returns the world positions of the corner voxels of a grid.
fn corners(volume: &Volume) -> Vec<DVec3> {
    let last = DVec3::from(volume.dims().map(|n| n as f64 - 1.0));
    let corner = |at: usize| DVec3::new((at & 1) as f64, (at >> 1 & 1) as f64, (at >> 2) as f64) * last;
    (0..8).map(|at| volume.world_from_index().transform_point3(corner(at))).collect()
}

#[test]
fn default_corrections_restore_the_opened_volume() {
    let opened = volume().with_remarks(vec!["told".to_owned()]);
    for by in all() {
        let corrected = opened.corrected(&by).unwrap();
        assert_ne!(corrected.content_id(), opened.content_id(), "{by:?}");
        assert_eq!((corrected.opened_id(), corrected.corrections()), (opened.content_id(), &by));
        assert_eq!(corrected.remarks(), opened.remarks());
        let again = corrected.corrected(&Corrections::default()).unwrap();
        assert_eq!((again.content_id(), again.ranges()), (opened.content_id(), opened.ranges()));
        assert_eq!(again.world_from_index(), opened.world_from_index());
        assert!(again.corrections().is_none() && again.shares_voxels(&opened));
    }
    let ids: std::collections::BTreeSet<_> =
        all().iter().map(|by| opened.corrected(by).unwrap().content_id()).collect();
    assert_eq!(ids.len(), all().len(), "no two are taken for each other");
}

#[test]
fn corrections_replace_earlier_ones() {
    let opened = volume();
    for first in all() {
        for second in all() {
            let directly = opened.corrected(&second).unwrap();
            let after = opened.corrected(&first).unwrap().corrected(&second).unwrap();
            assert_eq!(after.content_id(), directly.content_id());
            assert_eq!(after.world_from_index(), directly.world_from_index());
            assert_eq!((after.id(), after.samples()), (directly.id(), directly.samples()));
        }
    }
}

#[test]
fn voxels_are_shared_unless_values_change() {
    let opened = volume();
    for by in all() {
        let corrected = opened.corrected(&by).unwrap();
        assert_eq!(
            corrected.shares_voxels(&opened),
            by.keeps_values() || by.padding_value == PaddingValue::Nothing
        );
    }
}

/// Tests for exact equality, so that pictures are identical.
#[test]
fn corrected_spacing_equals_that_of_a_file() {
    let said = spaced([0.1, 0.7, 3.0]);
    for spacing in [[0.5, 0.5, 2.0], [1.0 / 3.0, 0.1, 7.3], [1e-6, 3e-6, 2e-6]] {
        let corrected = said.corrected(&with(|by| by.spacing = Some(spacing))).unwrap();
        let written = spaced(spacing);
        assert_eq!(corrected.world_from_index(), written.world_from_index());
        assert_eq!((corrected.scene(), corrected.spacing_mm()), (written.scene(), DVec3::from(spacing)));
        assert!(corrected.scene().mm_per_unit != said.scene().mm_per_unit);
    }
}

#[test]
fn units_make_lengths_of_numbers() {
    let unknown = spaced([1.0; 3]).with_unknown_scale();
    let spacing = |by: Corrections| {
        let corrected = unknown.corrected(&by).unwrap();
        (corrected.spacing_mm().x, corrected.has_unknown_scale())
    };
    assert_eq!(spacing(with(|by| by.unit = Some(SpacingUnit::Um))), (1e-3, false));
    assert_eq!(spacing(with(|by| by.spacing = Some([4.0; 3]))), (4.0, false));
    assert_eq!(spacing(with(|by| by.flip.x = true)), (1.0, true));
    let in_voxels = with(|by| (by.spacing, by.unit) = (Some([4.0; 3]), Some(SpacingUnit::Voxels)));
    assert_eq!(spacing(in_voxels), (4.0, true));
    for unit in SpacingUnit::ALL {
        let by = with(|by| (by.spacing, by.unit) = (Some([2.0, 3.0, 5.0]), Some(unit)));
        let found = volume().corrected(&by).unwrap().spacing_mm() / unit.mm();
        assert!((found - DVec3::new(2.0, 3.0, 5.0)).length() < 1e-12, "{unit:?}: {found}");
    }
}

#[test]
fn flips_mirror_within_the_same_extent() {
    let opened = volume();
    let flipped = opened.corrected(&with(|by| by.flip.y = true)).unwrap();
    assert_eq!(opened.value(1, 0, 2), flipped.value(1, 0, 2), "voxels stay where they are in memory");
    let (before, after) = (opened.world_from_index(), flipped.world_from_index());
    for [x, y, z] in [[0.0, 0.0, 0.0], [4.0, 3.0, 2.0], [1.0, 2.0, 0.5]] {
        let mirrored = DVec3::new(x, DIMS[1] as f64 - 1.0 - y, z);
        let apart = after.transform_point3(DVec3::new(x, y, z)) - before.transform_point3(mirrored);
        assert!(apart.length() < 1e-12);
    }
    // Flipping twice restores the geometry: tested on a file that lies as the flipped volume does.
    let file = Volume::new("t", DIMS, after, opened.samples().clone()).unwrap();
    let twice = file.corrected(&with(|by| by.flip.y = true)).unwrap().world_from_index();
    assert!(twice.abs_diff_eq(before, 1e-12), "{twice:?}");
}

#[test]
fn orders_of_axes_are_undone_by_their_inverse() {
    for order in AxisOrder::ALL {
        let opened = volume();
        let turned = opened.corrected(&with(|by| by.axis_order = order)).unwrap();
        // Spacings belong to the axes of the file.
        assert!((turned.spacing_mm() - opened.spacing_mm()).length() < 1e-12);
        let file = Volume::new("t", DIMS, turned.world_from_index(), opened.samples().clone()).unwrap();
        let back = file.corrected(&with(|by| by.axis_order = order.inverse())).unwrap();
        assert!(back.world_from_index().abs_diff_eq(opened.world_from_index(), 1e-12), "{order:?}");
        let places = order.permutation().map(|place| order.inverse().permutation()[place]);
        assert_eq!(places, [0, 1, 2], "{order:?}");
        let json = serde_json::to_value(order).unwrap();
        assert_eq!(json.as_str().unwrap(), order.name().replace(' ', ""));
    }
}

#[test]
fn axes_run_where_the_orientation_says() {
    let by = with(|by| by.orientation = Some("psl".parse().unwrap()));
    let corrected = spaced([0.5, 1.0, 2.0]).corrected(&by).unwrap();
    let axes = corrected.world_from_index().matrix3;
    assert_eq!(axes, DMat3::from_cols(DVec3::Y * -0.5, DVec3::Z, DVec3::X * -2.0));
    assert!(corrected.is_anatomical() && !spaced([1.0; 3]).is_anatomical());
    let known = volume().with_anatomical_axes(true);
    let unknown = known.corrected(&with(|by| by.orientation = Some(Orientation::Unknown))).unwrap();
    assert!(!unknown.is_anatomical());
    assert_eq!(unknown.world_from_index(), known.world_from_index());
    let codes: std::collections::BTreeSet<_> = Orientation::all_anatomical().map(String::from).collect();
    assert_eq!(codes.len(), 48);
    for code in codes {
        let orientation: Orientation = code.parse().unwrap();
        assert_eq!(orientation.to_string(), code);
        let Orientation::Anatomical(headings) = orientation else { panic!("{code}") };
        assert_eq!(AnatomicalAxes::nearest(headings.directions()), headings);
    }
    for bad in ["", "RA", "RAR", "RAX", "RLS", "RASI", "above"] {
        assert!(bad.parse::<Orientation>().unwrap_err().contains("RAS"), "{bad}");
    }
    assert_eq!(" Unknown ".parse(), Ok(Orientation::Unknown));
}

#[test]
fn means_of_blocks_are_corrected_as_their_voxels_are() {
    let opened = volume();
    for by in all().into_iter().filter(Corrections::keeps_values) {
        let first = opened.corrected(&by).unwrap().block_averaged([2, 2, 2]).unwrap();
        let last = opened.clone().block_averaged([2, 2, 2]).unwrap().corrected(&by).unwrap();
        for (a, b) in corners(&first).into_iter().zip(corners(&last)) {
            assert!((a - b).length() < 1e-9 * first.scene().mm_per_unit.max(1.0), "{by:?}: {a} {b}");
        }
        let spacing = last.file_spacing_mm() / opened.corrected(&by).unwrap().spacing_mm();
        assert!((spacing - DVec3::ONE).length() < 1e-9, "{by:?}: {spacing}");
    }
}

#[test]
fn padding_values_are_corrected() {
    let declared = volume().with_padding(-90.0).unwrap();
    assert_eq!(declared.missing().map(super::super::MissingVoxels::count), Some(1));
    let padded = volume().corrected(&with(|by| by.padding_value = PaddingValue::Value(-90.0))).unwrap();
    assert_eq!((padded.ranges(), padded.padding_value()), (declared.ranges(), Some(-90.0)));
    assert_eq!(padded.missing(), declared.missing());
    let none = declared.corrected(&with(|by| by.padding_value = PaddingValue::Nothing)).unwrap();
    assert_eq!((none.missing(), none.ranges()), (None, volume().ranges()));
    let same = Volume::with_spacing("t", [2, 1, 1], DVec3::ONE, Samples::U8(vec![3; 2])).unwrap();
    let all = same.corrected(&with(|by| by.padding_value = PaddingValue::Value(3.0)));
    assert!(matches!(all, Err(VolumeError::NothingFinite)));
}

#[test]
fn value_scales_choose_a_type_that_fits() {
    let mut hints = ValueMetadata::default();
    hints.set_window(10.0, 20.0);
    hints.labels.insert(3, "three", None);
    let opened = spaced([1.0; 3]).with_metadata(hints).with_padding(5.0).unwrap();
    for (slope, intercept, kind) in [
        (1.0, 100.0, "uint8"),
        (-1.0, 0.0, "int8"),
        (2.0, -1024.0, "int16"),
        (100_000.0, 0.0, "uint32"),
        (0.5, 0.0, "float32"),
        (1e11, 0.0, "float32"),
    ] {
        let scale = ValueScale { slope, intercept };
        let corrected = opened.corrected(&with(|by| by.value_scale = scale)).unwrap();
        assert_eq!(corrected.samples().voxel_type().name(), kind, "{scale:?}");
        for voxel in [0, 5, 7, 59] {
            let (value, wanted) = (corrected.samples().value(voxel), scale.value_from_number(voxel as f64));
            assert!((value - wanted).abs() <= 1e-6 * wanted.abs(), "{value} {wanted}");
        }
        assert_eq!(
            corrected.padding_value().map(|value| value as f32),
            Some(scale.value_from_number(5.0) as f32)
        );
        assert!(corrected.missing().is_some_and(|missing| missing.count() == 1 && missing.contains(5)));
        let [low, high] = corrected.metadata().window.unwrap();
        assert!(low < high);
        assert_eq!(scale.number_from_value(scale.value_from_number(3.25)), 3.25);
    }
    let wide = Samples::F64(vec![-1e300, 1e300]);
    let wide = Volume::with_spacing("t", [2, 1, 1], DVec3::ONE, wide).unwrap();
    let too_wide = wide.corrected(&with(|by| by.value_scale.slope = 1e9));
    assert!(matches!(too_wide, Err(VolumeError::TooWide { .. } | VolumeError::NothingFinite)));
}

#[test]
fn bounds_and_histogram_follow_corrected_values() {
    let opened = Dataset::new(volume()).with_density_mapping(DensityMapping::Range((-50.0, 50.0).into()));
    for by in all() {
        let corrected = opened.corrected(&by).unwrap();
        let afresh = Dataset::new(
            opened
                .volume()
                .corrected(&by)
                .unwrap()
                .with_density_mapping(corrected.volume().density_mapping()),
        );
        let counts = |dataset: &Dataset| format!("{:?}", dataset.histogram());
        assert_eq!(counts(&corrected), counts(&afresh), "{by:?}");
        if by.keeps_values() {
            assert!(std::sync::Arc::ptr_eq(opened.bricks(), corrected.bricks()));
            assert_eq!(corrected.volume().density_mapping(), opened.volume().density_mapping());
        }
    }
}

#[test]
fn corrections_round_trip_and_accept_text() {
    for by in all() {
        let text = serde_json::to_string(&by).unwrap();
        assert_eq!(serde_json::from_str::<Corrections>(&text).unwrap(), by, "{text}");
        assert!(!by.in_words().is_empty());
    }
    assert!(Corrections::default().in_words().is_empty());
    let read = |text: &str| serde_json::from_str::<Corrections>(text);
    let spacing = Some([0.5, 0.5, 2.0]);
    for text in ["[0.5, 0.5, 2]", "\"0.5,0.5,2\"", "\"0.5 x 0.5 x 2\""] {
        assert_eq!(read(&format!("{{\"spacing\": {text}}}")).unwrap().spacing, spacing);
    }
    assert_eq!(read(r#"{"spacing": 3}"#).unwrap().spacing, Some([3.0; 3]));
    assert_eq!(read(r#"{"unit": "µm"}"#).unwrap().unit, Some(SpacingUnit::Um));
    assert_eq!(read(r#"{"padding_value": "none"}"#).unwrap().padding_value, PaddingValue::Nothing);
    for (bad, word) in [
        (r#"{"spacing": "wide"}"#, "0.5,0.5,2"),
        (r#"{"padding_value": "some"}"#, "none"),
        (r#"{"orientation": "up"}"#, "RAS"),
        (r#"{"unit": "inch"}"#, "mm"),
    ] {
        let refused = read(bad).unwrap_err().to_string();
        assert!(refused.contains(word), "{refused}");
    }
}

#[test]
fn unusable_numbers_are_reset() {
    let sane = |change: fn(&mut Corrections)| {
        let mut by = with(change);
        by.sanitise();
        by
    };
    for nonsense in [
        (|by| by.spacing = Some([0.0, 1.0, 1.0])) as fn(&mut Corrections),
        |by| by.spacing = Some([f64::NAN, 1.0, 1.0]),
        |by| by.spacing = Some([-1.0, 1.0, 1.0]),
        |by| by.spacing = Some([1e-8, 1.0, 1.0]),
        |by| by.padding_value = PaddingValue::Value(f64::INFINITY),
        |by| by.hidden_table = Some(f64::NAN),
        |by| by.value_scale.slope = 0.0,
        |by| by.value_scale.slope = f64::NAN,
        |by| by.value_scale.intercept = f64::NEG_INFINITY,
    ] {
        assert!(sane(nonsense).is_none());
    }
    for mut by in all() {
        let before = by;
        by.sanitise();
        assert_eq!(by, before);
    }
    // A unit may turn usable numbers into unusable ones.
    let far = |by: &mut Corrections| (by.spacing, by.unit) = (Some([1e8; 3]), Some(SpacingUnit::M));
    assert_eq!(sane(far).spacing, None);
}
