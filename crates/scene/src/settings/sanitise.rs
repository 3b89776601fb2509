//! Sanitising of settings: clamping to valid ranges, so that no typed or loaded value reaches a shader as NaN, as a
//! negative extinction or as an endless loop.

use crate::{
    AreaLightSampling, Background, Camera, ClipPlane, Clipping, ControlPoint, CropBox, EnvironmentLight,
    FloorSettings, LightSettings, MAX_ANISOTROPY, MAX_BIAS_VOXELS, MAX_BOUNCES, MAX_ENVIRONMENT_RADIANCE,
    MAX_EXPOSURE, MAX_FLOOR_HEIGHT, MAX_FLOOR_RADIUS, MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_ASPECT,
    MAX_LIGHT_SAMPLES, MAX_LIGHT_SIZE, MAX_MIN_BLOCKS, MAX_NAME_CHARS, MAX_PLANE_OFFSET, MAX_POINTS,
    MIN_CROP_EXTENT, MIN_EXPOSURE, OutputSettings, PhongShading, ReconstructionKernel, SKY_DIRECTIONS,
    SamplingSettings, SavedEntry, ScatteringSettings, Settings, ShadowSettings, SkySettings, Spotlight,
};
use chiaroscuro_files::sanitised_line;

impl Settings {
    /// Clamps every number to its documented range, so that no typed or loaded value reaches a shader as NaN, as a
    /// negative extinction or as an endless loop; truncates names and lists to lengths that can be shown.
    pub fn sanitise(&mut self) {
        let number = |value: &mut f64, low: f64, high: f64, fallback: f64| {
            *value = if value.is_finite() { value.clamp(low, high) } else { fallback };
        };
        let rgb = |color: &mut [f32; 3]| {
            for c in color {
                *c = if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 };
            }
        };
        let point = |position: &mut [f64; 3], limit: f64| {
            for c in position {
                *c = if c.is_finite() { c.clamp(-limit, limit) } else { 0.0 };
            }
        };
        let kernel = |kernel: &mut ReconstructionKernel| {
            if let ReconstructionKernel::Gaussian { sigma } = kernel {
                *sigma = if sigma.is_finite() { sigma.clamp(0.4, 0.8) } else { 0.6 };
            }
        };
        let default = Self::default();
        self.sanitise_saved();
        let views = self.kept.iter_mut().filter_map(SavedEntry::as_view_mut);
        for camera in views.chain([&mut self.camera]) {
            let Camera {
                projection: _,
                up: _,
                azimuth_deg,
                elevation_deg,
                roll_deg,
                target,
                distance,
                fov_y_deg,
                fit: _,
            } = camera;
            number(azimuth_deg, -1e6, 1e6, default.camera.azimuth_deg);
            number(elevation_deg, -1e6, 1e6, default.camera.elevation_deg);
            number(roll_deg, -1e6, 1e6, 0.0);
            point(target, 100.0);
            number(distance, 0.05, 1e4, default.camera.distance);
            number(fov_y_deg, 1.0, 120.0, default.camera.fov_y_deg);
        }
        self.lights.truncate(crate::MAX_LIGHTS);
        for light in &mut self.lights {
            let LightSettings {
                name,
                kind: _,
                position,
                color,
                intensity,
                on: _,
                casts_shadows: _,
                lock: _,
                hood: Spotlight { on: _, half_angle_deg, rim_deg },
                density_scale,
                shape: _,
                size,
                angle_deg,
                aspect,
                turn_deg,
            } = light;
            *name = sanitised_line(name, MAX_NAME_CHARS);
            point(position, 1e6);
            rgb(color);
            number(intensity, 0.0, 1e3, 1.0);
            number(half_angle_deg, 1.0, 89.0, Spotlight::default().half_angle_deg);
            number(rim_deg, 0.0, 89.0, Spotlight::default().rim_deg);
            number(density_scale, 0.0, 1e3, 1.0);
            let fresh = LightSettings::default();
            number(size, 0.0, MAX_LIGHT_SIZE, fresh.size);
            number(angle_deg, 0.0, MAX_LIGHT_ANGLE_DEG, fresh.angle_deg);
            number(aspect, 1.0 / MAX_LIGHT_ASPECT, MAX_LIGHT_ASPECT, 1.0);
            number(turn_deg, -1e6, 1e6, 0.0);
        }
        for function in [&mut self.transfer, &mut self.lighting.curve] {
            function.points.retain(|point| point.value.is_finite());
            function.points.truncate(MAX_POINTS);
            for ControlPoint { value: _, color, opacity, easing: _ } in &mut function.points {
                rgb(color);
                number(opacity, 0.0, 1.0, 0.0);
            }
            function.sort();
        }
        self.range = self.range.sanitised();
        self.volume.sanitise();
        self.labels.sanitise();
        number(&mut self.lighting.scale, 0.0, 1e3, 1.0);
        let Clipping { crop, plane } = &mut self.cuts;
        let CropBox { on: _, low, high, effect: _ } = crop;
        for axis in 0..3 {
            number(&mut low[axis], 0.0, 1.0 - MIN_CROP_EXTENT, 0.0);
            number(&mut high[axis], low[axis] + MIN_CROP_EXTENT, 1.0, 1.0);
        }
        let ClipPlane { on: _, normal, offset, effect: _ } = plane;
        point(normal, 1e6);
        if *normal == [0.0; 3] {
            *normal = ClipPlane::default().normal;
        }
        number(offset, -MAX_PLANE_OFFSET, MAX_PLANE_OFFSET, 0.0);
        let FloorSettings { on: _, height, radius, color, opacity, shadow_only: _ } = &mut self.floor;
        number(height, -MAX_FLOOR_HEIGHT, MAX_FLOOR_HEIGHT, default.floor.height);
        number(radius, 0.1, MAX_FLOOR_RADIUS, default.floor.radius);
        rgb(color);
        number(opacity, 0.0, 1.0, 1.0);
        let SkySettings {
            mode: _,
            intensity,
            zenith,
            horizon,
            ground,
            picture: EnvironmentLight { name, mean, slope },
            tilt_deg,
            turn_deg,
            density_scale,
            directions,
            resolution: _,
        } = &mut self.sky;
        number(intensity, 0.0, 1e3, default.sky.intensity);
        [zenith, horizon, ground].into_iter().for_each(rgb);
        *name = sanitised_line(name, MAX_NAME_CHARS);
        for c in mean {
            number(c, 0.0, MAX_ENVIRONMENT_RADIANCE, 1.0);
        }
        for slope in slope {
            point(slope, MAX_ENVIRONMENT_RADIANCE);
        }
        number(tilt_deg, -360.0, 360.0, 0.0);
        number(turn_deg, -1e6, 1e6, 0.0);
        number(density_scale, 0.0, 1e3, 1.0);
        *directions = (*directions).clamp(*SKY_DIRECTIONS.start(), *SKY_DIRECTIONS.end());
        let ScatteringSettings {
            bounces,
            albedo,
            strength,
            anisotropy,
            density_scale,
            directions,
            resolution: _,
        } = &mut self.scattering;
        *bounces = (*bounces).min(MAX_BOUNCES);
        number(albedo, 0.0, 1.0, default.scattering.albedo);
        number(strength, 0.0, 100.0, 1.0);
        number(anisotropy, -MAX_ANISOTROPY, MAX_ANISOTROPY, 0.0);
        number(density_scale, 0.0, 1e3, 1.0);
        *directions = (*directions).clamp(*SKY_DIRECTIONS.start(), *SKY_DIRECTIONS.end());
        let length = self.opacity_unit.number();
        if !(length.is_finite() && length > 0.0) {
            self.opacity_unit = default.opacity_unit;
        }
        let PhongShading { emission, ambient, diffuse, specular, shininess, surface_gradient, sides: _ } =
            &mut self.shading;
        number(emission, 0.0, 100.0, default.shading.emission);
        number(ambient, 0.0, 10.0, default.shading.ambient);
        number(diffuse, 0.0, 10.0, default.shading.diffuse);
        number(specular, 0.0, 10.0, default.shading.specular);
        number(shininess, 1.0, 1e3, default.shading.shininess);
        number(surface_gradient, 1e-6, 10.0, default.shading.surface_gradient);
        let ShadowSettings {
            algorithm: _,
            strength,
            ambient_offset,
            gain,
            bias_voxels,
            balance,
            transmission,
            keep_balanced: _,
            first_touch: _,
            deposit: _,
            kernel: light_kernel,
            slab,
            quadrature: _,
            resolution: _,
            precision: _,
            storage: _,
            reverse_kernel: _,
            near_field: _,
            area: AreaLightSampling { samples, resolution: _ },
            least_blocks,
        } = &mut self.shadows;
        *least_blocks = (*least_blocks).clamp(1, MAX_MIN_BLOCKS);
        number(strength, 0.0, 1.0, default.shadows.strength);
        number(ambient_offset, 0.0, 1.0, default.shadows.ambient_offset);
        number(gain, 0.0, 100.0, default.shadows.gain);
        number(bias_voxels, 0.0, MAX_BIAS_VOXELS, default.shadows.bias_voxels);
        number(balance, 0.01, 100.0, default.shadows.balance);
        number(transmission, 0.0, 1.0, default.shadows.transmission);
        number(slab, 0.25, 2.0, default.shadows.slab);
        kernel(light_kernel);
        *samples = (*samples).clamp(1, MAX_LIGHT_SAMPLES);
        let SamplingSettings {
            kernel: eye_kernel,
            slab,
            slabs: _,
            quadrature: _,
            gradients: _,
            classification: _,
            engine: _,
            order: _,
        } = &mut self.sampling;
        number(slab, 0.25, 2.0, default.sampling.slab);
        kernel(eye_kernel);
        let OutputSettings { background: Background { top, bottom }, tone_map: _, exposure } =
            &mut self.output;
        rgb(top);
        rgb(bottom);
        number(exposure, MIN_EXPOSURE, MAX_EXPOSURE, default.output.exposure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OpacityLength;

    #[test]
    fn nonsense_becomes_usable() {
        let mut settings = Settings::default();
        settings.camera.distance = f64::NAN;
        settings.shadows.slab = 0.0;
        settings.lights = vec![LightSettings { intensity: -3.0, ..LightSettings::default() }; 20];
        settings.transfer.points.push(ControlPoint::new(f64::NAN, [2.0; 3], 0.1));
        settings.opacity_unit = OpacityLength::Mm(0.0);
        settings.sanitise();
        assert_eq!(settings.camera.distance, 5.2);
        assert_eq!(settings.shadows.slab, 0.25);
        assert_eq!(settings.lights.len(), 8);
        assert_eq!(settings.lights[0].intensity, 0.0);
        assert!(settings.transfer.points.is_empty());
        assert_eq!(settings.opacity_unit, OpacityLength::Voxels(1.0));
    }

    #[test]
    fn names_and_curves_have_lengths_that_can_be_shown() {
        let mut settings = Settings::default();
        settings.lights[0].name = format!("Sun\u{202e}\u{1b}[2J{}", "x".repeat(1 << 20));
        settings.transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.1); MAX_POINTS + 1];
        settings.lighting.curve.points = settings.transfer.points.clone();
        settings.sanitise();
        let name = &settings.lights[0].name;
        assert!(name.starts_with("Sun[2Jxx") && name.chars().count() == MAX_NAME_CHARS, "{name}");
        let lengths = [&settings.transfer, &settings.lighting.curve].map(|function| function.points.len());
        assert_eq!(lengths, [MAX_POINTS; 2]);
    }

    #[test]
    fn sane_settings_stay_as_they_are() {
        let mut settings = Settings::default();
        let before = settings.clone();
        settings.sanitise();
        assert_eq!(settings, before);
    }
}
