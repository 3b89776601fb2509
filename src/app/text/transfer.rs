//! Texts of the transfer function editor.

use super::{ControlText, control_text};

/// Section name of the editor in the command palette.
pub(crate) const TITLE: &str = "Transfer function";

/// Accessible name of the plot.
pub(crate) const PLOT: &str = "Transfer function plot";

pub(crate) const EYE: ControlText = control_text("Eye", "Edit the opacity curve for the eye");
pub(crate) const LIGHT: ControlText = control_text("Light", "Edit the opacity curve for light");
/// Tooltip of the light tab while both curves are linked.
/// Tooltip of the tab of a layer, counted from 1.
pub(crate) fn layer_tab_tooltip(number: usize, name: &str) -> String {
    format!("Edit layer {number}: {name}")
}

pub(crate) const LINKED_TIP: &str = "Light uses the eye's opacity curve; a click gives it a separate one";
/// Chain button that links the two curves, between their tabs.
pub(crate) const LINK: ControlText = control_text(
    "Link the curves of eye and light",
    "Makes light use the eye's opacity curve again; its own curve is kept",
);
pub(crate) const UNLINK_TIP: &str = "Light uses the eye's opacity curve. A click gives it a separate one";
pub(crate) const HINT: &str = "Click adds a point, a drag selects, the wheel zooms";

/// Accessible name of a control point of either curve, before its number.
pub(crate) const EYE_POINT: &str = "Eye point";
pub(crate) const LIGHT_POINT: &str = "Light point";

pub(crate) const AUTOMATIC: ControlText =
    control_text("Automatic", "Restores the automatic transfer function");
pub(crate) const LOG_HISTOGRAM: ControlText =
    control_text("Log histogram", "Shows counts on a logarithmic scale, so that rare values are visible");
pub(crate) const SHOW_ALL: ControlText = control_text("Show all", "Shows all values again");

/// Label of the upper end of the plot.
pub(crate) const OPACITY_ONE: &str = "opacity 1";

pub(crate) const PRESETS: &str = "Presets";
pub(crate) const TRY_PRESETS_TIP: &str = "Shows each preset on the open volume";
/// Explanation beside a CT preset while the data are not in Hounsfield units.
pub(crate) const FOR_CT: &str = "Made for CT in Hounsfield units, and these data are not; if their values are \
     offset by 1024, Data › Corrections › Values can shift them";

/// Tooltip of a preset that is made for another kind of data.
pub(crate) fn other_data_tooltip(about: &str) -> String {
    format!("{about}. {FOR_CT}")
}

/// Tooltip of the preset that is in use.
pub(crate) fn in_use_tooltip(about: &str) -> String {
    format!("{about} (in use)")
}

pub(crate) const COLORS: &str = "Transfer function";
pub(crate) const COLOR_MAP_TIP: &str = "Colours the visible values";
pub(crate) const REVERSED: &str = "Reversed";
/// Tooltip of the buttons that import and export a transfer function.
pub(crate) const FILES_TIP: &str = "Formats of ParaView, Slicer, Inviwo, MRIcroGL and ImageJ; those of Voreen and \
     AGAVE can only be imported";
pub(crate) const PERCEPTUAL_BLENDING: ControlText = control_text(
    "Perceptual blending",
    "Interpolates colours between points in Oklab: lightness changes evenly, also from blue to yellow, \
     without glare",
);
pub(crate) const INVERT: ControlText =
    control_text("Invert opacities", "Opaque values become transparent, and transparent ones opaque");

/// Fields that act on the whole curve.
pub(crate) const OPACITY: ControlText =
    control_text("Opacity", "The highest opacity; all others are scaled with it");
pub(crate) const LEVEL: ControlText = control_text("Level", "Moves all points along the values");
pub(crate) const WINDOW: ControlText = control_text("Window", "Spreads all points around their middle");

pub(crate) const SHAPE: &str = "Shape";
pub(crate) const FIT: ControlText = control_text("Fit", "Spreads the points over the values that occur");
pub(crate) const BUMP: ControlText = control_text("Bump", "Adds a smooth bump of opacity: a band of values");
pub(crate) const BOX: ControlText = control_text("Box", "Adds a band of values with sharp ends");

pub(crate) const POINT_VALUE: &str = "Value";
pub(crate) const POINT_OPACITY: &str = "Opacity";
pub(crate) const POINT_COLOR: &str = "Colour of the point";
pub(crate) const REMOVE: &str = "Remove";

pub(crate) const OKLCH: ControlText =
    control_text("OKLCH…", "Lightness, chroma and hue: equal steps look equally large");
pub(crate) const LIGHTNESS: &str = "Lightness";
pub(crate) const CHROMA: &str = "Chroma";
pub(crate) const HUE: &str = "Hue";

pub(crate) const INTERPOLATION_TIP: &str = "Interpolation to the next point";
pub(crate) const LINEAR: &str = "Linear";
pub(crate) const SMOOTH: &str = "Smooth";
pub(crate) const STEP: &str = "Step";

/// Accessible name of a control point of either curve, numbered from 1.
pub(crate) fn point_name(of: &str, number: usize) -> String {
    format!("{of} {number}")
}

/// Text in place of a value while several points are selected.
pub(crate) fn point_count(count: usize) -> String {
    format!("{count} points")
}

/// Tooltip of the button that applies a colour map reversed.
pub(crate) fn reversed_tip(map: &str) -> String {
    format!("{map}, reversed")
}

/// Readout under the pointer: a formatted value and its opacity.
pub(crate) fn pointer_readout(value: &str, opacity: f64) -> String {
    format!("{value} · opacity {opacity:.2}")
}

/// Button that starts drawing a curve by hand.
pub(crate) const FREEHAND: ControlText =
    control_text("Draw", "Draw the curve by hand: a stroke becomes a few points. Escape ends drawing");
pub(crate) const DRAW_HINT: &str = "Drag to draw; Escape takes back the current stroke, or else ends drawing";
