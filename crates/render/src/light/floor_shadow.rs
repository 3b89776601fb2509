//! Floor shadow map of an area light: its transmittance at points of the floor.
//!
//! Without the map, rays from every pixel of the floor to every point of the light would take as long as a picture
//! for each point.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::march::LightSheets;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, flag};
use crate::pipelines::uniforms::{self, rows};
use crate::plan::{FloorPlane, FloorTexels, LightView};
use crate::resources::pass;
use crate::volume::{VolumeContext, texture_3d};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{LightArea, LightGeometry, SceneLight};

/// Range of the map's texels along an edge; within it, texels are as large as the blocks of the light volume.
///
/// The maximum is two voxels of 256 across the scene's two units; with the minimum a texel is a fortieth of a unit.
const TEXEL_RANGE: std::ops::RangeInclusive<u32> = 256..=384;

/// Number of points up to which the map has the minimum resolution, as while the light is dragged: the map must not
/// delay the interaction.
const MAX_COARSE_POINTS: u32 = 16;

/// Map of an area light's transmittance at the floor.
#[derive(Debug)]
pub(crate) struct FloorShadowMap {
    /// Extent of the floor that the map covers.
    pub extent: FloorPlane,
    pub view: wgpu::TextureView,
    /// Number of texels along an edge.
    edge: u32,
    /// Sums over the views added so far, a float for each texel.
    sums: wgpu::Buffer,
}

/// View from a point on an area light: points outside the volume have one, points inside or close by have six.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointView<'a> {
    pub point: &'a SceneLight,
    /// Light on which the point lies.
    pub whole: &'a SceneLight,
    pub geometry: &'a LightView,
    /// Index of the view, and the number of views of all points.
    pub index: usize,
    pub count: usize,
    /// Number of points on the light.
    pub points: usize,
}

impl FloorShadowMap {
    /// Creates the texture, for a light volume with blocks of edge `block` in scene units, and for this number of
    /// points; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        place: FloorPlane,
        block: f64,
        points: u32,
    ) -> Result<Self, GpuError> {
        let fine = FloorPlane::texel_count(block).clamp(*TEXEL_RANGE.start(), *TEXEL_RANGE.end());
        let edge = if points <= MAX_COARSE_POINTS { *TEXEL_RANGE.start() } else { fine };
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let size = [edge as usize, edge as usize, 1];
        let format = context.storage_format;
        let texture = context.texture(&texture_3d("FloorShadow::texture", size, format, usages))?;
        let sums = context.uninitialised_buffer(&wgpu::BufferDescriptor {
            label: Some("FloorShadow::sums"),
            size: 4 * u64::from(edge) * u64::from(edge),
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Ok(Self {
            extent: place,
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            edge,
            sums,
        })
    }

    /// Returns the size of texture and sums, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.view.texture().format().block_copy_size(None).unwrap_or(4));
        self.sums.size() + texel * u64::from(self.edge) * u64::from(self.edge)
    }

    /// Returns the part of the map that is lit through the sheets of a view: first texel, and number of texels.
    /// `None` if part of the light goes upwards.
    fn lit_texels(&self, view: &LightView) -> Option<[[u32; 2]; 2]> {
        let FloorTexels { origin, along } = self.extent.texels(self.edge);
        let up = self.extent.up.direction();
        let [width, height] = view.frame.size.map(f64::from);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in [(-1.0, -1.0), (width, -1.0), (-1.0, height), (width, height)] {
            let pixel = (DVec2::from(corner) + view.first_pixel) * view.frame.pitch;
            let across = view.axes.x_axis * pixel.x + view.axes.y_axis * pixel.y;
            let direction = view.axes.z_axis + across * view.frame.inverse_distance;
            let from = view.anchor + across;
            let speed = direction.dot(up);
            // Almost parallel to the floor: the intersection is too far away.
            if speed > -1e-3 {
                return None;
            }
            let place = from + direction * ((self.extent.height - from.dot(up)) / speed);
            let texel = DVec2::from(along.map(|step| (place - origin).dot(step) / step.length_squared()));
            (low, high) = (low.min(texel), high.max(texel));
        }
        let edge = DVec2::splat(f64::from(self.edge));
        let first = (low.floor() - 1.0).clamp(DVec2::ZERO, edge);
        let end = (high.ceil() + 2.0).clamp(first, edge);
        Some([first, end - first].map(|v| [v.x as u32, v.y as u32]))
    }

    /// Adds the transmittance behind the sheets of a view; all of them must have been marched.
    pub(crate) fn add_view(
        &self,
        gpu: VolumeContext<'_>,
        of: PointView<'_>,
        march: uniforms::MarchUniform,
        sheets: &LightSheets,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let PointView { point, whole: light, geometry, index, count, points } = of;
        let variant = FloorShadowVariant { is_first: index == 0, is_last: index + 1 == count };
        let pipeline = gpu.shaders.pipeline(&variant)?;
        let FloorTexels { origin, along: [right, front] } = self.extent.texels(self.edge);
        let whole = [[0; 2], [self.edge; 2]];
        let is_whole = index == 0 || index + 1 == count || point.hood.on;
        let texels = if is_whole { whole } else { self.lit_texels(geometry).unwrap_or(whole) };
        let vec3 = |v: DVec3| v.as_vec3().into();
        let (place, perspective) = match point.kind {
            LightGeometry::Parallel => (point.direction(), 0.0),
            LightGeometry::Perspective => (point.position.into(), 1.0),
        };
        let centre = match light.kind {
            LightGeometry::Parallel => light.direction(),
            LightGeometry::Perspective => light.position.into(),
        };
        let way = DVec3::from(point.position) - centre;
        let border = |of: fn(&LightArea) -> DVec3| {
            let border = light.area.as_ref().map_or(DVec3::X, of);
            border.extend(way.dot(border) / border.length_squared()).as_vec4().into()
        };
        let pitch = 1.0 / geometry.frame.pitch;
        let to_light = DMat3::from_diagonal(DVec3::new(pitch, pitch, 1.0)) * geometry.axes.transpose();
        let light_from_scene = DAffine3 { matrix3: to_light, translation: -(to_light * geometry.anchor) };
        let [light_from_scene_x, light_from_scene_y, light_from_scene_z] = rows(&light_from_scene);
        let uniform = uniforms::FloorShadowUniform {
            origin: vec3(origin),
            size: self.edge,
            along_x: vec3(right),
            share: 1.0 / points as f32,
            along_y: vec3(front),
            cube_face: u32::from(geometry.cube_face),
            up: vec3(self.extent.up.direction()),
            perspective,
            place: vec3(place),
            pad0: 0.0,
            centre: centre.extend(0.0).as_vec4().into(),
            right: border(|area| area.right),
            top: border(|area| area.up),
            light_from_scene_x,
            light_from_scene_y,
            light_from_scene_z,
            first_pixel: geometry.first_pixel.as_vec2().into(),
            first_texel: texels[0],
        };
        let uniform = gpu.uniform("FloorShadow::uniform", uniform);
        let march = gpu.uniform("FloorShadow::march", march);
        let own = gpu.bind(
            "FloorShadow::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_march", &march),
                bind_buffer("bound_floor_map", &uniform),
                bind_buffer("sums", &self.sums),
                bind_buffer("transmittance", &sheets.ring.transmittance),
                bind_view("shadow", &self.view),
            ],
        );
        pass::dispatch(encoder, "FloorShadow::pass", &pipeline, &[&own], pass::tile_workgroups(texels[1]));
        Ok(())
    }
}

/// Pipeline variant of the floor shadow pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct FloorShadowVariant {
    is_first: bool,
    is_last: bool,
}

impl PipelineVariant for FloorShadowVariant {
    fn shader(&self) -> &'static str {
        "light/floor_shadow.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![flag("IS_FIRST", self.is_first), flag("IS_LAST", self.is_last)]
    }
}
