//! Predefined colour maps, each as nine evenly spaced sRGB colours, and their application to transfer functions.

use crate::{ControlPoint, Easing, TransferFunction};
use chiaroscuro_volume::ValueRange;

/// Colour map with nine evenly spaced stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColorMap {
    /// Name of the map in menus.
    pub name: &'static str,
    /// Stops as 0xRRGGBB, from the low end to the high one.
    stops: [u32; 9],
}

/// The colour maps of the menu.
///
/// Viridis, Inferno, Magma and Plasma are by Smith and van der Walt, Cividis by Nuñez and others, Cool to warm
/// by Moreland, three are Brewer's (Yellow to brown, Red to blue, Purple to green), and Batlow to Davos are by Crameri.
pub const COLOR_MAPS: [ColorMap; 15] = [
    ColorMap {
        name: "Viridis",
        stops: [0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725],
    },
    ColorMap {
        name: "Inferno",
        stops: [0x000004, 0x210c4a, 0x57106e, 0x8a226a, 0xbc3754, 0xe45a31, 0xf98e09, 0xf9cb35, 0xfcffa4],
    },
    ColorMap {
        name: "Magma",
        stops: [0x000004, 0x1d1147, 0x51127c, 0x832681, 0xb73779, 0xe75263, 0xfc8961, 0xfec488, 0xfcfdbf],
    },
    ColorMap {
        name: "Plasma",
        stops: [0x0d0887, 0x4c02a1, 0x7e03a8, 0xaa2395, 0xcc4778, 0xe66c5c, 0xf89540, 0xfdc527, 0xf0f921],
    },
    ColorMap {
        name: "Cividis",
        stops: [0x00224e, 0x1a386f, 0x434e6c, 0x61656f, 0x7d7c78, 0x9b9476, 0xbcae6c, 0xdec958, 0xfee838],
    },
    ColorMap {
        name: "Cool to warm",
        stops: [0x3b4cc0, 0x6282ea, 0x8db0fe, 0xb9d0f9, 0xdddcdc, 0xf5c4ac, 0xf4987a, 0xdd5f4b, 0xb40426],
    },
    ColorMap {
        name: "Yellow to brown",
        stops: [0xffffe5, 0xfff7bc, 0xfee390, 0xfec34f, 0xfe9829, 0xeb6f14, 0xcb4b02, 0x983404, 0x662506],
    },
    ColorMap {
        name: "Red to blue",
        stops: [0xa50026, 0xde402e, 0xf98e52, 0xfed485, 0xfeffc0, 0xd1ecf4, 0x8ec2dc, 0x4f81ba, 0x313695],
    },
    ColorMap {
        name: "Purple to green",
        stops: [0xfff7fb, 0xece2f0, 0xd0d1e6, 0xa5bddb, 0x66a9cf, 0x3590bf, 0x028189, 0x016b58, 0x014636],
    },
    ColorMap {
        name: "Batlow",
        stops: [0x011959, 0x114360, 0x226061, 0x4d734d, 0x828231, 0xc09036, 0xf29d6d, 0xfdb4b6, 0xfaccfa],
    },
    ColorMap {
        name: "Vik",
        stops: [0x001261, 0x034481, 0x307da6, 0x94bed2, 0xece5e0, 0xdbaa8d, 0xc27041, 0x912d06, 0x590008],
    },
    ColorMap {
        name: "Lajolla",
        stops: [0x191900, 0x372411, 0x67342a, 0xa64644, 0xd9604e, 0xe58851, 0xedae54, 0xf7da74, 0xfffecb],
    },
    ColorMap {
        name: "Oslo",
        stops: [0x010101, 0x0e1e2e, 0x15395b, 0x26578c, 0x507bbc, 0x7d99ca, 0xa3b1ca, 0xcfd2d8, 0xffffff],
    },
    ColorMap {
        name: "Davos",
        stops: [0x00054a, 0x143277, 0x2f5a96, 0x4e799d, 0x6c8e93, 0x8ca388, 0xbdc995, 0xf0f1cd, 0xfefefe],
    },
    ColorMap {
        name: "Grey",
        stops: [0x000000, 0x202020, 0x404040, 0x606060, 0x808080, 0x9f9f9f, 0xbfbfbf, 0xdfdfdf, 0xffffff],
    },
];

/// Minimum distance between control points, as a share of the range: a nearer stop gets no point of its own.
const MIN_STOP_DISTANCE: f64 = 0.02;

impl ColorMap {
    /// Returns the sRGB colour at a position from 0 to 1.
    pub fn at(&self, place: f64) -> [f32; 3] {
        let place = place.clamp(0.0, 1.0) * 8.0;
        let low = (place as usize).min(7);
        let t = (place - low as f64) as f32;
        let channel = |stop: u32, shift: u32| (stop >> shift & 0xff) as f32 / 255.0;
        [16, 8, 0].map(|shift| {
            let (a, b) = (channel(self.stops[low], shift), channel(self.stops[low + 1], shift));
            a + (b - a) * t
        })
    }
}

impl TransferFunction {
    /// Colours the visible values by a map, from the last invisible point to the last point, or in reverse. Opacities
    /// stay unchanged; points are added at the map's stops.
    pub fn apply_color_map(&mut self, map: &ColorMap, reversed: bool) {
        let Some(ValueRange { low, high }) = self.visible_range() else { return };
        let span = (high - low).max(1e-300);
        for stop in 0..=8 {
            let value = low + span * f64::from(stop) / 8.0;
            let near = |point: &ControlPoint| (point.value - value).abs() <= MIN_STOP_DISTANCE * span;
            if !self.points.iter().any(near) {
                self.split_at(value);
            }
        }
        for point in &mut self.points {
            let place = (point.value - low) / span;
            point.color = map.at(if reversed { 1.0 - place } else { place });
        }
    }

    /// Returns the range from the last point before anything is visible to the last point.
    fn visible_range(&self) -> Option<ValueRange> {
        let first = self.points.iter().position(|point| point.opacity > 0.0)?;
        let low = self.points[first.saturating_sub(1)].value;
        Some(ValueRange { low, high: self.points.last()?.value })
    }

    /// Mirrors opacities and colours along the range of values of the points.
    pub fn mirror(&mut self) {
        // A step, which holds until the next point, would have to hold since the previous one.
        for index in (0..self.points.len()).rev() {
            if self.points[index].easing == Easing::Step {
                self.linearise_segment(index);
            }
        }
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return };
        let sum = first.value + last.value;
        for point in &mut self.points {
            point.value = sum - point.value;
        }
        // A segment's easing now belongs to the point at its other end.
        let ways = self.points.len() - 1;
        let mut easings: Vec<_> = self.points[..ways].iter().map(|point| point.easing).collect();
        easings.reverse();
        self.points.reverse();
        for (point, easing) in self.points.iter_mut().zip(easings) {
            point.easing = easing;
        }
    }

    /// Moves all points along the value axis, so that those of one range of values come to lie in another.
    pub fn map_range(&mut self, from: ValueRange, to: ValueRange) {
        let stretch = to.span() / from.span();
        if !stretch.is_finite() || stretch <= 0.0 {
            return;
        }
        for point in &mut self.points {
            point.value = to.low + (point.value - from.low) * stretch;
        }
    }

    /// Moves all points along the value axis, and scales their distances from the middle.
    pub fn shift_and_stretch(&mut self, shift: f64, stretch: f64) {
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return };
        let middle = f64::midpoint(first.value, last.value);
        for point in &mut self.points {
            point.value = middle + (point.value - middle) * stretch + shift;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> TransferFunction {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        TransferFunction {
            points: vec![point(0.0, 0.0), point(100.0, 0.0), point(200.0, 0.5), point(300.0, 0.9)],
            ..TransferFunction::default()
        }
    }

    #[test]
    fn maps_begin_and_end_with_their_stops() {
        let viridis = COLOR_MAPS[0];
        let bytes = |color: [f32; 3]| color.map(|c| (c * 255.0).round() as u8);
        assert_eq!(bytes(viridis.at(0.0)), [68, 1, 84]);
        assert_eq!(bytes(viridis.at(0.5)), [33, 145, 140]);
        assert_eq!(bytes(viridis.at(7.0)), [253, 231, 37]);
    }

    #[test]
    fn coloring_keeps_every_opacity() {
        let before = ramp();
        for reversed in [false, true] {
            let mut function = before.clone();
            function.apply_color_map(&COLOR_MAPS[0], reversed);
            assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
            for i in 0..=60 {
                let value = f64::from(i) * 5.0;
                let change = (function.opacity_at(value) - before.opacity_at(value)).abs();
                assert!(change < 1e-9, "{value}: {change}");
            }
            let ends = [
                function.points.iter().find(|p| p.value == 100.0).unwrap().color,
                function.points.last().unwrap().color,
            ];
            let expected = [COLOR_MAPS[0].at(0.0), COLOR_MAPS[0].at(1.0)];
            assert_eq!(ends, if reversed { [expected[1], expected[0]] } else { expected });
        }
    }

    #[test]
    fn bands_are_bands_the_other_way_round() {
        let mut function = ramp();
        function.points[1].easing = Easing::Step;
        function.points[1].opacity = 0.7;
        function.points[2].easing = Easing::Smooth;
        let before = function.clone();
        function.mirror();
        for value in [10.0, 101.0, 150.0, 199.0, 230.0, 260.0] {
            let apart = (function.opacity_at(300.0 - value) - before.opacity_at(value)).abs();
            assert!(apart < 1e-9, "{value}: {apart}");
        }
        assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
    }

    #[test]
    fn inverting_twice_and_stretching_back_change_nothing() {
        let before = ramp();
        let mut function = before.clone();
        function.mirror();
        assert_eq!(function.points[0].opacity, 0.9);
        function.mirror();
        function.map_range(ValueRange::new(0.0, 300.0), ValueRange::new(10.0, 610.0));
        assert_eq!(function.points[2].value, 410.0);
        function.map_range(ValueRange::new(10.0, 610.0), ValueRange::new(0.0, 300.0));
        function.map_range(ValueRange::new(1.0, 1.0), ValueRange::new(0.0, 300.0));
        assert_eq!(function, ramp(), "a range without values is none");
        function.shift_and_stretch(20.0, 2.0);
        assert_eq!(function.points[0].value, 150.0 - 300.0 + 20.0);
        function.shift_and_stretch(-20.0, 1.0);
        function.shift_and_stretch(0.0, 0.5);
        assert_eq!(function, before);
    }
}
