//! Thin layers of material that columns of voxels meet from outside, before they meet a body.

use rayon::prelude::*;

use super::TableOrientation;
use crate::volume::Volume;

/// Distances of columns across and along a table, in millimetres. Across, the largest values of all voxels between two
/// columns count, since sheets may be as thin as a voxel; along, a table hardly changes.
const BLOCK_MM: [f64; 2] = [2.0, 4.0];

/// Largest thickness of a layer of a table, in millimetres: shells have one or two, boards up to 30.
const MAX_LAYER_MM: f64 = 30.0;

/// Smallest gap between a layer and what lies in front of it, in millimetres; noise may bridge less.
const MIN_GAP_MM: f64 = 1.5;

/// Smallest extent of a grid across the table, in millimetres: that of a table and the head of a child.
const MIN_DEPTH_MM: f64 = 90.0;

/// Smallest number of columns across and along a table, without which no shape can be told from noise.
const MIN_COLUMNS: usize = 16;

/// Largest number of layers of a column.
const MAX_LAYERS: usize = 6;

/// Thin layers of a grid's columns.
pub(super) struct ThinLayers {
    /// Number of columns across and along the table.
    pub(super) size: [usize; 2],
    /// Number of voxels from a column to the next.
    pub(super) block: [usize; 2],
    /// Length of a voxel across, along and down, in millimetres.
    pub(super) spacing_mm: [f64; 3],
    /// Number of voxels of a column.
    pub(super) depth: usize,
    columns: Vec<Column>,
}

/// Layers of a column, as depths in voxels from the face beyond the table.
#[derive(Debug, Clone, Default)]
struct Column {
    /// First depth in front of each thin layer, in order.
    tops: Vec<f32>,
    /// First depth of thicker material, which ends the column.
    body: Option<f32>,
}

impl ThinLayers {
    /// Finds the layers of a volume whose material has at least the value `threshold`; `None` if it is too thin for a
    /// table and a body.
    pub(super) fn new(volume: &Volume, threshold: f64, orientation: TableOrientation) -> Option<Self> {
        let dims = volume.dims();
        let TableOrientation { down, across, along, .. } = orientation;
        let spacing = volume.spacing_mm();
        let block = [(across, BLOCK_MM[0]), (along, BLOCK_MM[1])]
            .map(|(axis, mm)| ((mm / spacing[axis]).round() as usize).clamp(1, dims[axis]));
        let size = [dims[across] / block[0], dims[along] / block[1]];
        let max_layer = MAX_LAYER_MM / spacing[down];
        let is_thin = dims[down] as f64 <= MIN_DEPTH_MM / spacing[down];
        let min_gap = (MIN_GAP_MM / spacing[down]).ceil() as usize;
        if is_thin || size.iter().any(|&count| count < MIN_COLUMNS) {
            return None;
        }
        let column = |at: usize| {
            let [u, v] = [at % size[0] * block[0], at / size[0] * block[1]];
            let is_material = |depth: usize| {
                let mut voxel = [0; 3];
                voxel[down] = orientation.index_at(depth, dims);
                voxel[along] = v;
                (u..u + block[0]).any(|u| {
                    voxel[across] = u;
                    volume.value(voxel[0], voxel[1], voxel[2]) >= threshold
                })
            };
            Column::new(dims[down], max_layer as usize, min_gap, is_material)
        };
        let columns = (0..size[0] * size[1]).into_par_iter().map(column).collect();
        let spacing_mm = [across, along, down].map(|axis| spacing[axis]);
        Some(Self { size, block, spacing_mm, depth: dims[down], columns })
    }

    /// Returns the depths in front of the thin layers of a column.
    pub(super) fn tops(&self, u: usize, v: usize) -> &[f32] {
        &self.columns[u + self.size[0] * v].tops
    }

    /// Returns the share of the columns with thicker material beyond a top, given by its depth at voxels across and
    /// along.
    pub(super) fn cut_share(&self, top: impl Fn(f64, f64) -> Option<f64>) -> f64 {
        let slack = MAX_LAYER_MM / self.spacing_mm[2];
        let is_cut = |at: usize| {
            let [u, v] = [at % self.size[0] * self.block[0], at / self.size[0] * self.block[1]];
            let Some(body) = self.columns[at].body else { return false };
            top(u as f64, v as f64).is_some_and(|top| f64::from(body) + slack < top)
        };
        (0..self.columns.len()).filter(|&at| is_cut(at)).count() as f64 / self.columns.len() as f64
    }
}

impl Column {
    fn new(depth: usize, max_layer: usize, min_gap: usize, is_material: impl Fn(usize) -> bool) -> Self {
        let mut column = Self::default();
        let mut first = None;
        let mut gap = 0;
        for at in 0..depth {
            if is_material(at) {
                let begin = *first.get_or_insert(at);
                gap = 0;
                if at - begin >= max_layer {
                    column.body = Some(begin as f32);
                    break;
                }
            } else if first.is_some() {
                gap += 1;
                if gap >= min_gap {
                    first = None;
                    column.tops.push((at + 1 - gap) as f32);
                    if column.tops.len() == MAX_LAYERS {
                        break;
                    }
                }
            }
        }
        column
    }
}
