//! Channels of an image in the metadata of OMERO: names, colours and windows.

use serde_json::Value;

use chiaroscuro_files::sanitised;

/// Maximum number of channels that are described.
const MAX_CHANNELS: usize = 4096;

/// Channel of an image.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct OmeChannel {
    pub(crate) name: String,
    /// Colour in sRGB.
    pub(crate) color: Option<[u8; 3]>,
    /// Values that are shown as black and as full colour.
    pub(crate) window: Option<[f64; 2]>,
}

/// Parses the list of channels.
pub(super) fn parse_channels(channels: &Value) -> Vec<OmeChannel> {
    let parse = |channel: &Value| OmeChannel {
        name: sanitised(channel["label"].as_str().unwrap_or_default().trim(), 80),
        color: channel["color"].as_str().and_then(parse_color),
        window: channel["window"]["start"]
            .as_f64()
            .zip(channel["window"]["end"].as_f64())
            .map(|(low, high)| [low, high]),
    };
    channels.as_array().into_iter().flatten().take(MAX_CHANNELS).map(parse).collect()
}

/// Parses a colour of six hexadecimal digits, with or without `#`.
fn parse_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim().trim_start_matches('#');
    let number = u32::from_str_radix(digits.get(..6)?, 16).ok()?;
    let [_, red, green, blue] = number.to_be_bytes();
    Some([red, green, blue])
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn channels_have_names_colors_and_windows() {
        let channels = parse_channels(&json!([
            {"label": "DAPI", "color": "0000FF", "window": {"start": 100, "end": 2000.5, "min": 0, "max": 65535}},
            {"color": "#ff8000ff"},
            {"label": 3, "color": "blue"},
        ]));
        let [first, second, third] = &channels[..] else { panic!("{channels:?}") };
        assert_eq!(
            (first.name.as_str(), first.color, first.window),
            ("DAPI", Some([0, 0, 255]), Some([100.0, 2000.5]))
        );
        assert_eq!(second.color, Some([255, 128, 0]));
        assert_eq!(*third, OmeChannel::default());
    }
}
