//! Transfer functions in the files of other programs: ParaView's colour maps (JSON).
//!
//! A file holds `RGBPoints` (value, red, green, blue …) and `Points` (value, opacity, midpoint, sharpness …).
//! ParaView's opacities refer to a unit distance of the data, as ours do to the opacity unit.

use serde_json::{Value, json};

use super::{ControlPoint, TransferFunction};

/// Why a file is no transfer function.
#[derive(Debug, thiserror::Error)]
pub enum ExchangeError {
    /// Not JSON.
    #[error("not valid JSON: {0}")]
    Syntax(#[from] serde_json::Error),
    /// Something else than it should be.
    #[error(
        "{0}; a file that ParaView (.json), Slicer (.vp), MRIcroGL (.clut) or ImageJ (.lut) has written helps"
    )]
    Form(String),
}

/// Reads the first colour map of a ParaView file.
///
/// # Errors
/// When the text is no such file.
pub fn from_paraview(text: &str) -> Result<TransferFunction, ExchangeError> {
    let tree: Value = serde_json::from_str(text)?;
    let map = tree.as_array().map_or(Some(&tree), |maps| maps.first());
    let map = map.and_then(Value::as_object).ok_or_else(|| form("there is no colour map in the file"))?;
    let colors = numbers(map.get("RGBPoints"), "RGBPoints")?;
    if colors.len() < 4 || !colors.len().is_multiple_of(4) {
        return Err(form("RGBPoints does not hold a value and three colours for each point"));
    }
    let colors: Vec<(f64, [f32; 3])> = colors
        .chunks_exact(4)
        .map(|at| (at[0], [at[1], at[2], at[3]].map(|c| c.clamp(0.0, 1.0) as f32)))
        .collect();
    let opacities = match map.get("Points").filter(|points| !points.is_null()) {
        Some(points) => {
            let points = numbers(Some(points), "Points")?;
            if points.is_empty() || !points.len().is_multiple_of(4) {
                return Err(form("Points does not hold four numbers for each point"));
            }
            points.chunks_exact(4).map(|at| (at[0], at[1].clamp(0.0, 1.0))).collect()
        }
        // A map of colours alone: a ramp.
        None => vec![(colors[0].0, 0.0), (colors[colors.len() - 1].0, 1.0)],
    };
    Ok(merged(colors, opacities))
}

/// A transfer function from colours and opacities at different values; neither list is empty.
pub(super) fn merged(mut colors: Vec<(f64, [f32; 3])>, mut opacities: Vec<(f64, f64)>) -> TransferFunction {
    colors.sort_by(|a, b| a.0.total_cmp(&b.0));
    opacities.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut values: Vec<f64> =
        colors.iter().map(|at| at.0).chain(opacities.iter().map(|at: &(f64, f64)| at.0)).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let points = values
        .into_iter()
        .map(|value| {
            let color = between(&colors, value, |a, b, t| {
                std::array::from_fn(|c| mix(f64::from(a[c]), f64::from(b[c]), t) as f32)
            });
            ControlPoint { value, color, opacity: between(&opacities, value, |a, b, t| mix(*a, *b, t)) }
        })
        .collect();
    let mut function = TransferFunction { points, ..TransferFunction::default() };
    function.sort();
    function
}

/// A transfer function as ParaView reads it.
pub fn to_paraview(function: &TransferFunction, name: &str) -> String {
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

pub(super) fn form(what: &str) -> ExchangeError {
    ExchangeError::Form(what.to_owned())
}

fn numbers(list: Option<&Value>, name: &str) -> Result<Vec<f64>, ExchangeError> {
    let list = list.and_then(Value::as_array).ok_or_else(|| form(&format!("there is no list {name}")))?;
    let number = |value: &Value| value.as_f64().filter(|number| number.is_finite());
    let found: Option<Vec<f64>> = list.iter().map(number).collect();
    found.ok_or_else(|| form(&format!("{name} holds something that is no number")))
}

/// What stands at a value between the points of a list in ascending order.
fn between<T: Copy>(points: &[(f64, T)], value: f64, mix: impl Fn(&T, &T, f64) -> T) -> T {
    let upper = points.partition_point(|point| point.0 <= value);
    match (upper.checked_sub(1).map(|at| points[at]), points.get(upper)) {
        (Some((low, a)), Some((high, b))) => mix(&a, b, (value - low) / (high - low)),
        (Some((_, a)), None) => a,
        (None, Some((_, b))) => *b,
        (None, None) => points[0].1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Preset, Settings};

    #[test]
    fn what_is_written_is_read_back() {
        for name in ["ct/bone", "mr/head", "simulation/signed"] {
            let preset = Preset::find(name).unwrap();
            let before = preset.apply(&Settings::default(), (0.0, 1.0)).unwrap().transfer;
            let after = from_paraview(&to_paraview(&before, "a map")).unwrap();
            assert_eq!(after.points.len(), before.points.len());
            for (a, b) in after.points.iter().zip(&before.points) {
                assert!((a.value - b.value).abs() < 1e-12 && (a.opacity - b.opacity).abs() < 1e-12);
                assert!(a.color.iter().zip(&b.color).all(|(a, b)| (a - b).abs() < 1e-6), "{name}");
            }
        }
    }

    #[test]
    fn colors_and_opacities_may_stand_at_different_values() {
        let text = r#"[{"Name": "x", "ColorSpace": "Diverging",
            "RGBPoints": [0, 0.0, 0.0, 1.0, 10, 1.0, 0.0, 0.0],
            "Points": [0, 0.0, 0.5, 0.0, 5, 0.8, 0.5, 0.0, 10, 0.2, 0.5, 0.0]}]"#;
        let function = from_paraview(text).unwrap();
        let middle = function.points[1];
        assert_eq!((middle.value, middle.opacity, middle.color), (5.0, 0.8, [0.5, 0.0, 0.5]));
        let colors = from_paraview(r#"{"RGBPoints": [2, 0, 0, 0, 4, 1, 1, 1]}"#).unwrap();
        assert_eq!((colors.points[0].opacity, colors.points[1].opacity), (0.0, 1.0));
    }

    #[test]
    fn other_files_are_refused_in_words() {
        for (text, what) in [
            ("{", "JSON"),
            ("[]", "no colour map"),
            (r#"{"points": 3}"#, "RGBPoints"),
            (r#"{"RGBPoints": [1, 2, 3]}"#, "three colours"),
            (r#"{"RGBPoints": [1, "a", 3, 4]}"#, "no number"),
            (r#"{"RGBPoints": [1, 0, 0, 0], "Points": [1]}"#, "four numbers"),
        ] {
            let err = from_paraview(text).unwrap_err().to_string();
            assert!(err.contains(what), "{text}: {err}");
        }
    }
}
