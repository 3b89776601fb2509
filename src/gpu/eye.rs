//! The eye pass: from density and attenuation to linear light.

use super::GpuError;
use super::kernel::{kernel_constants, quadrature_constant};
use super::light_volume::LightVolume;
use super::tables::{Tables, dilation, view_entry};
use super::uniforms::{self, rows};
use super::volume::{Gpu, entry};
use crate::math::SceneSpace;
use crate::model::{Light, LightKind, MAX_LIGHTS, Projection, Sampling, Settings, ShadowAlgorithm};
use crate::plan::{SheetFrame, eye_frame};

/// Everything that the eye pass of one picture needs besides the volume.
pub(super) struct EyePass {
    frame: SheetFrame,
    uniform: uniforms::Eye,
    constants: [(&'static str, f64); 6],
    shadowed: usize,
}

impl EyePass {
    /// Sets up the pass. `lights` gives, for each light of the settings, its attenuation volume.
    pub(super) fn new(
        scene: &SceneSpace,
        settings: &Settings,
        size: [u32; 2],
        lights: &[Option<&LightVolume>],
        leaping: bool,
        dark: f32,
    ) -> Self {
        let frame = eye_frame(&settings.camera, scene, size, settings.sampling.slab);
        let mut on: Vec<(&Light, Option<&LightVolume>)> = settings
            .lights
            .iter()
            .zip(lights.iter().copied().chain(std::iter::repeat(None)))
            .filter(|(light, _)| light.on)
            .take(MAX_LIGHTS)
            .collect();
        on.sort_by_key(|(_, volume)| volume.is_none());
        let shadowed = on.iter().filter(|(_, volume)| volume.is_some()).count();
        let mut packed = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
        for (slot, (light, volume)) in packed.iter_mut().zip(&on) {
            *slot = pack_light(light, *volume, settings);
        }
        let stretch = frame.max_stretch_level() > 0.0;
        let constants = constants(&settings.sampling, stretch, on.len(), shadowed);
        let [sx, sy, sz] = rows(&scene.scene_from_index);
        let [ix, iy, iz] = rows(&scene.index_from_scene);
        let (eye, w) = match settings.camera.projection {
            Projection::Perspective => (settings.camera.eye(), 1.0),
            Projection::Orthographic => (settings.camera.scene_from_view().z_axis, 0.0),
        };
        let uniform = uniforms::Eye {
            frame: uniforms::SheetFrame::new(&frame),
            shading: pack_shading(settings, scene),
            scene_from_index_x: sx,
            scene_from_index_y: sy,
            scene_from_index_z: sz,
            index_from_scene_x: ix,
            index_from_scene_y: iy,
            index_from_scene_z: iz,
            eye: eye.as_vec3().extend(w).into(),
            first_row: 0,
            end_row: size[1],
            leaping: u32::from(leaping),
            dark,
            lights: packed,
        };
        Self { frame, uniform, constants, shadowed }
    }

    /// Slabs of the stack.
    pub(super) fn slab_count(&self) -> u32 {
        self.frame.slab_count
    }

    /// Draws some rows of the picture. `attenuation` holds the volumes of the shadowed lights, in
    /// the order in which the settings list those lights.
    pub(super) fn draw(
        &self,
        gpu: Gpu<'_>,
        tables: &Tables,
        attenuation: &[&LightVolume],
        picture: &wgpu::TextureView,
        rows: std::ops::Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        debug_assert_eq!(attenuation.len(), self.shadowed);
        let Gpu { context, shaders, volume, nothing } = gpu;
        let pipeline = shaders.pipeline("eye.wgsl", &self.constants)?;
        let uniform = uniforms::Eye { first_row: rows.start, end_row: rows.end, ..self.uniform };
        let uniform = context.buffer("Eye::uniform", &[uniform], wgpu::BufferUsages::UNIFORM);
        let own = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Eye::bind_group"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                entry(0, uniform.as_entire_binding()),
                entry(1, tables.eye.buffer.as_entire_binding()),
                view_entry(2, &tables.eye_distances),
                view_entry(3, picture),
            ],
        });
        let of_volume = volume.bind_group(context, &pipeline, dilation(self.frame.max_stretch_level()));
        let views: Vec<_> = (0..MAX_LIGHTS as u32)
            .map(|slot| view_entry(slot, attenuation.get(slot as usize).map_or(nothing, |light| &light.view)))
            .collect();
        let of_lights = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Eye::lights"),
            layout: &pipeline.get_bind_group_layout(2),
            entries: &views,
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("Eye::pass"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &own, &[]);
        pass.set_bind_group(1, &of_volume, &[]);
        pass.set_bind_group(2, &of_lights, &[]);
        pass.dispatch_workgroups(self.frame.size[0].div_ceil(8), (rows.end - rows.start).div_ceil(8), 1);
        Ok(())
    }
}

/// The variant of the shader for a kernel, for pixels wider than voxels or not, and for so many
/// lights, of which some have attenuation volumes.
pub(super) fn constants(
    sampling: &Sampling,
    stretch: bool,
    lights: usize,
    shadowed: usize,
) -> [(&'static str, f64); 6] {
    let [kernel, sigma] = kernel_constants(sampling.kernel);
    let stretch = ("STRETCH", f64::from(u8::from(stretch)));
    let counts = [("LIGHTS", lights as f64), ("SHADOWED", shadowed as f64)];
    [kernel, sigma, quadrature_constant(sampling.quadrature), stretch, counts[0], counts[1]]
}

fn pack_light(light: &Light, volume: Option<&LightVolume>, settings: &Settings) -> uniforms::Light {
    // Balance makes up for the light that shadows take away; without shadows there is none.
    let balance = match settings.shadows.algorithm {
        ShadowAlgorithm::Off => 1.0,
        ShadowAlgorithm::Splat => settings.shadows.balance,
    };
    let linear = |c: f32| crate::model::linear_from_srgb(f64::from(c));
    let (place, perspective) = match light.kind {
        LightKind::Parallel => (light.direction(), 0.0),
        LightKind::Perspective => (light.position.into(), 1.0),
    };
    uniforms::Light {
        place: place.as_vec3().into(),
        perspective,
        color: light.color.map(|c| (linear(c) * light.intensity * balance) as f32),
        shadowed: if volume.is_some() { 1.0 } else { 0.0 },
        lookup: volume.map_or([0.0; 3], |volume| volume.dims.map(|n| 1.0 / (n * volume.divisor) as f32)),
        pad0: 0.0,
    }
}

fn pack_shading(settings: &Settings, scene: &SceneSpace) -> uniforms::Shading {
    let (shading, shadows) = (&settings.shading, &settings.shadows);
    let unit = settings.opacity_unit.in_scene(scene).max(1e-9);
    uniforms::Shading {
        emission: shading.emission as f32,
        ambient: shading.ambient as f32,
        diffuse: shading.diffuse as f32,
        specular: shading.specular as f32,
        shininess: shading.shininess as f32,
        surface_gradient: (shading.surface_gradient / unit) as f32,
        strength: shadows.strength as f32,
        ambient_offset: shadows.ambient_offset as f32,
        gain: shadows.gain as f32,
        bias: (shadows.bias_voxels * scene.smallest_edge()) as f32,
        pad0: 0.0,
        pad1: 0.0,
    }
}
