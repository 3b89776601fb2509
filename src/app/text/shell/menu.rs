//! The menu bar; the names of commands are with the commands.

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
pub(crate) const KEPT: &str = "Saved views";
pub(crate) const PERSPECTIVE: &str = "Perspective";
pub(crate) const ORTHOGRAPHIC: &str = "Orthographic";

/// How long a preview may take.
pub(crate) const WHILE_MOVING: &str = "Quality while moving";
pub(crate) const AUTOMATIC: &str = "Automatic";
pub(crate) const SMOOTH: &str = "Smooth (16 ms)";
pub(crate) const BALANCED: &str = "Balanced (33 ms)";
pub(crate) const SHARP: &str = "Sharp (66 ms)";
pub(crate) const SHARPEST: &str = "Sharpest (200 ms)";

/// How large everything is.
pub(crate) const SIZE: &str = "Interface size";

/// The colours of the window.
pub(crate) const THEME: &str = "Theme";
pub(crate) const DARK: &str = "Dark";
pub(crate) const BRIGHT: &str = "Light";
pub(crate) const AS_SYSTEM: &str = "Same as system";

pub(crate) const USE_RIG: &str = "Light rigs";

/// A step of the history, and what it changes.
pub(crate) fn step(label: &str, what: Option<&str>) -> String {
    what.map_or_else(|| label.to_owned(), |what| format!("{label} {what}"))
}

/// A switch and its key.
pub(crate) fn with_key(label: &str, key: &str) -> String {
    format!("{label} ({key})")
}

/// The open volume's name, and what is said of it.
pub(crate) fn title(name: &str, facts: &str) -> String {
    format!("{name} · {facts}")
}

/// The open volume's voxels, and their size.
pub(crate) fn facts([nx, ny, nz]: [usize; 3], spacing_mm: [f64; 3], has_unknown_scale: bool) -> String {
    let [sx, sy, sz] = spacing_mm;
    // Voxels that are cubes of a size that nobody knows: there is nothing to say of it.
    if has_unknown_scale && sx == sy && sy == sz {
        return format!("{nx}×{ny}×{nz}");
    }
    let unit = crate::app::text::panels::data::unit_of_spacing(spacing_mm, has_unknown_scale);
    let [sx, sy, sz] = spacing_mm.map(|length| length / unit.mm);
    format!("{nx}×{ny}×{nz} · {sx:.3}×{sy:.3}×{sz:.3}{}", unit.suffix)
}
