//! All texts of the window in one place, for proofreading and translation.
//!
//! One file per part of the window. Plain texts are constants; texts with figures in them are functions, because
//! other languages put the figures elsewhere. Fonts and colours are chosen where a text is shown. The names of
//! presets, colour maps, views and light rigs are with these in `crates/scene/src`; errors have their messages where
//! they are defined.

pub(super) mod common;
pub(super) mod dock;
pub(super) mod history;
pub(super) mod materials;
mod panels;
pub(super) mod saved_views;
mod shell;
pub(super) mod thread_errors;
pub(super) mod transfer;
mod viewport;
mod windows;

pub(super) use self::panels::{
    camera, corrections, cuts, data, floor, labels, lights, sampling, scattering, sections, shading, shadows,
    sky, synonyms,
};
pub(super) use self::shell::{
    change_descriptions, commands, menu, messages, opening, persistence, start_screen, status,
};
pub(super) use self::viewport::{comparison, cut_handles, picture, probe, time_series};
pub(super) use self::windows::{
    chooser, contact_sheet, export, files, foreign_path, help, large_volume, light_volume, palette_synonyms,
    raw, slices,
};

/// Name of a control, with its tooltip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ControlText {
    /// Label beside or on the control; also its accessible name for screen readers.
    pub name: &'static str,
    /// Tooltip: a sentence without a full stop.
    pub tooltip: &'static str,
}

/// Makes a [`ControlText`] in a constant expression.
const fn control_text(name: &'static str, tip: &'static str) -> ControlText {
    ControlText { name, tooltip: tip }
}
