//! Test that the blocks of sky visibility that a picture needs are the same alone as among all blocks.

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{LightVolumeResolution, OpacityLength, Settings, SkyMode, SkySettings};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::common::{damaged_renderer, new_renderer};
use crate::scenes;

/// Volume with slanted rods that end at two faces of the grid, as vessels of a scan do.
fn slanted_rods() -> Volume {
    let dims = [150, 150, 60];
    let voxel = |at: usize| {
        let p = DVec3::new(
            (at % dims[0]) as f64,
            (at / dims[0] % dims[1]) as f64,
            (at / (dims[0] * dims[1])) as f64,
        );
        let rod = |i: usize| {
            let (i, j) = ((i % 3) as f64, (i / 3) as f64);
            let along = DVec3::new(1.2 - 1.31 * i, 0.9 * j - 1.1, 1.0);
            (p - DVec3::new(28.3 + 46.0 * i, 28.1 + 45.7 * j, 30.0)).reject_from(along).length() - 2.5
        };
        let nearest = (0..9).map(rod).fold(f64::INFINITY, f64::min);
        (250.0 * (0.5 - 0.5 * nearest).clamp(0.0, 1.0)).round() as u8
    };
    let values = (0..dims.iter().product()).map(voxel).collect();
    Volume::with_spacing("rods", dims, DVec3::new(1.0, 1.0, 1.3), Samples::U8(values))
        .expect("a valid volume")
}

#[test]
fn needed_blocks_of_sky_visibility_are_the_same_among_all_blocks() {
    let dataset = Dataset::new(slanted_rods());
    let sky = SkySettings {
        mode: SkyMode::White,
        intensity: 0.8,
        directions: 24,
        resolution: LightVolumeResolution::Full,
        ..SkySettings::default()
    };
    let settings = Settings { sky, ..scenes::look() }.with_opacity_unit(OpacityLength::Voxels(0.2));
    let different = |renderer: fn() -> Renderer| {
        let needed =
            renderer().needed_sky_visibility(&dataset, &settings, [256, 192]).expect("moments are read back");
        let all = renderer().sky_visibility(&dataset, &settings).expect("moments are read back");
        let compared = needed.iter().flatten().count();
        assert!((all.len() / 4..all.len() * 3 / 4).contains(&compared), "{compared} of {}", all.len());
        needed.iter().zip(&all).filter(|(some, all)| some.is_some_and(|some| some != **all)).count()
    };
    assert_eq!(different(new_renderer), 0);
    // Rays that start beside the grid are then read where nothing follows them, where the light of earlier directions
    // remains.
    assert_ne!(different(|| damaged_renderer("1.0 + MAX_DISTANCE_OUTSIDE", "1.0")), 0);
}
