//! Import and export of 3D Slicer volume properties: `.vp`, lines of numbers, and `.vp.json` (schema 1.0.0). Values
//! are data values; opacities are per millimetre or per the unit distance that the file gives.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::{
    ExchangeError, ValueStop, format_error, merge_colors_and_opacities, number_list, rgb_from_fractions,
};
use crate::TransferFunction;
use chiaroscuro_volume::ValueRange;

/// Reads a `.vp` file: numbers of the shading, then opacities by value, opacities by gradient, and colours by value,
/// each list preceded by the count of its numbers.
pub(crate) fn from_vp(text: &str) -> Result<TransferFunction, ExchangeError> {
    let mut lists = Vec::new();
    for line in text.lines() {
        let numbers: Option<Vec<f64>> =
            line.split_whitespace().map(|word| word.parse().ok().filter(|n: &f64| n.is_finite())).collect();
        let numbers = numbers.ok_or_else(|| format_error("a line contains something other than numbers"))?;
        if numbers.len() > 1 {
            if numbers[0] != (numbers.len() - 1) as f64 {
                return Err(format_error("a list is not as long as its first number states"));
            }
            lists.push(numbers[1..].to_vec());
        }
    }
    let [opacities, _by_gradient, colors] = &lists[..] else {
        return Err(format_error(
            "a volume property must have three lists: opacities, opacities by gradient, and colours",
        ));
    };
    if opacities.is_empty() || opacities.len() % 2 != 0 || colors.is_empty() || colors.len() % 4 != 0 {
        return Err(format_error("a list of the volume property is cut off"));
    }
    let opacity = |at: &[f64]| ValueStop { value: at[0], content: at[1].clamp(0.0, 1.0) };
    let color = |at: &[f64]| ValueStop { value: at[0], content: rgb_from_fractions(&at[1..]) };
    let opacities = opacities.chunks_exact(2).map(opacity).collect();
    Ok(merge_colors_and_opacities(colors.chunks_exact(4).map(color).collect(), opacities))
}

/// Writes a `.vp` file, with the shading of Slicer's own presets for bone.
pub(crate) fn to_vp(function: &TransferFunction) -> String {
    let points = &function.points;
    // Linear interpolation, shaded; diffuse, ambient, specular, power.
    let mut text = "1\n1\n0.9\n0.1\n0.2\n10\n".to_owned();
    let mut list = |count: usize, numbers: &mut dyn Iterator<Item = f64>| {
        text.push_str(&count.to_string());
        for number in numbers {
            // Writing to a string cannot fail.
            write!(text, " {number}").ok();
        }
        text.push('\n');
    };
    list(2 * points.len(), &mut points.iter().flat_map(|point| [point.value, point.opacity]));
    // Gradient opacity of 1 everywhere.
    list(4, &mut [0.0, 1.0, 255.0, 1.0].into_iter());
    list(
        4 * points.len(),
        &mut points.iter().flat_map(|point| [point.value].into_iter().chain(point.color.map(f64::from))),
    );
    text
}

/// Reads the first component of the first volume property.
pub(crate) fn from_vp_json(tree: &Value) -> Result<TransferFunction, ExchangeError> {
    let part = tree.pointer("/volumeProperties/0/components/0");
    let part = part.ok_or_else(|| format_error("there is no component in the first volume property"))?;
    let list = |name: &str| {
        let points = part.pointer(&format!("/{name}/points")).and_then(Value::as_array);
        points
            .filter(|points| !points.is_empty())
            .ok_or_else(|| format_error(&format!("{name} has no points")))
    };
    let number = |point: &Value, key: &str| {
        let found = point.get(key).and_then(Value::as_f64).filter(|number| number.is_finite());
        found.ok_or_else(|| format_error(&format!("a point has no number {key}")))
    };
    let opacities: Result<Vec<_>, ExchangeError> = list("scalarOpacity")?
        .iter()
        .map(|point| {
            Ok(ValueStop { value: number(point, "x")?, content: number(point, "y")?.clamp(0.0, 1.0) })
        })
        .collect();
    let colors: Result<Vec<_>, ExchangeError> = list("rgbTransferFunction")?
        .iter()
        .map(|point| {
            let color = rgb_from_fractions(&number_list(point.get("color"), "color")?);
            Ok(ValueStop { value: number(point, "x")?, content: color })
        })
        .collect();
    Ok(merge_colors_and_opacities(colors?, opacities?))
}

/// Writes a volume property with one component, as `.vp.json`.
pub(crate) fn to_vp_json(function: &TransferFunction, range: ValueRange) -> String {
    let points = &function.points;
    let opacities: Vec<Value> = points
        .iter()
        .map(|point| json!({ "x": point.value, "y": point.opacity, "midpoint": 0.5, "sharpness": 0.0 }))
        .collect();
    let colors: Vec<Value> = points
        .iter()
        .map(|point| json!({ "x": point.value, "color": point.color, "midpoint": 0.5, "sharpness": 0.0 }))
        .collect();
    let tree = json!({
        "@schema": "https://raw.githubusercontent.com/slicer/slicer/main/Modules/Loadable/VolumeRendering/Resources/Schema/volume-property-schema-v1.0.0.json#",
        "volumeProperties": [{
            "effectiveRange": [range.low, range.high],
            "isoSurfaceValues": [],
            "interpolationType": "linear",
            "useClippedVoxelIntensity": false,
            "components": [{
                "componentWeight": 1.0,
                "shade": true,
                "lighting": { "diffuse": 0.9, "ambient": 0.1, "specular": 0.2, "specularPower": 10.0 },
                "disableGradientOpacity": true,
                "scalarOpacityUnitDistance": 1.0,
                "scalarOpacity": { "type": "piecewiseLinearFunction", "points": opacities },
                "rgbTransferFunction": { "type": "colorTransferFunction", "points": colors },
            }],
        }],
    });
    format!("{tree:#}\n")
}
