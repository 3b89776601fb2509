//! Dithering of two-colour backgrounds in 8 bits, so that they have no bands.

use chiaroscuro_render::{PictureOptions, RenderOptions};
use chiaroscuro_scene::{Background, Settings};
use glam::DVec3;

use crate::common::{Dataset, new_renderer};
use crate::scenes;
use crate::thresholds::DITHERED;

const SIZE: [u32; 2] = [64, 96];

/// Red channel of every pixel of an empty picture, row by row.
fn background(top: f32, bottom: f32, transparent: bool) -> Vec<u8> {
    let mut settings: Settings = scenes::look();
    settings.layer_mut().transfer.points.iter_mut().for_each(|point| point.opacity = 0.0);
    settings.output.background = Background { top: [top; 3], bottom: [bottom; 3] };
    let mut renderer = new_renderer();
    let options = RenderOptions::from(PictureOptions { transparent, ..PictureOptions::default() });
    let loaded = Dataset::new(scenes::creature(8, DVec3::ONE));
    let picture = renderer.render(&loaded, &settings, SIZE, &options).expect("a picture");
    picture.display.chunks_exact(4).map(|texel| texel[0]).collect()
}

/// Largest difference between the mean over columns and eight rows and the gradient there, in steps of 8 bits.
fn banding(found: &[u8], top: f32, bottom: f32) -> f64 {
    let [width, height] = SIZE.map(|n| n as usize);
    let rows = (0..height - 8).map(|first| {
        let some = &found[first * width..(first + 8) * width];
        let mean = some.iter().map(|&value| f64::from(value)).sum::<f64>() / some.len() as f64;
        let down = (first as f64 + 4.0) / height as f64;
        let wanted = 255.0 * (f64::from(top) + f64::from(bottom - top) * down);
        (mean - wanted).abs()
    });
    rows.fold(0.0, f64::max)
}

#[test]
fn gradients_have_no_bands() {
    let (top, bottom) = (0.12, 0.135);
    let found = background(top, bottom, false);
    let apart = banding(&found, top, bottom);
    println!("dithered: {apart:.3} steps");
    assert!(apart < DITHERED, "{apart}");
    // Guards the comparison: a rounded gradient has bands.
    let [width, height] = SIZE.map(|n| n as usize);
    let rounded: Vec<u8> = (0..width * height)
        .map(|at| {
            let down = ((at / width) as f32 + 0.5) / height as f32;
            (255.0 * (top + (bottom - top) * down)).round() as u8
        })
        .collect();
    assert!(banding(&rounded, top, bottom) > 3.0 * DITHERED);
    assert!(
        found.iter().zip(&rounded).all(|(a, b)| a.abs_diff(*b) <= 1),
        "no value is further than a step away"
    );
    // The pattern is reproducible.
    assert_eq!(background(top, bottom, false), found);
}

#[test]
fn what_is_one_color_stays_so_and_what_is_cut_out_has_none() {
    let flat = background(0.123, 0.123, false);
    assert!(flat.iter().all(|&value| value == flat[0]));
    assert!(background(0.12, 0.135, true).iter().all(|&value| value == 0));
}
