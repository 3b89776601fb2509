//! Lights, in scene space.

pub(in crate::model) mod area;
pub(in crate::model) mod risen;
pub(in crate::model) mod scattering;
pub(in crate::model) mod sky;
pub(in crate::model) mod surroundings;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use self::area::{LightArea, LightShape};
use crate::model::Camera;

/// As many lights as a picture can have; each has its own attenuation volume.
pub const MAX_LIGHTS: usize = 8;

/// Most characters of a name: more than any list or label shows.
pub const MAX_NAME: usize = 200;

/// How a light's rays run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightKind {
    /// From infinitely far away, along the line from `position` to the middle of the volume.
    Parallel,
    /// From the point `position`, in all directions.
    Perspective,
}

/// What a light's position refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightLock {
    /// The scene: the light stays where it is when the camera turns.
    Scene,
    /// The camera's axes (right, up, back) around the origin: the light turns with it. At
    /// `[0, 0, z]` it is a headlight.
    Camera,
}

/// A lampshade: a perspective light shines only within a cone around the line to the origin (P §1,
/// "with or without hood").
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Hood {
    /// Whether there is one.
    pub on: bool,
    /// From the axis to where nothing is left of the light, in degrees.
    pub half_angle_deg: f64,
    /// The outer part of that in which the light fades, in degrees.
    pub rim_deg: f64,
}

impl Default for Hood {
    fn default() -> Self {
        Self { on: false, half_angle_deg: 25.0, rim_deg: 5.0 }
    }
}

/// One light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Light {
    /// What the user calls it.
    pub name: String,
    /// Parallel or perspective.
    pub kind: LightKind,
    /// In scene units. A parallel light uses only its direction as seen from the origin, so that
    /// switching the kind back and forth loses nothing.
    pub position: [f64; 3],
    /// sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Multiplies the colour in linear light.
    pub intensity: f64,
    /// Whether it shines.
    pub on: bool,
    /// Whether what it meets attenuates it; a fill light does without.
    pub casts_shadows: bool,
    /// What `position` refers to.
    pub lock: LightLock,
    /// Only for perspective lights.
    pub hood: Hood,
    /// Multiplies the extinction that this light meets.
    pub density_scale: f64,
    /// What shines of it. Anything but a point has penumbrae.
    pub shape: LightShape,
    /// Width of a perspective light, in scene units.
    pub size: f64,
    /// Width of a parallel light as it is seen from the volume, in degrees: the sun has half of one.
    pub angle_deg: f64,
    /// Width by height of a rectangle.
    pub aspect: f64,
    /// How far a rectangle is turned counterclockwise, as seen from the volume.
    pub turn_deg: f64,
}

impl Default for Light {
    fn default() -> Self {
        Self {
            name: "Light".to_owned(),
            kind: LightKind::Parallel,
            position: [2.0, -2.0, 2.5],
            color: [1.0; 3],
            intensity: 1.0,
            on: true,
            casts_shadows: true,
            lock: LightLock::Scene,
            hood: Hood::default(),
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

/// The cone of a hood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// From the light to the middle of what it shines at; a unit vector in scene space.
    pub axis: DVec3,
    /// Cosine of the angle from the axis up to which the light shines fully.
    pub cos_inner: f64,
    /// Cosine of the angle from the axis from which on it does not shine.
    pub cos_outer: f64,
}

impl Cone {
    /// Shines everywhere: −1, the smallest cosine, lies beyond the rim.
    const OPEN: Self = Self { axis: DVec3::NEG_Z, cos_inner: -2.0, cos_outer: -3.0 };

    /// The share that passes at a cosine of the angle to the axis: 3t² − 2t³ across the rim.
    pub fn share(&self, cosine: f64) -> f64 {
        let t = ((cosine - self.cos_outer) / (self.cos_inner - self.cos_outer)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

/// A light as every pass sees it: resolved into scene space, whatever it is locked to, and without a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneLight {
    /// How its light travels.
    pub kind: LightKind,
    /// In scene space: where a perspective light is, and a point in the direction of a parallel one.
    pub position: [f64; 3],
    /// sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Multiplies its colour.
    pub intensity: f64,
    /// Whether it shines.
    pub on: bool,
    /// Whether material attenuates it.
    pub casts_shadows: bool,
    /// Narrows a perspective light to a cone.
    pub hood: Hood,
    /// Multiplies the extinction that it meets.
    pub density_scale: f64,
    /// How large it is; `None` of a point.
    pub area: Option<LightArea>,
}

impl Light {
    /// The light where it stands in the scene, for the given camera.
    pub fn in_scene(&self, camera: &Camera) -> SceneLight {
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

    /// Half its width and half its height: in scene units, of a parallel light as tangents.
    fn half_extent(&self) -> DVec2 {
        let half = match self.kind {
            LightKind::Parallel => (0.5 * self.angle_deg).to_radians().tan(),
            LightKind::Perspective => 0.5 * self.size,
        };
        match self.shape {
            LightShape::Rectangle => DVec2::new(half, half / self.aspect),
            _ => DVec2::splat(half),
        }
    }

    /// Changes what the position refers to and leaves the light where it is.
    pub fn set_lock(&mut self, lock: LightLock, camera: &Camera) {
        let place = self.in_scene(camera).position;
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

    /// Whether shadows of this light need an attenuation volume, or rays.
    pub fn needs_volume(&self) -> bool {
        self.on && self.casts_shadows && self.intensity > 0.0
    }
}

impl Default for SceneLight {
    fn default() -> Self {
        Light::default().in_scene(&Camera::default())
    }
}

impl SceneLight {
    /// The cone in which the light shines; open for parallel lights and without a hood.
    pub fn cone(&self) -> Cone {
        let Hood { on, half_angle_deg, rim_deg } = self.hood;
        if !on || self.kind == LightKind::Parallel {
            return Cone::OPEN;
        }
        let cos_outer = half_angle_deg.to_radians().cos();
        let cos_inner = (half_angle_deg - rim_deg).max(0.0).to_radians().cos();
        // No rim at all would divide by zero; a millionth is sharper than any pixel.
        Cone { axis: -self.direction(), cos_inner: cos_inner.max(cos_outer + 1e-6), cos_outer }
    }

    /// Unit vector from the origin towards a parallel light.
    pub fn direction(&self) -> DVec3 {
        DVec3::from(self.position).normalize_or(DVec3::Z)
    }

    /// Whether this light needs an attenuation volume now.
    pub fn needs_volume(&self) -> bool {
        self.on && self.casts_shadows && self.intensity > 0.0
    }
}
