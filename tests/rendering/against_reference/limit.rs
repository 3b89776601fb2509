//! Quality *Exact* against its limit: rays from every sample in f64, through slabs so thin that thinner ones change
//! nothing, with the gradient of the kernel for normals.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_scene::{LightGeometry, QualityPreset, Settings, SkyMode, SlabMode, first_look};
use chiaroscuro_volume::synthetic::builtin;

use crate::common::{Dataset, new_renderer, render};
use crate::scenes;
use crate::thresholds::{EXACT_OF_LIMIT, LIMITS_AGREE};

/// Size of the picture, at which pixels are narrower than voxels, so that no kernel is stretched.
const SIZE: [u32; 2] = [64, 64];

/// Limit picture, with slabs of `1 / parts` voxel.
fn limit_picture(loaded: &Dataset, settings: &Settings, parts: f64) -> Vec<[f64; 4]> {
    let mut settings = settings.clone();
    QualityPreset::Exact.apply(&mut settings);
    settings.sampling.slabs = SlabMode::Even;
    settings.sampling.slab = 1.0 / parts;
    settings.shadows.slab = 1.0 / parts;
    Reference::new(loaded.volume(), &settings, ReferenceOptions::default()).picture(SIZE, &[None])
}

/// Root mean square of the difference over the object before black, in steps of 8-bit sRGB.
fn display_rmse(found: &[[f64; 4]], limit: &[[f64; 4]]) -> f64 {
    let steps = |c: f64| {
        let c = c.clamp(0.0, 1.0);
        255.0 * if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
    };
    let object: Vec<_> = found.iter().zip(limit).filter(|(_, limit)| limit[3] > 0.5).collect();
    assert!(object.len() > 200, "the object is seen");
    let squares = |(a, b): &(&[f64; 4], &[f64; 4])| -> f64 {
        (0..3).map(|channel| (steps(a[channel]) - steps(b[channel])).powi(2)).sum()
    };
    (object.iter().map(squares).sum::<f64>() / (3 * object.len()) as f64).sqrt()
}

/// At a resolution at which details are a voxel wide, and light volumes far from the limit.
#[test]
fn exact_is_the_limit() {
    let mut renderer = new_renderer();
    for name in ["chair", "cloud"] {
        let loaded = Dataset::new(builtin(name, Some(24)).expect("a built-in volume"));
        let mut settings = first_look::first_settings(loaded.volume(), loaded.histogram());
        settings.sky.mode = SkyMode::Off;
        // Without the thinner surfaces of small volumes.
        settings.layer_mut().transfer =
            first_look::transfer_for_kind(loaded.volume(), loaded.histogram(), None);
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [-2.2, -1.2, 1.6])];
        let (thin, thinner) =
            (limit_picture(&loaded, &settings, 8.0), limit_picture(&loaded, &settings, 16.0));
        let between = display_rmse(&thin, &thinner);
        let [fast, standard, fine, exact] = QualityPreset::ALL.map(|quality| {
            quality.apply(&mut settings);
            let found = render(&mut renderer, &loaded, &settings, SIZE).linear;
            let found: Vec<_> = found.into_iter().map(|texel| texel.map(f64::from)).collect();
            display_rmse(&found, &thinner)
        });
        println!(
            "{name}: limits {between:.3} apart, {fast:.2} fast, {standard:.2} standard, {fine:.2} fine, {exact:.3} exact"
        );
        assert!(between <= LIMITS_AGREE, "{name}: {between}");
        assert!(exact <= EXACT_OF_LIMIT, "{name}: {exact}");
        assert!(fast > standard && standard > 2.0 * EXACT_OF_LIMIT, "{name}: the measure tells levels apart");
    }
}
