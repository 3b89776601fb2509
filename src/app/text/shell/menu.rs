//! Titles of the menus and submenus; the names of commands are in `commands.rs`.

pub(crate) const FILE: &str = "File";
pub(crate) const EDIT: &str = "Edit";
pub(crate) const VIEW: &str = "View";
pub(crate) const LIGHT: &str = "Light";
pub(crate) const HELP: &str = "Help";

pub(crate) const OPEN_RECENT: &str = "Open recent";
pub(crate) const EARLIER_LOOKS: &str = "Earlier looks";
pub(crate) const KEEP_LOOK_TIP: &str =
    "Lights, transfer function and shadows stay when another file is opened";

pub(crate) const LOOK_FROM: &str = "Look from";
pub(crate) const SAVED_VIEWS: &str = "Saved views";
pub(crate) const PERSPECTIVE: &str = "Perspective";
pub(crate) const ORTHOGRAPHIC: &str = "Orthographic";

/// Submenu of the render mode.
pub(crate) const RENDER_MODE: &str = "Render mode";

/// Submenu of the time budget of a preview.
pub(crate) const PREVIEW_BUDGET: &str = "Quality while moving";
pub(crate) const AUTOMATIC: &str = "Automatic";
pub(crate) const SMOOTH: &str = "Smooth (16 ms)";
pub(crate) const BALANCED: &str = "Balanced (33 ms)";
pub(crate) const SHARP: &str = "Sharp (66 ms)";
pub(crate) const SHARPEST: &str = "Sharpest (200 ms)";

/// Submenu of the interface scale.
pub(crate) const SIZE: &str = "Interface size";

/// Submenu of the colour theme.
pub(crate) const THEME: &str = "Theme";
pub(crate) const DARK: &str = "Dark";
pub(crate) const LIGHT_THEME: &str = "Light";
pub(crate) const AS_SYSTEM: &str = "Same as system";

pub(crate) const USE_RIG: &str = "Light rigs";

/// Undo or redo entry, with the change that it affects.
pub(crate) fn history_entry(label: &str, what: Option<&str>) -> String {
    what.map_or_else(|| label.to_owned(), |what| format!("{label} {what}"))
}

/// Name of a toggle with its keyboard shortcut.
pub(crate) fn with_key(label: &str, key: &str) -> String {
    format!("{label} ({key})")
}

/// Name of the open volume, with its dimensions and spacing.
pub(crate) fn title(name: &str, facts: &str) -> String {
    format!("{name} · {facts}")
}

/// Dimensions of the open volume, and its voxel spacing where that is informative.
pub(crate) fn facts([nx, ny, nz]: [usize; 3], spacing_mm: [f64; 3], has_unknown_scale: bool) -> String {
    let [sx, sy, sz] = spacing_mm;
    // Cubic voxels of unknown size: their spacing says nothing.
    if has_unknown_scale && sx == sy && sy == sz {
        return format!("{nx}×{ny}×{nz}");
    }
    let unit = crate::app::text::panels::data::unit_of_spacing(spacing_mm, has_unknown_scale);
    let [sx, sy, sz] = spacing_mm.map(|length| length / unit.mm);
    format!("{nx}×{ny}×{nz} · {sx:.3}×{sy:.3}×{sz:.3}{}", unit.suffix)
}
