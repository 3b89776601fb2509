//! Import and export of ParaView colour maps (JSON): `RGBPoints` (value, red, green, blue …) and `Points` (value,
//! opacity, midpoint, sharpness …). Opacities refer to ParaView's unit distance, as Chiaroscuro's do to the opacity
//! unit.

use serde_json::{Value, json};

use super::{
    ExchangeError, ValueStop, format_error, merge_colors_and_opacities, number_list, rgb_from_fractions,
};
use crate::TransferFunction;

/// Reads the first colour map of a file.
pub(crate) fn from_paraview(tree: &Value) -> Result<TransferFunction, ExchangeError> {
    let map = tree.as_array().map_or(Some(tree), |maps| maps.first());
    let map =
        map.and_then(Value::as_object).ok_or_else(|| format_error("there is no colour map in the file"))?;
    let colors = number_list(map.get("RGBPoints"), "RGBPoints")?;
    if colors.len() < 4 || !colors.len().is_multiple_of(4) {
        return Err(format_error("RGBPoints must hold a value, red, green and blue for each point"));
    }
    let color = |at: &[f64]| ValueStop { value: at[0], content: rgb_from_fractions(&at[1..]) };
    let opacity = |value, content| ValueStop { value, content };
    let colors: Vec<_> = colors.chunks_exact(4).map(color).collect();
    let opacities = match map.get("Points").filter(|points| !points.is_null()) {
        Some(points) => {
            let points = number_list(Some(points), "Points")?;
            if points.is_empty() || !points.len().is_multiple_of(4) {
                return Err(format_error("Points must hold four numbers for each point"));
            }
            points.chunks_exact(4).map(|at| opacity(at[0], at[1].clamp(0.0, 1.0))).collect()
        }
        // A map of colours alone gets a linear opacity ramp.
        None => vec![opacity(colors[0].value, 0.0), opacity(colors[colors.len() - 1].value, 1.0)],
    };
    Ok(merge_colors_and_opacities(colors, opacities))
}

/// Writes a transfer function as a ParaView colour map.
pub(crate) fn to_paraview(function: &TransferFunction, name: &str) -> String {
    let colors: Vec<f64> = function
        .points
        .iter()
        .flat_map(|point| [point.value].into_iter().chain(point.color.map(f64::from)))
        .collect();
    let opacities: Vec<f64> =
        function.points.iter().flat_map(|point| [point.value, point.opacity, 0.5, 0.0]).collect();
    let map = json!([{
        "ColorSpace": "RGB",
        "Name": name,
        "Points": opacities,
        "RGBPoints": colors,
    }]);
    format!("{map:#}\n")
}
