//! Top of a table: depth across the table, fitted to thin layers that are at the same depth along most of it.

use super::columns::ThinLayers;

/// Tilts of a table along its length that are tried: steps to either side, and the size of a step.
const TILT_STEPS: i32 = 16;
const TILT_STEP: f64 = 0.005;

/// Smallest share of the columns along a table in which a layer must be at the same depth.
const MIN_SHARE: f64 = 0.3;

/// Largest distance of layers from the fitted top, in millimetres: bends that a parabola does not have.
const MAX_MISFIT_MM: f64 = 4.0;

/// Smallest share of the grid's width on which the top must be seen.
const MIN_WIDTH_SHARE: f64 = 0.12;

/// Weight of layers in front of a fitted top, compared with those at it: what lies there is part of the table, too.
const FRONT_WEIGHT: f64 = 2.0;

/// Number of places across between which parabolas are tried.
const TRIED_PLACES: usize = 18;

/// Distance by which a top extends beyond the outermost columns in which it is seen, in millimetres.
const MARGIN_MM: f64 = 8.0;

/// Top of a table, as depths in voxels from the face beyond it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TableTop {
    /// Depth of each voxel across, in the slice at the origin of the axis along the table; NaN beside the table.
    depths: Vec<f32>,
    /// Change of the depth from voxel to voxel along the table.
    tilt: f64,
    score: f64,
}

/// Layers at the same depth along most of the table.
#[derive(Debug, Clone, Copy)]
struct Ridge {
    u: usize,
    depth: f64,
    /// Share of the columns along the table.
    share: f64,
}

impl TableTop {
    /// Fits the top to thin layers; `None` if too few agree.
    pub(super) fn fit(layers: &ThinLayers) -> Option<Self> {
        let tilts = (-TILT_STEPS..=TILT_STEPS).map(|step| f64::from(step) * TILT_STEP);
        let strength = |ridges: &[Ridge]| ridges.iter().map(|ridge| ridge.share.powi(2)).sum::<f64>();
        // Among equally strong ones the smallest tilt.
        let (tilt, ridges) = tilts
            .map(|tilt| (tilt, find_ridges(layers, tilt)))
            .max_by(|(s, a), (t, b)| strength(a).total_cmp(&strength(b)).then(t.abs().total_cmp(&s.abs())))?;
        let misfit = MAX_MISFIT_MM / layers.spacing_mm[1];
        let parabola = best_parabola(&ridges, layers.size[0], misfit)?;
        let at_top: Vec<Ridge> = ridges
            .iter()
            .copied()
            .filter(|ridge| (ridge.depth - parabola.at(ridge.u)).abs() <= misfit)
            .collect();
        let seen: std::collections::BTreeSet<usize> = at_top.iter().map(|ridge| ridge.u).collect();
        if (seen.len() as f64) < MIN_WIDTH_SHARE * layers.size[0] as f64 {
            return None;
        }
        let margin = (MARGIN_MM / (layers.spacing_mm[0] * layers.block[0] as f64)).ceil() as usize;
        let (first, last) = (*seen.first()?, *seen.last()?);
        let range = first.saturating_sub(margin)..=(last + margin).min(layers.size[0] - 1);
        let column_depth = |u: usize| {
            let own = at_top.iter().filter(|ridge| ridge.u == u).map(|ridge| ridge.depth);
            own.fold(None, |top: Option<f64>, depth| Some(top.map_or(depth, |top| top.max(depth))))
        };
        // Measured where it is seen, and else the parabola, moved to meet the measured ends of the gap.
        let offsets: Vec<(usize, f64)> =
            seen.iter().filter_map(|&u| Some((u, column_depth(u)? - parabola.at(u)))).collect();
        let depth_at = |u: usize| parabola.at(u) + interpolated(&offsets, u);
        let depths = (0..layers.size[0] * layers.block[0]).map(|voxel| {
            let u = voxel / layers.block[0];
            if range.contains(&u) { depth_at(u) as f32 } else { f32::NAN }
        });
        let score = at_top.iter().map(|ridge| ridge.share).sum::<f64>() / layers.size[0] as f64;
        Some(Self { depths: depths.collect(), tilt: tilt_per_voxel(layers, tilt), score })
    }

    /// Returns the depth of the top at a voxel across and along; `None` beside the table.
    pub(super) fn depth(&self, across: f64, along: f64) -> Option<f64> {
        let depth = f64::from(*self.depths.get(across as usize)?);
        depth.is_finite().then_some(depth + self.tilt * along)
    }

    /// Returns the share of the grid's width on which layers agree, weighted by the share of the length.
    pub(super) fn score(&self) -> f64 {
        self.score
    }
}

/// Returns a tilt per column as one per voxel along the table.
fn tilt_per_voxel(layers: &ThinLayers, tilt: f64) -> f64 {
    tilt / layers.block[1] as f64
}

/// Returns an interpolation between known numbers at sorted places; constant beyond them.
fn interpolated(known: &[(usize, f64)], u: usize) -> f64 {
    let above = known.partition_point(|(place, _)| *place < u);
    match (above.checked_sub(1).map(|at| known[at]), known.get(above)) {
        (Some((a, low)), Some(&(b, high))) => low + (high - low) * (u - a) as f64 / (b - a).max(1) as f64,
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (None, None) => 0.0,
    }
}

/// Finds the depths at which most columns along the table have a layer, if it is tilted by so many voxels a column.
fn find_ridges(layers: &ThinLayers, tilt: f64) -> Vec<Ridge> {
    let [width, length] = layers.size;
    let ridges = |u: usize| {
        let mut counts = vec![0_u32; layers.depth + 2];
        for v in 0..length {
            for &top in layers.tops(u, v) {
                let depth = (f64::from(top) - tilt * v as f64).round();
                if depth >= 0.0 && depth < layers.depth as f64 {
                    counts[depth as usize + 1] += 1;
                }
            }
        }
        let wide = |at: usize| counts[at - 1] + counts[at] + counts[at + 1];
        let least = (MIN_SHARE * length as f64).max(1.0);
        (1..=layers.depth)
            .filter(|&at| {
                f64::from(wide(at)) >= least && counts[at] >= counts[at - 1] && counts[at] > counts[at + 1]
            })
            .map(|at| {
                let sum = f64::from(wide(at));
                let mean = (f64::from(counts[at + 1]) - f64::from(counts[at - 1])) / sum;
                Ridge { u, depth: at as f64 - 1.0 + mean, share: (sum / length as f64).min(1.0) }
            })
            .collect::<Vec<_>>()
    };
    (0..width).flat_map(ridges).collect()
}

/// Parabola over columns across the table.
#[derive(Debug, Clone, Copy)]
struct Parabola {
    coefficients: [f64; 3],
}

impl Parabola {
    /// Creates the parabola through three ridges; `None` if two are in the same column.
    fn through([a, b, c]: [Ridge; 3]) -> Option<Self> {
        let [x, y, z] = [a, b, c].map(|ridge| ridge.u as f64);
        if x == y || y == z || x == z {
            return None;
        }
        // Newton's divided differences.
        let first = (b.depth - a.depth) / (y - x);
        let second = ((c.depth - b.depth) / (z - y) - first) / (z - x);
        Some(Self { coefficients: [a.depth - first * x + second * x * y, first - second * (x + y), second] })
    }

    fn at(&self, u: usize) -> f64 {
        let [a, b, c] = self.coefficients;
        a + u as f64 * (b + u as f64 * c)
    }
}

/// Returns the parabola at which most layers lie, and in front of which few do.
fn best_parabola(ridges: &[Ridge], width: usize, misfit: f64) -> Option<Parabola> {
    let step = (ridges.len() as f64 / TRIED_PLACES as f64).max(1.0);
    let tried: Vec<Ridge> =
        (0..TRIED_PLACES).filter_map(|at| ridges.get((at as f64 * step) as usize).copied()).collect();
    // The frontmost ridge of each column is a candidate as well.
    let mut front: Vec<Ridge> = Vec::new();
    for ridge in ridges {
        match front.last_mut() {
            Some(last) if last.u == ridge.u => *last = *ridge,
            _ => front.push(*ridge),
        }
    }
    let step = (front.len() as f64 / TRIED_PLACES as f64).max(1.0);
    let tried: Vec<Ridge> = tried
        .into_iter()
        .chain((0..TRIED_PLACES).filter_map(|at| front.get((at as f64 * step) as usize).copied()))
        .collect();
    let score = |parabola: &Parabola| {
        let part = |ridge: &Ridge| {
            let before = ridge.depth - parabola.at(ridge.u);
            if before.abs() <= misfit {
                ridge.share
            } else if before > 0.0 {
                -FRONT_WEIGHT * ridge.share
            } else {
                0.0
            }
        };
        ridges.iter().map(part).sum::<f64>()
    };
    let mut best: Option<(f64, Parabola)> = None;
    for (i, a) in tried.iter().enumerate() {
        for (j, b) in tried.iter().enumerate().skip(i + 1) {
            for c in &tried[j + 1..] {
                let Some(parabola) = Parabola::through([*a, *b, *c]) else { continue };
                // Tables bend by less than their width.
                let bend = parabola.coefficients[2].abs() * (width as f64).powi(2);
                if bend > width as f64 {
                    continue;
                }
                let reached = score(&parabola);
                if best.is_none_or(|(most, _)| reached > most) {
                    best = Some((reached, parabola));
                }
            }
        }
    }
    best.filter(|(score, _)| *score > 0.0).map(|(_, parabola)| parabola)
}
