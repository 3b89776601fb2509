//! Built-in volume `stained_glass`: a leaded church window, a label map of stone, lead and coloured panes.
//!
//! A rose window, as cathedrals have had since the twelfth century: petals, spokes and a wreath, in a round frame that
//! stands upright across y. The pattern is drawn in x and z, and cut from slabs of stone and glass whose faces lie
//! between voxels where 32 or a multiple of them are along an edge.

use glam::DVec2;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::super::value_metadata::{ValueMeaning, ValueMetadata};
use super::UnitGrid;

/// Label of the frame and of its tracery.
const STONE: u8 = 1;

/// Label of the strips of lead between panes.
const LEAD: u8 = 2;

const RUBY: u8 = 3;
const COBALT: u8 = 4;
const AMBER: u8 = 5;
const EMERALD: u8 = 6;
const VIOLET: u8 = 7;
const TURQUOISE: u8 = 8;
const PALE: u8 = 9;

/// Names and colours of the labels from [`STONE`] on, sRGB. Panes transmit light of their hue alone, so their colours
/// are nearly pure.
const LABELS: [(&str, [f32; 3]); 9] = [
    ("Stone", [0.74, 0.69, 0.60]),
    ("Lead", [0.10, 0.10, 0.12]),
    ("Ruby glass", [0.90, 0.04, 0.06]),
    ("Cobalt glass", [0.05, 0.18, 0.92]),
    ("Amber glass", [1.0, 0.60, 0.02]),
    ("Emerald glass", [0.02, 0.68, 0.24]),
    ("Violet glass", [0.55, 0.10, 0.85]),
    ("Turquoise glass", [0.03, 0.70, 0.82]),
    ("Pale glass", [1.0, 0.88, 0.50]),
];

/// Extents along y of panes with their leads, and of stone: one and three voxels of 32 along an edge.
const GLASS_Y: [f64; 2] = [0.0, 0.0625];
const STONE_Y: [f64; 2] = [-0.0625, 0.125];

/// Half the width of a strip of lead: three quarters of a voxel of the default size.
const HALF_LEAD: f64 = 0.0118;

/// Outer radius of the frame, and half the width and the foot of the block on which it stands.
const FRAME: f64 = 0.86;
const BLOCK_HALF_WIDTH: f64 = 0.375;
const BLOCK_FOOT: f64 = -0.9375;

/// Radii at which the rings of the window end, from the middle outwards: boss, petals, hub of stone, spokes with the
/// glass between them, and wreath. Beyond the wreath is the frame.
const BOSS: f64 = 0.11;
const PETALS: f64 = 0.32;
const HUB: f64 = 0.38;
const SPOKES: f64 = 0.67;
const WREATH: f64 = 0.78;

/// Half the width of a spoke, as wide as the hub.
const HALF_SPOKE: f64 = 0.025;

/// Radius of the roundels between the spokes, and its circle: they leave room for a pane towards the hub.
const ROUNDEL: f64 = 0.105;
const ROUNDELS_AT: f64 = 0.535;

/// Pane at a point of the pattern, with the distance of the point from the pane's border.
struct GlassPane {
    label: u8,
    border: f64,
}

/// Computes the labels of the window, 0 … 9.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let pattern: Vec<u8> =
        (0..grid.n * grid.n).map(|i| label(grid.centre(i % grid.n), grid.centre(i / grid.n))).collect();
    grid.fill(context, control, |z, slice| {
        for (y, row) in slice.chunks_exact_mut(grid.n).enumerate() {
            let within = |[from, to]: [f64; 2]| (from..to).contains(&grid.centre(y));
            for (voxel, &label) in row.iter_mut().zip(&pattern[z * grid.n..]) {
                let is_here = within(if label == STONE { STONE_Y } else { GLASS_Y });
                *voxel = if is_here { label } else { 0 };
            }
        }
    })
}

/// Returns the names and colours of the labels.
pub(super) fn metadata() -> ValueMetadata {
    let mut metadata = ValueMetadata::default();
    for (number, (name, color)) in (i64::from(STONE)..).zip(LABELS) {
        metadata.labels.insert(number, name, Some(color));
    }
    metadata.meaning = ValueMeaning::Labels;
    metadata
}

/// Returns the label at a point of the pattern; 0 outside the window.
fn label(x: f64, z: f64) -> u8 {
    let radius = distance(x, z);
    if radius > WREATH {
        let is_block = x.abs() < BLOCK_HALF_WIDTH && (BLOCK_FOOT..0.0).contains(&z);
        return if radius < FRAME || is_block { STONE } else { 0 };
    }
    let pane = match radius {
        _ if radius < BOSS => GlassPane { label: AMBER, border: BOSS - radius },
        _ if radius < PETALS => {
            let sector = WindowSector::at(x, z, 8, 0.5);
            let border = sector.side.min(radius - BOSS).min(PETALS - radius);
            GlassPane { label: [RUBY, COBALT][sector.number % 2], border }
        }
        _ if radius < HUB => return STONE,
        _ if radius < SPOKES => {
            let sector = WindowSector::at(x, z, 8, 0.0);
            if sector.side < HALF_SPOKE {
                return STONE;
            }
            pane_between_spokes(x, z, &sector)
        }
        _ => {
            let sector = WindowSector::at(x, z, 24, 0.0);
            let border = sector.side.min(radius - SPOKES).min(WREATH - radius);
            GlassPane { label: [COBALT, AMBER, RUBY][sector.number % 3], border }
        }
    };
    if pane.border < HALF_LEAD { LEAD } else { pane.label }
}

/// Sector of the window at a point of the pattern.
struct WindowSector {
    number: usize,
    /// Distance of the point from the nearer side of the sector.
    side: f64,
    /// Direction of the middle of the sector, in radians.
    middle: f64,
}

impl WindowSector {
    /// Returns the sector of a point among `count` ones, which begin at `offset` sectors before +x.
    fn at(x: f64, z: f64, count: usize, offset: f64) -> Self {
        let width = std::f64::consts::TAU / count as f64;
        let at = (z.atan2(x) / width + offset).rem_euclid(count as f64);
        let (number, inside) = (at.floor(), at.fract());
        let side = (inside.min(1.0 - inside) * width).sin() * distance(x, z);
        Self { number: number as usize % count, side, middle: (number + 0.5 - offset) * width }
    }
}

/// Returns the length of an offset in the pattern.
fn distance(x: f64, z: f64) -> f64 {
    DVec2::new(x, z).length()
}

/// Returns the pane at a point between two spokes: a roundel, and around it panes towards the hub and to both sides.
fn pane_between_spokes(x: f64, z: f64, sector: &WindowSector) -> GlassPane {
    let (sin, cos) = sector.middle.sin_cos();
    // Distances along the middle of the sector, and across it.
    let (along, across) = (x * cos + z * sin, z * cos - x * sin);
    let from_roundel = distance(along - ROUNDELS_AT, across) - ROUNDEL;
    if from_roundel < 0.0 {
        return GlassPane { label: [PALE, RUBY][sector.number % 2], border: -from_roundel };
    }
    let rims =
        (distance(x, z) - HUB).min(SPOKES - distance(x, z)).min(sector.side - HALF_SPOKE).min(from_roundel);
    // A lead from the roundel's middle to each spoke parts the pane towards the hub from the others, and one along
    // the middle of the sector parts those.
    if along < ROUNDELS_AT {
        return GlassPane {
            label: [TURQUOISE, VIOLET][sector.number % 2],
            border: rims.min(ROUNDELS_AT - along),
        };
    }
    let border = rims.min(along - ROUNDELS_AT).min(across.abs());
    GlassPane { label: if across > 0.0 { EMERALD } else { COBALT }, border }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::builtin;

    #[test]
    fn the_file_names_every_label_that_occurs() {
        let volume = builtin("stained_glass", None).unwrap();
        assert!(volume.is_label_map());
        let numbers: Vec<i64> = volume.labels().unwrap().labels().iter().map(|label| label.number).collect();
        assert_eq!(numbers, (0..=9).collect::<Vec<_>>());
        let names = &volume.metadata().labels;
        assert!((1..=9).all(|number| names.get(number).is_some_and(|label| label.color.is_some())));
    }

    #[test]
    fn lead_or_stone_lies_between_panes_and_around_all() {
        let n = 128;
        let grid = UnitGrid { n };
        let at = |x: usize, z: usize| label(grid.centre(x), grid.centre(z));
        for z in 1..n {
            for x in 1..n {
                for [beside, below] in [[1, 0], [0, 1]] {
                    let (one, other) = (at(x, z), at(x - beside, z - below));
                    let is_glass = |label: u8| label > LEAD;
                    assert!(one == other || !is_glass(one) || !is_glass(other), "{x} {z}: {one} {other}");
                    assert!(one != 0 || other <= STONE, "{x} {z}: glass at the border");
                }
            }
        }
    }
}
