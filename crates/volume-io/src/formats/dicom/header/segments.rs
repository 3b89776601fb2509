//! Segments of a segmentation (PS3.3 section C.8.20): numbers, names and colours.

use chiaroscuro_volume::FileLabelTable;

/// Maximum number of segments read: their numbers have 16 bits.
pub(crate) const MAX_SEGMENTS: usize = 1 << 16;

/// Type of a segmentation: meaning of its pixel values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SegmentationType {
    /// One bit per pixel, with separate frames for each segment.
    Binary,
    /// Fraction of a segment per pixel, with separate frames for each segment.
    Fractional,
    /// Segment number per pixel, in one set of frames.
    LabelMap,
}

impl SegmentationType {
    /// Parses the code string of element (0062,0001).
    pub(crate) fn parse(code: &str) -> Option<Self> {
        match code {
            "BINARY" => Some(Self::Binary),
            "FRACTIONAL" => Some(Self::Fractional),
            "LABELMAP" => Some(Self::LabelMap),
            _ => None,
        }
    }
}

/// Segment as the header describes it.
#[derive(Debug, Clone, Default)]
pub(crate) struct DicomSegment {
    pub(crate) number: Option<u16>,
    pub(crate) label: String,
    /// Colour in `CIELab` as the standard stores it: each component from 0 to 65535.
    pub(crate) color: Option<[u16; 3]>,
}

/// Returns names and colours of segments by their numbers.
pub(crate) fn labels_from_segments(segments: &[DicomSegment]) -> FileLabelTable {
    let mut labels = FileLabelTable::default();
    for segment in segments {
        if let Some(number) = segment.number {
            labels.insert(number.into(), &segment.label, segment.color.map(srgb_from_cielab));
        }
    }
    labels
}

/// Converts a colour from `CIELab` under D50, as PS3.3 section C.10.7.1.1 stores it, to sRGB from 0 to 1; components
/// out of gamut are clamped.
fn srgb_from_cielab([lightness, a, b]: [u16; 3]) -> [f32; 3] {
    let share = |part: u16| f64::from(part) / f64::from(u16::MAX);
    // L* from 0 to 100, a* and b* from −128 to 127.
    let lightness = share(lightness) * 100.0;
    let [a, b] = [a, b].map(|part| share(part) * 255.0 - 128.0);
    // CIE 15: the inverse of f(t) is t³ above 6/29, and linear below.
    let y = (lightness + 16.0) / 116.0;
    let inverse = |f: f64| {
        if f > 6.0 / 29.0 { f.powi(3) } else { 3.0 * (6.0f64 / 29.0).powi(2) * (f - 4.0 / 29.0) }
    };
    // White point of D50 (ICC.1, the profile connection space).
    let x = 0.9642 * inverse(y + a / 500.0);
    let z = 0.8249 * inverse(y - b / 200.0);
    let y = inverse(y);
    // IEC 61966-2-1 with the primaries adapted to D50 after Bradford (ICC's sRGB profile, inverted).
    [
        3.134_136 * x - 1.617_386 * y - 0.490_662 * z,
        -0.978_795 * x + 1.916_254 * y + 0.033_443 * z,
        0.071_955 * x - 0.228_977 * y + 1.405_386 * z,
    ]
    .map(|linear| {
        let encoded =
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        encoded.clamp(0.0, 1.0) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Encodes L*, a* and b* as a segmentation stores them.
    fn encode_cielab([lightness, a, b]: [f64; 3]) -> [u16; 3] {
        [lightness / 100.0, (a + 128.0) / 255.0, (b + 128.0) / 255.0]
            .map(|part| (part * 65535.0).round() as u16)
    }

    #[test]
    fn colors_are_those_of_srgb() {
        // CIELab under D50 of sRGB's colours (Lindbloom, <http://www.brucelindbloom.com>).
        for (lab, rgb) in [
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
            ([100.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
            ([54.29, 80.81, 69.89], [1.0, 0.0, 0.0]),
            ([87.82, -79.29, 80.99], [0.0, 1.0, 0.0]),
            ([29.57, 68.30, -112.03], [0.0, 0.0, 1.0]),
            ([53.39, 0.0, 0.0], [0.5, 0.5, 0.5]),
        ] {
            let found = srgb_from_cielab(encode_cielab(lab));
            // The figures above have four digits, and sRGB is steep in dark colours.
            let furthest = found.iter().zip(rgb).map(|(found, right): (&f32, f32)| (found - right).abs());
            assert!(furthest.fold(0.0, f32::max) < 0.02, "{lab:?}: {found:?}, {rgb:?} expected");
        }
    }

    #[test]
    fn segments_without_numbers_have_no_labels() {
        let segment = DicomSegment { label: "Liver".to_owned(), ..DicomSegment::default() };
        assert!(labels_from_segments(std::slice::from_ref(&segment)).is_empty());
        let labels = labels_from_segments(&[DicomSegment { number: Some(3), ..segment }]);
        assert_eq!(labels.get(3).map(|label| (label.name.as_str(), label.color)), Some(("Liver", None)));
    }
}
