//! Mosaics: the slices of a volume side by side in one picture, as Siemens scanners write them.

use super::header::Header;
use super::layer::Slice;
use super::pixels::shape::Shape;

/// Most slices of a mosaic: they are as many as the scans of the finest have, by far.
const MOST_TILES: f64 = 4096.0;

/// How slices lie in a picture: row after row, in a square that has room for all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mosaic {
    count: usize,
    /// Slices in a row, and in a column.
    across: usize,
    /// Pixels of a slice.
    columns: usize,
    rows: usize,
    /// Slices go to where the picture's own normal comes from.
    is_backwards: bool,
}

/// Whether a picture is a mosaic, as its image type says.
pub(crate) fn is_mosaic(header: &Header) -> bool {
    header.found.image_type.contains("MOSAIC") && header.frame_count() == 1
}

impl Mosaic {
    /// How slices lie in a file's picture; `None` where it is no mosaic, or does not say how many slices it has.
    pub(crate) fn new(header: &Header) -> Option<Self> {
        let found = &header.found;
        let count = found.mosaic_count.filter(|count| (1.0..=MOST_TILES).contains(count))?;
        let across = count.sqrt().ceil() as usize;
        let (columns, rows) = (usize::from(found.columns?), usize::from(found.rows?));
        if !is_mosaic(header) || columns == 0 || columns % across != 0 || rows % across != 0 {
            return None;
        }
        let own = found.plane(0).normal();
        let is_backwards = own.zip(found.mosaic_normal).is_some_and(|(own, said)| own.dot(said) < 0.0);
        let (columns, rows) = (columns / across, rows / across);
        Some(Self { count: count as usize, across, columns, rows, is_backwards })
    }

    /// How the pixels of a slice are stored in a picture of this shape.
    pub(crate) fn tile_shape(&self, shape: Shape) -> Shape {
        Shape { columns: self.columns, rows: self.rows, ..shape }
    }

    /// The slices of a picture. Its position is that of a picture as large as the mosaic around the first slice's middle
    /// (after `dcm2niix` and SPM, which found that out).
    pub(crate) fn tiles(&self, picture: &Slice) -> Vec<Slice> {
        let plane = &picture.plane;
        let across_mm = plane.between.or(plane.thickness).unwrap_or(0.0).abs();
        let across_mm = if self.is_backwards { -across_mm } else { across_mm };
        let middle = |pixels: usize| pixels as f64 * (self.across - 1) as f64 / 2.0;
        let tile = |tile: usize| {
            let mut slice = Slice { tile: Some(tile), ..*picture };
            slice.plane.position = plane.position.map(|position| {
                let (Some([along_row, along_column]), Some([between_rows, between_columns]), Some(normal)) =
                    (plane.orientation, plane.spacing, plane.normal())
                else {
                    return position;
                };
                position
                    + along_row * (between_columns.abs() * middle(self.columns))
                    + along_column * (between_rows.abs() * middle(self.rows))
                    + normal * (across_mm * tile as f64)
            });
            slice
        };
        (0..self.count).map(tile).collect()
    }

    /// Takes a slice out of the whole picture.
    pub(crate) fn pick<T: Copy>(&self, tile: usize, picture: &[T], voxels: &mut [T]) {
        let width = self.columns * self.across;
        let first = tile / self.across * self.rows * width + tile % self.across * self.columns;
        for (row, voxels) in voxels.chunks_exact_mut(self.columns).enumerate() {
            voxels.copy_from_slice(&picture[first + row * width..][..self.columns]);
        }
    }
}
