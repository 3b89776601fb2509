//! Oklab colour space: lightness, green to red, and blue to yellow (Ottosson 2020, the matrices of 2021-01-25). Equal
//! steps look equally large, so that interpolation keeps lightness even and mixtures saturated.

use crate::srgb_from_linear;

/// Converts linear RGB to Oklab: lightness (0 … 1), green to red, blue to yellow.
pub fn oklab_from_linear(rgb: [f64; 3]) -> [f64; 3] {
    let cones = product(&CONES_FROM_RGB, rgb).map(f64::cbrt);
    product(&LAB_FROM_CONES, cones)
}

/// Converts Oklab to linear RGB; colours outside the gamut are clipped to 0 and 1.
pub fn linear_from_oklab(lab: [f64; 3]) -> [f64; 3] {
    let cones = product(&CONES_FROM_LAB, lab).map(|root| root * root * root);
    product(&RGB_FROM_CONES, cones).map(|c| c.clamp(0.0, 1.0))
}

/// Converts Oklab to lightness, chroma and hue in degrees (0 … 360; 0 for greys).
pub fn lch_from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let chroma = (a * a + b * b).sqrt();
    // Rounding gives greys a chroma of 1e-8, and any hue.
    let hue = if chroma < 1e-6 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
    [l, chroma, hue]
}

/// Converts lightness, chroma and hue in degrees to Oklab.
pub fn lab_from_lch([l, chroma, hue_deg]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = hue_deg.to_radians().sin_cos();
    [l, chroma * cos, chroma * sin]
}

/// Converts lightness, chroma and hue in degrees to sRGB, as control points store it; clipped to the gamut.
pub fn srgb_from_lch(lch: [f64; 3]) -> [f32; 3] {
    linear_from_oklab(lab_from_lch(lch)).map(|c| srgb_from_linear(c).clamp(0.0, 1.0) as f32)
}

fn product(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

const CONES_FROM_RGB: [[f64; 3]; 3] = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
];

const LAB_FROM_CONES: [[f64; 3]; 3] = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
];

const CONES_FROM_LAB: [[f64; 3]; 3] = [
    [1.0, 0.3963377774, 0.2158037573],
    [1.0, -0.1055613458, -0.0638541728],
    [1.0, -0.0894841775, -1.2914855480],
];

const RGB_FROM_CONES: [[f64; 3]; 3] = [
    [4.0767416621, -3.3077115913, 0.2309699292],
    [-1.2684380046, 2.6097574011, -0.3413193965],
    [-0.0041960863, -0.7034186147, 1.7076147010],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_come_back() {
        for r in 0..=4 {
            for g in 0..=4 {
                for b in 0..=4 {
                    let rgb = [r, g, b].map(|c| f64::from(c) / 4.0);
                    let lab = oklab_from_linear(rgb);
                    let back = linear_from_oklab(lab_from_lch(lch_from_lab(lab)));
                    assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-6), "{rgb:?} {back:?}");
                }
            }
        }
    }

    #[test]
    fn known_colors_are_where_the_definition_puts_them() {
        let near =
            |found: [f64; 3], wanted: [f64; 3]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(near(oklab_from_linear([1.0; 3]), [1.0, 0.0, 0.0]));
        assert!(near(oklab_from_linear([1.0, 0.0, 0.0]), [0.628, 0.2249, 0.1258]));
        let [_, _, hue] = lch_from_lab(oklab_from_linear([0.0, 0.0, 1.0]));
        assert!((hue - 264.05).abs() < 0.1, "{hue}");
        assert_eq!(lch_from_lab(oklab_from_linear([0.5; 3]))[2], 0.0, "greys have no hue");
    }
}
