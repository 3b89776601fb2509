//! Panorama: radiance over all directions, in cells of latitude and longitude.

use std::f64::consts::PI;

use glam::DVec3;

/// Maximum number of columns of cells: the sun covers one and a half.
const MAX_COLUMNS: usize = 1024;

/// Maximum plausible radiance; more is an error in the picture: the sun is 2·10⁵ times as bright as the sky around
/// it.
const MAX_RADIANCE: f32 = 1e7;

/// Radiance over all directions; z is up, and x points to the middle of the picture.
#[derive(Debug, Clone)]
pub struct Panorama {
    /// Width and height of the picture, in pixels.
    size: [usize; 2],
    /// Number of columns and rows of cells.
    cells: [usize; 2],
    /// Sum of the pixels' linear RGB in each cell, and their number.
    sums: Vec<[f64; 4]>,
}

/// Cell of a panorama: a piece of the sphere.
#[derive(Debug, Clone, Copy)]
pub struct PanoramaCell {
    /// Unit vector towards the centre of the cell.
    pub towards: DVec3,
    /// Solid angle of the cell in steradians.
    pub solid_angle: f64,
    /// Mean radiance, linear RGB.
    pub radiance: [f64; 3],
}

impl Panorama {
    /// Creates a black panorama for a picture of the given size in pixels.
    pub fn new(size: [usize; 2]) -> Self {
        let columns = size[0].clamp(1, MAX_COLUMNS);
        let cells = [columns, size[1].clamp(1, MAX_COLUMNS / 2)];
        Self { size, cells, sums: vec![[0.0; 4]; cells[0] * cells[1]] }
    }

    /// Adds a pixel to its cell.
    pub fn add(&mut self, column: usize, row: usize, rgb: [f32; 3]) {
        let [columns, rows] = self.cells;
        let x = (column * columns / self.size[0]).min(columns - 1);
        let y = (row * rows / self.size[1]).min(rows - 1);
        let sum = &mut self.sums[x + columns * y];
        for (sum, value) in sum.iter_mut().zip(rgb) {
            // NaN and negative values count as black.
            *sum += f64::from(if value > 0.0 { value.min(MAX_RADIANCE) } else { 0.0 });
        }
        sum[3] += 1.0;
    }

    /// Iterates over all cells, row by row from the top.
    pub fn cells(&self) -> impl Iterator<Item = PanoramaCell> + '_ {
        (0..self.sums.len()).map(|at| self.cell(at))
    }

    /// Returns the cell at an index.
    pub fn cell(&self, at: usize) -> PanoramaCell {
        let [columns, rows] = self.cells;
        let (column, row) = (at % columns, at / columns);
        // Moving right from the middle is clockwise, seen from above.
        let azimuth = 2.0 * PI * (0.5 - (column as f64 + 0.5) / columns as f64);
        let latitude = |row: f64| PI * (0.5 - row / rows as f64);
        let (above, middle, below) = (row as f64, row as f64 + 0.5, row as f64 + 1.0);
        let (sin, cos) = latitude(middle).sin_cos();
        let [r, g, b, count] = self.sums[at];
        PanoramaCell {
            towards: DVec3::new(azimuth.cos() * cos, azimuth.sin() * cos, sin),
            solid_angle: 2.0 * PI / columns as f64 * (latitude(above).sin() - latitude(below).sin()),
            radiance: [r, g, b].map(|sum| sum / count.max(1.0)),
        }
    }

    /// Returns the indices of the neighbouring cells; columns wrap around from the left border to the right.
    pub fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.cells;
        let (column, row) = (at % columns, at / columns);
        let above = (row > 0).then(|| at - columns);
        let below = (row + 1 < rows).then(|| at + columns);
        let first = columns * row;
        let sides = [first + (column + columns - 1) % columns, first + (column + 1) % columns];
        sides.into_iter().chain(above).chain(below)
    }

    /// Overwrites the radiance of a cell.
    pub fn set(&mut self, at: usize, [r, g, b]: [f64; 3]) {
        self.sums[at] = [r, g, b, 1.0];
    }

    /// Creates a panorama from a function of the direction.
    #[cfg(test)]
    pub fn from_fn(size: [usize; 2], radiance: impl Fn(DVec3) -> [f64; 3]) -> Self {
        let mut panorama = Self::new(size);
        for at in 0..panorama.sums.len() {
            let towards = panorama.cell(at).towards;
            panorama.set(at, radiance(towards));
        }
        panorama
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cover_the_sphere_once() {
        let panorama = Panorama::new([64, 32]);
        let all: f64 = panorama.cells().map(|cell| cell.solid_angle).sum();
        assert!((all - 4.0 * PI).abs() < 1e-9);
        let middle = panorama.cell(64 * 16 + 32).towards;
        assert!(middle.dot(DVec3::X) > 0.99, "{middle}");
        assert!(panorama.cell(0).towards.z > 0.99);
        // A quarter turn to the right of the middle.
        assert!(panorama.cell(64 * 16 + 48).towards.dot(DVec3::NEG_Y) > 0.99);
        assert!(panorama.neighbours(64 * 3).any(|next| next == 64 * 3 + 63));
    }

    #[test]
    fn what_is_no_number_is_black() {
        let mut panorama = Panorama::new([4, 2]);
        panorama.add(0, 0, [f32::NAN, -3.0, f32::INFINITY]);
        assert_eq!(panorama.cell(0).radiance, [0.0, 0.0, f64::from(MAX_RADIANCE)]);
    }
}
