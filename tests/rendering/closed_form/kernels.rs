//! Kernels in closed form: partition of unity, convergence of slabs, and finite results for extreme volumes.

use chiaroscuro_scene::{DepositMode, RenderEngine, SlabQuadrature};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, full_attenuation, render};
use crate::compare::{difference, to_f64};
use crate::scenes;
use crate::thresholds::{EIGHT_BITS, MIN_COMPARED_LIGHT, ORDER_FRONT, ORDER_MEAN, UNITY};

with_both_engines! {
    kernels_are_a_partition_of_unity
    thinner_slabs_converge
    extremes_stay_finite
}

/// No. 1: A constant remains constant under the kernel, wherever it is sampled: the ratio of successive sheets of a
/// light gives the density back.
fn kernels_are_a_partition_of_unity(engine: RenderEngine) {
    let per_slab = 1.0;
    let n = 32;
    let loaded = Dataset::new(scenes::block(n, |v| v != [0, 0, 0]));
    for light in [[0.31, -0.62, 0.77], [-0.9, 0.2, 0.13]] {
        let mut settings = base(engine, per_slab);
        settings.lights[0].position = light;
        // Sheets that deposit the arriving light: successive ratios are e^−τ of one slab.
        settings.shadows.deposit = DepositMode::Front;
        let sheets = renderer().light_sheets(&loaded, &settings, 0, 0).expect("sheets");
        let view = &chiaroscuro_render::plan::light_views(
            &settings.lights[0].resolve(&settings.camera),
            &settings.shadows,
            &loaded.volume().scene(),
        )[0];
        let [w, h] = view.frame.size;
        let mut checked = 0;
        for k in 0..view.frame.slab_count - 1 {
            for (i, j) in (0..w).flat_map(|i| (0..h).map(move |j| (i, j))) {
                let p = view.frame.point(f64::from(i), f64::from(j), view.frame.depth_of(f64::from(k)));
                // Three voxels away from the faces, and from the one empty voxel.
                let inside = p.min_element() > 3.0 && p.max_element() < n as f64 - 4.0;
                let at = |k: u32| f64::from(sheets[(i + w * (j + h * k)) as usize]);
                if inside && at(k) > MIN_COMPARED_LIGHT {
                    let density = -(at(k + 1) / at(k)).ln() / per_slab;
                    assert!((density - 1.0).abs() <= UNITY, "{density} at {p}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 200, "only {checked} samples were checked");
    }
}

/// No. 8: Thinner light slabs converge: first order with the literal deposit, second with the mean.
fn thinner_slabs_converge(engine: RenderEngine) {
    let loaded = Dataset::new(scenes::ball(40, DVec3::splat(19.5), 13.0));
    for (deposit, order) in [(DepositMode::Front, ORDER_FRONT), (DepositMode::SlabMean, ORDER_MEAN)] {
        let volume = |slab: f64| {
            let mut settings = base(engine, 0.3);
            // Along the grid: the remaining error is that of the slabs alone.
            settings.lights[0].position = [0.0, 0.0, 1.0];
            settings.shadows.deposit = deposit;
            settings.shadows.slab = slab;
            settings.shadows.quadrature = SlabQuadrature::Two;
            to_f64(&full_attenuation(&mut renderer(), &loaded, &settings, 0))
        };
        let coarse = difference(&volume(2.0), &volume(0.5)).rmse;
        let fine = difference(&volume(1.0), &volume(0.25)).rmse;
        println!("{deposit:?}: {coarse:.2e} → {fine:.2e}, ratio {:.2}", coarse / fine);
        assert!(coarse / fine >= order, "{deposit:?}: {coarse} → {fine}");
    }
}

/// No. 17: Noise, empty and solid volumes give finite numbers, and empty ones exactly the background.
fn extremes_stay_finite(engine: RenderEngine) {
    let noise: Vec<u8> = (0..32usize.pow(3)).map(|i| (i.wrapping_mul(2654435761) >> 13) as u8).collect();
    let noise = chiaroscuro_volume::Volume::with_spacing(
        "noise",
        [32; 3],
        DVec3::ONE,
        chiaroscuro_volume::Samples::U8(noise),
    )
    .expect("a valid volume");
    let loaded = Dataset::new(noise);
    let mut renderer = renderer();
    for opacity in [0.0, 0.5, 1.0] {
        let mut settings = scenes::look();
        settings.sampling.engine = engine;
        for point in &mut settings.layer_mut().transfer.points {
            point.opacity = opacity;
        }
        let picture = render(&mut renderer, &loaded, &settings, [64, 64]);
        assert!(picture.linear.iter().flatten().all(|c| c.is_finite() && *c >= 0.0), "opacity {opacity}");
        assert!(picture.linear.iter().all(|texel| texel[3] <= 1.0), "opacity {opacity}");
        let empty = picture.linear.iter().all(|texel| texel[3] == 0.0);
        assert_eq!(empty, opacity == 0.0);
        if empty {
            let [top, bottom] = [settings.output.background.top, settings.output.background.bottom];
            for (at, texel) in picture.display.chunks_exact(4).enumerate() {
                let down = ((at / 64) as f32 + 0.5) / 64.0;
                for c in 0..3 {
                    let expected = top[c] + (bottom[c] - top[c]) * down;
                    let apart = f64::from(f32::from(texel[c]) / 255.0 - expected).abs();
                    // Half a step of dither, and half of rounding.
                    assert!(apart <= EIGHT_BITS, "{texel:?} in row {}", at / 64);
                }
            }
        }
    }
}
