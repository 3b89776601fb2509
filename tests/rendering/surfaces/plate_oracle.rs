//! Oracle of an oblique plate in parallel light: the single scattering of its picture, integrated in `f64` through the
//! cubic B-spline of its voxels. It shares no code with the program.
//!
//! All lengths are in voxels; the plate does not depend on y, nor do view and light.

/// Steps in which rays are integrated, in voxels: with twice as many, levels change by less than 1e-4.
const EYE_STEP: f64 = 1.0 / 96.0;
const LIGHT_STEP: f64 = 1.0 / 32.0;

/// Optical depth behind which nothing counts: e^−12 = 6e-6.
const OPAQUE_DEPTH: f64 = 12.0;

/// Voxels of a plate with their curve of extinction, and a light.
pub(super) struct PlateOracle<'a> {
    /// Number of voxels along x and z.
    pub(super) size: [usize; 2],
    /// Densities, 0 … 1, x fastest.
    pub(super) densities: Vec<f64>,
    /// Extinction per voxel of a density.
    pub(super) extinction: &'a dyn Fn(f64) -> f64,
    /// Unit vector towards the light, in x and z.
    pub(super) to_light: [f64; 2],
    /// Share of the colour that is seen without light.
    pub(super) ambient: f64,
}

/// Cubic B-spline.
fn spline(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        2.0 / 3.0 - x * x * (1.0 - x / 2.0)
    } else if x < 2.0 {
        (2.0 - x).powi(3) / 6.0
    } else {
        0.0
    }
}

/// Derivative of the cubic B-spline.
fn spline_slope(x: f64) -> f64 {
    let far = x.abs();
    let slope = if far < 1.0 {
        far * (1.5 * far - 2.0)
    } else if far < 2.0 {
        -0.5 * (2.0 - far).powi(2)
    } else {
        0.0
    };
    slope * x.signum()
}

impl PlateOracle<'_> {
    fn sum(&self, x: f64, z: f64, along_x: fn(f64) -> f64, along_z: fn(f64) -> f64) -> f64 {
        let [nx, nz] = self.size.map(|n| n as i64);
        let [first_x, first_z] = [x.floor() as i64 - 1, z.floor() as i64 - 1];
        let mut sum = 0.0;
        for k in first_z.max(0)..(first_z + 4).min(nz) {
            for i in first_x.max(0)..(first_x + 4).min(nx) {
                let weight = along_x(x - i as f64) * along_z(z - k as f64);
                sum += weight * self.densities[(k * nx + i) as usize];
            }
        }
        sum
    }

    fn density(&self, [x, z]: [f64; 2]) -> f64 {
        self.sum(x, z, spline, spline)
    }

    /// Optical depth from a point along a direction, up to where nothing more counts or the grid ends.
    fn optical_depth(&self, from: [f64; 2], along: [f64; 2]) -> f64 {
        let mut depth = 0.0;
        let mut way = 0.5 * LIGHT_STEP;
        loop {
            let [x, z] = [from[0] + along[0] * way, from[1] + along[1] * way];
            let is_outside =
                x < -2.0 || z < -2.0 || x > self.size[0] as f64 + 1.0 || z > self.size[1] as f64 + 1.0;
            if is_outside || depth > OPAQUE_DEPTH {
                return depth;
            }
            depth += LIGHT_STEP * (self.extinction)(self.density([x, z]));
            way += LIGHT_STEP;
        }
    }

    /// Light of a point of the material per extinction, of white colour.
    fn reflected(&self, at: [f64; 2]) -> f64 {
        let slope =
            [self.sum(at[0], at[1], spline_slope, spline), self.sum(at[0], at[1], spline, spline_slope)];
        let steepness = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt().max(1e-12);
        let facing = -(slope[0] * self.to_light[0] + slope[1] * self.to_light[1]) / steepness;
        let light = if facing > 0.0 { facing * (-self.optical_depth(at, self.to_light)).exp() } else { 0.0 };
        self.ambient + light
    }

    /// Brightness over opacity, and opacity, of a ray from a point in front of the plate.
    pub(super) fn ray(&self, from: [f64; 2], along: [f64; 2], length: f64) -> [f64; 2] {
        let steps = (length / EYE_STEP).ceil() as usize;
        let [mut depth, mut brightness] = [0.0_f64; 2];
        for step in 0..steps {
            let way = (step as f64 + 0.5) * EYE_STEP;
            let at = [from[0] + along[0] * way, from[1] + along[1] * way];
            let part = EYE_STEP * (self.extinction)(self.density(at));
            if part > 0.0 {
                brightness += (-depth).exp() * -(-part).exp_m1() * self.reflected(at);
                depth += part;
            }
            if depth > OPAQUE_DEPTH {
                break;
            }
        }
        let opacity = -(-depth).exp_m1();
        [brightness / opacity.max(1e-12), opacity]
    }
}
