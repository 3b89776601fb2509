//! Tests of automatic transfer functions on synthetic data of each kind.

use glam::DVec3;

use super::find_transfer;
use crate::first_look::domain::DataDomain;
use crate::first_look::{FirstLookOptions, count_lost_labels, first_settings_with, transfer_for_kind};
use crate::{DensityRange, Easing, LabelTable, MAX_POINTS, Settings, TransferFunction};
use chiaroscuro_volume::{
    DataKind, Histogram, KindName, Modality, Samples, ValueMeaning, ValueMetadata, Volume,
};

const N: usize = 32;

/// Creates a volume from a function of the position relative to the centre, in units of half the edge.
fn volume(value: impl Fn(DVec3) -> f64) -> Volume {
    let middle = (N - 1) as f64 / 2.0;
    let place =
        |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| (c as f64 - middle) / middle));
    let values = (0..N * N * N).map(|at| value(place(at)) as f32).collect();
    Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::F32(values)).unwrap()
}

fn shown(volume: &Volume, kind: KindName) -> TransferFunction {
    let function = transfer_for_kind(volume, &Histogram::from_volume(volume), Some(kind));
    let values: Vec<f64> = function.points.iter().map(|point| point.value).collect();
    assert!(values.is_sorted(), "{values:?}");
    assert!(
        function.points.iter().all(|point| point.value.is_finite() && (0.0..=1.0).contains(&point.opacity))
    );
    function
}

fn bump(p: DVec3, at: DVec3) -> f64 {
    (-(p - at).length_squared() / 0.08).exp()
}

#[test]
fn signed_fields_show_both_sides_and_not_zero() {
    let lobes = volume(|p| 3.0 * (bump(p, DVec3::X * 0.4) - bump(p, DVec3::X * -0.4)));
    let function = shown(&lobes, KindName::Signed);
    for value in [0.0, 0.1, -0.1] {
        assert_eq!(function.opacity_at(value), 0.0, "{value}");
    }
    for value in [2.5, -2.5, 3.0, -3.0] {
        assert!(function.opacity_at(value) > 0.5, "{value}");
        // Red above zero, blue below.
        let [red, _, blue] = function.sample(value).color;
        assert_eq!(red > blue, value > 0.0, "{value}");
    }
    for value in [0.5, 1.0, 2.0, 2.9] {
        assert!((function.opacity_at(value) - function.opacity_at(-value)).abs() < 1e-9, "{value}");
    }
    // Scaled data give a scaled function.
    let larger = volume(|p| 3000.0 * (bump(p, DVec3::X * 0.4) - bump(p, DVec3::X * -0.4)));
    for (a, b) in function.points.iter().zip(shown(&larger, KindName::Signed).points) {
        assert!((a.value * 1000.0 / b.value - 1.0).abs() < 1e-3, "{} {}", a.value, b.value);
    }
}

#[test]
fn one_outlier_does_not_decide_what_is_strong() {
    let lobes = |p: DVec3| 3.0 * (bump(p, DVec3::X * 0.4) - bump(p, DVec3::X * -0.4));
    let before = shown(&volume(lobes), KindName::Signed);
    for odd in [1e30, -1e30, 500.0] {
        let with = volume(|p| if p.min_element() > 0.99 { odd } else { lobes(p) });
        let found = shown(&with, KindName::Signed);
        for (a, b) in before.points.iter().zip(&found.points) {
            assert!((a.value - b.value).abs() < 0.06, "{odd}: {} {}", a.value, b.value);
        }
    }
}

#[test]
fn noise_around_zero_is_not_shown() {
    // Uniform noise of deviation 0.58 with a strong spot: none of the noise is strong.
    let noise = |p: DVec3| ((p.dot(DVec3::new(127.1, 311.7, 74.7))).sin() * 43758.5453).fract();
    let spot = volume(|p| noise(p) + 8.0 * bump(p, DVec3::ZERO) - 8.0 * bump(p, DVec3::X * 0.7));
    let function = shown(&spot, KindName::Signed);
    assert_eq!(function.opacity_at(1.0), 0.0);
    assert!(function.opacity_at(7.0) > 0.5 && function.opacity_at(-7.0) > 0.5);
}

#[test]
fn hounsfield_units_show_bone_and_not_flesh() {
    let head = |offset: f64| {
        volume(move |p| {
            offset
                + if p.length() > 0.8 {
                    -1000.0
                } else if p.length() > 0.65 {
                    900.0
                } else {
                    40.0
                }
        })
    };
    for water in [0.0, 1024.0] {
        let function = shown(&head(water), KindName::HounsfieldCt);
        for hidden in [-1000.0, -100.0, 40.0, 100.0] {
            assert_eq!(function.opacity_at(water + hidden), 0.0, "{hidden}");
        }
        for bone in [500.0, 900.0, 3000.0] {
            assert!(function.opacity_at(water + bone) > 0.5, "{bone}");
        }
    }
    // Without bone, other tissue is shown.
    let soft = volume(|p| if p.length() > 0.7 { -1000.0 } else { 40.0 });
    assert!(shown(&soft, KindName::HounsfieldCt).opacity_at(40.0) > 0.3);
}

#[test]
fn what_is_dark_is_shown_on_bright() {
    let dark = volume(|p| 1000.0 - 800.0 * bump(p, DVec3::ZERO) + 10.0 * (40.0 * p.x).sin());
    let function = shown(&dark, KindName::DarkOnBright);
    assert_eq!(function.opacity_at(990.0), 0.0);
    assert!(function.opacity_at(250.0) > 0.6 && function.opacity_at(200.0) >= function.opacity_at(500.0));
}

#[test]
fn masks_have_their_surface_halfway() {
    for (low, high) in [(0.0, 255.0), (-1.0, 1.0), (0.0, 1e-6)] {
        let mask = volume(|p| if p.length() < 0.6 { high } else { low });
        let function = shown(&mask, KindName::Mask);
        let span = high - low;
        assert_eq!(function.opacity_at(low + 0.35 * span), 0.0);
        assert!(function.opacity_at(low + 0.65 * span) > 0.8 && function.opacity_at(high) > 0.8);
    }
    // Other data can be treated as a mask, and an outlier does not widen its surface.
    let ball = |p: DVec3| 100.0 * (-4.0 * p.length_squared()).exp();
    let odd = volume(|p| if p.min_element() > 0.99 { 1e30 } else { ball(p) });
    let (before, found) = (shown(&volume(ball), KindName::Mask), shown(&odd, KindName::Mask));
    for (a, b) in before.points.iter().zip(&found.points) {
        // A tolerance for the few brightest voxels, which are outliers beside it.
        assert!((a.value - b.value).abs() < 5.0, "{} {}", a.value, b.value);
    }
}

#[test]
fn every_label_is_shown_alike_in_a_color_of_its_own() {
    let regions = |p: DVec3| if p.length() > 0.9 { 0.0 } else { 1.0 + ((p.x + 1.0) * 5.0).floor() * 37.0 };
    let mut hints = ValueMetadata::default();
    hints.labels.insert(38, "named", Some([0.1, 0.2, 0.3]));
    let labels = volume(regions).with_metadata(hints);
    let function = shown(&labels, KindName::LabelMap);
    assert_eq!(function.opacity_at(0.0), 0.0);
    let numbers: Vec<f64> = (0..10).map(|i| f64::from(i) * 37.0 + 1.0).collect();
    for (index, &number) in numbers.iter().enumerate() {
        assert_eq!(function.opacity_at(number), function.opacity_at(numbers[0]));
        assert!(function.opacity_at(number) > 0.8);
        assert!(
            numbers[..index]
                .iter()
                .all(|&other| function.sample(other).color != function.sample(number).color)
        );
    }
    let [red, ..] = function.sample(38.0).color;
    assert!((red - crate::linear_from_srgb(f64::from(0.1f32))).abs() < 1e-9, "the file's own colour");
    let settings = Settings::default().with_transfer(function);
    assert_eq!(count_lost_labels(&settings, &labels), 0);
    // The first look has a table with the same colours.
    let wishes = FirstLookOptions { data_kind: Some(KindName::LabelMap), ..FirstLookOptions::default() };
    let first = first_settings_with(&labels, &Histogram::from_volume(&labels), wishes);
    assert_eq!((first.layer().labels.len(), count_lost_labels(&first, &labels)), (11, 0));
    let named = first.layer().labels.get(38).expect("an entry");
    assert_eq!((named.name.as_str(), named.color), ("named", [0.1, 0.2, 0.3]));
    assert!(!first.layer().labels.look_or_default(0).visible && named.visible);
    let mut hidden = first.clone();
    hidden.layer_mut().labels.entry_mut(38).visible = false;
    assert_eq!(count_lost_labels(&hidden, &labels), 1);
    let other = FirstLookOptions { data_kind: Some(KindName::Scalar), ..wishes };
    assert!(first_settings_with(&labels, &Histogram::from_volume(&labels), other).layer().labels.is_empty());
    let ramp = Settings::default().with_transfer(shown(&labels, KindName::Scalar));
    assert!(count_lost_labels(&ramp, &labels) > 0, "what it is for");
}

/// Creates regions with the numbers 0, `first`, `first` + 1 … `first` + `count` − 1.
fn regions(first: usize, count: usize) -> Volume {
    let values = (0..N * N * N).map(|at| {
        let region = at / (N * N * N / (count + 1) + 1);
        if region == 0 { 0 } else { (first + region - 1) as u32 }
    });
    Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::U32(values.collect())).unwrap()
}

#[test]
fn labels_are_told_apart_in_the_table_where_it_has_an_entry_for_each() {
    let look = |volume: &Volume| {
        let wishes = FirstLookOptions { data_kind: Some(KindName::LabelMap), ..FirstLookOptions::default() };
        // As if the label table were removed.
        let labels = LabelTable::default();
        first_settings_with(volume, &Histogram::from_volume(volume), wishes).with_labels(labels)
    };
    for (first, count) in [(1, 40), (1, 500), (1, 600), (1, 900), (1, 1022), (5000, 800)] {
        let volume = regions(first, count);
        let settings = look(&volume);
        assert_eq!(count_lost_labels(&settings, &volume), 0, "{count} from {first}");
        // Over all values there are not enough entries, so it is the range that matters.
        let all = settings.with_range(DensityRange::Full);
        let is_enough = first + count <= 512;
        assert_eq!(count_lost_labels(&all, &volume) == 0, is_enough, "{count} from {first}");
    }
    // With too few entries, the lowest label is still visible.
    let many = regions(5000, 3000);
    let settings = look(&many);
    let range = settings.shown_range(&many.ranges());
    let table = settings.layer().transfer.bake(range, 1.0, 1.0);
    assert!(table.sample(many.with_density_mapping(range).density_of(5000.0))[3] > 0.5);
    assert_eq!(table.sample(many.with_density_mapping(range).density_of(0.0))[3], 0.0);
    // No range has an entry for each number of these.
    for volume in [
        regions(1, 3000),
        volume(|p| {
            if p.x > 0.0 {
                1.0
            } else if p.y > 0.0 {
                2.0
            } else {
                50_000.0
            }
        }),
    ] {
        assert!(count_lost_labels(&look(&volume), &volume) > 0);
    }
}

#[test]
fn functions_have_no_more_points_than_they_may() {
    let many = volume(|p| ((p + 1.0) * 16.0).floor().dot(DVec3::new(1.0, 40.0, 1600.0)).max(0.0));
    let function = shown(&many, KindName::LabelMap);
    assert!(
        function.points.len() <= MAX_POINTS
            && function.points.iter().all(|point| point.easing == Easing::Step)
    );
}

#[test]
fn every_volume_can_be_treated_as_every_kind() {
    let flat = volume(|_| 7.0);
    let negative = volume(|p| -5.0 - p.length());
    let odd = volume(|p| if p.x > 0.9 { 1e30 } else { 0.0 });
    for volume in [flat, negative, odd] {
        for kind in KindName::choices() {
            let settings = first_settings_with(
                &volume,
                &Histogram::from_volume(&volume),
                FirstLookOptions { data_kind: kind, ..FirstLookOptions::default() },
            );
            let mut sane = settings.clone();
            sane.sanitise();
            assert_eq!(sane, settings, "{kind:?}");
            assert!(
                settings.layer().transfer.points.windows(2).all(|pair| pair[0].value <= pair[1].value),
                "{kind:?}"
            );
        }
    }
}

#[test]
fn colors_are_those_of_the_field() {
    let rough =
        |p: DVec3| if p.length() < 0.6 { 100.0 + 20.0 * ((p.x * 91.0).sin() * 47.0).fract() } else { 0.0 };
    let domain =
        |volume: &Volume| find_transfer(volume, &Histogram::from_volume(volume), DataKind::Scalar).domain;
    let with = |say: &dyn Fn(&mut ValueMetadata)| {
        let mut hints = ValueMetadata::default();
        say(&mut hints);
        domain(&volume(rough).with_metadata(hints))
    };
    assert_eq!(with(&|_| {}), DataDomain::Unknown);
    assert_eq!(with(&|hints| hints.modality = Modality::Mr), DataDomain::MagneticResonance);
    assert_eq!(with(&|hints| hints.modality = Modality::Ct), DataDomain::Metal);
    assert_eq!(with(&|hints| hints.modality = Modality::LightMicroscopy), DataDomain::Fluorescence);
    assert_eq!(with(&|hints| hints.meaning = ValueMeaning::PositiveDensity), DataDomain::Molecule);
    assert_eq!(domain(&volume(rough).with_anatomical_axes(true)), DataDomain::MagneticResonance);
    assert_eq!(domain(&volume(|p| 200.0 * (-p.length_squared() * 3.0).exp())), DataDomain::Simulation);
    let shell = |p: DVec3| if (0.5..0.7).contains(&p.length()) { 100.0 } else { 0.0 };
    assert_eq!(domain(&volume(shell)), DataDomain::Unknown);
}
