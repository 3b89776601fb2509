//! Built-in volumes: small scenes and test signals, computed at any resolution.
//!
//! All fill the same cube of 128 mm around the world's origin, whatever the number of voxels, so that settings made
//! for one resolution hold for the others. They are described in coordinates p in [-1, 1]³ with z up: p = 1 is 64 mm,
//! and voxel i of n has its centre at (i + ½) / n · 2 − 1.

mod bone;
mod cells;
mod chair;
mod cloud;
mod cube;
mod marschner_lobb;
mod noise;
mod shapes;
mod solids;
mod sphere;
mod stained_glass;
mod voxelise;
mod wax;

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use super::load_context::{
    GridExtent, LevelRule, LoadContext, LoadControl, LoadError, ReadContext, VolumeChoice,
    memory_budget_bytes,
};
use super::{Samples, ValueMetadata, Volume, VoxelType};

/// Names of the built-in volumes.
pub const BUILTIN_NAMES: [&str; 9] =
    ["chair", "cloud", "sphere", "box", "marschner-lobb", "bone", "wax", "stained_glass", "cells"];

/// Default number of voxels along each edge.
pub const DEFAULT_SIZE: usize = 128;

/// Opacity unit of built-in volumes, in mm: a voxel of the default size.
pub(super) const OPACITY_UNIT_MM: f64 = 1.0;

/// Allowed numbers of voxels along each edge.
const SIZES: std::ops::RangeInclusive<usize> = 8..=1024;

/// Edge of the cube, in mm.
const EDGE_MM: f64 = 128.0;

/// Cubic grid of `n` voxels along each axis, in coordinates p.
#[derive(Debug, Clone, Copy)]
struct UnitGrid {
    n: usize,
}

impl UnitGrid {
    /// Returns the edge of a voxel, in units of p.
    fn voxel_edge(self) -> f64 {
        2.0 / self.n as f64
    }

    /// Returns the centre of voxel `i` along one axis, in units of p.
    fn centre(self, i: usize) -> f64 {
        (i as f64 + 0.5) / self.n as f64 * 2.0 - 1.0
    }

    /// Returns the voxels whose centres lie in `[from, to]` along one axis.
    fn range(self, from: f64, to: f64) -> std::ops::Range<usize> {
        let index = |p: f64| (p * 0.5 + 0.5) * self.n as f64 - 0.5;
        let first = index(from).ceil().max(0.0) as usize;
        let end = (index(to).floor() + 1.0).clamp(0.0, self.n as f64) as usize;
        first.min(end)..end
    }

    /// Computes all voxels in parallel: `slice(z, values)` fills one z-slice, which begins as zeros.
    fn fill<T: Copy + Default + Send>(
        self,
        context: LoadContext<'_>,
        control: &LoadControl,
        slice: impl Fn(usize, &mut [T]) + Sync,
    ) -> Result<Vec<T>, LoadError> {
        let mut values = Vec::new();
        let count = self.n.pow(3);
        if values.try_reserve_exact(count).is_err() {
            return Err(context.limit_error("N", "there is not enough memory", "choose fewer voxels"));
        }
        values.resize(count, T::default());
        control.start((count * size_of::<T>()) as u64);
        values.par_chunks_mut(self.n * self.n).enumerate().try_for_each(|(z, values)| {
            control.check()?;
            slice(z, values);
            control.advance(size_of_val(values) as u64);
            Ok::<(), LoadError>(())
        })?;
        Ok(values)
    }

    /// Computes all voxels in parallel from the coordinates p of their centres.
    fn fill_points<T: Copy + Default + Send>(
        self,
        context: LoadContext<'_>,
        control: &LoadControl,
        value: impl Fn(DVec3) -> T + Sync,
    ) -> Result<Vec<T>, LoadError> {
        self.fill(context, control, |z, slice| {
            for (y, row) in slice.chunks_exact_mut(self.n).enumerate() {
                for (x, voxel) in row.iter_mut().enumerate() {
                    *voxel = value(DVec3::new(self.centre(x), self.centre(y), self.centre(z)));
                }
            }
        })
    }
}

/// Makes the built-in volume `name` of `n`³ voxels, [`DEFAULT_SIZE`]³ by default.
///
/// # Errors
/// `BadInput` for a name that is not in [`BUILTIN_NAMES`] or an `n` outside 8 … 1024; `Limit` when it would need more
/// than three quarters of the free memory.
pub fn builtin(name: &str, n: Option<usize>) -> Result<Volume, LoadError> {
    builtin_with_budget(name, n, memory_budget_bytes(), &VolumeChoice::default(), &LoadControl::new())
}

/// Makes a built-in volume as [`builtin`] does, with a memory budget in bytes that must also hold the chosen portion,
/// and with a control for progress and cancellation.
///
/// # Errors
/// Fails like [`builtin`]; also with `Cancelled`.
pub fn builtin_with_budget(
    name: &str,
    n: Option<usize>,
    budget_bytes: u64,
    choice: &VolumeChoice,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let source = format!("builtin:{name}");
    let context = LoadContext { operation: "make the built-in volume", path: Path::new(&source) };
    let n = n.unwrap_or(DEFAULT_SIZE);
    if !BUILTIN_NAMES.contains(&name) {
        return Err(context.bad_input_error(
            "NAME",
            "there is no built-in volume of that name",
            format!("choose one of {}", BUILTIN_NAMES.join(", ")),
        ));
    }
    if !SIZES.contains(&n) {
        let (least, most) = (SIZES.start(), SIZES.end());
        return Err(context.bad_input_error(
            "N",
            format!("{least} to {most} voxels along an edge are possible, {n} were asked for"),
            format!("write it like builtin:{name}:{DEFAULT_SIZE}"),
        ));
    }
    control.check()?;
    let voxel_type = if name == "marschner-lobb" { VoxelType::F32 } else { VoxelType::U8 };
    // All voxels are made, even if only a portion of them is wanted.
    let room = ReadContext { budget_bytes, choice, control, level: LevelRule::default() };
    GridExtent::checked_whole(context, "N", [n as u64; 3], voxel_type, room)?;
    let grid = UnitGrid { n };
    let samples = match name {
        "chair" => Samples::U8(voxelise::voxelise(grid, &chair::parts(), context, control)?),
        "bone" => Samples::U8(bone::voxels(grid, context, control)?),
        "wax" => Samples::U8(wax::voxels(grid, context, control)?),
        "cells" => Samples::U8(cells::voxels(grid, context, control)?),
        "stained_glass" => Samples::U8(stained_glass::voxels(grid, context, control)?),
        "sphere" => Samples::U8(voxelise::voxelise(grid, &sphere::parts(), context, control)?),
        "cloud" => Samples::U8(cloud::voxels(grid, context, control)?),
        "box" => Samples::U8(cube::voxels(grid, context, control)?),
        _ => Samples::F32(marschner_lobb::voxels(grid, context, control)?),
    };
    let metadata = if name == "stained_glass" { stained_glass::metadata() } else { ValueMetadata::default() };
    let spacing_mm = EDGE_MM / n as f64;
    let world_from_index = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::splat(spacing_mm)),
        translation: DVec3::splat((spacing_mm - EDGE_MM) / 2.0),
    };
    Volume::new(name, [n; 3], world_from_index, samples)
        // The opacity unit is one voxel of the default size, so that the look is independent of the resolution.
        .map(|volume| volume.with_unit_mm(OPACITY_UNIT_MM).with_metadata(metadata))
        .map_err(|error| {
            context.bad_input_error("data", error.to_string(), "choose another number of voxels")
        })
}

#[cfg(test)]
mod tests {
    use super::super::load_context::LoadErrorKind;
    use super::*;

    fn make(name: &str, n: usize) -> Volume {
        builtin(name, Some(n)).unwrap()
    }

    /// Mean value; of a label map, whose numbers have no mean, the share of voxels with a label.
    fn mean(volume: &Volume) -> f64 {
        let count = volume.voxel_count();
        let value = |voxel| volume.samples().value(voxel);
        let shown = |voxel| if volume.is_label_map() { value(voxel).min(1.0) } else { value(voxel) };
        (0..count).map(shown).sum::<f64>() / count as f64
    }

    #[test]
    fn all_fill_the_same_cube() {
        for name in BUILTIN_NAMES {
            for n in [8, 30, 33] {
                let volume = make(name, n);
                assert_eq!((volume.name(), volume.dims()), (name, [n; 3]));
                let affine = volume.world_from_index();
                let low = affine.transform_point3(DVec3::splat(-0.5));
                let high = affine.transform_point3(DVec3::splat(n as f64 - 0.5));
                assert!((low + 64.0).length() < 1e-9 && (high - 64.0).length() < 1e-9, "{name}:{n}");
            }
        }
        assert_eq!(make("box", DEFAULT_SIZE).dims(), builtin("box", None).unwrap().dims());
    }

    #[test]
    fn resolution_changes_little() {
        for name in BUILTIN_NAMES {
            let (coarse, fine) = (mean(&make(name, 32)), mean(&make(name, 64)));
            assert!((coarse / fine - 1.0).abs() < 0.04, "{name}: {coarse} at 32, {fine} at 64");
        }
    }

    #[test]
    fn the_same_call_gives_the_same_voxels() {
        for name in BUILTIN_NAMES {
            assert_eq!(make(name, 24).samples(), make(name, 24).samples(), "{name}");
        }
    }

    #[test]
    fn scenes_stay_clear_of_the_border() {
        for name in BUILTIN_NAMES.into_iter().filter(|name| *name != "marschner-lobb") {
            let volume = make(name, 32);
            for a in 0..32 {
                for b in 0..32 {
                    for [x, y, z] in [[0, a, b], [31, a, b], [a, 0, b], [a, 31, b], [a, b, 0], [a, b, 31]] {
                        assert_eq!(volume.value(x, y, z), 0.0, "{name} at {x} {y} {z}");
                    }
                }
            }
        }
    }

    #[test]
    fn ranges_hold_the_centres() {
        let grid = UnitGrid { n: 8 };
        assert_eq!(grid.range(-2.0, 2.0), 0..8);
        assert_eq!(grid.range(grid.centre(2), grid.centre(5)), 2..6);
        assert_eq!(grid.range(0.01, 0.02), 4..4);
        assert_eq!(grid.range(1.5, 2.0), 8..8);
        assert!(grid.range(-3.0, -2.0).is_empty());
    }

    #[test]
    fn unknown_names_and_sizes_are_refused() {
        let kind = |name, n, budget| {
            builtin_with_budget(name, n, budget, &VolumeChoice::default(), &LoadControl::new())
                .map_err(|error| error.kind())
                .map(drop)
        };
        assert_eq!(kind("table", None, 1 << 30), Err(LoadErrorKind::BadInput));
        assert_eq!(kind("box", Some(7), 1 << 30), Err(LoadErrorKind::BadInput));
        assert_eq!(kind("box", Some(1025), 1 << 60), Err(LoadErrorKind::BadInput));
        assert_eq!(kind("box", Some(8), 511), Err(LoadErrorKind::Limit));
        assert_eq!(kind("marschner-lobb", Some(8), 2047), Err(LoadErrorKind::Limit));
        assert_eq!(kind("box", Some(8), 512), Ok(()));
    }
}
