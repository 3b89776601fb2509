//! Metadata of tifffile: the shape of an array, as JSON or, in versions before 2017, as `shape=(2, 8, 7, 8)`.

use serde::Deserialize;
use serde_json::Value;

/// Maximum length of a description, in bytes: programs add metadata of their own to the shape.
pub(super) const MAX_BYTES: u64 = 1 << 20;

/// Description of a series of pages.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub(super) struct ShapeDescription {
    /// Sizes of the array, slowest axis first.
    pub(super) shape: Vec<u64>,
    /// Letter of each axis, in the order of `shape`.
    pub(super) axes: Option<String>,
    pub(super) name: Option<String>,
    /// True if one page stands for all.
    pub(super) truncated: bool,
    /// Distance between slices, in `unit`.
    pub(super) spacing: Option<f64>,
    /// Name of the unit of length.
    pub(super) unit: Option<String>,
    /// Names of channels in OME's form.
    #[serde(rename = "Channel")]
    channel: Value,
    /// Names of channels or pages in `ImageJ`'s form.
    #[serde(rename = "Labels")]
    labels: Value,
}

impl ShapeDescription {
    /// Parses a description; `None` for any other text.
    pub(super) fn parse(description: &str) -> Option<Self> {
        let description = description.trim();
        if let Some(old) = description.strip_prefix("shape=(") {
            let (numbers, _) = old.split_once(')')?;
            let numbers = numbers.split(',').map(str::trim).filter(|number| !number.is_empty());
            let shape: Option<Vec<u64>> = numbers.map(|number| number.parse().ok()).collect();
            return shape.filter(|shape| !shape.is_empty()).map(|shape| Self { shape, ..Self::default() });
        }
        if !description.starts_with('{') || !description.contains("\"shape\"") {
            return None;
        }
        // If other members have unexpected types, only shape and axes are used.
        let words = serde_json::from_str(description).ok().or_else(|| {
            let value: Value = serde_json::from_str(description).ok()?;
            let shape = serde_json::from_value(value.get("shape")?.clone()).ok()?;
            let axes = value.get("axes").and_then(Value::as_str).map(str::to_owned);
            Some(Self { shape, axes, ..Self::default() })
        });
        words.filter(|words: &Self| !words.shape.is_empty())
    }

    /// Names of the channels, if there are exactly `channels` of them; otherwise empty.
    pub(super) fn channel_names(&self, channels: usize) -> Vec<String> {
        let texts = |value: &Value| -> Vec<String> {
            let all = value.as_array().map_or(&[][..], Vec::as_slice);
            all.iter().map(|name| name.as_str().unwrap_or_default().to_owned()).collect()
        };
        let listed = self.channel.as_array().map_or(&[][..], Vec::as_slice);
        let each: Vec<Value> =
            listed.iter().map(|channel| channel.get("Name").cloned().unwrap_or_default()).collect();
        let of_all = self.channel.get("Name").cloned().unwrap_or_default();
        let lists = [texts(&of_all), texts(&Value::Array(each)), texts(&self.labels)];
        lists.into_iter().find(|names| names.len() == channels).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_understood_in_both_forms() {
        let shape = |text: &str| ShapeDescription::parse(text).map(|words| words.shape);
        assert_eq!(shape("{\"shape\": [2, 8, 7, 8]}"), Some(vec![2, 8, 7, 8]));
        assert_eq!(shape("shape=(2, 8,7,)"), Some(vec![2, 8, 7]));
        assert_eq!(shape("{\"axes\": 7, \"shape\": [3, 1]}"), Some(vec![3, 1]), "axes of another type");
        for text in
            ["", "{}", "{\"shape\": []}", "{\"shape\": [-1]}", "{\"shape\": [2", "ImageJ=1", "shape=()"]
        {
            assert_eq!(shape(text), None, "{text}");
        }
    }

    #[test]
    fn names_of_channels_are_understood() {
        for text in [
            "{\"shape\": [2], \"Channel\": {\"Name\": [\"a\", \"b\"]}}",
            "{\"shape\": [2], \"Channel\": [{\"Name\": \"a\"}, {\"Name\": \"b\"}]}",
            "{\"shape\": [2], \"Labels\": [\"a\", \"b\"]}",
        ] {
            let words = ShapeDescription::parse(text).unwrap();
            assert_eq!(words.channel_names(2), ["a", "b"], "{text}");
            assert!(words.channel_names(3).is_empty());
        }
    }
}
