//! The window that asks how a file of bare voxels is stored.

use std::path::{Path, PathBuf};

use eframe::egui::{self, DragValue, Ui};

use crate::app::text;
use crate::data::VoxelType;
use crate::data::load::{Endian, RawGuess, RawLayout};

/// The longest edge that can be typed.
const LONGEST: usize = 65_536;

/// What the user said.
#[derive(Debug)]
pub(crate) struct Described {
    /// The file.
    pub path: PathBuf,
    /// How it is stored.
    pub layout: RawLayout,
    /// Where to write a header that says so, if the user asks for it.
    pub header: Option<PathBuf>,
    /// Whether the file is compressed.
    pub is_gzip: bool,
}

#[derive(Debug)]
struct Form {
    path: PathBuf,
    why: String,
    guess: RawGuess,
    layout: RawLayout,
    /// Where a header may be written; none if there is one already.
    header: Option<PathBuf>,
    keep: bool,
}

/// State of the window.
#[derive(Debug, Default)]
pub(crate) struct RawDialog {
    form: Option<Form>,
}

impl RawDialog {
    /// Asks about a file; `why` says what is not known.
    pub(crate) fn ask(&mut self, path: &Path, why: String, guess: RawGuess) {
        let header = Some(header_of(path)).filter(|header| !header.exists());
        let keep = header.is_some();
        self.form = Some(Form { path: path.to_owned(), why, layout: guess.layout, guess, header, keep });
    }

    /// Shows the window, if it is open. Gives what the user said, once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<Described> {
        let form = self.form.as_mut()?;
        let (mut open, mut accepted, mut cancelled) = (true, false, false);
        let window = egui::Window::new(text::raw::TITLE).open(&mut open).collapsible(false).resizable(false);
        window.default_pos([140.0, 90.0]).show(ctx, |ui| {
            ui.set_max_width(420.0);
            let name = form.path.file_name().unwrap_or_default().to_string_lossy();
            ui.strong(name);
            ui.weak(&form.why);
            ui.add_space(4.0);
            form.fields(ui);
            ui.add_space(4.0);
            let fits = form.length(ui);
            if let Some(header) = &form.header {
                let header = header.file_name().unwrap_or_default().to_string_lossy();
                let switch = ui.checkbox(&mut form.keep, text::raw::remember(&header));
                switch.on_hover_text(text::raw::REMEMBER_TIP);
            }
            ui.horizontal(|ui| {
                accepted = ui.add_enabled(fits, egui::Button::new(text::raw::OPEN)).clicked();
                cancelled = ui.button(text::common::CANCEL).clicked();
            });
        });
        let described = accepted.then(|| Described {
            path: form.path.clone(),
            layout: form.layout,
            header: form.header.clone().filter(|_| form.keep),
            is_gzip: form.guess.is_gzip,
        });
        if described.is_some() || cancelled || !open {
            self.form = None;
        }
        described
    }
}

impl Form {
    fn fields(&mut self, ui: &mut Ui) {
        let layout = &mut self.layout;
        egui::Grid::new("raw layout").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
            ui.label(text::raw::VOXELS);
            ui.horizontal(|ui| {
                for (axis, n) in text::raw::AXES.into_iter().zip(&mut layout.dims) {
                    ui.name_inputs(text::raw::voxels_along(axis), |ui| {
                        ui.add(DragValue::new(n).range(1..=LONGEST))
                    });
                }
                ui.weak(text::raw::FASTEST_AXIS);
            });
            ui.end_row();
            ui.label(text::raw::NUMBER_TYPE);
            let combo = egui::ComboBox::from_id_salt("voxel type").selected_text(layout.voxel_type.name());
            let shown = combo.show_ui(ui, |ui| {
                for voxel_type in VoxelType::ALL {
                    ui.selectable_value(&mut layout.voxel_type, voxel_type, voxel_type.name());
                }
            });
            let named = || egui::WidgetInfo::labeled(egui::Role::ComboBox, true, text::raw::NUMBER_TYPE);
            shown.response.widget_info(named);
            ui.end_row();
            ui.label(text::raw::BYTE_ORDER);
            ui.horizontal(|ui| {
                for (endian, order) in [(Endian::Little, text::raw::LITTLE), (Endian::Big, text::raw::BIG)] {
                    let choice = ui.selectable_value(&mut layout.endian, endian, order.name);
                    choice.on_hover_text(order.tip);
                }
            });
            ui.end_row();
            ui.label(text::raw::SPACING);
            ui.horizontal(|ui| {
                for (axis, mm) in text::raw::AXES.into_iter().zip(&mut layout.spacing_mm) {
                    let field = DragValue::new(mm).range(1e-6..=1e6).speed(0.01).max_decimals(6);
                    ui.name_inputs(text::raw::spacing_along(axis), |ui| ui.add(field));
                }
                ui.weak(text::raw::MILLIMETRES);
            });
            ui.end_row();
            ui.label(text::raw::HEADER);
            ui.horizontal(|ui| {
                ui.name_inputs(text::raw::HEADER_BYTES, |ui| ui.add(DragValue::new(&mut layout.offset)));
                ui.weak(text::raw::HEADER_UNIT);
            });
            ui.end_row();
        });
    }

    /// Says whether the file is as long as that, and what helps. Whether it is, or may be.
    fn length(&mut self, ui: &mut Ui) -> bool {
        if self.guess.is_gzip {
            ui.weak(text::raw::COMPRESSED);
            return true;
        }
        let found = self.guess.file_bytes;
        let expected = self.layout.file_bytes();
        match expected {
            Some(expected) if expected == found => {
                ui.label(text::raw::fits(found));
                true
            }
            Some(expected) if expected < found => {
                ui.horizontal(|ui| {
                    let more = found - expected;
                    ui.colored_label(ui.visuals().warn_fg_color, text::raw::longer(more));
                    if ui.button(text::raw::ARE_HEADER).clicked() {
                        self.layout.offset += more;
                    }
                });
                false
            }
            Some(expected) => {
                let missing = text::raw::shorter(found, expected);
                ui.colored_label(ui.visuals().error_fg_color, missing);
                false
            }
            None => {
                ui.colored_label(ui.visuals().error_fg_color, text::raw::TOO_MANY);
                false
            }
        }
    }
}

/// The header beside a data file: `scan.raw.gz` has `scan.nhdr`.
fn header_of(path: &Path) -> PathBuf {
    let stem = |path: &Path| path.file_stem().map(PathBuf::from).unwrap_or_default();
    let mut name = stem(path);
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz")) {
        name = stem(&name);
    }
    path.with_file_name(format!("{}.nhdr", name.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_lie_beside_their_data() {
        for (data, header) in
            [("/a/scan.raw", "/a/scan.nhdr"), ("scan.raw.gz", "scan.nhdr"), ("b.c/scan", "b.c/scan.nhdr")]
        {
            assert_eq!(header_of(Path::new(data)), Path::new(header));
        }
    }
}
