//! Tests of the detection of kinds on synthetic data: examples of each kind, and data that only resembles it.

use glam::DVec3;

use super::{DataKind, KindName};
use crate::synthetic::builtin;
use crate::{Modality, Samples, ValueMeaning, ValueMetadata, Volume};

const N: usize = 40;

/// Returns uniform noise from −1 to 1, deterministic for a place and seed.
pub(super) fn noise(at: usize, seed: u64) -> f64 {
    let mut state =
        (at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed.wrapping_mul(0xd1b5_4a32_d192_ed03);
    for _ in 0..3 {
        state = (state ^ (state >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    }
    (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Returns approximately normal noise with a standard deviation of 1.
pub(super) fn bell(at: usize, seed: u64) -> f64 {
    (0..6).map(|i| noise(at, seed * 16 + i)).sum::<f64>() / 2f64.sqrt()
}

/// Makes values from positions relative to the middle, in units of half the edge, and from voxel indices.
pub(super) fn values(value: impl Fn(DVec3, usize) -> f64) -> Vec<f64> {
    let middle = (N - 1) as f64 / 2.0;
    (0..N * N * N)
        .map(|at| {
            let p = [at % N, at / N % N, at / N / N].map(|c| (c as f64 - middle) / middle);
            value(DVec3::from(p), at)
        })
        .collect()
}

pub(super) fn volume_of(samples: Samples) -> Volume {
    Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
}

pub(super) fn kind(values: &[f64]) -> KindName {
    volume_of(Samples::F64(values.to_vec())).kind().kind.name()
}

/// Returns the number of the nearest of `count` seeds (a Voronoi cell), from 1; 0 outside a ball.
fn regions(p: DVec3, count: u64) -> f64 {
    if p.length() > 0.8 {
        return 0.0;
    }
    let centre = |i: u64| DVec3::new(noise(1, i), noise(2, i), noise(3, i)) * 0.7;
    let nearest = (0..count).min_by(|&a, &b| centre(a).distance(p).total_cmp(&centre(b).distance(p)));
    nearest.unwrap_or(0) as f64 + 1.0
}

pub(super) fn bump(p: DVec3, at: DVec3, width: f64) -> f64 {
    (-(p - at).length_squared() / (2.0 * width * width)).exp()
}

/// Returns Hounsfield units of a trunk with lungs, ribs and a spine.
pub(super) fn chest(p: DVec3, at: usize) -> f64 {
    let disk = |x: f64, y: f64, rx: f64, ry: f64| ((p.x - x) / rx).powi(2) + ((p.y - y) / ry).powi(2) < 1.0;
    let base = if disk(0.0, 0.5, 0.15, 0.12)
        || (disk(0.0, 0.0, 0.75, 0.6) && !disk(0.0, 0.0, 0.68, 0.53) && p.z.abs() % 0.3 < 0.1)
    {
        600.0
    } else if disk(0.35, 0.0, 0.25, 0.4) || disk(-0.35, 0.0, 0.25, 0.4) {
        -850.0
    } else if disk(0.0, 0.0, 0.85, 0.7) {
        if disk(0.0, 0.0, 0.8, 0.65) { 45.0 } else { -95.0 }
    } else {
        -1000.0
    };
    (base + 15.0 * bell(at, 5)).round()
}

fn masks() -> Vec<Vec<f64>> {
    vec![
        values(|p, _| if p.length() < 0.6 { 255.0 } else { 0.0 }),
        values(|p, _| f64::from(u8::from(p.x > 0.1 && p.y.abs() < 0.9))),
        values(|_, at| f64::from(u8::from(noise(at, 1) > 0.7))),
        values(|p, _| if (p * 9.0).to_array().map(f64::sin).iter().sum::<f64>() > 0.0 { 1.0 } else { -1.0 }),
    ]
}

fn label_maps() -> Vec<Vec<f64>> {
    vec![
        values(|p, _| regions(p, 12)),
        values(|p, _| 1000.0 * regions(p, 7) + if regions(p, 7) > 3.0 { 17.0 } else { 0.0 }),
        // Three nested labels.
        values(|p, _| (3.0 - (p.length() * 4.0).floor()).max(0.0)),
        // Small labels, far apart.
        values(|p, _| {
            if (p * 5.0).fract().abs().max_element() < 0.6 {
                ((p * 5.0).trunc().dot(DVec3::new(1.0, 7.0, 49.0)) + 300.0).max(0.0)
            } else {
                0.0
            }
        }),
    ]
}

fn signed_fields() -> Vec<Vec<f64>> {
    vec![
        values(|p, _| (4.0 * p.x).sin() * (3.0 * p.y).cos() * (5.0 * p.z).sin()),
        values(|p, _| bump(p, DVec3::X * 0.4, 0.15) - 0.8 * bump(p, DVec3::X * -0.4, 0.15)),
        values(|p, at| 30.0 * (bump(p, DVec3::Y * 0.4, 0.2) - bump(p, DVec3::Y * -0.4, 0.2)) + bell(at, 3)),
        values(|p, _| if p.length() < 0.7 { 1e-9 * (p.x * 6.0).sin() } else { 0.0 }),
    ]
}

fn hounsfield() -> Vec<Vec<f64>> {
    vec![
        values(chest),
        // Padding outside the scanner's field of view.
        values(|p, at| if p.truncate().length() > 0.95 { -3024.0 } else { chest(p, at) }),
        values(|p, at| {
            let base = if p.length() > 0.7 {
                -1000.0
            } else if p.length() > 0.6 {
                1200.0
            } else {
                35.0
            };
            (base + 10.0 * bell(at, 8)).round()
        }),
    ]
}

fn dark_on_bright() -> Vec<Vec<f64>> {
    vec![
        values(|p, at| if (p.truncate() - glam::DVec2::X * 0.3 * (3.0 * p.z).sin()).length() < 0.2 { 30.0 } else { 230.0 } + 12.0 * bell(at, 2)),
        values(|p, _| 1000.0 - 900.0 * bump(p, DVec3::ZERO, 0.3)),
        values(|p, _| f64::from(u8::from(p.length() > 0.5))),
    ]
}

fn scalars() -> Vec<Vec<f64>> {
    let edge = |p: DVec3| ((0.6 - p.length()) * 12.0).clamp(0.0, 1.0);
    vec![
        values(|p, _| 200.0 * edge(p)),
        // A CT of metal in eight bits: two materials with edges between them, and little else.
        values(|p, _| (200.0 * edge(p)).round()),
        // A core of one material in another, without edges.
        values(|p, _| {
            if p.length() < 0.4 {
                220.0
            } else if p.length() < 0.7 {
                90.0
            } else {
                0.0
            }
        }),
        // A smooth field of eight values.
        values(|p, _| (8.0 * bump(p, DVec3::ZERO, 0.5)).floor()),
        // Few values, with noise.
        values(|p, at| (4.0 * edge(p) + 1.0 + 0.5 * bell(at, 4)).round()),
        // A head whose noise reaches below zero.
        values(|p, at| 100.0 * edge(p) + 30.0 * bell(at, 6)),
        // Noise alone, positive and negative.
        values(|_, at| 50.0 + 50.0 * noise(at, 7)),
        values(|_, at| -500.0 + 50.0 * bell(at, 7)),
        // A gradient, and noise over the range of Hounsfield units.
        values(|p, _| p.x + 2.0),
        values(|_, at| (1000.0 + 2000.0 * noise(at, 9)).round()),
        // Tissue that fills the volume, with brighter parts.
        values(|p, at| 100.0 + 20.0 * bell(at, 9) + 60.0 * bump(p, DVec3::X * 0.2, 0.3)),
        // A scan of twelve bits whose tissue is at a thousand.
        values(|p, at| {
            if p.length() < 0.7 { 1024.0 + 40.0 * bell(at, 1) } else { (5.0 * bell(at, 2)).abs() }.round()
        }),
        // A scan without negative values, with padding.
        values(
            |p, at| {
                if p.length() < 0.9 { (80.0 * edge(p) + 5.0 * bell(at, 1).abs()).round() } else { -32768.0 }
            },
        ),
        // A dense object in air whose value is as far below zero.
        values(|p, at| if p.length() < 0.6 { 1200.0 } else { -1000.0 } + 5.0 * bell(at, 3)),
        vec![7.0; N * N * N],
    ]
}

#[track_caller]
fn assert_all(fields: &[Vec<f64>], name: KindName) {
    for (index, field) in fields.iter().enumerate() {
        let volume = volume_of(Samples::F64(field.clone()));
        assert_eq!(volume.kind().kind.name(), name, "{index}: {}", volume.kind().reason);
    }
}

#[test]
fn each_kind_is_recognised_and_what_looks_like_it_is_not() {
    assert_all(&masks(), KindName::Mask);
    assert_all(&label_maps(), KindName::LabelMap);
    assert_all(&signed_fields(), KindName::Signed);
    assert_all(&hounsfield(), KindName::HounsfieldCt);
    assert_all(&dark_on_bright(), KindName::DarkOnBright);
    assert_all(&scalars(), KindName::Scalar);
}

fn all_fields() -> Vec<Vec<f64>> {
    [masks(), label_maps(), signed_fields(), hounsfield(), dark_on_bright(), scalars()].concat()
}

#[test]
fn kinds_do_not_depend_on_how_the_grid_lies() {
    for (index, field) in all_fields().iter().enumerate() {
        let found = kind(field);
        let turned: Vec<f64> = (0..field.len())
            .map(|at| {
                let [x, y, z] = [at % N, at / N % N, at / N / N];
                field[(x * N + (N - 1 - y)) * N + z]
            })
            .collect();
        assert_eq!(kind(&turned), found, "{index}");
    }
}

#[test]
fn kinds_without_an_absolute_meaning_do_not_depend_on_scale_and_offset() {
    for (index, field) in [masks(), dark_on_bright()].concat().iter().enumerate() {
        for (scale, offset) in [(3.7, 11.0), (1e-6, 0.0), (0.25, -40.0)] {
            let other: Vec<f64> = field.iter().map(|value| value * scale + offset).collect();
            assert_eq!(kind(&other), kind(field), "{index}: times {scale} plus {offset}");
        }
    }
    for (index, field) in [signed_fields(), scalars()].concat().iter().enumerate() {
        let other: Vec<f64> = field.iter().map(|value| value * 3e5).collect();
        assert_eq!(kind(&other), kind(field), "{index}");
    }
}

#[test]
fn kinds_do_not_depend_on_the_number_type() {
    for (index, field) in
        [masks(), label_maps(), hounsfield(), dark_on_bright(), scalars()].concat().iter().enumerate()
    {
        let is_whole = field.iter().all(|value| value.fract() == 0.0 && value.abs() < 32000.0);
        let found = kind(field);
        let floats = Samples::F32(field.iter().map(|&value| value as f32).collect());
        assert_eq!(volume_of(floats).kind().kind.name(), found, "{index}");
        if is_whole {
            let short = Samples::I16(field.iter().map(|&value| value as i16).collect());
            let long = Samples::I32(field.iter().map(|&value| value as i32).collect());
            assert_eq!(volume_of(short).kind().kind.name(), found, "{index}");
            assert_eq!(volume_of(long).kind().kind.name(), found, "{index}");
        }
    }
}

#[test]
fn outliers_and_missing_voxels_change_no_kind() {
    for field in all_fields() {
        let found = kind(&field);
        // A mask with one more value is no mask.
        let of_few = volume_of(Samples::F64(field.clone())).value_range();
        let is_of_two = field.iter().all(|value| [of_few.low, of_few.high].contains(value));
        if !is_of_two && found != KindName::LabelMap {
            let mut hot = field.clone();
            hot[N * N * N / 2 + 7] = 1e6;
            assert_eq!(kind(&hot), found);
        }
        let mut missing = field;
        for value in missing.iter_mut().take(N * N * 2) {
            *value = f64::NAN;
        }
        assert_eq!(kind(&missing), found);
    }
}

#[test]
fn file_metadata_overrides_detection() {
    let with = |field: &[f64], say: &dyn Fn(&mut ValueMetadata)| {
        let mut hints = ValueMetadata::default();
        say(&mut hints);
        volume_of(Samples::F64(field.to_vec())).with_metadata(hints).kind().kind
    };
    let ball = &scalars()[0];
    let labels = with(ball, &|hints| hints.meaning = ValueMeaning::Labels);
    assert!(matches!(labels, DataKind::LabelMap { .. }));
    let hounsfield_units = with(ball, &|hints| hints.set_unit("HU"));
    assert_eq!(hounsfield_units, DataKind::HounsfieldCt { water: 0.0 });
    let lobes = &signed_fields()[1];
    assert_eq!(with(lobes, &|hints| hints.meaning = ValueMeaning::PositiveDensity), DataKind::Scalar);
    // Twelve bits without a sign: CT only if the file says so.
    let head = &scalars()[11];
    let of_ct = with(head, &|hints| hints.modality = Modality::Ct);
    assert_eq!(of_ct, DataKind::HounsfieldCt { water: 1024.0 });
    let of_mr = with(&hounsfield()[2], &|hints| hints.modality = Modality::Mr);
    assert_ne!(of_mr.name(), KindName::HounsfieldCt);
    let rescaled = with(&hounsfield()[2], &|hints| hints.is_rescaled = true);
    assert_ne!(rescaled.name(), KindName::HounsfieldCt);
    assert_eq!(with(&scalars()[12], &|hints| hints.set_padding(-32768.0)), DataKind::Scalar);
}

#[test]
fn labels_are_counted() {
    let count = |field: &[f64]| volume_of(Samples::F64(field.to_vec())).kind().kind;
    let mut twelve = label_maps()[0].clone();
    twelve[..13].copy_from_slice(&std::array::from_fn::<f64, 13, _>(|number| number as f64));
    assert_eq!(count(&twelve), DataKind::LabelMap { count: 12 });
    assert_eq!(count(&label_maps()[2]), DataKind::LabelMap { count: 3 });
    let everywhere: Vec<f64> =
        values(|p, _| 5.0 + if p.x > 0.0 { 1.0 } else { 0.0 } + if p.y > 0.0 { 2.0 } else { 0.0 });
    assert_eq!(count(&everywhere), DataKind::LabelMap { count: 4 });
}

#[test]
fn built_in_volumes_are_what_they_are() {
    for (name, n, kind) in [
        ("chair", 96, KindName::Scalar),
        ("chair", 200, KindName::Scalar),
        ("cloud", 64, KindName::Scalar),
        ("sphere", 128, KindName::Scalar),
        ("box", 32, KindName::Mask),
        ("marschner-lobb", 48, KindName::Scalar),
    ] {
        let volume = builtin(name, Some(n)).unwrap();
        assert_eq!(volume.kind().kind.name(), kind, "{name} {n}: {}", volume.kind().reason);
    }
}

#[test]
fn declared_padding_is_ignored() {
    let with_padding = |values: Vec<f64>, padding: f64| {
        volume_of(Samples::F64(values)).with_padding(padding).unwrap().kind().kind
    };
    // Padding scattered over a label map, so that only part of its neighbours would be equal.
    let here_and_there = |at: usize| noise(at, 9) > 0.2;
    let labels = values(|p, at| if here_and_there(at) { 77.0 } else { regions(p, 12) });
    let mut numbers: Vec<u8> = values(|p, _| regions(p, 12)).into_iter().map(|number| number as u8).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(with_padding(labels.clone(), 77.0), DataKind::LabelMap { count: numbers.len() - 1 });
    assert_eq!(kind(&labels), KindName::Scalar, "that it is the padding which hides them");
    // A third value beside two.
    let mask = values(|p, _| if p.x > 0.8 { -5.0 } else { f64::from(u8::from(p.length() < 0.6)) });
    assert_eq!(with_padding(mask, -5.0), DataKind::Mask);
    // Black corners of a bright field.
    let dark = values(|p, at| {
        let field = if p.length() < 0.5 { 300.0 } else { 900.0 };
        if p.truncate().abs().min_element() > 0.7 { 0.0 } else { field + 10.0 * noise(at, 4) }
    });
    assert_eq!(with_padding(dark.clone(), 0.0), DataKind::DarkOnBright);
    // A face of only padding shows no background.
    let hollow =
        values(|p, _| if p.abs().max_element() > 0.9 { -5.0 } else { f64::from(u8::from(p.length() > 0.3)) });
    assert_eq!(with_padding(hollow, -5.0), DataKind::Mask);
}
