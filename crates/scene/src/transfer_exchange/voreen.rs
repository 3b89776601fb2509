//! Import of Voreen transfer functions (`.tfi`, XML): keys at fractions of a domain, with byte colours on the left
//! and on the right, which differ where the key is split.

use roxmltree::Node;

use super::inviwo::number_attribute;
use super::{ExchangeError, format_error, rgb_from_fractions};
use crate::{ControlPoint, TransferFunction};
use chiaroscuro_files::xml;
use chiaroscuro_volume::ValueRange;

/// Reads the keys between the thresholds.
pub(crate) fn from_tfi(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let document = xml::parse(text)?;
    let function = document.descendants().find(|node| node.tag_name().name().starts_with("TransFunc"));
    let function = function.ok_or_else(|| format_error("there is no TransFuncIntensity in the file"))?;
    let child = |parent: Node<'_, '_>, name: &str| {
        parent.children().find(|node| node.has_tag_name(name)).map(|node| node.id())
    };
    let pair = |name: &str| -> Option<ValueRange> {
        let node = document.get_node(child(function, name)?)?;
        ValueRange::non_degenerate(number_attribute(node, "x").ok()?, number_attribute(node, "y").ok()?)
    };
    // Without a domain the function refers to the range of the data; a domain of 0 … 1 means that as well.
    let domain = pair("domain").filter(|domain| *domain != ValueRange::UNIT).unwrap_or(range);
    let threshold = pair("threshold").unwrap_or(ValueRange::UNIT);
    let mut points = Vec::new();
    for key in function.descendants().filter(|node| node.has_tag_name("key")) {
        let part = |name: &str| {
            let node = child(key, name).and_then(|id| document.get_node(id));
            node.ok_or_else(|| format_error(&format!("a key has no {name}")))
        };
        let share = number_attribute(part("intensity")?, "value")?;
        let side = |name: &str| -> Result<ControlPoint, ExchangeError> {
            let node = part(name)?;
            let byte =
                |channel: &str| number_attribute(node, channel).map(|byte| (byte / 255.0).clamp(0.0, 1.0));
            let color = rgb_from_fractions(&[byte("r")?, byte("g")?, byte("b")?]);
            Ok(ControlPoint::new(domain.value_at(share), color, byte("a")?))
        };
        points.push(side("colorL")?);
        if part("split").is_ok_and(|node| node.attribute("value") == Some("true")) {
            points.push(side("colorR")?);
        }
    }
    if points.is_empty() {
        return Err(format_error("there are no keys in the file"));
    }
    let mut function = TransferFunction { points, ..TransferFunction::default() };
    function.sort();
    Ok(clip_to_thresholds(
        &function,
        ValueRange::new(domain.value_at(threshold.low), domain.value_at(threshold.high)),
    ))
}

/// Returns the function clipped to the values between two thresholds, with jumps to opacity 0 at both.
fn clip_to_thresholds(function: &TransferFunction, thresholds: ValueRange) -> TransferFunction {
    let ValueRange { low: from, high: to } = thresholds;
    let starts_outside = function.points.first().is_some_and(|first| first.value < from);
    let ends_outside = function.points.last().is_some_and(|last| last.value > to);
    let mut points: Vec<_> =
        function.points.iter().copied().filter(|point| thresholds.contains(point.value)).collect();
    if starts_outside {
        let point = function.point_at(from);
        points.splice(..0, [ControlPoint { opacity: 0.0, ..point }, point]);
    }
    if ends_outside {
        let point = function.point_at(to);
        points.extend([point, ControlPoint { opacity: 0.0, ..point }]);
    }
    TransferFunction { points, ..function.clone() }
}
