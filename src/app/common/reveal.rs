//! Showing where something is set: its section opens, and its row comes into sight and glows for a moment.

use eframe::egui::{self, Align, Id, Rect, Ui};

use super::theme;

/// Where something is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    /// The title of its section.
    pub section: &'static str,
    /// The name of its row; none for the section as a whole.
    pub row: Option<&'static str>,
    /// It is among what is folded away there.
    pub is_advanced: bool,
}

/// Seconds that a row glows.
const GLOW_S: f64 = 2.0;
/// Seconds during which it is scrolled to: as long as sections take to open.
const SCROLL_S: f64 = 0.5;

/// What is being shown.
#[derive(Debug, Clone, Copy)]
struct Shown {
    place: Place,
    since_s: f64,
    /// The passes in which its section, and what is folded away in it, were told to open.
    opened: [Option<u64>; 2],
    /// The last pass that has come to what is folded away in its section.
    unfolded: Option<u64>,
    /// The last pass in which its row was there.
    seen: Option<u64>,
}

fn id() -> Id {
    Id::unique("revealed")
}

fn now_s(ctx: &egui::Context) -> f64 {
    ctx.input(|input| input.time)
}

/// Begins to show a place.
pub(crate) fn reveal(ctx: &egui::Context, place: Place) {
    let shown = Shown { place, since_s: now_s(ctx), opened: [None; 2], unfolded: None, seen: None };
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    ctx.request_repaint();
}

fn shown(ctx: &egui::Context) -> Option<Shown> {
    let shown: Shown = ctx.data(|data| data.get_temp(id()))?;
    (now_s(ctx) - shown.since_s < GLOW_S).then_some(shown)
}

/// Whether a section, or what is folded away in it, is to open now. Says so during one pass: a section can have several
/// parts that are folded away, and any of them may hold the row.
pub(in crate::app) fn opens(ctx: &egui::Context, section: &str, is_advanced: bool) -> bool {
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

/// Whether a section as a whole is being scrolled to: also where the row that is sought in it is not there, since it
/// belongs to something that is off.
pub(in crate::app) fn is_led_to(ctx: &egui::Context, section: &str) -> bool {
    shown(ctx).is_some_and(|shown| {
        let is_row_there = shown.seen == Some(ctx.cumulative_pass_nr());
        shown.place.section == section && !is_row_there && now_s(ctx) - shown.since_s < SCROLL_S
    })
}

/// Lets a row glow, if it is that which is shown.
pub(in crate::app) fn glow(ui: &Ui, section: &str, row: &str, area: Rect) {
    let ctx = ui.ctx();
    let Some(mut shown) = shown(ctx) else { return };
    if shown.place.section != section || shown.place.row != Some(row) {
        return;
    }
    let pass = Some(ctx.cumulative_pass_nr());
    if shown.place.is_advanced && shown.unfolded != pass {
        // Another row of that name, above what is folded away.
        return;
    }
    shown.seen = pass;
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    let age = now_s(ctx) - shown.since_s;
    if age < SCROLL_S {
        ui.scroll_to_rect(area, Some(Align::Center));
    }
    let strength = (1.0 - age / GLOW_S) as f32;
    ui.painter().rect_filled(area.expand(3.0), 4.0, theme::ACCENT.gamma_multiply(0.35 * strength));
    ctx.request_repaint();
}

/// Opens a section and brings it into sight, if what it is about was switched on.
pub(crate) fn show_section(ctx: &egui::Context, section: &'static str, is_on: bool) {
    if is_on {
        reveal(ctx, Place { section, row: None, is_advanced: false });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTION: &str = "Data";
    const ROW: &str = "Spacing";

    /// Begins to show a row that is folded away, and runs two passes.
    fn run(mut pass: impl FnMut(&mut Ui)) {
        let ctx = egui::Context::default();
        reveal(&ctx, Place { section: SECTION, row: Some(ROW), is_advanced: true });
        for _ in 0..2 {
            let mut output = ctx.run_ui(egui::RawInput::default(), &mut pass);
            output.textures_delta.clear();
        }
    }

    #[test]
    fn all_that_is_folded_away_in_a_section_opens_once() {
        let mut opened = Vec::new();
        run(|ui| {
            assert!(!opens(ui.ctx(), "Lights", false), "another section stays as it is");
            opened.push([false, true, true].map(|is_advanced| opens(ui.ctx(), SECTION, is_advanced)));
        });
        assert_eq!(opened, [[true; 3], [false; 3]]);
    }

    #[test]
    fn a_row_that_is_folded_away_is_told_from_one_of_its_name_above() {
        run(|ui| {
            glow(ui, SECTION, ROW, Rect::ZERO);
            assert!(is_led_to(ui.ctx(), SECTION), "the section is, as long as its row is not there");
            opens(ui.ctx(), SECTION, true);
            glow(ui, SECTION, ROW, Rect::ZERO);
            assert!(!is_led_to(ui.ctx(), SECTION));
        });
    }
}
