//! Phantoms of bodies on tables, with both known.

use glam::DVec3;

use super::*;
use crate::Samples;
use crate::volume::Corrections;

const DIMS: [usize; 3] = [176, 150, 80];
const SPACING_MM: f64 = 2.4;

/// Value from which on the phantoms' voxels are material, in Hounsfield units.
const THRESHOLD: f64 = -500.0;

/// Shape of a table's top: its depth in millimetres below the middle of the grid, at a distance from its middle.
type Top = fn(f64) -> f64;

/// Phantom of a body on a table.
#[derive(Clone, Copy)]
struct Phantom {
    name: &'static str,
    top: Top,
    /// Distance between back and top, in millimetres; negative where the back is pressed flat.
    gap_mm: f64,
    half_width_mm: f64,
    /// Thicknesses of the shells, and of the foam between them.
    shell_mm: f64,
    foam_mm: f64,
    /// Rise across and along the table.
    slopes: [f64; 2],
    has_arms: bool,
    /// Size of the body, relative to a torso.
    size: f64,
    noise: f64,
    /// First and last voxel across that are kept.
    kept: [usize; 2],
}

const PLAIN: Phantom = Phantom {
    name: "flat",
    top: |_| 105.0,
    gap_mm: 6.0,
    half_width_mm: 190.0,
    shell_mm: 4.0,
    foam_mm: 30.0,
    slopes: [0.0; 2],
    has_arms: false,
    size: 1.0,
    noise: 20.0,
    kept: [0, DIMS[0]],
};

fn curved(x: f64) -> f64 {
    112.0 - x * x / 900.0
}

/// Half of a tube, as under heads.
fn cradle(x: f64) -> f64 {
    (135.0_f64.powi(2) - x * x).max(0.0).sqrt() - 25.0
}

fn phantoms() -> [Phantom; 14] {
    [
        PLAIN,
        Phantom { name: "touching", gap_mm: -3.0, ..PLAIN },
        Phantom { name: "curved", top: curved, gap_mm: 4.0, ..PLAIN },
        Phantom { name: "curved, touching", top: curved, gap_mm: -4.0, ..PLAIN },
        Phantom { name: "cushioned", gap_mm: 18.0, ..PLAIN },
        Phantom { name: "tilted across", slopes: [0.05, 0.0], gap_mm: 2.0, ..PLAIN },
        Phantom { name: "tilted along", slopes: [0.0, 0.06], gap_mm: 2.0, ..PLAIN },
        Phantom { name: "cropped", kept: [40, 150], gap_mm: -2.0, ..PLAIN },
        Phantom { name: "board", shell_mm: 14.0, foam_mm: 0.0, gap_mm: -2.0, ..PLAIN },
        Phantom { name: "arms", has_arms: true, gap_mm: -2.0, ..PLAIN },
        Phantom { name: "noisy", noise: 90.0, gap_mm: -2.0, ..PLAIN },
        Phantom {
            name: "cradle",
            top: cradle,
            size: 0.55,
            half_width_mm: 128.0,
            foam_mm: 0.0,
            gap_mm: 14.0,
            ..PLAIN
        },
        Phantom { name: "bent by gravity", top: |x| 104.0 + x.abs() / 12.0, gap_mm: -1.0, ..PLAIN },
        Phantom { name: "narrow", half_width_mm: 120.0, top: curved, gap_mm: 1.0, ..PLAIN },
    ]
}

/// Part of a phantom that a point belongs to.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Part {
    Air,
    Body,
    Table,
    Foam,
}

impl Phantom {
    /// Returns the part at a point, in millimetres from the middle: across, down and along.
    fn part(&self, x: f64, y: f64, z: f64) -> Part {
        let rise = self.slopes[0] * x + self.slopes[1] * z;
        let below = y - ((self.top)(x) + rise);
        // A back with two curves along the spine.
        let deep = 98.0 + 7.0 * (z / 45.0).sin();
        let lowest = (self.top)(0.0) + self.slopes[1] * z - self.gap_mm;
        let middle = lowest - 105.0 * self.size;
        let ellipse = |cx: f64, cy: f64, rx: f64, ry: f64| {
            let [dx, dy] = [(x - cx) / (rx * self.size), (y - cy) / (ry * self.size)];
            dx * dx + dy * dy < 1.0
        };
        let torso = ellipse(0.0, middle, 155.0 + 12.0 * (z / 60.0).cos(), deep + 7.0);
        let arms = self.has_arms && [-180.0, 180.0].iter().any(|&at| ellipse(at, middle + 50.0, 24.0, 30.0));
        if below < 0.0 && (torso || arms) {
            let lung = ellipse(-60.0, middle - 10.0, 45.0, 55.0) && z > 0.0;
            return if lung { Part::Air } else { Part::Body };
        }
        if x.abs() > self.half_width_mm || below < 0.0 {
            return Part::Air;
        }
        let thick = 2.0 * self.shell_mm + self.foam_mm;
        if below < self.shell_mm || (below > self.shell_mm + self.foam_mm && below < thick) {
            Part::Table
        } else if below < thick {
            Part::Foam
        } else {
            Part::Air
        }
    }

    fn point(voxel: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| (voxel[axis] as f64 - 0.5 * (DIMS[axis] - 1) as f64) * SPACING_MM)
    }

    /// Returns the volume, the part of each voxel, and its dimensions.
    fn volume(&self) -> (Volume, Vec<Part>, [usize; 3]) {
        let dims = [self.kept[1] - self.kept[0], DIMS[1], DIMS[2]];
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        };
        let mut parts = Vec::new();
        let mut values = Vec::new();
        for at in 0..dims.iter().product::<usize>() {
            let voxel = [at % dims[0] + self.kept[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])];
            let [x, y, z] = Self::point(voxel);
            let part = self.part(x, y, z);
            let value = match part {
                Part::Air => -1000.0,
                Part::Body => 40.0,
                Part::Table => -60.0,
                Part::Foam => -930.0,
            };
            // The standard deviation of uniform noise is 0.29 of its range.
            values.push((value + self.noise / 0.29 * noise()) as f32);
            parts.push(part);
        }
        let volume = Volume::with_spacing("phantom", dims, DVec3::splat(SPACING_MM), Samples::F32(values));
        (volume.expect("a phantom"), parts, dims)
    }
}

/// Returns a volume corrected by hiding its table.
fn without_table(volume: &Volume) -> Volume {
    volume
        .corrected(&Corrections { hidden_table: Some(THRESHOLD), ..Corrections::NONE })
        .expect("a corrected volume")
}

#[test]
fn a_hidden_table_is_missing_and_comes_back() {
    let (volume, parts, dims) = Phantom { gap_mm: -2.0, ..PLAIN }.volume();
    let hidden = without_table(&volume);
    let missing = hidden.missing().expect("missing voxels");
    assert!((0..parts.len()).filter(|&at| parts[at] == Part::Table).all(|at| missing.contains(at)));
    assert_ne!(hidden.content_id(), volume.content_id());
    assert_eq!(hidden.value(0, 0, 0), volume.value(0, 0, 0), "values stay");
    // Corrections that only move voxels keep it, and the volume as opened has it still.
    let turned = Corrections { hidden_table: Some(THRESHOLD), orientation: None, ..Corrections::NONE };
    assert_eq!(
        hidden.corrected(&turned).expect("a volume").missing().map(crate::MissingVoxels::count),
        Some(missing.count())
    );
    assert!(hidden.as_opened().missing().is_none());
    let back = hidden.corrected(&Corrections::NONE).expect("the volume as opened");
    assert_eq!((back.content_id(), back.missing()), (volume.content_id(), None));
    // Averaged blocks in the table are missing, too.
    let half = hidden.to_block_averaged([2; 3]).expect("half of the voxels");
    let [nx, ny, _] = half.dims();
    let missing = half.missing().expect("missing blocks");
    for at in 0..half.dims().iter().product::<usize>() {
        let block = [at % nx, at / nx % ny, at / (nx * ny)];
        let voxels = (0..8)
            .map(|corner| [0, 1, 2].map(|axis| (2 * block[axis] + (corner >> axis & 1)).min(dims[axis] - 1)));
        let is_table = voxels.clone().all(|[x, y, z]| parts[x + dims[0] * (y + dims[1] * z)] == Part::Table);
        assert!(!is_table || missing.contains(at), "{block:?}");
    }
}

/// Axes may lie in any order and direction.
#[test]
fn tables_are_found_along_every_axis() {
    let phantom = Phantom { gap_mm: -2.0, ..PLAIN };
    let (volume, _, [nx, ny, nz]) = phantom.volume();
    let count = PatientTable::find(&volume, THRESHOLD).map(|table| count_of(&table, [nx, ny, nz]));
    // z, x, y in place of x, y, z, with the table at the other end.
    let turned = [nz, nx, ny];
    let value = |at: usize| {
        let [z, x, y] = [at % nz, at / nz % nx, at / (nz * nx)];
        volume.value(x, ny - 1 - y, z) as f32
    };
    let samples = Samples::F32((0..nx * ny * nz).map(value).collect());
    let turned_volume =
        Volume::with_spacing("turned", turned, DVec3::splat(SPACING_MM), samples).expect("a volume");
    let found = PatientTable::find(&turned_volume, THRESHOLD).map(|table| count_of(&table, turned));
    assert!(count.is_some_and(|count| count > 10_000));
    assert_eq!(found, count);
}

fn count_of(table: &PatientTable, [nx, ny, nz]: [usize; 3]) -> usize {
    let voxel = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)];
    (0..nx * ny * nz).filter(|&at| table.contains(voxel(at))).count()
}

/// Returns the share of the body that is hidden, and of the table that is left.
fn hidden_and_left(table: &PatientTable, parts: &[Part], dims: [usize; 3]) -> [f64; 2] {
    let share = |part: Part, is_hidden: bool| {
        let all = (0..parts.len()).filter(|&at| parts[at] == part);
        let [mut count, mut found] = [0usize; 2];
        for at in all {
            count += 1;
            let voxel = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])];
            found += usize::from(table.contains(voxel) == is_hidden);
        }
        found as f64 / count.max(1) as f64
    };
    [share(Part::Body, true), share(Part::Table, false)]
}

#[test]
fn tables_of_phantoms_are_found_and_their_bodies_stay() {
    let mut failures = Vec::new();
    for phantom in phantoms() {
        let (volume, parts, dims) = phantom.volume();
        match PatientTable::find(&volume, THRESHOLD) {
            None => failures.push(format!("{}: no table", phantom.name)),
            Some(table) => {
                let [hidden, left] = hidden_and_left(&table, &parts, dims);
                println!(
                    "{}: {:.3} % of the body hidden, {:.2} % of the table left",
                    phantom.name,
                    100.0 * hidden,
                    100.0 * left
                );
                if hidden > 0.005 || left > 0.01 {
                    failures.push(format!(
                        "{}: {:.3} %, {:.2} %",
                        phantom.name,
                        100.0 * hidden,
                        100.0 * left
                    ));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_body_without_a_table_stays_whole() {
    let bare = Phantom { half_width_mm: -1.0, gap_mm: -2.0, ..PLAIN };
    for phantom in [bare, Phantom { has_arms: true, ..bare }] {
        let (volume, ..) = phantom.volume();
        assert!(PatientTable::find(&volume, THRESHOLD).is_none());
    }
}
