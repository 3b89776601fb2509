//! Slices of light volumes, and their export in false colours as PNG.

use std::path::Path;

use crate::resources::textures::AttenuationData;
use chiaroscuro_files::{check_extension, write_atomically};
use chiaroscuro_media::{ExportError, encode_png};
use chiaroscuro_scene::srgb_from_linear;
use chiaroscuro_volume::math::false_color;

/// Axis-aligned slice of a light volume.
#[derive(Debug, Clone, PartialEq)]
pub struct AttenuationSlice {
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// Attenuation from 0 (fully shadowed) to 1 (fully lit), row by row; the last rows of the grid come first, so
    /// that up is up.
    pub values: Vec<f32>,
    /// Attenuation of red, green and blue light where shadows are coloured; else empty.
    pub rgb: Vec<[f32; 3]>,
}

impl AttenuationData {
    /// Returns the slice `index` across an axis (0 for x): the other two axes run to the right and up. `None` beyond
    /// the grid.
    pub fn slice(&self, axis: usize, index: usize) -> Option<AttenuationSlice> {
        if index >= *self.dims.get(axis)? {
            return None;
        }
        let [right, up] = [[1, 2], [0, 2], [0, 1]][axis];
        let strides = [1, self.dims[0], self.dims[0] * self.dims[1]];
        let size = [self.dims[right], self.dims[up]];
        let row = |v: usize| {
            let start = index * strides[axis] + v * strides[up];
            (0..size[0]).map(move |u| start + u * strides[right])
        };
        let voxels = || (0..size[1]).rev().flat_map(row);
        let values = voxels().map(|at| self.values[at]).collect();
        let rgb = voxels().filter_map(|at| self.colors.get(at).copied()).collect();
        Some(AttenuationSlice { size, values, rgb })
    }
}

impl AttenuationSlice {
    /// Returns sRGB bytes, three per value: false colours, or the colour of white light behind coloured shadows.
    pub fn colors(&self) -> Vec<u8> {
        if self.rgb.is_empty() {
            return self.values.iter().flat_map(|&value| false_color(value)).collect();
        }
        let byte = |linear: f32| (255.0 * srgb_from_linear(f64::from(linear)).clamp(0.0, 1.0)).round() as u8;
        self.rgb.iter().flat_map(|color| color.map(byte)).collect()
    }
}

/// Writes a slice as a PNG file.
///
/// # Errors
/// Returns an error if the name has another ending than `.png`, or as [`write_atomically`].
pub fn export_slice(slice: &AttenuationSlice, path: &Path) -> Result<(), ExportError> {
    let png = encode_png(slice.size.map(|n| n as u32), png::ColorType::Rgb, &slice.colors(), None)?;
    check_extension(path, &["png"], "slices of light volumes are written as .png")?;
    Ok(write_atomically(path, &png)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_cut_across_any_axis_and_stand_upright() {
        let attenuation = AttenuationData {
            dims: [2, 3, 4],
            divisor: 1,
            values: (0..24).map(|i| i as f32).collect(),
            colors: Vec::new(),
        };
        let at = |x: usize, y: usize, z: usize| (x + 2 * (y + 3 * z)) as f32;
        let z = attenuation.slice(2, 1).unwrap();
        assert_eq!((z.size, z.values[0], z.values[5]), ([2, 3], at(0, 2, 1), at(1, 0, 1)));
        let x = attenuation.slice(0, 1).unwrap();
        assert_eq!((x.size, x.values[0], x.values[11]), ([3, 4], at(1, 0, 3), at(1, 2, 0)));
        let y = attenuation.slice(1, 2).unwrap();
        assert_eq!((y.size, y.values[1]), ([2, 4], at(1, 2, 3)));
        assert_eq!((attenuation.slice(2, 4), attenuation.slice(3, 0)), (None, None));
    }

    #[test]
    fn slices_of_coloured_light_have_its_colours() {
        let colors = vec![[1.0, 0.0, 0.5], [0.0; 3]];
        let attenuation = AttenuationData { dims: [2, 1, 1], divisor: 1, values: vec![0.25, 0.0], colors };
        let slice = attenuation.slice(2, 0).unwrap();
        assert_eq!(slice.colors(), [255, 0, 188, 0, 0, 0]);
    }
}
