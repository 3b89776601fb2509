//! Voxel spacing of a FITS file, from its world coordinates (section 8 of the standard).
//!
//! The coordinates neither rotate nor mirror the image: pixels are shown where other programs show them. Only the
//! lengths of the steps are used. Degrees on the sky are no lengths, but comparable with each other; metres along one
//! axis and hertz along another are not.

use super::super::placement::GridPlacement;
use super::header::FitsHeader;
use super::layout::FitsLayout;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::is_usable_spacing;

/// First four letters of spectral coordinate types: those of table 25, and others in common use.
const SPECTRAL: [&str; 16] = [
    "FREQ", "ENER", "WAVN", "VRAD", "WAVE", "VOPT", "ZOPT", "AWAV", "VELO", "BETA", "FELO", "LAMB", "VLSR",
    "CHAN", "PIXE", "LINE",
];

/// First four letters of celestial coordinate types (section 8.3).
const CELESTIAL: [&str; 12] =
    ["RA--", "DEC-", "GLON", "GLAT", "ELON", "ELAT", "HLON", "HLAT", "SLON", "SLAT", "HPLN", "HPLT"];

/// Unit of a world coordinate, after conversion.
#[derive(Debug, Clone, PartialEq)]
enum FitsUnit {
    /// Angle on the sky, in degrees.
    Angle,
    /// Length in space, in millimetres.
    Length,
    /// Any other unit, by its name; comparable only with itself.
    Other(String),
}

impl FitsUnit {
    /// Returns the unit's name for remarks to the user.
    fn name(&self) -> &str {
        match self {
            Self::Angle => "degrees",
            Self::Length => "mm",
            Self::Other(name) if name.is_empty() => "no unit",
            Self::Other(name) => name,
        }
    }
}

/// Step from one pixel to the next along an axis: length and unit.
#[derive(Debug, Clone)]
struct AxisStep {
    length: f64,
    unit: FitsUnit,
}

/// Returns the placement of an array's voxels: the first at the lower left, rows upwards.
pub(super) fn placement(header: &FitsHeader, layout: &FitsLayout) -> GridPlacement {
    let steps = layout.axes.map(|axis| axis.and_then(|axis| axis_step(header, axis)));
    let stated_steps: Vec<&AxisStep> = steps.iter().flatten().collect();
    let Some(first) = stated_steps.first() else { return GridPlacement::unknown() };
    // Most common unit: that of the first axis, or that of the other two if only they agree.
    let count = |unit: &FitsUnit| stated_steps.iter().filter(|step| step.unit == *unit).count();
    let common_unit =
        if count(&first.unit) == 1 && stated_steps.len() == 3 && stated_steps[1].unit == stated_steps[2].unit
        {
            &stated_steps[1].unit
        } else {
            &first.unit
        };
    let comparable_lengths: Vec<f64> =
        stated_steps.iter().filter(|step| step.unit == *common_unit).map(|step| step.length).collect();
    let shortest = comparable_lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let is_length = *common_unit == FitsUnit::Length
        && comparable_lengths.iter().all(|&length| is_usable_spacing(length));
    let scale = if is_length { 1.0 } else { shortest };
    let spacing = [0, 1, 2].map(|axis| match &steps[axis] {
        Some(step) if step.unit == *common_unit => step.length / scale,
        // An axis whose unit cannot be compared gets the shortest spacing of the others.
        _ => shortest / scale,
    });
    let remarks = [0, 1, 2].map(|axis| {
        let step = steps[axis].as_ref().filter(|step| step.unit != *common_unit)?;
        let keyword = format!("CTYPE{}", layout.axes[axis].unwrap_or_default());
        let kind = sanitised(header.text(&keyword), 40);
        Some(format!(
            "axis {} ({}, in {}) has a different unit from the other axes ({}): their smallest spacing is used for it",
            axis + 1,
            if kind.is_empty() { "unnamed" } else { &kind },
            sanitised(step.unit.name(), 40),
            sanitised(common_unit.name(), 40)
        ))
    });
    let placed = GridPlacement::from_spacing(spacing);
    let placed = remarks.into_iter().fold(placed, GridPlacement::with_remark);
    if is_length { placed } else { placed.with_unknown_scale() }
}

/// Returns the step along an axis of the file, counted from 1; `None` if the header gives no usable one.
fn axis_step(header: &FitsHeader, axis: usize) -> Option<AxisStep> {
    let own = coordinate_unit(header, axis);
    let mut along: Vec<(FitsUnit, f64)> = Vec::new();
    for world in 1..=MAX_COORDINATES {
        let Some(rate) = coordinate_derivative(header, world, axis).filter(|&rate| rate != 0.0) else {
            continue;
        };
        let (unit, factor) = coordinate_unit(header, world);
        along.push((unit, (rate * factor).abs()));
    }
    let length_in = |unit: &FitsUnit| {
        let parts = along.iter().filter(|(other, _)| other == unit).map(|(_, length)| length * length);
        parts.sum::<f64>().sqrt()
    };
    let length = length_in(&own.0);
    // If the axis' own coordinate is constant along it, the first other coordinate that varies supplies the step.
    let (unit, length) = match along.first() {
        Some((other, _)) if length == 0.0 => (other.clone(), length_in(other)),
        _ => (own.0, length),
    };
    (length.is_finite() && length > 0.0).then_some(AxisStep { length, unit })
}

/// Maximum number of world coordinates examined: two on the sky, a spectrum, polarisation, and as many degenerate
/// ones.
const MAX_COORDINATES: usize = 8;

/// Returns the derivative of a world coordinate along an array axis: `CDi_j`, or `CDELTi` times `PCi_j`, or `CDELTi`
/// alone.
fn coordinate_derivative(header: &FitsHeader, world: usize, axis: usize) -> Option<f64> {
    let has_matrix = (1..=MAX_COORDINATES)
        .any(|i| (1..=MAX_COORDINATES).any(|j| header.float(&format!("CD{i}_{j}")).is_some()));
    if has_matrix {
        return header.float(&format!("CD{world}_{axis}"));
    }
    let delta = header.float(&format!("CDELT{world}"))?;
    let turned = header.float(&format!("PC{world}_{axis}"));
    Some(delta * turned.unwrap_or(if world == axis { 1.0 } else { 0.0 }))
}

/// Returns the unit of a world coordinate, and the factor to degrees or millimetres.
fn coordinate_unit(header: &FitsHeader, world: usize) -> (FitsUnit, f64) {
    let kind = header.text(&format!("CTYPE{world}")).to_uppercase();
    let said = header.text(&format!("CUNIT{world}"));
    let begins = |names: &[&str]| names.iter().any(|name| kind.starts_with(name));
    // Wavelengths are lengths, but not in space.
    if begins(&SPECTRAL) || kind == "TIME" || kind == "STOKES" {
        let name = if said.is_empty() { &kind } else { said };
        return (FitsUnit::Other(name.to_lowercase()), 1.0);
    }
    // Older programs write angle units in capitals; units of length are case-sensitive, as another case means another
    // unit.
    let angle = match said.to_lowercase().as_str() {
        "" if begins(&CELESTIAL) => Some(1.0),
        "deg" | "degree" | "degrees" => Some(1.0),
        "arcmin" => Some(1.0 / 60.0),
        "arcsec" => Some(1.0 / 3600.0),
        "mas" => Some(1.0 / 3.6e6),
        "rad" => Some(180.0 / std::f64::consts::PI),
        _ => None,
    };
    if let Some(degrees) = angle {
        return (FitsUnit::Angle, degrees);
    }
    match said {
        "km" => (FitsUnit::Length, 1e6),
        "m" => (FitsUnit::Length, 1e3),
        "cm" => (FitsUnit::Length, 10.0),
        "mm" => (FitsUnit::Length, 1.0),
        "um" | "micron" => (FitsUnit::Length, 1e-3),
        "nm" => (FitsUnit::Length, 1e-6),
        "Angstrom" | "angstrom" => (FitsUnit::Length, 1e-7),
        other => (FitsUnit::Other(other.to_lowercase()), 1.0),
    }
}
