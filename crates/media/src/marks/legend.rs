//! Legend of a picture: a colour bar with values, or the colours of labels.

use super::layer::{INK, MarksLayer, OUTLINE_INK};
use chiaroscuro_scene::{Settings, srgb_from_linear};
use chiaroscuro_volume::Volume;

/// Height of the colour bar, relative to the picture's height.
const BAR_HEIGHT: f64 = 0.4;

/// Maximum number of labels in the legend, so that it stays small beside the picture.
const MAX_LABELS: usize = 12;

/// Minimum number of ticks beside the colour bar.
const MIN_TICKS: f64 = 4.0;

/// Opacity below which values and labels count as invisible, and are left out of the legend.
const MIN_OPACITY: f64 = 0.005;

/// Draws the legend at the right of a picture.
pub(super) fn draw(
    layer: &mut MarksLayer,
    settings: &Settings,
    volume: &Volume,
    size: [f64; 2],
    letters: f64,
) {
    if settings.layer().labels.is_empty() {
        draw_value_legend(layer, settings, volume, size, letters);
    } else {
        draw_label_legend(layer, settings, volume, size, letters);
    }
}

fn srgb_bytes(srgb: [f64; 3]) -> [u8; 3] {
    srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// Returns the range of visible values: from the first to the last whose opacity exceeds the threshold.
fn visible_range(settings: &Settings, volume: &Volume) -> Option<[f64; 2]> {
    let range = settings.shown_range(&volume.ranges());
    const STEPS: usize = 1024;
    let value = |at: usize| range.low + range.span() * at as f64 / STEPS as f64;
    let is_seen = |at: &usize| settings.layer().transfer.opacity_at(value(*at)) > MIN_OPACITY;
    let first = (0..=STEPS).find(is_seen)?;
    let last = (0..=STEPS).rfind(is_seen)?;
    (last > first).then(|| [value(first), value(last)])
}

/// Round numbers on a scale.
#[derive(Debug, PartialEq)]
struct ScaleTicks {
    values: Vec<f64>,
    /// Number of decimals with which the values are written.
    decimals: usize,
}

/// Returns round numbers between two values.
fn ticks([low, high]: [f64; 2]) -> ScaleTicks {
    let rough = (high - low) / MIN_TICKS;
    let power = 10f64.powf(rough.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= rough).unwrap_or(1.0) * power;
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    // Bounded: a step exceeds a tenth of a quarter of the range.
    let values = (first..=last.min(first + 50)).map(|at| at as f64 * step).collect();
    ScaleTicks { values, decimals }
}

fn draw_value_legend(
    layer: &mut MarksLayer,
    settings: &Settings,
    volume: &Volume,
    [width, height]: [f64; 2],
    letters: f64,
) {
    let Some([low, high]) = visible_range(settings, volume) else { return };
    let (tall, wide) = ((height * BAR_HEIGHT).round(), (letters * 0.9).round());
    let ScaleTicks { values: numbers, decimals } = ticks([low, high]);
    let text = |value: &f64| match decimals {
        // Fixed notation would show nothing but zeros.
        9.. => format!("{value:.1e}"),
        _ => format!("{value:.decimals$}"),
    };
    let texts: Vec<String> = numbers.iter().map(text).collect();
    let longest = texts.iter().map(|text| MarksLayer::width(text, letters)).fold(0.0, f64::max);
    let left = (width - letters - longest - letters * 0.5 - wide).round();
    let top = ((height - tall) / 2.0).round();
    let edge = (letters / 12.0).round().max(1.0);
    layer.fill([left - edge, top - edge], [wide + 2.0 * edge, tall + 2.0 * edge], OUTLINE_INK, 255);
    for row in 0..tall as usize {
        let value = high - (high - low) * (row as f64 + 0.5) / tall;
        let linear = settings.layer().transfer.sample(value).color;
        layer.fill([left, top + row as f64], [wide, 1.0], srgb_bytes(linear.map(srgb_from_linear)), 255);
    }
    for (value, text) in numbers.iter().zip(&texts) {
        let y = top + tall * (high - value) / (high - low);
        layer.fill([left + wide, y - edge / 2.0], [letters * 0.3, edge], INK, 255);
        layer.write(text, [left + wide + letters * 0.5, y], [0.0, 0.5], letters);
    }
}

fn draw_label_legend(
    layer: &mut MarksLayer,
    settings: &Settings,
    volume: &Volume,
    [width, height]: [f64; 2],
    letters: f64,
) {
    let in_file = &volume.metadata().labels;
    let rows: Vec<(String, [u8; 3])> = settings
        .layer()
        .labels
        .iter()
        .filter(|(_, look)| look.effective_opacity() > MIN_OPACITY)
        .map(|(number, look)| {
            let own = Some(look.name.as_str()).filter(|name| !name.is_empty());
            let known = own.or_else(|| in_file.get(number).map(|label| label.name.as_str()));
            let name =
                known.filter(|name| !name.is_empty()).map_or_else(|| number.to_string(), str::to_owned);
            (name, srgb_bytes(look.color.map(f64::from)))
        })
        .collect();
    let named = rows.len().min(MAX_LABELS);
    let more = rows.len() - named;
    let mut rows: Vec<_> = rows.into_iter().take(named).map(|(name, ink)| (name, Some(ink))).collect();
    if more > 0 {
        rows.push((format!("and {more} more"), None));
    }
    let longest =
        rows.iter().map(|(name, _)| MarksLayer::width(name, letters)).fold(0.0, f64::max).min(width / 3.0);
    let step = letters * 1.35;
    let left = width - letters - longest - letters * 1.4;
    let top = (height - step * rows.len() as f64) / 2.0;
    let edge = (letters / 12.0).round().max(1.0);
    for (at, (mut name, ink)) in rows.into_iter().enumerate() {
        let y = top + step * at as f64;
        if let Some(ink) = ink {
            layer.fill(
                [left - edge, y - edge],
                [letters + 2.0 * edge, letters + 2.0 * edge],
                OUTLINE_INK,
                255,
            );
            layer.fill([left, y], [letters, letters], ink, 255);
        }
        while MarksLayer::width(&name, letters) > longest.max(1.0) && name.pop().is_some() {}
        layer.write(&name, [left + letters * 1.4, y + letters / 2.0], [0.0, 0.5], letters);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let values = vec![0.0, 50.0, 100.0, 150.0, 200.0, 250.0];
        assert_eq!(ticks([0.0, 255.0]), ScaleTicks { values, decimals: 0 });
        assert_eq!(ticks([-1000.0, 3000.0]).values, [-1000.0, 0.0, 1000.0, 2000.0, 3000.0]);
        let ScaleTicks { values: fine, decimals } = ticks([0.113, 0.147]);
        assert_eq!((fine.len(), decimals), (7, 3), "{fine:?}");
    }
}
