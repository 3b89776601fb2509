//! Where a floor lies, and maps of it.

use glam::DVec3;

use crate::model::{SceneAxis, Settings};

/// How far a map reaches from the middle of the floor, in scene units: beyond, a volume hides next to nothing.
const REACH: f64 = 3.0;

/// Where a floor lies that takes light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorPlace {
    /// From the middle of the scene upwards.
    pub height: f64,
    /// The axis of the scene that points up.
    pub up: SceneAxis,
}

/// Texels of a map in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorTexels {
    /// Middle of the first.
    pub origin: DVec3,
    /// From one to the next along both edges.
    pub along: [DVec3; 2],
}

impl FloorPlace {
    /// That of a look; `None` where there is no floor.
    pub fn of(settings: &Settings) -> Option<Self> {
        let Settings { floor, camera, .. } = settings;
        floor.on.then_some(Self { height: floor.height, up: camera.up })
    }

    /// Two directions along it, and up.
    fn axes(self) -> [DVec3; 3] {
        let upright = self.up.scene_from_upright();
        [upright * DVec3::X, upright * DVec3::Y, self.up.direction()]
    }

    /// As many texels along an edge of a map as are so long in scene units.
    pub fn texels_of(length: f64) -> u32 {
        (2.0 * REACH / length).ceil() as u32
    }

    /// The texels of a map with `edge` of them along each edge.
    pub fn texels(self, edge: u32) -> FloorTexels {
        let [right, front, up] = self.axes();
        let texel = 2.0 * REACH / f64::from(edge);
        FloorTexels {
            origin: up * self.height - (right + front) * (REACH - 0.5 * texel),
            along: [right * texel, front * texel],
        }
    }

    /// From scene space to texture coordinates of a map: vectors, and what is added.
    pub fn lookup(self) -> [[f32; 4]; 2] {
        let map = |axis: DVec3| (axis / (2.0 * REACH)).extend(0.5).as_vec4().into();
        let [right, front, _] = self.axes();
        [map(right), map(front)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    #[test]
    fn texels_of_a_length_cover_a_map() {
        for (length, edge) in [(2.0 * REACH / 300.0, 300), (2.0 * REACH / 300.5, 301)] {
            assert_eq!(FloorPlace::texels_of(length), edge);
        }
    }

    #[test]
    fn texels_are_looked_up_in_their_middles() {
        for up in [SceneAxis::PlusZ, SceneAxis::MinusY] {
            let place = FloorPlace { height: -0.7, up };
            let FloorTexels { origin, along } = place.texels(10);
            let lookup = place.lookup();
            for (x, y) in [(0.0, 0.0), (3.0, 9.0)] {
                let at = (origin + along[0] * x + along[1] * y).as_vec3().extend(1.0);
                let found = lookup.map(|row| f64::from(Vec4::from(row).dot(at)));
                assert!((found[0] - (x + 0.5) / 10.0).abs() < 1e-6, "{found:?}");
                assert!((found[1] - (y + 0.5) / 10.0).abs() < 1e-6, "{found:?}");
                assert!((at.truncate().as_dvec3().dot(up.direction()) + 0.7).abs() < 1e-6);
            }
        }
    }
}
