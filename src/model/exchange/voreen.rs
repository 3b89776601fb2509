//! Import of Voreen transfer functions (`.tfi`, XML): keys at fractions of a domain, with byte colours on the left
//! and on the right, which differ where the key is split.

use roxmltree::Node;

use super::inviwo::number;
use super::{ExchangeError, form, rgb};
use crate::data::{ValueRange, xml};
use crate::model::{ControlPoint, TransferFunction};

/// Reads the keys between the thresholds.
pub(crate) fn from_tfi(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let document = xml::parse(text)?;
    let function = document.descendants().find(|node| node.tag_name().name().starts_with("TransFunc"));
    let function = function.ok_or_else(|| form("there is no TransFuncIntensity in the file"))?;
    let child = |parent: Node<'_, '_>, name: &str| {
        parent.children().find(|node| node.has_tag_name(name)).map(|node| node.id())
    };
    let pair = |name: &str| -> Option<ValueRange> {
        let node = document.get_node(child(function, name)?)?;
        ValueRange::spread(number(node, "x").ok()?, number(node, "y").ok()?)
    };
    // Without a domain the function refers to the range of the data; a domain of 0 … 1 means that as well.
    let domain = pair("domain").filter(|domain| *domain != ValueRange::UNIT).unwrap_or(range);
    let threshold = pair("threshold").unwrap_or(ValueRange::UNIT);
    let mut points = Vec::new();
    for key in function.descendants().filter(|node| node.has_tag_name("key")) {
        let part = |name: &str| {
            let node = child(key, name).and_then(|id| document.get_node(id));
            node.ok_or_else(|| form(&format!("a key has no {name}")))
        };
        let share = number(part("intensity")?, "value")?;
        let side = |name: &str| -> Result<ControlPoint, ExchangeError> {
            let node = part(name)?;
            let byte = |channel: &str| number(node, channel).map(|byte| (byte / 255.0).clamp(0.0, 1.0));
            let color = rgb(&[byte("r")?, byte("g")?, byte("b")?]);
            Ok(ControlPoint::new(domain.at(share), color, byte("a")?))
        };
        points.push(side("colorL")?);
        if part("split").is_ok_and(|node| node.attribute("value") == Some("true")) {
            points.push(side("colorR")?);
        }
    }
    if points.is_empty() {
        return Err(form("there are no keys in the file"));
    }
    let mut function = TransferFunction { points, ..TransferFunction::default() };
    function.sort();
    Ok(between(&function, ValueRange::new(domain.at(threshold.low), domain.at(threshold.high))))
}

/// Returns the function clipped to the values between two thresholds, with jumps to opacity 0 at both.
fn between(function: &TransferFunction, kept: ValueRange) -> TransferFunction {
    let ValueRange { low: from, high: to } = kept;
    let begins = function.points.first().is_some_and(|first| first.value < from);
    let goes_on = function.points.last().is_some_and(|last| last.value > to);
    let mut points: Vec<_> =
        function.points.iter().copied().filter(|point| kept.contains(point.value)).collect();
    if begins {
        let point = function.point_at(from);
        points.splice(..0, [ControlPoint { opacity: 0.0, ..point }, point]);
    }
    if goes_on {
        let point = function.point_at(to);
        points.extend([point, ControlPoint { opacity: 0.0, ..point }]);
    }
    TransferFunction { points, ..function.clone() }
}
