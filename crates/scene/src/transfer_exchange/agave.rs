//! Import of AGAVE settings (JSON): the first enabled channel. Its curve is laid over the range of the volume in one
//! of AGAVE's modes: window and level, an isovalue with a width, control points, or the ends of the range.

use serde_json::Value;

use super::{ExchangeError, format_error, number_list, rgb_from_fractions};
use crate::{ControlPoint, Easing, TransferFunction};
use chiaroscuro_volume::ValueRange;

/// Reads the opacity curve and the colour of a channel.
pub(crate) fn from_agave(tree: &Value, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let channels = tree.get("channels").and_then(Value::as_array);
    let channels =
        channels.filter(|all| !all.is_empty()).ok_or_else(|| format_error("there are no channels"))?;
    let is_on = |channel: &&Value| channel.get("enabled").and_then(Value::as_bool).unwrap_or(true);
    let channel = channels.iter().find(is_on).unwrap_or(&channels[0]);
    let of = |key: &str| channel.get(key).and_then(Value::as_f64).filter(|n| n.is_finite());
    let opacity = of("opacity").unwrap_or(1.0).clamp(0.0, 1.0);
    let color = match channel.get("diffuseColor") {
        Some(list) => rgb_from_fractions(&number_list(Some(list), "diffuseColor")?),
        None => [1.0; 3],
    };
    let curve = channel.get("lutParams").ok_or_else(|| format_error("the channel has no lutParams"))?;
    let curve_number = |key: &str| {
        let found = curve.get(key).and_then(Value::as_f64).filter(|n| n.is_finite());
        found.ok_or_else(|| format_error(&format!("lutParams has no number {key}")))
    };
    let point = |at: f64, a: f64| ControlPoint::new(range.value_at(at), color, a * opacity);
    let points = match curve.get("mode").and_then(Value::as_u64) {
        Some(0) => {
            let (level, half) = (curve_number("level")?, curve_number("window")?.abs().max(1e-6) / 2.0);
            vec![point(level - half, 0.0), point(level + half, 1.0)]
        }
        Some(1) => {
            let (value, half) = (curve_number("isovalue")?, curve_number("isorange")?.abs().max(1e-6) / 2.0);
            let step = |at: f64, a: f64| ControlPoint { easing: Easing::Step, ..point(at, a) };
            // Opacity is 0 on either side.
            vec![point(value - half, 0.0), step(value - half, 1.0), step(value + half, 0.0)]
        }
        Some(3) => control_points(curve, &point)?,
        // Percentiles and ends of the range: *Fit* finds their values in this volume.
        _ => vec![point(0.0, 0.0), point(1.0, 1.0)],
    };
    Ok(TransferFunction { points, ..TransferFunction::default() })
}

/// Reads control points of red, green, blue and opacity, of which only the opacity is used.
fn control_points(
    curve: &Value,
    point: &dyn Fn(f64, f64) -> ControlPoint,
) -> Result<Vec<ControlPoint>, ExchangeError> {
    let list = curve.get("controlPoints").and_then(Value::as_array);
    let list =
        list.filter(|list| !list.is_empty()).ok_or_else(|| format_error("there are no controlPoints"))?;
    list.iter()
        .map(|at| {
            let place = at.get("x").and_then(Value::as_f64).filter(|n| n.is_finite());
            let place = place.ok_or_else(|| format_error("a control point has no number x"))?;
            let rgba = number_list(at.get("value"), "value")?;
            let [_, _, _, alpha] = rgba[..] else {
                return Err(format_error("a value must have four numbers"));
            };
            Ok(point(place, alpha.clamp(0.0, 1.0)))
        })
        .collect()
}
