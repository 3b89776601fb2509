//! Value range rows of the section "Data": the values that densities 0 and 1 stand for.

use eframe::egui::{self, Ui};

use super::super::controls::{choice_row, format_number, row, unlabelled_row};
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{DensityRange, Settings};
use chiaroscuro_volume::{ValueRange, ValueRanges};

/// Share of the span by which a drag of one point moves an end: 500 points, which fit in every window, cover the
/// span.
const DRAG_SPEED: f64 = 1.0 / 500.0;

/// Smallest distance between the ends of a typed range, as a share of the robust range: one of 65 536 densities, the
/// steps of 16 bits.
const MIN_SPAN_SHARE: f64 = 1.0 / 65_536.0;

/// Shows the rows of the value range: choice, typed ends, and result.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, volume: &VolumeFacts) {
    let chosen = &mut settings.layer_at_mut(volume.layer).range;
    let typed = match *chosen {
        DensityRange::Typed(range) => range,
        DensityRange::Robust | DensityRange::Full => chosen.resolve(&volume.ranges),
    };
    let options = [
        (DensityRange::Robust, text::data::ROBUST),
        (DensityRange::Full, text::data::FULL),
        (DensityRange::Typed(typed), text::data::TYPED_RANGE),
    ];
    choice_row(ui, text::data::RANGE, chosen, &options);
    if let DensityRange::Typed(range) = chosen {
        unlabelled_row(ui, |ui| range_end_fields(ui, range, volume));
    }
    let ValueRange { low, high } = settings.layer_at(volume.layer).shown_range(&volume.ranges, None);
    let all = volume.ranges.all;
    let shown =
        text::data::range_shown(&[low, high].map(format_number), &[all.low, all.high].map(format_number));
    row(ui, ControlText { name: text::data::SHOWN, tooltip: "" }, |ui| {
        ui.add(egui::Label::new(shown).truncate())
    });
}

/// Shows the two ends of a typed range; each is limited by the other, so that they stay in order and apart.
fn range_end_fields(ui: &mut Ui, range: &mut ValueRange, volume: &VolumeFacts) {
    let speed = volume.ranges.robust.span().max(range.span()).max(f64::MIN_POSITIVE) * DRAG_SPEED;
    let RangeLimits { max_low: most_low, min_high: least_high } = RangeLimits::new(*range, volume.ranges);
    for (end, limits, named) in [
        (&mut range.low, f64::MIN..=most_low, text::data::LOW),
        (&mut range.high, least_high..=f64::MAX, text::data::HIGH),
    ] {
        // A value from a file stays until the user changes it.
        let field = egui::DragValue::new(end).speed(speed).max_decimals(6);
        let field = field.range(limits).clamp_existing_to_range(false);
        ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip);
    }
}

/// Limits of the ends of a typed range.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RangeLimits {
    max_low: f64,
    min_high: f64,
}

impl RangeLimits {
    /// Computes the limits of a range's ends, for a volume with these values.
    fn new(range: ValueRange, ranges: ValueRanges) -> Self {
        let least = ranges.robust.span().max(f64::MIN_POSITIVE) * MIN_SPAN_SHARE;
        // Next to large numbers the difference may round to 0.
        let most_low = (range.high - least).min(range.high.next_down());
        let least_high = (range.low + least).max(range.low.next_up());
        Self { max_low: most_low, min_high: least_high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_stay_apart() {
        for (low, high) in [(0.0, 10.0), (-1000.0, 3000.0), (0.0, 0.0), (1e17, 1e17 + 32.0), (-1e300, 1e300)]
        {
            let range = ValueRange::new(low, high);
            for ranges in [ValueRanges::UNIT, ValueRanges::without_outliers(range)] {
                let RangeLimits { max_low: most_low, min_high: least_high } = RangeLimits::new(range, ranges);
                assert!(most_low < high && low < least_high, "{low} {high}: {most_low} {least_high}");
            }
        }
        let ends = RangeLimits::new(
            ValueRange::new(0.0, 10.0),
            ValueRanges::without_outliers(ValueRange::new(0.0, 65_536.0)),
        );
        assert_eq!(ends, RangeLimits { max_low: 9.0, min_high: 1.0 });
    }
}
