//! Exchange of transfer functions with other programs: import and export of their file formats.
//!
//! Some formats hold data values (ParaView, 3D Slicer, Voreen where it has a domain); others are laid over the range
//! of the volume. Features that a format lacks, such as smooth segments between points, are written as additional
//! points.

mod agave;
mod color_tables;
mod inviwo;
mod native;
mod paraview;
mod slicer;
#[cfg(test)]
mod tests;
mod voreen;

use std::path::Path;

use serde_json::Value;

use crate::{
    ColorMixing, ControlPoint, Easing, MAX_POINTS, OpacityInterpolation, SMOOTH_SEGMENT_PIECES,
    TransferFunction,
};
use chiaroscuro_files::xml::XmlError;
use chiaroscuro_volume::ValueRange;

/// File extensions that [`import_transfer`] reads.
pub const IMPORT_EXTENSIONS: [&str; 6] = ["json", "vp", "itf", "tfi", "clut", "lut"];

/// File extensions that [`export_transfer`] writes.
pub const EXPORT_EXTENSIONS: [&str; 5] = ["json", "vp", "itf", "clut", "lut"];

/// Largest magnitude of a value: that of data in 32-bit floats.
const MAX_VALUE: f64 = f32::MAX as f64;

/// Largest size of an XML file or table, in bytes: that of a table of 4096 keys.
const MAX_XML_BYTES: usize = 2 << 20;

/// Largest size of a JSON file, in bytes: that of Slicer's with 4096 points of opacity and as many of colour.
const MAX_JSON_BYTES: usize = 2 << 20;

/// Largest size of a node table, in bytes: ten times that of 256 nodes.
const MAX_CLUT_BYTES: usize = 1 << 16;

/// Reason why a file is not a usable transfer function.
#[derive(Debug, thiserror::Error)]
pub enum ExchangeError {
    /// Syntax error: the text is not JSON.
    #[error("not valid JSON: {0}")]
    Syntax(#[from] serde_json::Error),
    /// XML that is malformed or too costly to parse.
    #[error("{0}; choose a file written by Inviwo (.itf) or Voreen (.tfi)")]
    Xml(#[from] XmlError),
    /// Content that does not fit the format, with a description.
    #[error(
        "{0}; choose a file written by ParaView or AGAVE (.json), Slicer (.vp, .vp.json), Inviwo (.itf), \
         Voreen (.tfi), MRIcroGL (.clut) or ImageJ (.lut)"
    )]
    Format(String),
    /// File extension that [`export_transfer`] does not support.
    #[error(
        "{0} is not an extension of a transfer function; choose .json, .vp, .vp.json, .itf, .clut or .lut"
    )]
    UnsupportedExtension(String),
}

/// Reads the transfer function in a file with the given name, for a volume with the given value range.
///
/// # Errors
/// Returns an error if the content does not fit the format that the file extension names.
pub fn import_transfer(
    path: &Path,
    bytes: &[u8],
    range: ValueRange,
) -> Result<TransferFunction, ExchangeError> {
    let ending = extension(path);
    if ending == "lut" && !bytes.is_ascii() {
        return color_tables::from_binary_lut(bytes, range);
    }
    let text =
        std::str::from_utf8(bytes).map_err(|err| format_error(&format!("it is not UTF-8 text: {err}")))?;
    let mut function = match ending.as_str() {
        "vp" => slicer::from_vp(text)?,
        "itf" => inviwo::from_itf(check_length(text, MAX_XML_BYTES)?, range)?,
        "tfi" => voreen::from_tfi(check_length(text, MAX_XML_BYTES)?, range)?,
        "clut" => color_tables::from_clut(check_length(text, MAX_CLUT_BYTES)?, range)?,
        "lut" => color_tables::from_text_lut(text, range)?,
        _ => from_json(check_length(text, MAX_JSON_BYTES)?, range)?,
    };
    if function.points.len() > MAX_POINTS {
        return Err(format_error(&format!(
            "{} points are too many; the limit is {MAX_POINTS}",
            function.points.len()
        )));
    }
    if function.points.iter().any(|point| point.value.abs() > MAX_VALUE) {
        return Err(format_error("a value is beyond the range of 32-bit floats"));
    }
    function.sort();
    Ok(function)
}

/// Returns the text if it has at most `most` bytes; readers of such files are slow on large input.
fn check_length(text: &str, most: usize) -> Result<&str, ExchangeError> {
    if text.len() > most {
        Err(format_error("it is longer than a transfer function can be"))
    } else {
        Ok(text)
    }
}

/// Reads a JSON file; its content tells which program wrote it.
fn from_json(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    // ParaView itself ships a file with a trailing comma.
    let mut tree: Value = serde_json::from_str(text).or_else(|err| {
        let trimmed = text.trim_end().strip_suffix(']').map(str::trim_end);
        let Some(list) = trimmed.and_then(|list| list.strip_suffix(',')) else { return Err(err) };
        serde_json::from_str(&format!("{list}]"))
    })?;
    if tree.get("volumeProperties").is_some() {
        slicer::from_vp_json(&tree)
    } else if tree.get("channels").is_some() {
        agave::from_agave(&tree, range)
    } else if native::transfer_path(&tree).is_some() {
        native::from_preset(&mut tree, range)
    } else {
        paraview::from_paraview(&tree)
    }
}

/// Encodes a transfer function for a file with the given name, for a volume with the given value range.
///
/// # Errors
/// Returns an error if the file extension is not one of [`EXPORT_EXTENSIONS`].
pub fn export_transfer(
    path: &Path,
    function: &TransferFunction,
    range: ValueRange,
) -> Result<Vec<u8>, ExchangeError> {
    let stem = path.file_stem().map_or_else(|| "Chiaroscuro".into(), |stem| stem.to_string_lossy());
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let straight = linearised(function);
    Ok(match extension(path).as_str() {
        "json" if name.ends_with(".vp.json") => slicer::to_vp_json(&straight, range).into_bytes(),
        "json" if name.ends_with(".preset.json") => native::to_preset(function).into_bytes(),
        "json" => paraview::to_paraview(&straight, &stem).into_bytes(),
        "vp" => slicer::to_vp(&straight).into_bytes(),
        "itf" => inviwo::to_itf(&straight, range).into_bytes(),
        "clut" => color_tables::to_clut(&straight, range).into_bytes(),
        "lut" => color_tables::to_lut(function, range),
        other => return Err(ExchangeError::UnsupportedExtension(format!(".{other}"))),
    })
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Returns the function with linear segments only, linear opacity, and colours mixed in linear RGB.
fn linearised(function: &TransferFunction) -> TransferFunction {
    let mut straight = function.clone();
    for index in (0..straight.points.len().saturating_sub(1)).rev() {
        let (point, next) = (straight.points[index], straight.points[index + 1]);
        let bends = (function.mixing == ColorMixing::Seen && point.color != next.color)
            || (function.interpolation == OpacityInterpolation::Extinction && point.opacity != next.opacity);
        if bends && point.easing == Easing::Linear {
            // Short pieces of the segment, which is linear here but curved in the other program.
            let share = |step: u32| f64::from(step) / f64::from(SMOOTH_SEGMENT_PIECES);
            let value = |step: u32| point.value + (next.value - point.value) * share(step);
            let between: Vec<_> =
                (1..SMOOTH_SEGMENT_PIECES).map(|step| function.point_at(value(step))).collect();
            straight.points.splice(index + 1..=index, between);
        } else {
            straight.linearise_segment(index);
        }
    }
    TransferFunction { interpolation: OpacityInterpolation::Opacity, mixing: ColorMixing::Light, ..straight }
}

/// Colour or opacity at a value.
#[derive(Clone, Copy)]
struct ValueStop<T> {
    value: f64,
    content: T,
}

/// Builds a transfer function from colours and opacities at different values; neither list is empty.
fn merge_colors_and_opacities(
    mut colors: Vec<ValueStop<[f32; 3]>>,
    mut opacities: Vec<ValueStop<f64>>,
) -> TransferFunction {
    colors.sort_by(|a, b| a.value.total_cmp(&b.value));
    opacities.sort_by(|a, b| a.value.total_cmp(&b.value));
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let color = |value: f64| {
        interpolate(&colors, value, |a, b, t| {
            std::array::from_fn(|c| mix(f64::from(a[c]), f64::from(b[c]), t) as f32)
        })
    };
    // A jump has two points at one value: the first opacity there belongs to the first colour there.
    let mut points = Vec::new();
    let mut before = 0;
    for (at, &ValueStop { value, content: opacity }) in opacities.iter().enumerate() {
        before = if at > 0 && opacities[at - 1].value == value { before + 1 } else { 0 };
        let first = colors.partition_point(|other| other.value < value);
        let jump = &colors[first..colors.partition_point(|other| other.value <= value)];
        let color =
            jump.get(before).filter(|_| jump.len() > 1).map_or_else(|| color(value), |other| other.content);
        points.push(ControlPoint::new(value, color, opacity));
    }
    for &ValueStop { value, content: color } in &colors {
        if opacities.binary_search_by(|at| at.value.total_cmp(&value)).is_err() {
            points.push(ControlPoint::new(
                value,
                color,
                interpolate(&opacities, value, |a, b, t| mix(*a, *b, t)),
            ));
        }
    }
    let mut function = TransferFunction { points, ..TransferFunction::default() };
    function.sort();
    function
}

/// Interpolates a list sorted by value; outside it, returns the nearest end.
fn interpolate<T: Copy>(points: &[ValueStop<T>], value: f64, mix: impl Fn(&T, &T, f64) -> T) -> T {
    let upper = points.partition_point(|point| point.value <= value);
    match (upper.checked_sub(1).map(|at| points[at]), points.get(upper)) {
        (Some(low), Some(high)) => {
            mix(&low.content, &high.content, (value - low.value) / (high.value - low.value))
        }
        (Some(low), None) => low.content,
        (None, Some(high)) => high.content,
        (None, None) => points[0].content,
    }
}

fn format_error(what: &str) -> ExchangeError {
    ExchangeError::Format(what.to_owned())
}

/// Reads a JSON array of finite numbers.
fn number_list(list: Option<&Value>, name: &str) -> Result<Vec<f64>, ExchangeError> {
    let list =
        list.and_then(Value::as_array).ok_or_else(|| format_error(&format!("the list {name} is missing")))?;
    let number = |value: &Value| value.as_f64().filter(|number| number.is_finite());
    let found: Option<Vec<f64>> = list.iter().map(number).collect();
    found.ok_or_else(|| format_error(&format!("{name} contains something other than numbers")))
}

/// Converts RGB fractions to a colour, clamped to 0 … 1; missing components are 1.
fn rgb_from_fractions(shares: &[f64]) -> [f32; 3] {
    std::array::from_fn(|c| shares.get(c).map_or(1.0, |share| share.clamp(0.0, 1.0) as f32))
}
