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
    /// Its section and what is folded away in it have been told to open.
    has_opened: [bool; 2],
}

fn id() -> Id {
    Id::unique("revealed")
}

fn now_s(ctx: &egui::Context) -> f64 {
    ctx.input(|input| input.time)
}

/// Begins to show a place.
pub(crate) fn reveal(ctx: &egui::Context, place: Place) {
    let shown = Shown { place, since_s: now_s(ctx), has_opened: [false; 2] };
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    ctx.request_repaint();
}

fn shown(ctx: &egui::Context) -> Option<Shown> {
    let shown: Shown = ctx.data(|data| data.get_temp(id()))?;
    (now_s(ctx) - shown.since_s < GLOW_S).then_some(shown)
}

/// Whether a section, or what is folded away in it, is to open now; says so once.
pub(in crate::app) fn opens(ctx: &egui::Context, section: &str, is_advanced: bool) -> bool {
    let Some(mut shown) = shown(ctx).filter(|shown| shown.place.section == section) else { return false };
    let opened = &mut shown.has_opened[usize::from(is_advanced)];
    if *opened || is_advanced && !shown.place.is_advanced {
        return false;
    }
    *opened = true;
    ctx.data_mut(|data| data.insert_temp(id(), shown));
    true
}

/// Whether a section as a whole is being scrolled to.
pub(in crate::app) fn is_led_to(ctx: &egui::Context, section: &str) -> bool {
    shown(ctx).is_some_and(|shown| {
        let Place { section: wanted, row, .. } = shown.place;
        wanted == section && row.is_none() && now_s(ctx) - shown.since_s < SCROLL_S
    })
}

/// Lets a row glow, if it is that which is shown.
pub(in crate::app) fn glow(ui: &Ui, section: &str, row: &str, area: Rect) {
    let ctx = ui.ctx();
    let Some(shown) = shown(ctx) else { return };
    if shown.place.section != section || shown.place.row != Some(row) {
        return;
    }
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
