//! Revealing of a setting: its section opens, the panel scrolls to its row, and the row glows for a moment.

use std::collections::BTreeMap;

use eframe::egui::{self, Align, Id, Rect, Ui};

use super::theme;

/// Location of a setting in the panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SettingPlace {
    /// Title of the setting's section.
    pub section: &'static str,
    /// Name of the setting's row; `None` for the section as a whole.
    pub row: Option<&'static str>,
    /// True if the row is in the advanced part of its section, which is collapsed at first.
    pub is_advanced: bool,
}

/// Duration for which a revealed row glows, in seconds.
const GLOW_S: f64 = 2.0;
/// Number of passes at the same position after which scrolling has finished: one finds the destination, and the next
/// moves there.
const PASSES_AT_REST: u8 = 3;
/// Movement between passes from which scrolling has not finished, in points.
const MOVEMENT_TOLERANCE: f32 = 0.5;

/// Place that is being revealed, with its progress.
#[derive(Debug, Clone, Copy)]
struct RevealState {
    place: SettingPlace,
    since_s: f64,
    /// Passes in which the section and its advanced part were told to open.
    opened: [Option<u64>; 2],
    /// Last pass in which an advanced part of the section was shown.
    unfolded: Option<u64>,
    /// Last pass in which the row was shown.
    seen: Option<u64>,
    way: ScrollProgress,
}

/// Progress of scrolling to a place. It is counted in passes, not in time: where frames are slow, few of them fit
/// into the seconds in which a fast window arrives.
#[derive(Debug, Clone, Copy, Default)]
struct ScrollProgress {
    /// Upper edge of the place in the previous pass, in points of the window.
    top: f32,
    /// Number of passes since without movement.
    at_rest: u8,
    has_begun: bool,
}

impl ScrollProgress {
    const END: Self = Self { top: 0.0, at_rest: PASSES_AT_REST, has_begun: true };

    fn is_over(self) -> bool {
        self.at_rest >= PASSES_AT_REST
    }

    /// Continues scrolling to an area. `may_rest`: the layout around it is not animated. Scrolling by the user's
    /// wheel ends it.
    fn advance(self, ui: &Ui, area: Rect, align: Align, may_rest: bool) -> Self {
        let is_wheel = |event: &egui::Event| matches!(event, egui::Event::MouseWheel { .. });
        let is_left = self.has_begun && ui.input(|input| input.events.iter().any(is_wheel));
        if self.is_over() || is_left {
            return Self::END;
        }
        ui.scroll_to_rect(area, Some(align));
        ui.ctx().request_repaint();
        let rests = self.has_begun && may_rest && (area.top() - self.top).abs() < MOVEMENT_TOLERANCE;
        Self { top: area.top(), at_rest: if rests { self.at_rest + 1 } else { 0 }, has_begun: true }
    }
}

fn id() -> Id {
    Id::unique("revealed")
}

fn now_s(ctx: &egui::Context) -> f64 {
    ctx.input(|input| input.time)
}

/// Starts to reveal a place.
pub(crate) fn reveal(ctx: &egui::Context, place: SettingPlace) {
    let way = ScrollProgress::default();
    let shown =
        RevealState { place, since_s: now_s(ctx), opened: [None; 2], unfolded: None, seen: None, way };
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    ctx.request_repaint();
}

fn shown(ctx: &egui::Context) -> Option<RevealState> {
    let shown: RevealState = ctx.data(|data| data.get_temp(id()))?;
    (now_s(ctx) - shown.since_s < GLOW_S || !shown.way.is_over()).then_some(shown)
}

/// Returns true if a section, or an advanced part of it, is to open now. It does so during one pass: a section can
/// have several advanced parts, and any of them may hold the row.
pub(crate) fn should_open(ctx: &egui::Context, section: &str, is_advanced: bool) -> bool {
    let Some(mut shown) = shown(ctx).filter(|shown| shown.place.section == section) else { return false };
    if is_advanced && !shown.place.is_advanced {
        return false;
    }
    let pass = ctx.cumulative_pass_nr();
    if is_advanced {
        shown.unfolded = Some(pass);
    }
    let opened = *shown.opened[usize::from(is_advanced)].get_or_insert(pass);
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    opened == pass
}

/// Scrolls to the title of a section, if the section as a whole is revealed, or if the row is not there because it
/// belongs to a feature that is off. `is_open`: the section has its full height. Returns true while it is being
/// scrolled to.
pub(crate) fn scroll_to_section(ui: &Ui, section: &str, title: Rect, is_open: bool) -> bool {
    let ctx = ui.ctx();
    report_area(ctx, title, || section.to_owned());
    let Some(mut shown) = shown(ctx).filter(|shown| shown.place.section == section) else { return false };
    let is_row_there = shown.seen == Some(ctx.cumulative_pass_nr());
    if is_row_there || shown.way.is_over() {
        return false;
    }
    shown.way = shown.way.advance(ui, title, Align::TOP, is_open);
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    true
}

/// Scrolls to a row and lets it glow, while it is being revealed.
pub(crate) fn highlight_row(ui: &Ui, section: &str, row: &str, area: Rect) {
    let ctx = ui.ctx();
    report_area(ctx, area, || format!("{section}/{row}"));
    let Some(mut shown) = shown(ctx) else { return };
    if shown.place.section != section || shown.place.row != Some(row) {
        return;
    }
    let pass = Some(ctx.cumulative_pass_nr());
    if shown.place.is_advanced && shown.unfolded != pass {
        // Another row of that name, above the advanced part.
        return;
    }
    shown.seen = pass;
    shown.way = shown.way.advance(ui, area, Align::Center, true);
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    let age = now_s(ctx) - shown.since_s;
    let strength = (1.0 - age / GLOW_S).max(0.0) as f32;
    ui.painter().rect_filled(area.expand(3.0), 4.0, theme::ACCENT.gamma_multiply(0.35 * strength));
    ctx.request_repaint();
}

/// Reveals a section if its feature was switched on.
pub(crate) fn show_section(ctx: &egui::Context, section: &'static str, is_on: bool) {
    if is_on {
        reveal(ctx, SettingPlace { section, row: None, is_advanced: false });
    }
}

/// Areas of the panel's parts in one pass, in points of the window: by section, by section and row (`Data/Spacing`),
/// and by the names of buttons.
#[derive(Debug, Clone, Default)]
struct ReportedAreas {
    pass: u64,
    areas: BTreeMap<String, Rect>,
}

fn reported_id() -> Id {
    Id::unique("reported places")
}

/// Records the area of a part of the panel, for the status file.
pub(crate) fn report_area(ctx: &egui::Context, area: Rect, name: impl FnOnce() -> String) {
    let pass = ctx.cumulative_pass_nr();
    ctx.data_mut(|data| {
        // Absent unless the status file is in use.
        let Some(mut reported) = data.get_temp::<ReportedAreas>(reported_id()) else { return };
        if reported.pass != pass {
            reported = ReportedAreas { pass, ..ReportedAreas::default() };
        }
        reported.areas.insert(name(), area);
        data.insert_temp(reported_id(), reported);
    });
}

/// Returns the areas recorded in this pass; the first call returns none and starts the recording.
pub(crate) fn reported_areas(ctx: &egui::Context) -> BTreeMap<String, Rect> {
    let reported: ReportedAreas =
        ctx.data_mut(|data| data.get_temp_mut_or_default::<ReportedAreas>(reported_id()).clone());
    reported.areas
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTION: &str = "Data";
    const ROW: &str = "Spacing";

    /// Reveals a row in an advanced part, and runs two passes.
    fn run(mut pass: impl FnMut(&mut Ui)) {
        let ctx = egui::Context::default();
        reveal(&ctx, SettingPlace { section: SECTION, row: Some(ROW), is_advanced: true });
        for _ in 0..2 {
            let mut output = ctx.run_ui(egui::RawInput::default(), &mut pass);
            output.textures_delta.clear();
        }
    }

    #[test]
    fn all_that_is_folded_away_in_a_section_opens_once() {
        let mut opened = Vec::new();
        run(|ui| {
            assert!(!should_open(ui.ctx(), "Lights", false), "another section stays as it is");
            opened.push([false, true, true].map(|is_advanced| should_open(ui.ctx(), SECTION, is_advanced)));
        });
        assert_eq!(opened, [[true; 3], [false; 3]]);
    }

    #[test]
    fn a_row_that_is_folded_away_is_told_from_one_of_its_name_above() {
        run(|ui| {
            highlight_row(ui, SECTION, ROW, Rect::ZERO);
            let is_led_to = |ui: &Ui| scroll_to_section(ui, SECTION, Rect::ZERO, true);
            assert!(is_led_to(ui), "the section is, as long as its row is not there");
            should_open(ui.ctx(), SECTION, true);
            highlight_row(ui, SECTION, ROW, Rect::ZERO);
            assert!(!is_led_to(ui));
        });
    }
}
