//! Pictures beside those of a path tracer that follows light until it has been scattered once, in steep material:
//! where they are seen and what of the light arrives there are both drawn by lot, without steps and without slabs.

use chiaroscuro::data::KindName;
use chiaroscuro::data::synthetic::builtin;
use chiaroscuro::gpu::{RenderOptions, Renderer};
use chiaroscuro::model::auto::Wishes;
use chiaroscuro::model::{
    BakedTransfer, Length, LightKind, Projection, Quality, Settings, ShadowAlgorithm, auto,
};
use chiaroscuro::plan::picture_frame;
use chiaroscuro::reference::cubic_b_spline;
use glam::DVec3;
use rayon::prelude::*;

use crate::common::{Dataset, context};
use crate::scenes::{self, isotropic};
use crate::thresholds::{TRACED_EXACT, TRACED_STANDARD};

/// Pictures are so many pixels wide and high: pixels are narrower than voxels, so that no kernel is stretched.
const SIZE: u32 = 160;

/// Paths of each pixel.
const PATHS: u32 = 32;

/// What paths run through.
struct Material {
    /// Voxels along each axis, with those of nothing that surround the grid.
    dims: [usize; 3],
    densities: Vec<f64>,
    table: BakedTransfer,
    /// The largest extinction anywhere.
    majorant: f64,
    /// Where some of the 4³ voxels around a point may attenuate: of points from a voxel to the next along each axis.
    is_occupied: Vec<bool>,
}

/// Voxels of nothing around the grid: as many as a kernel reaches, and one for points that lie on its rim.
const BORDER: usize = 3;

impl Material {
    fn of(loaded: &Dataset, settings: &Settings) -> Self {
        let range = settings.shown_range(&loaded.volume().ranges());
        let volume = &loaded.volume().showing(range);
        let table = settings.baked_eye(range, &volume.scene());
        let dims = volume.dims().map(|length| length + 2 * BORDER);
        let mut densities = vec![0.0; dims.iter().product()];
        for z in 0..volume.dims()[2] {
            for (at, density) in volume.slice_densities(z).into_iter().enumerate() {
                let [x, y] = [at % volume.dims()[0], at / volume.dims()[0]];
                densities[((z + BORDER) * dims[1] + y + BORDER) * dims[0] + x + BORDER] = f64::from(density);
            }
        }
        let reached = 3 * (dims[0] * dims[1] + dims[0] + 1);
        let is_occupied = (0..densities.len().saturating_sub(reached))
            .map(|first| {
                let densest =
                    rows(dims, first).flat_map(|row| &densities[row..row + 4]).fold(0.0, |a, &b| b.max(a));
                table.largest_extinction(0.0, densest) > 0.0
            })
            .collect();
        Self { dims, densities, majorant: table.largest_extinction(0.0, 1.0), is_occupied, table }
    }

    /// Extinction at an index-space point, per scene unit.
    fn extinction(&self, point: DVec3) -> f64 {
        let below = point.floor();
        // The first of the four voxels along each axis whose kernels reach the point.
        let first = below + (BORDER as f64 - 1.0);
        let is_near = (0..3).all(|axis| first[axis] >= 0.0 && first[axis] + 3.0 < self.dims[axis] as f64);
        if !is_near {
            return 0.0;
        }
        let [x, y, z] = first.to_array().map(|c| c as usize);
        let first = (z * self.dims[1] + y) * self.dims[0] + x;
        if !self.is_occupied[first] {
            return 0.0;
        }
        let [wx, wy, wz] =
            (point - below).to_array().map(|f| [1.0 + f, f, 1.0 - f, 2.0 - f].map(cubic_b_spline));
        let density: f64 = rows(self.dims, first)
            .enumerate()
            .map(|(at, row)| {
                let along: f64 = self.densities[row..row + 4].iter().zip(wx).map(|(d, w)| d * w).sum();
                wz[at / 4] * wy[at % 4] * along
            })
            .sum();
        self.table.sample(density)[3]
    }

    /// Where light from the eye meets material first, by Woodcock's tracking; `step` is one scene unit along the ray.
    fn first_meeting(&self, lots: &mut Lots, mut point: DVec3, step: DVec3, length: f64) -> Option<DVec3> {
        let mut left = length;
        loop {
            let way = -(1.0 - lots.draw()).ln() / self.majorant;
            left -= way;
            if left < 0.0 {
                return None;
            }
            point += step * way;
            if lots.draw() * self.majorant < self.extinction(point) {
                return Some(point);
            }
        }
    }

    /// An estimate of the transmittance of a way, right in the mean (ratio tracking).
    fn transmittance(&self, lots: &mut Lots, mut point: DVec3, step: DVec3, length: f64) -> f64 {
        let mut left = length;
        let mut transmittance = 1.0;
        loop {
            let way = -(1.0 - lots.draw()).ln() / self.majorant;
            left -= way;
            if left < 0.0 || transmittance < 1e-6 {
                return transmittance;
            }
            point += step * way;
            transmittance *= 1.0 - self.extinction(point) / self.majorant;
        }
    }
}

/// The first voxels of the 4² rows of four from one voxel on.
fn rows(dims: [usize; 3], first: usize) -> impl Iterator<Item = usize> {
    (0..16).map(move |row| first + (row / 4 * dims[1] + row % 4) * dims[0])
}

/// Numbers in [0, 1) that look drawn by lot (`SplitMix64`).
struct Lots(u64);

impl Lots {
    fn draw(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The mean over all pixels of the light that arrives where each is met first, and how uncertain that is.
fn traced(loaded: &Dataset, settings: &Settings) -> (f64, f64) {
    let volume = loaded.volume();
    let scene = volume.scene();
    let material = Material::of(loaded, settings);
    let frame = picture_frame(settings, &scene, [SIZE; 2]);
    let light = settings.lights[0].in_scene(&settings.camera);
    let to_light = scene.index_from_scene.transform_vector3(light.direction());
    let first = frame.first_depth;
    let length = frame.slab * f64::from(frame.slab_count);
    // Two estimates of each pixel: how much they differ says how much chance is left in the mean.
    let estimates: Vec<[f64; 2]> = (0..SIZE * SIZE)
        .into_par_iter()
        .map(|pixel| {
            let [i, j] = [f64::from(pixel % SIZE), f64::from(pixel / SIZE)];
            let mut lots = Lots(u64::from(pixel) << 32);
            let mut path = || {
                let eye = (frame.point(i, j, first), frame.direction.at(i, j));
                let met = material.first_meeting(&mut lots, eye.0, eye.1, length);
                met.map_or(0.0, |point| {
                    material.transmittance(&mut lots, point, to_light, 2.0 * scene.support_radius())
                })
            };
            [(); 2].map(|()| (0..PATHS / 2).map(|_| path()).sum::<f64>() / f64::from(PATHS / 2))
        })
        .collect();
    let count = estimates.len() as f64;
    let mean = estimates.iter().flatten().sum::<f64>() / (2.0 * count);
    let squares: f64 = estimates.iter().map(|[a, b]| (a - b).powi(2)).sum();
    (mean, 0.5 * squares.sqrt() / count)
}

/// Box, sphere and cloud, white and steep: the mean of the picture is the path tracer's.
#[test]
fn pictures_are_as_bright_as_a_path_tracers() {
    let mut renderer = Renderer::new(&context()).expect("a renderer");
    for name in ["box", "sphere", "cloud"] {
        let loaded = Dataset::new(builtin(name, Some(64)).expect("a built-in volume"));
        // A ramp of opacities, also of the box, which is a mask.
        let wishes = Wishes { treated_as: Some(KindName::Scalar), ..Wishes::default() };
        let mut settings = auto::first_settings_with(loaded.volume(), loaded.histogram(), wishes);
        scenes::seen_as_earlier(&mut settings);
        isotropic(&mut settings);
        settings.camera.projection = Projection::Orthographic;
        settings.lights = vec![scenes::light(LightKind::Parallel, [-2.2, -1.2, 1.6])];
        // More than half of the light ends within a voxel.
        settings.opacity_unit = Length::Voxels(1.0);
        for point in &mut settings.transfer.points {
            point.opacity = point.opacity.min(1.0 - (-0.84_f64).exp());
            point.color = [1.0; 3];
        }
        let mut mean = |settings: &Settings| {
            let picture =
                renderer.render(&loaded, settings, [SIZE; 2], &RenderOptions::default()).expect("a picture");
            let sum =
                |channel: usize| -> f64 { picture.light.iter().map(|texel| f64::from(texel[channel])).sum() };
            [sum(0), sum(3)].map(|sum| sum / f64::from(SIZE * SIZE))
        };
        let (expected, doubt) = traced(&loaded, &settings);
        // What material that light reaches unhindered looks like.
        let mut unshadowed = settings.clone();
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
        let [full, opaque] = mean(&unshadowed);
        let mut off = |quality: Quality, density_scale: f64| {
            let mut settings = settings.clone();
            settings.lights[0].density_scale = density_scale;
            quality.apply(&mut settings);
            mean(&settings)[0] / (full / opaque) / expected - 1.0
        };
        let [fast, standard, fine, exact] = Quality::ALL.map(|quality| off(quality, 1.0));
        println!(
            "{name}: traced {expected:.5} ± {:.2} %, off by {fast:+.4} fast, {standard:+.4} standard, {fine:+.4} fine, {exact:+.4} exact",
            100.0 * doubt / expected
        );
        let damaged = off(Quality::Exact, 0.95);
        assert!(damaged.abs() > TRACED_EXACT, "{name}: thinner shadows are noticed: {damaged}");
        assert!(standard.abs() <= TRACED_STANDARD, "{name}: {standard}");
        assert!(exact.abs() <= TRACED_EXACT, "{name}: {exact}");
    }
}
