//! Coordinate transforms of a level: scales and translations of its axes.

use serde_json::Value;

/// Scale and translation of an axis, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AxisScale {
    /// Distance between neighbouring voxels.
    pub(crate) scale: f64,
    /// Place of the centre of the first voxel.
    pub(crate) translation: f64,
}

/// Composes lists of transforms for so many axes; empty where there are none. Transforms of another kind, or with
/// another number of axes, are left out.
pub(super) fn parse_transforms(lists: &[&Value], axes: usize) -> Vec<AxisScale> {
    let mut composed: Vec<AxisScale> = Vec::new();
    for transform in lists.iter().filter_map(|list| list.as_array()).flatten() {
        let numbers = |name: &str| -> Option<Vec<f64>> {
            let list = transform[name].as_array()?;
            let numbers: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
            numbers.filter(|numbers| axes == 0 || numbers.len() == axes)
        };
        let [scale, translation] = match transform["type"].as_str() {
            Some("scale") => [numbers("scale"), None],
            Some("translation") => [None, numbers("translation")],
            _ => continue,
        };
        let count = scale.iter().chain(&translation).map(Vec::len).max().unwrap_or(0);
        if composed.is_empty() {
            composed = vec![AxisScale { scale: 1.0, translation: 0.0 }; count];
        }
        for (axis, factor) in composed.iter_mut().zip(scale.into_iter().flatten()) {
            axis.scale *= factor;
            axis.translation *= factor;
        }
        for (axis, offset) in composed.iter_mut().zip(translation.into_iter().flatten()) {
            axis.translation += offset;
        }
    }
    composed
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn transforms_of_level_and_image_are_composed() {
        let level = json!([{"type": "scale", "scale": [2.0, 1.0]}, {"type": "translation", "translation": [0.5, 0.25]}]);
        let image = json!([{"type": "scale", "scale": [10.0, 4.0]}, {"type": "affine", "affine": []}]);
        let at = |scale, translation| AxisScale { scale, translation };
        assert_eq!(parse_transforms(&[&level, &image], 2), [at(20.0, 5.0), at(4.0, 1.0)]);
        assert_eq!(parse_transforms(&[&level], 3), [], "for other axes");
        assert_eq!(parse_transforms(&[&json!(null), &json!([{"type": "identity"}])], 2), []);
    }
}
