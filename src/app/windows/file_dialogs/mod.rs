//! File dialogs of the window: the desktop's on threads, a dialog for typed paths, dropped files, and settings files.

mod desktop;
mod desktop_dialog;
#[cfg(all(unix, not(target_os = "macos")))]
mod portal;

use std::path::{Path, PathBuf};

use eframe::egui;

use self::desktop_dialog::{FileDialog, FileDialogOutcome};
use crate::app::common::{overlay_windows, shortcuts};
use crate::app::text;
use crate::app::text::files::FileRequest;
use chiaroscuro_files::read_small_file;
use chiaroscuro_media::may_carry_record;
use chiaroscuro_scene::{LookRecord, Settings, TransferFunction, export_transfer, import_transfer};
use chiaroscuro_volume::{ValueRange, ValueRanges};

/// Purpose of a file dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileDialogPurpose {
    /// Opens the file of a volume.
    OpenVolume,
    /// Opens a folder of slices.
    OpenFolder,
    /// Adds the file of a volume as a layer.
    AddLayer,
    /// Chooses the volume of a look that waits for it.
    VolumeOfLook,
    /// Loads settings and applies them.
    LoadSettings,
    /// Loads an environment map to light by.
    EnvironmentMap,
    /// Imports a transfer function of another program.
    ImportTransfer,
    /// Exports the transfer function for another program.
    ExportTransfer,
    /// Loads settings to compare with.
    CompareSettings,
    /// Saves the settings to a file.
    SaveSettings,
    /// Chooses the file of an exported picture.
    ExportPicture,
    /// Exports one picture of all kept items.
    ExportKept,
    /// Exports a light volume, or a slice of it.
    ExportLight,
}

impl FileDialogPurpose {
    /// Returns true if the file is written at once; the desktop's dialog asks before it replaces a file.
    fn writes_immediately(self) -> bool {
        matches!(self, Self::SaveSettings | Self::ExportTransfer | Self::ExportLight | Self::ExportKept)
    }

    /// Title, hint and button of the dialog.
    fn dialog_text(self) -> FileRequest {
        match self {
            Self::OpenVolume => text::files::OPEN_VOLUME,
            Self::OpenFolder => text::files::OPEN_FOLDER,
            Self::AddLayer => text::files::ADD_LAYER,
            Self::VolumeOfLook => text::files::VOLUME_OF_LOOK,
            Self::LoadSettings => text::files::LOAD_SETTINGS,
            Self::EnvironmentMap => text::files::OPEN_ENVIRONMENT_MAP,
            Self::ImportTransfer => text::files::IMPORT_TRANSFER,
            Self::ExportTransfer => text::files::EXPORT_TRANSFER,
            Self::CompareSettings => text::files::COMPARE_SETTINGS,
            Self::SaveSettings => text::files::SAVE_SETTINGS,
            Self::ExportPicture => text::files::EXPORT_PICTURE,
            Self::ExportKept => text::files::EXPORT_CONTACT_SHEET,
            Self::ExportLight => text::files::EXPORT_LIGHT,
        }
    }
}

/// State of the dialog for typed paths.
#[derive(Debug)]
struct TypedPathDialog {
    purpose: FileDialogPurpose,
    text: String,
    requests_focus: bool,
    /// True while the user is asked whether an existing file may be replaced.
    asks_to_replace: bool,
}

/// File dialogs that are open.
#[derive(Debug, Default)]
pub(crate) struct FileDialogs {
    dialog: Option<FileDialog>,
    typed_path: Option<TypedPathDialog>,
    /// True if a request was refused because the desktop's dialog was open for another, and the user has not been
    /// told.
    was_refused: bool,
}

impl FileDialogs {
    /// Opens the desktop's file dialog; without one, the dialog for a typed path.
    pub(crate) fn open_dialog(
        &mut self,
        purpose: FileDialogPurpose,
        frame: &eframe::Frame,
        ctx: &egui::Context,
    ) {
        if let Some(dialog) = &self.dialog {
            if dialog.may_be_open() {
                self.was_refused = true;
                ctx.request_repaint();
            } else {
                // The earlier dialog has not appeared, whatever became of it.
                self.open_typed_path(purpose);
            }
            return;
        }
        match FileDialog::open(purpose, frame, ctx) {
            Ok(dialog) => self.dialog = Some(dialog),
            Err(err) => {
                log::warn!("no file dialog: {err}");
                self.open_typed_path(purpose);
            }
        }
    }

    /// Opens the dialog for a typed path.
    pub(crate) fn open_typed_path(&mut self, purpose: FileDialogPurpose) {
        let before = self.typed_path.take().filter(|typed| typed.purpose == purpose);
        let text = before.map(|typed| typed.text).unwrap_or_default();
        self.typed_path =
            Some(TypedPathDialog { purpose, text, requests_focus: true, asks_to_replace: false });
    }

    /// Title of the dialog for a typed path, if it is open.
    pub(crate) fn typed_path_title(&self) -> Option<&'static str> {
        self.typed_path.as_ref().map(|typed| typed.purpose.dialog_text().title)
    }

    /// Returns the file chosen in the desktop's dialog, once. Called in each frame.
    pub(crate) fn take_choice(&mut self, ctx: &egui::Context) -> Option<(FileDialogPurpose, PathBuf)> {
        let dialog = self.dialog.as_mut()?;
        dialog.observe_focus(ctx);
        let answer = dialog.take_outcome()?;
        let purpose = dialog.purpose;
        self.dialog = None;
        match answer {
            FileDialogOutcome::Chosen(path) => return Some((purpose, path)),
            FileDialogOutcome::Cancelled => {}
            // A user who is typing a path has given up on the dialog.
            FileDialogOutcome::NoDialog if self.typed_path.is_some() => {}
            FileDialogOutcome::NoDialog => self.open_typed_path(purpose),
        }
        None
    }

    /// Returns true, once, if a request was refused because the desktop's dialog was open for another.
    pub(crate) fn take_refused(&mut self) -> bool {
        std::mem::take(&mut self.was_refused)
    }

    /// Shows the dialog for a typed path, if it is open, and returns the path that was entered.
    pub(crate) fn typed_path_ui(&mut self, ctx: &egui::Context) -> Option<(FileDialogPurpose, PathBuf)> {
        let typed = self.typed_path.as_mut()?;
        shortcuts::reserve_letters(ctx);
        let (mut open, mut accepted, mut cancelled) = (true, false, false);
        let FileRequest { title, hint, verb } = typed.purpose.dialog_text();
        let window = egui::Window::new(title).id(egui::Id::unique("typed path")).open(&mut open);
        let window = window.constrain_to(overlay_windows::window_area(ctx));
        let width = (0.6 * ctx.content_rect().width()).clamp(240.0, 720.0);
        let window = window.collapsible(false).resizable(false).default_pos([140.0, 110.0]);
        let shown = window.show(ctx, |ui| {
            ui.horizontal(|ui| {
                let label = ui.label(text::files::PATH);
                let field = egui::TextEdit::singleline(&mut typed.text).hint_text(hint);
                let field = ui.add(field.desired_width(width)).labelled_by(label.id);
                if std::mem::take(&mut typed.requests_focus) {
                    field.request_focus();
                }
                accepted = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            });
            let path = PathBuf::from(typed.text.trim());
            // The name may have been edited meanwhile.
            typed.asks_to_replace &= path.is_file();
            if typed.asks_to_replace {
                ui.label(text::files::overwrite_question(&path));
            }
            ui.horizontal(|ui| {
                let verb = if typed.asks_to_replace { text::files::REPLACE } else { verb };
                let pressed =
                    ui.add_enabled(!typed.text.trim().is_empty(), egui::Button::new(verb)).clicked();
                cancelled = ui.button(text::common::CANCEL).clicked();
                // Enter alone does not replace a file.
                accepted = pressed || accepted && !typed.asks_to_replace;
                if accepted && !typed.asks_to_replace && typed.purpose.writes_immediately() && path.is_file()
                {
                    (typed.asks_to_replace, accepted) = (true, false);
                }
            });
        });
        let chosen = (accepted && !typed.text.trim().is_empty())
            .then(|| (typed.purpose, PathBuf::from(typed.text.trim())));
        let is_left = overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
        if chosen.is_some() || cancelled || is_left || !open {
            self.typed_path = None;
        }
        chosen
    }
}

/// Paths of the files dropped on the window in this frame.
pub(crate) fn dropped_files(ctx: &egui::Context) -> Vec<PathBuf> {
    ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect())
}

/// Returns true if a picture file carries a look in its metadata; PNG files without one are slices.
pub(crate) fn carries_look(path: &Path) -> bool {
    may_carry_record(path) && chiaroscuro_media::read_record(path).is_ok_and(|record| record.is_some())
}

/// Returns true if a path that may hold a look is a volume: a folder, or a PNG without a look.
pub(crate) fn is_volume_path(path: &Path) -> bool {
    let is_readable = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    path.is_dir() || is_readable && chiaroscuro_media::read_record(path).is_ok_and(|record| record.is_none())
}

/// Writes a file atomically; the previous one is kept beside it as `.bak`.
pub(crate) fn write_with_backup(path: &Path, contents: &[u8]) -> Result<(), String> {
    chiaroscuro_files::keep_backup(path).map_err(|err| err.to_string())?;
    chiaroscuro_files::write_atomically(path, contents).map_err(|err| err.to_string())
}

/// Reads the record of a session file, a preset or an exported picture.
pub(crate) fn load_record(path: &Path) -> Result<LookRecord, String> {
    let record = if may_carry_record(path) {
        let found = chiaroscuro_media::read_record(path).map_err(|err| err.to_string())?;
        found.ok_or_else(|| text::files::no_settings(path))?.into_bytes()
    } else {
        read_small_file(path).map_err(|err| text::files::settings_not_read(path, err))?
    };
    let mut record =
        LookRecord::from_bytes(&record).map_err(|err| text::files::settings_invalid(path, err))?;
    record.file = Some(path.to_owned());
    Ok(record)
}

/// Value range onto which transfer functions of other programs are mapped at import and export: the shown range.
pub(crate) fn transfer_exchange_range(settings: &Settings, ranges: &ValueRanges) -> ValueRange {
    settings.shown_range(ranges)
}

/// Imports a transfer function of another program, mapped to a value range unless the file names one.
pub(crate) fn import_transfer_file(path: &Path, range: ValueRange) -> Result<TransferFunction, String> {
    let bytes = read_small_file(path).map_err(|err| text::files::transfer_not_read(path, err))?;
    import_transfer(path, &bytes, range).map_err(|err| text::files::transfer_invalid(path, err))
}

/// Exports the transfer function of a look for another program, for a volume with these values.
pub(crate) fn export_transfer_file(
    path: &Path,
    settings: &Settings,
    ranges: &ValueRanges,
) -> Result<(), String> {
    let range = transfer_exchange_range(settings, ranges);
    let bytes = export_transfer(path, &settings.layer().transfer, range).map_err(|err| err.to_string())?;
    chiaroscuro_files::write_atomically(path, &bytes).map_err(|err| err.to_string())
}

/// Returns true if a file name is that of a look rather than a volume: JSON, or a picture that may carry a record.
pub(crate) fn may_be_look_file(path: &Path) -> bool {
    may_carry_record(path) || path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{ControlPoint, OpacityInterpolation};

    #[test]
    fn settings_are_small_texts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        std::fs::write(&path, "{\"shadows\": {\"gain\": 2.0}}").unwrap();
        let settings =
            load_record(&path).unwrap().apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings;
        assert_eq!(settings.shadows.gain, 2.0);
        std::fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(load_record(&path).unwrap_err().contains("not UTF-8 text"));
        assert!(load_record(folder.path()).unwrap_err().contains("regular"));
        assert!(import_transfer_file(&folder.path().join("none.json"), ValueRange::UNIT).is_err());
    }

    #[test]
    fn transfer_functions_come_back_as_they_went() {
        let folder = tempfile::tempdir().unwrap();
        let (all, robust) = (ValueRange::new(-1000.0, 5000.0), ValueRange::new(0.0, 100.0));
        let ranges = ValueRanges { all, robust };
        // Beyond the robust range, which widens the shown range.
        let points = [(-20.0, 0.0), (60.0, 0.3), (150.0, 0.9)];
        let points = points.map(|(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity)).to_vec();
        let transfer = TransferFunction {
            points,
            interpolation: OpacityInterpolation::Opacity,
            ..TransferFunction::default()
        };
        let settings = Settings::default().with_transfer(transfer);
        for ending in ["itf", "vp", "json"] {
            let path = folder.path().join(format!("a.{ending}"));
            export_transfer_file(&path, &settings, &ranges).unwrap();
            let back = import_transfer_file(&path, transfer_exchange_range(&settings, &ranges)).unwrap();
            for value in [-20.0, 0.0, 60.0, 100.0, 140.0] {
                let (found, meant) = (back.opacity_at(value), settings.layer().transfer.opacity_at(value));
                assert!((found - meant).abs() < 1e-3, "{ending} at {value}: {found} and not {meant}");
            }
        }
    }

    #[test]
    fn looks_and_volumes_are_told_apart_by_name() {
        for (name, record) in
            [("a.json", true), ("b.PNG", true), ("d.Exr", true), ("c.nrrd", false), ("png", false)]
        {
            assert_eq!(may_be_look_file(Path::new(name)), record, "{name}");
        }
    }
}
