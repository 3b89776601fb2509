//! Hidden shares of all voxels, which cuts change one after another.

use rayon::prelude::*;

use crate::{CutAction, ShapeCut};
use glam::DVec3;

/// Number of voxels of a row for which one distance may stand.
const RUN_VOXELS: usize = 16;

/// Hidden share of a voxel that is not visible at all.
const HIDDEN: u8 = 255;

/// Hidden share of each voxel, from 0 to 255.
pub(super) struct HiddenShares {
    /// Shares that are hidden from the eye.
    pub(super) from_eye: Vec<u8>,
    /// Shares that are hidden from light, once a cut has hidden something from eye or light alone.
    pub(super) from_light: Option<Vec<u8>>,
}

impl HiddenShares {
    /// Creates the shares of so many visible voxels.
    pub(super) fn new(count: usize) -> Self {
        Self { from_eye: vec![0; count], from_light: None }
    }

    /// Returns the shares that a cut changes.
    fn changed_by(&mut self, cut: &ShapeCut) -> Vec<&mut Vec<u8>> {
        let (is_seen, is_met) = match cut.action {
            CutAction::Restore => (true, true),
            CutAction::Hide | CutAction::Keep => (cut.effect.is_invisible(), cut.effect.is_shadowless()),
        };
        if !(is_seen && is_met) && self.from_light.is_none() {
            self.from_light = Some(self.from_eye.clone());
        }
        let from_eye = is_seen.then_some(&mut self.from_eye);
        let from_light = self.from_light.as_mut().filter(|_| is_met);
        from_eye.into_iter().chain(from_light).collect()
    }

    /// Applies a cut to all voxels of a grid, with the signed distance by which each lies inside its shape, and inside
    /// a limit that may jump.
    pub(super) fn apply_distance(
        &mut self,
        cut: &ShapeCut,
        rows: RowChanges,
        inside: &(impl Fn(DVec3) -> f64 + Sync),
        limit: Option<&Distance<'_>>,
    ) {
        for shares in self.changed_by(cut) {
            apply_distance(shares, cut.action, rows, inside, limit);
        }
    }

    /// Applies a cut to all voxels, of which it is known whether they lie inside its shape.
    pub(super) fn apply_voxels(&mut self, cut: &ShapeCut, inside: &[bool]) {
        for shares in self.changed_by(cut) {
            shares.par_iter_mut().zip(inside).for_each(|(hidden, is_inside)| {
                *hidden = applied(cut.action, *hidden, if *is_inside { HIDDEN } else { 0 });
            });
        }
    }
}

/// Signed distance in voxels by which a point of index space lies inside a shape.
pub(super) type Distance<'a> = dyn Fn(DVec3) -> f64 + Sync + 'a;

/// Rows of a grid, along which distances change slowly.
#[derive(Debug, Clone, Copy)]
pub(super) struct RowChanges {
    /// Number of voxels along x, y, z.
    pub(super) dims: [usize; 3],
    /// Largest change of a distance from one voxel of a row to the next.
    pub(super) max_change: f64,
}

/// Applies an action to all voxels of a grid, with the signed distance in voxels by which each lies inside a shape, and
/// inside a limit that may jump.
fn apply_distance(
    hidden: &mut [u8],
    action: CutAction,
    RowChanges { dims: [nx, ny, _], max_change }: RowChanges,
    voxels_inside: &(impl Fn(DVec3) -> f64 + Sync),
    limit: Option<&Distance<'_>>,
) {
    hidden.par_chunks_mut(nx).enumerate().for_each(|(row, hidden)| {
        let (y, z) = ((row % ny) as f64, (row / ny) as f64);
        let inside = |x: f64| voxels_inside(DVec3::new(x, y, z));
        for (run, hidden) in hidden.chunks_mut(RUN_VOXELS).enumerate() {
            let first = (run * RUN_VOXELS) as f64;
            // Far from the edge all voxels of a run are alike.
            let middle = inside(first + 0.5 * (hidden.len() - 1) as f64);
            let is_far = middle.abs() > max_change * RUN_VOXELS as f64 + 1.0;
            let is_alike = is_far && (middle < 0.0 || limit.is_none());
            for (x, hidden) in hidden.iter_mut().enumerate() {
                // A voxel whose centre lies on the edge is hidden by half.
                let distance = match limit {
                    _ if is_alike => middle,
                    None => inside(first + x as f64),
                    Some(limit) => inside(first + x as f64).min(limit(DVec3::new(first + x as f64, y, z))),
                };
                let share = (distance + 0.5).clamp(0.0, 1.0);
                *hidden = applied(action, *hidden, (share * f64::from(HIDDEN) + 0.5) as u8);
            }
        }
    });
}

/// Returns the hidden share of a voxel after an action of which `inside` is the share inside the shape.
fn applied(action: CutAction, hidden: u8, inside: u8) -> u8 {
    match action {
        CutAction::Hide => hidden.max(inside),
        CutAction::Keep => hidden.max(HIDDEN - inside),
        CutAction::Restore => hidden.saturating_sub(inside),
    }
}
