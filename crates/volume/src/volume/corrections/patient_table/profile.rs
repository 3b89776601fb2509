//! Top of a table: depth across the table, fitted to thin layers that are at the same depth along most of it.

use super::columns::ThinLayers;

/// Tilts of a table along its length that are tried: number of steps to either side, and the change of its depth per
/// length of a step. The error of half a step is a millimetre over 0.8 m.
const TILT_STEPS: i32 = 24;
const TILT_STEP: f64 = 0.0025;

/// Smallest share of the columns along a table in which a layer must be at the same depth.
const MIN_SHARE: f64 = 0.3;

/// Largest distance of layers from the fitted top, in millimetres: bends that a shape does not have.
const MAX_MISFIT_MM: f64 = 4.0;

/// Smallest share of the grid's width on which the top must be seen.
const MIN_WIDTH_SHARE: f64 = 0.12;

/// Weight of layers in front of a fitted top, compared with those at it: what lies there is part of the table, too.
const FRONT_WEIGHT: f64 = 2.0;

/// Number of places across between which shapes are tried.
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
    /// Depth from which on no voxel is beyond the top.
    limit: f64,
    score: f64,
}

/// Layers at the same depth along most of the table.
#[derive(Debug, Clone, Copy)]
struct Ridge {
    u: usize,
    depth: f64,
    /// Share of the columns along the table, within a voxel of the depth.
    share: f64,
    /// Share of the columns in the voxel of the depth: it is largest at the right tilt.
    peak: f64,
}

impl TableTop {
    /// Fits the top to thin layers; `None` if too few agree.
    pub(super) fn fit(layers: &ThinLayers) -> Option<Self> {
        let [mm_across, mm_along, mm_down] = layers.spacing_mm;
        let steps = (-TILT_STEPS..=TILT_STEPS).map(f64::from);
        let tilts = steps.map(|step| step * TILT_STEP * mm_along / mm_down);
        let strength = |ridges: &[Ridge]| ridges.iter().map(|ridge| ridge.peak.powi(2)).sum::<f64>();
        // Among equally strong ones the smallest tilt.
        let (tilt, ridges) = tilts
            .map(|tilt| (tilt, find_ridges(layers, tilt)))
            .max_by(|(s, a), (t, b)| strength(a).total_cmp(&strength(b)).then(t.abs().total_cmp(&s.abs())))?;
        let misfit = MAX_MISFIT_MM / mm_down;
        let shape = best_shape(&ridges, layers, misfit)?;
        let at_top: Vec<Ridge> = ridges
            .iter()
            .copied()
            .filter(|ridge| (ridge.depth - shape.at(ridge.u)).abs() <= misfit)
            .collect();
        let seen: std::collections::BTreeSet<usize> = at_top.iter().map(|ridge| ridge.u).collect();
        if (seen.len() as f64) < MIN_WIDTH_SHARE * layers.size[0] as f64 {
            return None;
        }
        let margin = (MARGIN_MM / (mm_across * layers.block[0] as f64)).ceil() as usize;
        let (first, last) = (*seen.first()?, *seen.last()?);
        let range = first.saturating_sub(margin)..=(last + margin).min(layers.size[0] - 1);
        let column_depth = |u: usize| {
            let own = at_top.iter().filter(|ridge| ridge.u == u).map(|ridge| ridge.depth);
            own.fold(None, |top: Option<f64>, depth| Some(top.map_or(depth, |top| top.max(depth))))
        };
        // Measured where it is seen, and else the shape, moved to meet the measured ends of the gap.
        let offsets: Vec<(usize, f64)> =
            seen.iter().filter_map(|&u| Some((u, column_depth(u)? - shape.at(u)))).collect();
        let depth_at = |u: usize| shape.at(u) + interpolate(&offsets, u);
        let depths = (0..layers.size[0] * layers.block[0]).map(|voxel| {
            let u = voxel / layers.block[0];
            if !range.contains(&u) {
                return f32::NAN;
            }
            // The walls of a cradle lie beside the columns in which its top is seen.
            (if (first..=last).contains(&u) { depth_at(u) } else { shape.depth_of_wall(u) }) as f32
        });
        let depths: Vec<f32> = depths.collect();
        let deepest = depths.iter().copied().filter(|depth| depth.is_finite()).fold(0.0, f32::max);
        let limit = f64::from(deepest) + (tilt * (layers.size[1] * layers.block[1]) as f64).max(0.0);
        let score = at_top.iter().map(|ridge| ridge.share).sum::<f64>() / layers.size[0] as f64;
        Some(Self { depths, tilt, limit, score })
    }

    /// Returns the depth from which on no voxel is beyond the top.
    pub(super) fn limit(&self) -> f64 {
        self.limit
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

/// Interpolates between known numbers at sorted places; constant beyond them.
fn interpolate(known: &[(usize, f64)], u: usize) -> f64 {
    let above = known.partition_point(|(place, _)| *place < u);
    match (above.checked_sub(1).map(|at| known[at]), known.get(above)) {
        (Some((a, low)), Some(&(b, high))) => low + (high - low) * (u - a) as f64 / (b - a).max(1) as f64,
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (None, None) => 0.0,
    }
}

/// Finds the depths at which most columns along the table have a layer, if its depth changes by `tilt` from voxel to
/// voxel along it.
fn find_ridges(layers: &ThinLayers, tilt: f64) -> Vec<Ridge> {
    let [width, length] = layers.size;
    let ridges = |u: usize| {
        let mut counts = vec![0_u32; layers.depth + 2];
        for v in 0..length {
            for &top in layers.tops(u, v) {
                let depth = (f64::from(top) - tilt * (v * layers.block[1]) as f64).round();
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
                let share = |count: f64| (count / length as f64).min(1.0);
                let (share, peak) = (share(sum), share(f64::from(counts[at])));
                Ridge { u, depth: at as f64 - 1.0 + mean, share, peak }
            })
            .collect::<Vec<_>>()
    };
    (0..width).flat_map(ridges).collect()
}

/// Shape of a table across its length: depth in voxels over columns.
#[derive(Debug, Clone, Copy)]
enum TableShape {
    /// Flat or bent board: coefficients of a parabola.
    Board([f64; 3]),
    /// Cradle, as head holders are: middle and radius of a circle, in voxels of depth, with the number of them per
    /// column.
    Cradle { middle: [f64; 2], radius: f64, per_column: f64 },
}

impl TableShape {
    /// Returns the shapes through three ridges in different columns.
    fn through([a, b, c]: [Ridge; 3], per_column: f64) -> impl Iterator<Item = Self> {
        let [x, y, z] = [a, b, c].map(|ridge| ridge.u as f64);
        let is_proper = x != y && y != z && x != z;
        // Newton's divided differences.
        let first = (b.depth - a.depth) / (y - x);
        let second = ((c.depth - b.depth) / (z - y) - first) / (z - x);
        let board = Self::Board([a.depth - first * x + second * x * y, first - second * (x + y), second]);
        // Equal distances from the middle, relative to the first ridge (Cramer's rule).
        let [p, q] = [b, c].map(|ridge| [(ridge.u as f64 - x) * per_column, ridge.depth - a.depth]);
        let [p2, q2] = [p, q].map(|way| way[0] * way[0] + way[1] * way[1]);
        let area = 2.0 * (p[0] * q[1] - p[1] * q[0]);
        let way = [(q[1] * p2 - p[1] * q2) / area, (p[0] * q2 - q[0] * p2) / area];
        let middle = [x * per_column + way[0], a.depth + way[1]];
        let cradle = Self::Cradle { middle, radius: (way[0] * way[0] + way[1] * way[1]).sqrt(), per_column };
        // The middle of a cradle is on the side of the body.
        let is_cradle = area.abs() > 1e-6 && way[1] > 0.0;
        let shapes = [is_proper.then_some(board), (is_proper && is_cradle).then_some(cradle)];
        shapes.into_iter().flatten()
    }

    /// Returns the depth at a column; for columns beside a cradle that of its middle.
    fn at(&self, u: usize) -> f64 {
        let u = u as f64;
        match self {
            Self::Board([a, b, c]) => a + u * (b + u * c),
            Self::Cradle { middle, radius, per_column } => {
                let aside = u * per_column - middle[0];
                middle[1] - (radius * radius - aside * aside).max(0.0).sqrt()
            }
        }
    }

    /// Returns the depth up to which the table reaches at its sides: cradles are little more than halves of tubes.
    fn depth_of_wall(&self, u: usize) -> f64 {
        match self {
            Self::Board(_) => self.at(u),
            Self::Cradle { middle, radius, .. } => middle[1] + 0.25 * radius,
        }
    }

    /// Returns true if tables may be bent like this, in a grid of so many columns of `per_column` voxels of depth.
    fn is_likely(&self, columns: usize, per_column: f64) -> bool {
        let columns = columns as f64;
        let width = columns * per_column;
        match self {
            // At the ends of the grid a board is bent by a quarter of its width at most.
            Self::Board([.., bend]) => bend.abs() * columns * columns <= width,
            Self::Cradle { radius, .. } => *radius <= 2.0 * width,
        }
    }
}

/// Returns the shape at which most layers lie, and in front of which few do.
fn best_shape(ridges: &[Ridge], layers: &ThinLayers, misfit: f64) -> Option<TableShape> {
    let [width, _] = layers.size;
    let [mm_across, _, mm_down] = layers.spacing_mm;
    let per_column = layers.block[0] as f64 * mm_across / mm_down;
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
    let score = |shape: &TableShape| {
        let part = |ridge: &Ridge| {
            let before = ridge.depth - shape.at(ridge.u);
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
    let mut best: Option<(f64, TableShape)> = None;
    for (i, a) in tried.iter().enumerate() {
        for (j, b) in tried.iter().enumerate().skip(i + 1) {
            for c in &tried[j + 1..] {
                for shape in TableShape::through([*a, *b, *c], per_column)
                    .filter(|shape| shape.is_likely(width, per_column))
                {
                    let reached = score(&shape);
                    if best.is_none_or(|(most, _)| reached > most) {
                        best = Some((reached, shape));
                    }
                }
            }
        }
    }
    best.filter(|(score, _)| *score > 0.0).map(|(_, shape)| shape)
}
