//! The status bar: what is shown, on what, how fast, and what is being done.

use eframe::egui::{self, ProgressBar, RichText};

use super::commands::Command;
use super::messages::Messages;
use super::theme;
use super::viewport::{Doing, Facts};

/// Opening a volume: what, the phase, and the share that is done.
pub(super) type Opening<'a> = (&'a str, &'static str, Option<f32>);

/// Shows the bar.
pub(super) fn show(
    ui: &mut egui::Ui,
    facts: &Facts,
    opening: Option<Opening<'_>>,
    messages: &mut Messages,
    commands: &mut Vec<Command>,
) {
    egui::Panel::bottom("status").resizable(false).show(ui, |ui| {
        ui.horizontal(|ui| {
            if let Some((source, phase, fraction)) = opening {
                let bar = ProgressBar::new(fraction.unwrap_or(0.0)).desired_width(120.0).desired_height(8.0);
                ui.add(bar.animate(fraction.is_none()));
                ui.label(format!("{phase} {source}"));
                if ui.small_button("Cancel").clicked() {
                    commands.push(Command::CancelOpening);
                }
            } else {
                doing(ui, facts.doing);
            }
            messages.ui(ui);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.add(egui::Label::new(figures(facts)).truncate()).on_hover_text(&facts.driver);
            });
        });
    });
}

fn doing(ui: &mut egui::Ui, doing: Doing) {
    match doing {
        Doing::Nothing => ui.weak("no volume"),
        Doing::FullQuality => ui.label("full quality"),
        Doing::Preview => ui.label(RichText::new("preview").color(theme::accent(ui.visuals()))),
        Doing::Refining(what, share) => {
            let bar = ProgressBar::new(share).desired_width(80.0).desired_height(8.0);
            ui.add(bar.fill(theme::ACCENT));
            ui.label(format!("refining {:.0} %, {what}", share * 100.0))
        }
        Doing::Failed => ui.label(RichText::new("not rendered").color(ui.visuals().error_fg_color)),
        Doing::Lost => ui.label(RichText::new("graphics device lost").color(ui.visuals().error_fg_color)),
    };
}

fn figures(facts: &Facts) -> RichText {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), |ms| format!("{ms:.0} ms"));
    let software = if facts.software { " (software)" } else { "" };
    let splats = if facts.splats > 0 {
        format!("{:.1} million splats · ", facts.splats as f64 * 1e-6)
    } else {
        String::new()
    };
    RichText::new(format!(
        "{splats}full {} · preview {} · light volumes {} cached, {} filled · {:.0} MiB · {}{software}",
        ms(facts.full_ms),
        ms(facts.preview_ms),
        facts.cached_light_volumes,
        facts.light_rebuilds,
        facts.gpu_mebibytes,
        facts.adapter,
    ))
    .weak()
}
