//! Axes of an image: their roles and units.

use serde_json::Value;

use crate::length_unit::millimetres;

/// Role of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AxisRole {
    X,
    Y,
    Z,
    Channel,
    Time,
    /// Any other axis.
    Other,
}

impl AxisRole {
    /// Roles of the spatial axes.
    pub(crate) const SPACE: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Role of an axis of a name, as microscopes and climate models name them.
    fn from_name(name: &str) -> Self {
        match name.trim().to_lowercase().as_str() {
            "x" | "lon" | "longitude" | "easting" => Self::X,
            "y" | "lat" | "latitude" | "northing" => Self::Y,
            "z" | "depth" | "lev" | "level" | "altitude" | "height" => Self::Z,
            "c" | "channel" | "ch" => Self::Channel,
            "t" | "time" => Self::Time,
            _ => Self::Other,
        }
    }
}

/// Axis of an image.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ImageAxis {
    pub(crate) role: AxisRole,
    /// Unit of length in millimetres, where the axis has one.
    pub(crate) unit_mm: Option<f64>,
}

impl From<AxisRole> for ImageAxis {
    fn from(role: AxisRole) -> Self {
        Self { role, unit_mm: None }
    }
}

/// Parses the axes of metadata: names alone, or objects since version 0.4.
pub(super) fn parse_axes(axes: &Value) -> Vec<ImageAxis> {
    let parse = |axis: &Value| {
        let name = axis["name"].as_str().or_else(|| axis.as_str()).unwrap_or_default();
        let role = match (axis["type"].as_str(), AxisRole::from_name(name)) {
            (Some("channel"), _) => AxisRole::Channel,
            (Some("time"), _) => AxisRole::Time,
            (_, role) => role,
        };
        ImageAxis { role, unit_mm: axis["unit"].as_str().and_then(millimetres) }
    };
    with_spatial_roles(axes.as_array().map(|list| list.iter().map(parse).collect()).unwrap_or_default())
}

/// Returns axes by the names of an array's dimensions, where at least one of them is spatial.
pub(crate) fn axes_by_names(names: &[Option<String>]) -> Option<Vec<ImageAxis>> {
    let roles = names.iter().map(|name| AxisRole::from_name(name.as_deref().unwrap_or_default()).into());
    let axes: Vec<ImageAxis> = roles.collect();
    let is_spatial = |axis: &ImageAxis| AxisRole::SPACE.contains(&axis.role);
    axes.iter().any(is_spatial).then(|| with_spatial_roles(axes))
}

/// Returns axes by their places alone: time, channel, z, y and x, of which the first are left out.
pub(crate) fn axes_by_position(count: usize) -> Vec<ImageAxis> {
    use AxisRole::{Channel, Other, Time, X, Y, Z};
    let known = [Time, Channel, Z, Y, X];
    // An array of four axes counts volumes, as a series does.
    let known: &[AxisRole] = if count == 4 { &[Time, Z, Y, X] } else { &known[5 - count.min(5)..] };
    let others = std::iter::repeat_n(Other, count.saturating_sub(known.len()));
    others.chain(known.iter().copied()).map(ImageAxis::from).collect()
}

/// Gives axes of unknown names the spatial roles that are missing, fastest first; each role counts once.
fn with_spatial_roles(mut axes: Vec<ImageAxis>) -> Vec<ImageAxis> {
    for at in 0..axes.len() {
        if axes[..at].iter().any(|before| before.role == axes[at].role) {
            axes[at].role = AxisRole::Other;
        }
    }
    for role in AxisRole::SPACE {
        if axes.iter().all(|axis| axis.role != role)
            && let Some(axis) = axes.iter_mut().rev().find(|axis| axis.role == AxisRole::Other)
        {
            axis.role = role;
        }
    }
    axes
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::AxisRole::{Channel, Other, Time, X, Y, Z};
    use super::*;

    fn roles(axes: &[ImageAxis]) -> Vec<AxisRole> {
        axes.iter().map(|axis| axis.role).collect()
    }

    #[test]
    fn axes_have_roles_by_type_name_and_place() {
        let axes = parse_axes(&json!([
            {"name": "t", "type": "time", "unit": "second"},
            {"name": "c", "type": "channel"},
            {"name": "z", "type": "space", "unit": "micrometer"},
            {"name": "y", "type": "space", "unit": "micrometer"},
            {"name": "x", "type": "space", "unit": "nanometer"},
        ]));
        assert_eq!(roles(&axes), [Time, Channel, Z, Y, X]);
        let units: Vec<Option<f64>> = axes.iter().map(|axis| axis.unit_mm).collect();
        assert_eq!(units, [None, None, Some(1e-3), Some(1e-3), Some(1e-6)]);
        assert_eq!(roles(&parse_axes(&json!(["c", "z", "y", "x"]))), [Channel, Z, Y, X], "version 0.3");
        let anatomical = parse_axes(&json!([{"name": "k"}, {"name": "j"}, {"name": "i"}]));
        assert_eq!(roles(&anatomical), [Z, Y, X], "by place");
        assert_eq!(roles(&parse_axes(&json!([{"name": "x"}, {"name": "x"}, {"name": "y"}]))), [X, Z, Y]);
        assert_eq!(parse_axes(&json!(null)), []);
        let names = ["time", "lev", "lat", "lon"].map(|name| Some(name.to_owned()));
        assert_eq!(axes_by_names(&names).map(|axes| roles(&axes)), Some(vec![Time, Z, Y, X]));
        assert_eq!(axes_by_names(&[Some("gene".to_owned()), None]), None);
        assert_eq!(roles(&axes_by_position(2)), [Y, X]);
        assert_eq!(roles(&axes_by_position(4)), [Time, Z, Y, X]);
        assert_eq!(roles(&axes_by_position(6)), [Other, Time, Channel, Z, Y, X]);
    }
}
