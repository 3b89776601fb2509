//! Light sources: settings of a light, and lights resolved into scene space.

pub(crate) mod area_light;
pub(crate) mod cube_axes;
pub(crate) mod direction_sets;
pub(crate) mod environment_map;
pub(crate) mod horizon_clipping;
pub(crate) mod point_weights;
mod sample_count;
pub(crate) mod scattering;
pub(crate) mod sky;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use self::area_light::{LightArea, LightShape};
use crate::Camera;

/// Largest number of lights; each has its own attenuation volume.
pub const MAX_LIGHTS: usize = 8;

/// Largest number of characters in a name: more than any list or label shows.
pub const MAX_NAME_CHARS: usize = 200;

/// Light geometry: parallel rays or rays from a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightGeometry {
    /// Parallel rays from infinitely far away, along the line from `position` to the centre of the volume.
    Parallel,
    /// Rays in all directions from the point `position`.
    Perspective,
}

/// Coordinate frame of a light's position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightLock {
    /// Scene space: the light stays in place when the camera moves.
    Scene,
    /// Camera axes (right, up, back) around the origin: the light turns with the camera. At `[0, 0, z]` it is a
    /// headlight.
    Camera,
}

/// Spotlight cone of a perspective light around the line to the origin (P §1, "with or without hood").
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Spotlight {
    /// Limits the light to the cone.
    pub on: bool,
    /// Half the opening angle in degrees: from the axis to where no light is left.
    pub half_angle_deg: f64,
    /// Angular width in degrees of the outer part of the cone in which the light fades.
    pub rim_deg: f64,
}

impl Default for Spotlight {
    fn default() -> Self {
        Self { on: false, half_angle_deg: 25.0, rim_deg: 5.0 }
    }
}

/// Light source with its position, colour, shape and shadow settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightSettings {
    /// Name given by the user.
    pub name: String,
    /// Light geometry: parallel or perspective.
    pub kind: LightGeometry,
    /// Position in scene units. A parallel light uses only its direction as seen from the origin, so that switching
    /// the kind back and forth loses nothing.
    pub position: [f64; 3],
    /// Colour as sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Factor for the colour in linear light.
    pub intensity: f64,
    /// Switches the light on.
    pub on: bool,
    /// Attenuates the light by material; fill lights do without.
    pub casts_shadows: bool,
    /// Coordinate frame of `position`.
    pub lock: LightLock,
    /// Spotlight cone, only for perspective lights.
    pub hood: Spotlight,
    /// Factor for the extinction of material for this light.
    pub density_scale: f64,
    /// Shape of the emitting surface. Anything but a point has penumbrae.
    pub shape: LightShape,
    /// Width of a perspective light, in scene units.
    pub size: f64,
    /// Angular width in degrees of a parallel light as seen from the volume: the sun has half a degree.
    pub angle_deg: f64,
    /// Aspect ratio of a rectangle, width by height.
    pub aspect: f64,
    /// Rotation of a rectangle in degrees, counterclockwise as seen from the volume.
    pub turn_deg: f64,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self {
            name: "Light".to_owned(),
            kind: LightGeometry::Parallel,
            position: [2.0, -2.0, 2.5],
            color: [1.0; 3],
            intensity: 1.0,
            on: true,
            casts_shadows: true,
            lock: LightLock::Scene,
            hood: Spotlight::default(),
            density_scale: 1.0,
            shape: LightShape::Point,
            size: 1.0,
            // At usual distances as wide as a perspective light of the size above.
            angle_deg: 15.0,
            aspect: 1.0,
            turn_deg: 0.0,
        }
    }
}

/// Cone of a spotlight, in cosines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpotlightCone {
    /// Unit vector in scene space from the light along the axis of the cone.
    pub axis: DVec3,
    /// Cosine of the angle from the axis up to which the light has its full intensity.
    pub cos_inner: f64,
    /// Cosine of the angle from the axis beyond which there is no light.
    pub cos_outer: f64,
}

impl SpotlightCone {
    /// Cone without a limit: −1, the smallest cosine, lies within full intensity.
    const UNLIMITED: Self = Self { axis: DVec3::NEG_Z, cos_inner: -2.0, cos_outer: -3.0 };

    /// Returns the share of light at a cosine of the angle to the axis: 3t² − 2t³ across the rim.
    pub fn attenuation(&self, cosine: f64) -> f64 {
        let t = ((cosine - self.cos_outer) / (self.cos_inner - self.cos_outer)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

/// Light for rendering: resolved into scene space, whatever it is locked to, and without a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneLight {
    /// Light geometry: parallel or perspective.
    pub kind: LightGeometry,
    /// Position in scene space of a perspective light; for a parallel light, any point in its direction.
    pub position: [f64; 3],
    /// Colour as sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Factor for the colour in linear light.
    pub intensity: f64,
    /// True if the light is switched on.
    pub on: bool,
    /// True if material attenuates the light.
    pub casts_shadows: bool,
    /// Spotlight cone of a perspective light.
    pub hood: Spotlight,
    /// Factor for the extinction of material for this light.
    pub density_scale: f64,
    /// Extent of an area light; `None` for a point.
    pub area: Option<LightArea>,
}

impl LightSettings {
    /// Resolves the light into scene space, for the given camera.
    pub fn resolve(&self, camera: &Camera) -> SceneLight {
        let Self {
            name: _,
            kind,
            position,
            color,
            intensity,
            on,
            casts_shadows,
            lock,
            hood,
            density_scale,
            shape: _,
            size: _,
            angle_deg: _,
            aspect: _,
            turn_deg: _,
        } = self;
        let position = match lock {
            LightLock::Scene => *position,
            LightLock::Camera => (camera.scene_from_view() * DVec3::from(*position)).into(),
        };
        let direction = DVec3::from(position).normalize_or(DVec3::Z);
        SceneLight {
            kind: *kind,
            position,
            color: *color,
            intensity: *intensity,
            on: *on,
            casts_shadows: *casts_shadows,
            hood: *hood,
            density_scale: *density_scale,
            area: LightArea::new(
                (self.shape, self.half_extent()),
                direction,
                camera.up.direction(),
                self.turn_deg,
            ),
        }
    }

    /// Returns half the width and half the height: in scene units, or as tangents for a parallel light.
    fn half_extent(&self) -> DVec2 {
        let half = match self.kind {
            LightGeometry::Parallel => (0.5 * self.angle_deg).to_radians().tan(),
            LightGeometry::Perspective => 0.5 * self.size,
        };
        match self.shape {
            LightShape::Rectangle => DVec2::new(half, half / self.aspect),
            _ => DVec2::splat(half),
        }
    }

    /// Changes the coordinate frame of the position without moving the light.
    pub fn set_lock(&mut self, lock: LightLock, camera: &Camera) {
        let place = self.resolve(camera).position;
        self.lock = lock;
        self.set_scene_position(place.into(), camera);
    }

    /// Moves the light to a position in the scene.
    pub fn set_scene_position(&mut self, place: DVec3, camera: &Camera) {
        self.position = match self.lock {
            LightLock::Scene => place.into(),
            LightLock::Camera => (camera.scene_from_view().transpose() * place).into(),
        };
    }

    /// Returns true if shadows of this light need an attenuation volume, or rays.
    pub fn needs_volume(&self) -> bool {
        self.on && self.casts_shadows && self.intensity > 0.0
    }
}

impl Default for SceneLight {
    fn default() -> Self {
        LightSettings::default().resolve(&Camera::default())
    }
}

impl SceneLight {
    /// Returns the spotlight cone; unlimited for parallel lights and without a hood.
    pub fn cone(&self) -> SpotlightCone {
        let Spotlight { on, half_angle_deg, rim_deg } = self.hood;
        if !on || self.kind == LightGeometry::Parallel {
            return SpotlightCone::UNLIMITED;
        }
        let cos_outer = half_angle_deg.to_radians().cos();
        let cos_inner = (half_angle_deg - rim_deg).max(0.0).to_radians().cos();
        // A rim of zero width would divide by zero; a millionth is sharper than any pixel.
        SpotlightCone { axis: -self.direction(), cos_inner: cos_inner.max(cos_outer + 1e-6), cos_outer }
    }

    /// Returns the unit vector from the origin towards the light.
    pub fn direction(&self) -> DVec3 {
        DVec3::from(self.position).normalize_or(DVec3::Z)
    }

    /// Returns true if the light needs an attenuation volume now.
    pub fn needs_volume(&self) -> bool {
        self.on && self.casts_shadows && self.intensity > 0.0
    }
}
