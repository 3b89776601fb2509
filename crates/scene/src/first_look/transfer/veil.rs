//! Veils: transfer functions that make an outer material translucent around an inner one.

use super::super::domain::DataDomain;
use super::super::palette::DomainPalette;
use crate::{ControlPoint, OpacityInterpolation, TransferFunction};

/// Returns a function that shows only values above `start`: in the colours of the domain that all channels of the
/// file share, or else in ivory.
pub(crate) fn inner_transfer(
    function: &TransferFunction,
    start: f64,
    channels: Option<DataDomain>,
) -> TransferFunction {
    let end = function.points.last().map_or(start, |point| point.value).max(start);
    let at = |share: f64| start + share * (end - start);
    let color = |place: f64, ivory: [f32; 3]| {
        channels.map_or(ivory, |domain| DomainPalette::for_domain(domain).color_at(place))
    };
    let points = vec![
        ControlPoint::new(at(0.0), color(0.0, [0.72, 0.60, 0.48]), 0.0),
        ControlPoint::new(at(0.15), color(0.4, [0.87, 0.78, 0.64]), 0.6),
        ControlPoint::new(at(0.5), color(0.8, [0.96, 0.91, 0.82]), 0.9),
        ControlPoint::new(at(1.0), color(1.0, [1.0, 0.98, 0.95]), 0.96),
    ];
    TransferFunction { points, interpolation: OpacityInterpolation::Opacity, ..function.clone() }
}

/// Returns a function that shows values above `start` as [`inner_transfer`] does, and of those below only the outer
/// surface: a skin with a share of its opacity, fully transparent inside.
pub(crate) fn veiled_transfer(
    function: &TransferFunction,
    start: f64,
    share: f64,
    channels: Option<DataDomain>,
) -> TransferFunction {
    let begins = function.points.windows(2).find(|pair| pair[0].opacity <= 0.0 && pair[1].opacity > 0.0);
    let skin = begins.filter(|pair| pair[1].value < start).map(|pair| {
        let [outside, surface] = [pair[0], pair[1]];
        // Symmetric about the surface, if it fits.
        let ends = (2.0 * surface.value - outside.value).min(f64::midpoint(surface.value, start));
        let at = |value: f64, opacity: f64| ControlPoint { value, opacity, ..function.point_at(value) };
        [outside, at(surface.value, share * surface.opacity), at(ends, 0.0)]
    });
    let points = skin.into_iter().flatten().chain(inner_transfer(function, start, channels).points).collect();
    TransferFunction { points, ..function.clone() }
}

/// Returns a function with every visible point opaque, so that a veil counts as visible.
pub(crate) fn opaque_transfer(function: &TransferFunction) -> TransferFunction {
    let mut opaque = function.clone();
    opaque.points.iter_mut().filter(|point| point.opacity > 0.0).for_each(|point| point.opacity = 1.0);
    opaque
}

/// Multiplies the opacity of all points by a factor.
pub(crate) fn scale_opacity(function: &mut TransferFunction, share: f64) {
    for point in &mut function.points {
        point.opacity *= share;
    }
}
