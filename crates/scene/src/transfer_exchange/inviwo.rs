//! Import and export of Inviwo transfer functions (`.itf`, XML): points at fractions of the data range. Older files
//! have the position in an attribute `x`, newer ones in `content`.

use std::fmt::Write as _;

use roxmltree::Node;

use super::{ExchangeError, format_error, rgb_from_fractions};
use crate::{ControlPoint, TransferFunction};
use chiaroscuro_files::xml;
use chiaroscuro_volume::ValueRange;

/// Reads the points of either file version.
pub(crate) fn from_itf(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let document = xml::parse(text)?;
    let mut points = Vec::new();
    for point in document.descendants().filter(|node| node.tag_name().name().eq_ignore_ascii_case("point")) {
        let child = |name: &str| {
            let found = point.children().find(|node| node.has_tag_name(name));
            found.ok_or_else(|| format_error(&format!("a point has no {name}")))
        };
        let (pos, rgba) = (child("pos")?, child("rgba")?);
        let share = number_attribute(pos, "content").or_else(|_| number_attribute(pos, "x"))?;
        let color =
            [number_attribute(rgba, "x")?, number_attribute(rgba, "y")?, number_attribute(rgba, "z")?];
        let value = range.value_at(share);
        points.push(ControlPoint::new(
            value,
            rgb_from_fractions(&color),
            number_attribute(rgba, "w")?.clamp(0.0, 1.0),
        ));
    }
    if points.is_empty() {
        return Err(format_error("there are no points in the file"));
    }
    Ok(TransferFunction { points, ..TransferFunction::default() })
}

/// Writes the newer file version (3).
pub(crate) fn to_itf(function: &TransferFunction, range: ValueRange) -> String {
    let mut text =
        "<?xml version=\"1.0\" ?>\n<InviwoWorkspace version=\"3\">\n    <maskMin content=\"0\" />\n    \
                    <maskMax content=\"1\" />\n    <type content=\"0\" />\n    <Points>\n"
            .to_owned();
    for ControlPoint { value, color: [r, g, b], opacity, easing: _ } in &function.points {
        let share = range.share_of(*value);
        // Writing to a string cannot fail.
        writeln!(text, "        <Point>\n            <pos content=\"{share}\" />").ok();
        writeln!(
            text,
            "            <rgba x=\"{r}\" y=\"{g}\" z=\"{b}\" w=\"{opacity}\" />\n        </Point>"
        )
        .ok();
    }
    text.push_str("    </Points>\n</InviwoWorkspace>\n");
    text
}

/// Parses an XML attribute as a finite number.
pub(crate) fn number_attribute(node: Node<'_, '_>, attribute: &str) -> Result<f64, ExchangeError> {
    let found = node.attribute(attribute).and_then(|text| text.trim().parse().ok());
    let name = node.tag_name().name();
    found
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| format_error(&format!("{attribute} of <{name}> is not a number")))
}
