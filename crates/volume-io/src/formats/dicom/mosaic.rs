//! Mosaics: the slices of a volume as tiles of one image, as Siemens scanners write them.

use super::header::DicomHeader;
use super::pixels::layout::PixelLayout;
use super::slice_layer::DicomSlice;

/// Maximum number of tiles: far more than the finest scans have slices.
const MAX_TILES: f64 = 4096.0;

/// Layout of a mosaic: tiles in rows, in the smallest square that holds them all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mosaic {
    count: usize,
    /// Number of tiles in a row, and in a column.
    tiles_per_row: usize,
    /// Size of a tile in pixels.
    columns: usize,
    rows: usize,
    /// True if the slices advance against the normal of the image plane.
    is_reversed: bool,
}

/// True if the image type marks the file as a mosaic.
pub(crate) fn is_mosaic(header: &DicomHeader) -> bool {
    header.values.image_type.contains("MOSAIC") && header.frame_count() == 1
}

impl Mosaic {
    /// Returns the layout of a file's mosaic; `None` for other images, and if the number of slices is not stated.
    pub(crate) fn new(header: &DicomHeader) -> Option<Self> {
        let found = &header.values;
        let count = found.mosaic_count.filter(|count| (1.0..=MAX_TILES).contains(count))?;
        let across = count.sqrt().ceil() as usize;
        let (columns, rows) = (usize::from(found.columns?), usize::from(found.rows?));
        if !is_mosaic(header) || columns == 0 || columns % across != 0 || rows % across != 0 {
            return None;
        }
        let image_normal = found.plane(0).normal();
        let is_backwards =
            image_normal.zip(found.mosaic_normal).is_some_and(|(own, said)| own.dot(said) < 0.0);
        let (columns, rows) = (columns / across, rows / across);
        Some(Self { count: count as usize, tiles_per_row: across, columns, rows, is_reversed: is_backwards })
    }

    /// Returns the pixel layout of a tile, given that of the whole image.
    pub(crate) fn tile_shape(&self, shape: PixelLayout) -> PixelLayout {
        PixelLayout { columns: self.columns, rows: self.rows, ..shape }
    }

    /// Returns the slices of a mosaic. Its stated position is the corner of an image as large as the mosaic, centred
    /// on the first slice (after `dcm2niix` and SPM, which found that out).
    pub(crate) fn tiles(&self, picture: &DicomSlice) -> Vec<DicomSlice> {
        let plane = &picture.plane;
        let across_mm = plane.slice_spacing_mm.or(plane.thickness_mm).unwrap_or(0.0).abs();
        let across_mm = if self.is_reversed { -across_mm } else { across_mm };
        let corner_offset = |pixels: usize| pixels as f64 * (self.tiles_per_row - 1) as f64 / 2.0;
        let tile = |tile: usize| {
            let mut slice = DicomSlice { tile: Some(tile), ..*picture };
            slice.plane.position = plane.position.map(|position| {
                let (Some([along_row, along_column]), Some([between_rows, between_columns]), Some(normal)) =
                    (plane.orientation, plane.spacing, plane.normal())
                else {
                    return position;
                };
                position
                    + along_row * (between_columns.abs() * corner_offset(self.columns))
                    + along_column * (between_rows.abs() * corner_offset(self.rows))
                    + normal * (across_mm * tile as f64)
            });
            slice
        };
        (0..self.count).map(tile).collect()
    }

    /// Copies a tile out of the whole image.
    pub(crate) fn copy_tile<T: Copy>(&self, tile: usize, picture: &[T], voxels: &mut [T]) {
        let width = self.columns * self.tiles_per_row;
        let first = tile / self.tiles_per_row * self.rows * width + tile % self.tiles_per_row * self.columns;
        for (row, voxels) in voxels.chunks_exact_mut(self.columns).enumerate() {
            voxels.copy_from_slice(&picture[first + row * width..][..self.columns]);
        }
    }
}
