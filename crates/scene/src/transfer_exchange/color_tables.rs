//! Import and export of colour tables, laid over the range of the volume: nodes of `MRIcroGL` (`.clut`) and 256
//! colours of `ImageJ` (`.lut`).

use std::fmt::Write as _;

use super::{ExchangeError, format_error, rgb_from_fractions};
use crate::{ControlPoint, TransferFunction, srgb_from_linear};
use chiaroscuro_volume::ValueRange;

/// Number of entries of a byte table.
const TABLE_ENTRIES: usize = 256;

/// Sampling interval when a table becomes control points: every 16th entry, 17 points.
const POINT_STRIDE: usize = 16;

/// Reads an `MRIcroGL` colour table: nodes with a position of 0 … 255 and red, green, blue and opacity as bytes.
pub(crate) fn from_clut(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let entry = |key: &str| {
        text.lines().find_map(|line| {
            let (name, value) = line.split_once('=')?;
            name.trim().eq_ignore_ascii_case(key).then(|| value.trim())
        })
    };
    let number = |key: &str| entry(key).and_then(|value| value.parse().ok()).filter(|n: &f64| n.is_finite());
    let count = number("numnodes").filter(|count| (2.0..=TABLE_ENTRIES as f64).contains(count));
    let count = count.ok_or_else(|| format_error("numnodes must be a number from 2 to 256"))? as usize;
    // Zeros stand for the range of the volume.
    let ends = number("min").zip(number("max")).and_then(|(low, high)| ValueRange::non_degenerate(low, high));
    let range = ends.unwrap_or(range);
    let mut points = Vec::with_capacity(count);
    for node in 0..count {
        let place = number(&format!("nodeintensity{node}"));
        let place = place.ok_or_else(|| format_error(&format!("nodeintensity{node} is missing")))?;
        let rgba: Option<Vec<f64>> = entry(&format!("nodergba{node}"))
            .map(|value| value.split('|').map_while(|part| part.trim().parse().ok()).collect());
        let Some(&[r, g, b, a]) = rgba.as_deref() else {
            return Err(format_error(&format!("nodergba{node} must be four numbers separated by |")));
        };
        let share = |byte: f64| (byte / 255.0).clamp(0.0, 1.0);
        points.push(ControlPoint::new(
            range.value_at(share(place)),
            rgb_from_fractions(&[r, g, b].map(share)),
            share(a),
        ));
    }
    Ok(TransferFunction { points, ..TransferFunction::default() })
}

/// Writes an `MRIcroGL` colour table. Positions are bytes, so that points closer than that coincide.
pub(crate) fn to_clut(function: &TransferFunction, range: ValueRange) -> String {
    let ends = function.points.first().zip(function.points.last());
    let range = ends.and_then(|(a, b)| ValueRange::non_degenerate(a.value, b.value)).unwrap_or(range);
    let byte = |share: f64| (share * 255.0).round().clamp(0.0, 255.0) as u8;
    let mut nodes: Vec<(u8, [u8; 4])> = Vec::new();
    for ControlPoint { value, color, opacity, easing: _ } in &function.points {
        let [r, g, b] = color.map(|c| byte(f64::from(c)));
        // Positions must ascend: a jump takes two adjacent ones, at the end the last two.
        let mut place = byte(range.share_of(*value));
        if let Some(last) = nodes.last().map(|last| last.0).filter(|last| place <= *last) {
            place = last.saturating_add(1);
            if last == u8::MAX {
                nodes.retain(|node| node.0 != u8::MAX - 1);
                nodes.iter_mut().filter(|node| node.0 == u8::MAX).for_each(|node| node.0 -= 1);
            }
        }
        nodes.push((place, [r, g, b, byte(*opacity)]));
    }
    // A table needs two nodes or more.
    if let [(0..=254, color)] = nodes[..] {
        nodes.push((u8::MAX, color));
    }
    let mut text =
        format!("[FLT]\nmin={}\nmax={}\n[INT]\nnumnodes={}\n[BYT]\n", range.low, range.high, nodes.len());
    for (at, (place, _)) in nodes.iter().enumerate() {
        // Writing to a string cannot fail.
        writeln!(text, "nodeintensity{at}={place}").ok();
    }
    text.push_str("[RGBA255]\n");
    for (at, (_, [r, g, b, a])) in nodes.iter().enumerate() {
        writeln!(text, "nodergba{at}={r}|{g}|{b}|{a}").ok();
    }
    text
}

/// Reads an `ImageJ` colour table: 256 reds, 256 greens and 256 blues, optionally after a header.
pub(crate) fn from_binary_lut(bytes: &[u8], range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let first = bytes
        .len()
        .checked_sub(3 * TABLE_ENTRIES)
        .ok_or_else(|| format_error("a table must have 768 bytes"))?;
    let table = &bytes[first..];
    let colors: Vec<_> = (0..TABLE_ENTRIES)
        .map(|at| [table[at], table[at + TABLE_ENTRIES], table[at + 2 * TABLE_ENTRIES]])
        .collect();
    Ok(ramp_from_colors(&colors, range))
}

/// Reads an `ImageJ` colour table in text form: rows of red, green and blue, optionally after the entry's index.
pub(crate) fn from_text_lut(text: &str, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let row = |line: &str| {
        let numbers: Option<Vec<u8>> = line
            .split([' ', '\t', ','])
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().ok())
            .collect();
        let numbers = numbers?;
        let first = numbers.len().checked_sub(3)?;
        (first <= 1).then(|| [numbers[first], numbers[first + 1], numbers[first + 2]])
    };
    // Lines that are not numbers, such as a heading, are skipped.
    let colors: Vec<[u8; 3]> = text.lines().filter_map(row).collect();
    if colors.len() != TABLE_ENTRIES {
        return Err(format_error(&format!(
            "{} rows of three bytes were found, a table must have 256",
            colors.len()
        )));
    }
    Ok(ramp_from_colors(&colors, range))
}

/// Builds a transfer function with the table's colours over a range and a linear opacity ramp.
fn ramp_from_colors(colors: &[[u8; 3]], range: ValueRange) -> TransferFunction {
    let last = colors.len() - 1;
    let point = |at: usize| {
        let share = at as f64 / last as f64;
        let color = colors[at].map(|byte| f32::from(byte) / 255.0);
        ControlPoint::new(range.value_at(share), color, share)
    };
    let places = (0..last).step_by(POINT_STRIDE).chain([last]);
    TransferFunction { points: places.map(point).collect(), ..TransferFunction::default() }
}

/// Writes 256 colours as bytes: all reds, all greens, all blues. The format has no opacities.
pub(crate) fn to_lut(function: &TransferFunction, range: ValueRange) -> Vec<u8> {
    let last = (TABLE_ENTRIES - 1) as f64;
    let colors: Vec<[f64; 3]> = (0..TABLE_ENTRIES)
        .map(|at| function.sample(range.low + range.span() * at as f64 / last).color)
        .collect();
    let byte = |linear: f64| (srgb_from_linear(linear) * 255.0).round().clamp(0.0, 255.0) as u8;
    (0..3).flat_map(|channel| colors.iter().map(move |color| byte(color[channel]))).collect()
}
