//! Units of length by their names in the software of microscopes.

/// Length of an inch in millimetres, the unit of the resolution of prints and screens.
pub(crate) const INCH_MM: f64 = 25.4;

/// Length of a unit in millimetres; `None` for any other text.
pub(crate) fn millimetres(unit: &str) -> Option<f64> {
    // The micro sign is also written as the Greek letter, and as an escape of Java.
    let unit = unit.trim().replace("\\u00B5", "µ").replace("\\u00b5", "µ").replace('μ', "µ");
    Some(match unit.as_str() {
        "m" | "meter" | "meters" | "metre" => 1e3,
        "cm" | "centimeter" | "centimeters" => 10.0,
        "mm" | "millimeter" | "millimeters" | "millimetre" => 1.0,
        "µm" | "um" | "µ" | "micron" | "microns" | "micrometer" | "micrometers" | "micrometre" => 1e-3,
        "nm" | "nanometer" | "nanometers" | "nanometre" => 1e-6,
        "pm" | "picometer" => 1e-9,
        // Also as the angstrom sign, which is a character of its own.
        "Å" | "\u{212b}" | "A" | "angstrom" | "Angstrom" => 1e-7,
        "in" | "inch" | "inches" => INCH_MM,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_length_are_known() {
        for (unit, length) in
            [("micron", 1e-3), ("\\u00B5m", 1e-3), ("µm", 1e-3), ("μm", 1e-3), (" nm ", 1e-6), ("inch", 25.4)]
        {
            assert_eq!(millimetres(unit), Some(length), "{unit}");
        }
        for unit in ["", "pixel", "pixels", "s", "reference frame"] {
            assert_eq!(millimetres(unit), None, "{unit}");
        }
    }
}
