//! Sanitising of settings: clamping to valid ranges, so that no typed or loaded value reaches a shader as NaN, as a
//! negative extinction or as an endless loop.

use crate::{
    AreaLightSampling, Background, BoxCut, Camera, ClipPlane, Clipping, ComponentCut, ControlPoint, CropBox,
    CutShape, EnvironmentLight, FloorSettings, HalfSpaceCut, LightSettings, LightingTransfer, MAX_ANISOTROPY,
    MAX_BIAS_VOXELS, MAX_BOUNCES, MAX_ENVIRONMENT_RADIANCE, MAX_EXPOSURE, MAX_FLOOR_HEIGHT, MAX_FLOOR_RADIUS,
    MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_ASPECT, MAX_LIGHT_SAMPLES, MAX_LIGHT_SIZE, MAX_MATERIAL_BOXES,
    MAX_MIN_BLOCKS, MAX_NAME_CHARS, MAX_OUTLINE_POINTS, MAX_PLANE_OFFSET, MAX_POINTS, MAX_SHAPE_CUTS,
    MIN_CROP_EXTENT, MIN_EXPOSURE, MaterialBox, OutlineCut, OutputSettings, PhongShading,
    ReconstructionKernel, RenderModeSettings, SKY_DIRECTIONS, SamplingSettings, SavedEntry,
    ScatteringSettings, Settings, ShadowSettings, SkySettings, SphereCut, Spotlight, VolumeLayer,
};
use chiaroscuro_files::sanitised_line;

/// Smallest width of a picture by its height, and height by its width, through which an outline is drawn.
const MIN_OUTLINE_ASPECT: f64 = 0.01;

/// Largest coordinate of an outline, in widths or heights of the picture: a line may leave it.
const MAX_OUTLINE_PLACE: f64 = 10.0;

/// Largest coordinate of the shape of a cut, in scene units: beyond that of a cube's corner, √3.
const MAX_SHAPE_PLACE: f64 = 10.0;

impl Settings {
    /// Clamps every number to its documented range, so that no typed or loaded value reaches a shader as NaN, as a
    /// negative extinction or as an endless loop; truncates names and lists to lengths that can be shown.
    pub fn sanitise(&mut self) {
        let default = Self::default();
        self.sanitise_saved();
        let views = self.kept.iter_mut().filter_map(SavedEntry::as_view_mut);
        for camera in views.chain([&mut self.camera]) {
            sanitise_camera(camera, &default.camera);
        }
        self.lights.truncate(crate::MAX_LIGHTS);
        self.lights.iter_mut().for_each(sanitise_light);
        self.layers.iter_mut().for_each(sanitise_layer);
        self.volume.sanitise();
        sanitise_clipping(&mut self.cuts);
        sanitise_floor(&mut self.floor, &default.floor);
        sanitise_sky(&mut self.sky, &default.sky);
        sanitise_scattering(&mut self.scattering, &default.scattering);
        sanitise_mode(&mut self.mode);
        sanitise_shading(&mut self.shading, &default.shading);
        sanitise_shadows(&mut self.shadows, &default.shadows);
        sanitise_sampling(&mut self.sampling, &default.sampling);
        sanitise_output(&mut self.output, &default.output);
    }
}

/// Clamps a number to its range, and replaces one that is not finite.
fn clamp_number(value: &mut f64, low: f64, high: f64, fallback: f64) {
    *value = if value.is_finite() { value.clamp(low, high) } else { fallback };
}

/// Clamps the components of a colour to 0 … 1.
fn clamp_color(color: &mut [f32; 3]) {
    for c in color {
        *c = if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 };
    }
}

/// Clamps the coordinates of a point to a cube around the origin.
fn clamp_point(position: &mut [f64; 3], limit: f64) {
    for c in position {
        *c = if c.is_finite() { c.clamp(-limit, limit) } else { 0.0 };
    }
}

/// Clamps the width of a Gaussian kernel.
fn clamp_kernel(kernel: &mut ReconstructionKernel) {
    if let ReconstructionKernel::Gaussian { sigma } = kernel {
        *sigma = if sigma.is_finite() { sigma.clamp(0.4, 0.8) } else { 0.6 };
    }
}

fn sanitise_camera(camera: &mut Camera, default: &Camera) {
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
    clamp_number(azimuth_deg, -1e6, 1e6, default.azimuth_deg);
    clamp_number(elevation_deg, -1e6, 1e6, default.elevation_deg);
    clamp_number(roll_deg, -1e6, 1e6, 0.0);
    clamp_point(target, 100.0);
    clamp_number(distance, 0.05, 1e4, default.distance);
    clamp_number(fov_y_deg, 1.0, 120.0, default.fov_y_deg);
}

fn sanitise_light(light: &mut LightSettings) {
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
    clamp_point(position, 1e6);
    clamp_color(color);
    clamp_number(intensity, 0.0, 1e3, 1.0);
    clamp_number(half_angle_deg, 1.0, 89.0, Spotlight::default().half_angle_deg);
    clamp_number(rim_deg, 0.0, 89.0, Spotlight::default().rim_deg);
    clamp_number(density_scale, 0.0, 1e3, 1.0);
    let fresh = LightSettings::default();
    clamp_number(size, 0.0, MAX_LIGHT_SIZE, fresh.size);
    clamp_number(angle_deg, 0.0, MAX_LIGHT_ANGLE_DEG, fresh.angle_deg);
    clamp_number(aspect, 1.0 / MAX_LIGHT_ASPECT, MAX_LIGHT_ASPECT, 1.0);
    clamp_number(turn_deg, -1e6, 1e6, 0.0);
}

fn sanitise_mode(mode: &mut RenderModeSettings) {
    let RenderModeSettings { kind: _, isovalue, lit: _ } = mode;
    *isovalue = isovalue.filter(|value| value.is_finite());
}

fn sanitise_layer(layer: &mut VolumeLayer) {
    let VolumeLayer {
        range,
        labels,
        transfer,
        lighting,
        opacity_unit,
        visibility: _,
        blend: _,
        edges,
        materials,
        ignores_cuts: _,
    } = layer;
    let LightingTransfer { linked: _, scale, curve } = lighting;
    for function in [transfer, curve] {
        function.points.retain(|point| point.value.is_finite());
        function.points.truncate(MAX_POINTS);
        for ControlPoint { value: _, color, opacity, easing: _ } in &mut function.points {
            clamp_color(color);
            clamp_number(opacity, 0.0, 1.0, 0.0);
        }
        function.sort();
    }
    *range = range.sanitised();
    labels.sanitise();
    clamp_number(scale, 0.0, 1e3, 1.0);
    clamp_number(edges, 0.0, 1.0, 0.0);
    materials.truncate(MAX_MATERIAL_BOXES);
    materials.retain_mut(|MaterialBox { values, changes, softness, color, opacity }| {
        values.sort_by(f64::total_cmp);
        changes.sort_by(f64::total_cmp);
        clamp_number(softness, 0.0, 1.0, MaterialBox::default().softness);
        clamp_color(color);
        clamp_number(opacity, 0.0, 1.0, 0.0);
        values.iter().chain(changes.iter()).all(|end| end.is_finite())
    });
    let length = opacity_unit.number();
    if !(length.is_finite() && length > 0.0) {
        *opacity_unit = VolumeLayer::default().opacity_unit;
    }
}

/// Clamps the bounds of a box, which are fractions of the grid.
fn clamp_extents(low: &mut [f64; 3], high: &mut [f64; 3]) {
    for axis in 0..3 {
        clamp_number(&mut low[axis], 0.0, 1.0 - MIN_CROP_EXTENT, 0.0);
        clamp_number(&mut high[axis], low[axis] + MIN_CROP_EXTENT, 1.0, 1.0);
    }
}

fn sanitise_clipping(cuts: &mut Clipping) {
    let Clipping { crop, plane, shapes } = cuts;
    let CropBox { on: _, low, high, effect: _ } = crop;
    clamp_extents(low, high);
    let ClipPlane { on: _, normal, offset, effect: _ } = plane;
    clamp_plane(normal, offset);
    shapes.truncate(MAX_SHAPE_CUTS);
    shapes.retain_mut(|cut| match &mut cut.shape {
        CutShape::Outline(OutlineCut { camera, aspect, points, depth: _, surface }) => {
            *surface = surface.filter(|values| values.low.is_finite() && values.high.is_finite());
            sanitise_camera(camera, &Camera::default());
            clamp_number(aspect, MIN_OUTLINE_ASPECT, 1.0 / MIN_OUTLINE_ASPECT, 1.0);
            points.truncate(MAX_OUTLINE_POINTS);
            points.retain(|point| point.iter().all(|at| at.abs() <= MAX_OUTLINE_PLACE));
            points.len() >= 3
        }
        CutShape::Sphere(SphereCut { center, radius }) => {
            clamp_point(center, MAX_SHAPE_PLACE);
            clamp_number(radius, 0.0, MAX_SHAPE_PLACE, SphereCut::default().radius);
            true
        }
        CutShape::Box(BoxCut { low, high }) => {
            clamp_extents(low, high);
            true
        }
        CutShape::HalfSpace(HalfSpaceCut { normal, offset }) => {
            clamp_plane(normal, offset);
            true
        }
        CutShape::Component(ComponentCut { seed, values }) => {
            clamp_point(seed, MAX_SHAPE_PLACE);
            values.low.is_finite() && values.high.is_finite()
        }
    });
}

fn clamp_plane(normal: &mut [f64; 3], offset: &mut f64) {
    clamp_point(normal, 1e6);
    if *normal == [0.0; 3] {
        *normal = ClipPlane::default().normal;
    }
    clamp_number(offset, -MAX_PLANE_OFFSET, MAX_PLANE_OFFSET, 0.0);
}

fn sanitise_floor(floor: &mut FloorSettings, default: &FloorSettings) {
    let FloorSettings { on: _, height, radius, color, opacity, shadow_only: _ } = floor;
    clamp_number(height, -MAX_FLOOR_HEIGHT, MAX_FLOOR_HEIGHT, default.height);
    clamp_number(radius, 0.1, MAX_FLOOR_RADIUS, default.radius);
    clamp_color(color);
    clamp_number(opacity, 0.0, 1.0, 1.0);
}

fn sanitise_sky(sky: &mut SkySettings, default: &SkySettings) {
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
    } = sky;
    clamp_number(intensity, 0.0, 1e3, default.intensity);
    [zenith, horizon, ground].into_iter().for_each(clamp_color);
    *name = sanitised_line(name, MAX_NAME_CHARS);
    for c in mean {
        clamp_number(c, 0.0, MAX_ENVIRONMENT_RADIANCE, 1.0);
    }
    for slope in slope {
        clamp_point(slope, MAX_ENVIRONMENT_RADIANCE);
    }
    clamp_number(tilt_deg, -360.0, 360.0, 0.0);
    clamp_number(turn_deg, -1e6, 1e6, 0.0);
    clamp_number(density_scale, 0.0, 1e3, 1.0);
    *directions = (*directions).clamp(*SKY_DIRECTIONS.start(), *SKY_DIRECTIONS.end());
}

fn sanitise_scattering(scattering: &mut ScatteringSettings, default: &ScatteringSettings) {
    let ScatteringSettings {
        bounces,
        albedo,
        strength,
        anisotropy,
        density_scale,
        directions,
        resolution: _,
    } = scattering;
    *bounces = (*bounces).min(MAX_BOUNCES);
    clamp_number(albedo, 0.0, 1.0, default.albedo);
    clamp_number(strength, 0.0, 100.0, 1.0);
    clamp_number(anisotropy, -MAX_ANISOTROPY, MAX_ANISOTROPY, 0.0);
    clamp_number(density_scale, 0.0, 1e3, 1.0);
    *directions = (*directions).clamp(*SKY_DIRECTIONS.start(), *SKY_DIRECTIONS.end());
}

fn sanitise_shading(shading: &mut PhongShading, default: &PhongShading) {
    let PhongShading { emission, ambient, diffuse, specular, shininess, surface_gradient, sides: _ } =
        shading;
    clamp_number(emission, 0.0, 100.0, default.emission);
    clamp_number(ambient, 0.0, 10.0, default.ambient);
    clamp_number(diffuse, 0.0, 10.0, default.diffuse);
    clamp_number(specular, 0.0, 10.0, default.specular);
    clamp_number(shininess, 1.0, 1e3, default.shininess);
    clamp_number(surface_gradient, 1e-6, 10.0, default.surface_gradient);
}

fn sanitise_shadows(shadows: &mut ShadowSettings, default: &ShadowSettings) {
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
        kernel,
        slab,
        quadrature: _,
        resolution: _,
        precision: _,
        storage: _,
        reverse_kernel: _,
        near_field: _,
        area: AreaLightSampling { samples, resolution: _ },
        least_blocks,
    } = shadows;
    *least_blocks = (*least_blocks).clamp(1, MAX_MIN_BLOCKS);
    clamp_number(strength, 0.0, 1.0, default.strength);
    clamp_number(ambient_offset, 0.0, 1.0, default.ambient_offset);
    clamp_number(gain, 0.0, 100.0, default.gain);
    clamp_number(bias_voxels, 0.0, MAX_BIAS_VOXELS, default.bias_voxels);
    clamp_number(balance, 0.01, 100.0, default.balance);
    clamp_number(transmission, 0.0, 1.0, default.transmission);
    clamp_number(slab, 0.25, 2.0, default.slab);
    clamp_kernel(kernel);
    *samples = (*samples).clamp(1, MAX_LIGHT_SAMPLES);
}

fn sanitise_sampling(sampling: &mut SamplingSettings, default: &SamplingSettings) {
    let SamplingSettings {
        kernel,
        slab,
        slabs: _,
        max_undivided_share,
        quadrature: _,
        gradients: _,
        classification: _,
        engine: _,
        order: _,
        finer_levels: _,
    } = sampling;
    clamp_number(slab, 0.25, 2.0, default.slab);
    clamp_number(max_undivided_share, 0.0, 1.0, default.max_undivided_share);
    clamp_kernel(kernel);
}

fn sanitise_output(output: &mut OutputSettings, default: &OutputSettings) {
    let OutputSettings { background: Background { top, bottom }, tone_map: _, exposure, antialiasing } =
        output;
    clamp_color(top);
    clamp_color(bottom);
    clamp_number(exposure, MIN_EXPOSURE, MAX_EXPOSURE, default.exposure);
    *antialiasing = OutputSettings::nearest_antialiasing(*antialiasing);
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
        settings.layer_mut().transfer.points.push(ControlPoint::new(f64::NAN, [2.0; 3], 0.1));
        settings.layer_mut().opacity_unit = OpacityLength::Mm(0.0);
        settings.sanitise();
        assert_eq!(settings.camera.distance, 5.2);
        assert_eq!(settings.shadows.slab, 0.25);
        assert_eq!(settings.lights.len(), 8);
        assert_eq!(settings.lights[0].intensity, 0.0);
        assert!(settings.layer().transfer.points.is_empty());
        assert_eq!(settings.layer().opacity_unit, OpacityLength::Voxels(1.0));
    }

    #[test]
    fn names_and_curves_have_lengths_that_can_be_shown() {
        let mut settings = Settings::default();
        settings.lights[0].name = format!("Sun\u{202e}\u{1b}[2J{}", "x".repeat(1 << 20));
        settings.layer_mut().transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.1); MAX_POINTS + 1];
        settings.layer_mut().lighting.curve.points = settings.layer().transfer.points.clone();
        settings.sanitise();
        let name = &settings.lights[0].name;
        assert!(name.starts_with("Sun[2Jxx") && name.chars().count() == MAX_NAME_CHARS, "{name}");
        let lengths = [&settings.layer().transfer, &settings.layer().lighting.curve]
            .map(|function| function.points.len());
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
