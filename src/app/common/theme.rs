//! Theme of the window: all its colours, sizes and spacings.

use eframe::egui::{self, Color32, FontId, TextStyle, Theme, Vec2};

/// Width of the side panel in points.
pub(crate) const SIDE_WIDTH: f32 = 316.0;
/// Widths to which the side panel can be dragged, in points: in a narrower one, sliders are too short to aim with.
pub(crate) const SIDE_WIDTHS: std::ops::RangeInclusive<f32> = 300.0..=560.0;
/// Height of the transfer function editor in points.
pub(crate) const EDITOR_HEIGHT: f32 = 158.0;
/// Height of the table of labels in points, which replaces the editor: six rows are visible.
pub(crate) const LABEL_TABLE_HEIGHT: f32 = 230.0;
/// Width of the labels before the controls, in points.
pub(crate) const LABEL_WIDTH: f32 = 106.0;
/// Indentation of the controls that belong to a list entry, in points.
pub(crate) const INDENT: f32 = 12.0;
/// Width of the typed value behind a slider, in points.
pub(crate) const VALUE_WIDTH: f32 = 62.0;
/// Width of a reset button, in points.
pub(crate) const RESET_WIDTH: f32 = 16.0;

/// Font size of texts and buttons, in points.
pub(crate) const FONT_SIZE: f32 = 13.0;

/// Radius of a light's handle, in points.
pub(crate) const HANDLE_RADIUS: f32 = 8.0;
/// Minimum distance of a handle from the border of the picture, in points.
pub(crate) const HANDLE_INSET: f32 = 14.0;
/// Minimum distance of a light's handle from the border of the picture, in points; it may have an arrow towards a
/// light that is outside.
pub(crate) const LIGHT_INSET: f32 = 22.0;
/// Radius of a control point of a transfer function, in points.
pub(crate) const POINT_RADIUS: f32 = 5.0;
/// Duration of fading handles in and out, in seconds.
pub(crate) const FADE_S: f32 = 0.25;

/// Colour of selected or active elements.
pub(crate) const ACCENT: Color32 = Color32::from_rgb(0xe9, 0xae, 0x4a);
/// Colour of text over pictures, whatever the theme of the window.
pub(crate) const PICTURE_TEXT: Color32 = Color32::from_rgb(0xe8, 0xec, 0xf2);
/// Colour of small shares in bars of the side panel, and of the histogram in the dark theme.
pub(crate) const LOW_BAR: Color32 = Color32::from_rgb(0x4a, 0x52, 0x60);
/// Edge length of a checkerboard field, in points.
pub(crate) const CHECKER_EDGE: f32 = 8.0;
/// Colours of the axes x, y and z of the grid.
pub(crate) const AXES: [Color32; 3] = [
    Color32::from_rgb(0xf0, 0x6a, 0x5e),
    Color32::from_rgb(0x6c, 0xc9, 0x72),
    Color32::from_rgb(0x62, 0xa4, 0xf2),
];
/// Colour around handles and points, which separates them from any picture.
pub(crate) const OUTLINE: Color32 = Color32::from_rgb(0x0c, 0x0d, 0x10);
/// Colour of the guide lines while a light is moved.
pub(crate) const GUIDE: Color32 = Color32::from_rgb(0xc9, 0xd2, 0xe0);
/// Colour of the part of a light's path where material absorbs it.
pub(crate) const BLOCKED: Color32 = Color32::from_rgb(0xf0, 0x5a, 0x4a);
/// Colour of the empty picture while no volume is open.
pub(crate) const EMPTY_CANVAS: Color32 = Color32::from_rgb(0x1b, 0x1e, 0x24);

/// Colours of the transfer function's plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlotColors {
    /// Colours of the two kinds of checkerboard fields behind the curve's colours.
    pub checker: [Color32; 2],
    /// Colour of the histogram bars.
    pub histogram: Color32,
    /// Colour of the eye's curve, over its colours, and of numbers.
    pub eye: Color32,
    /// Colour of the lighting curve.
    pub light: Color32,
    /// Colour behind numbers and around points.
    pub background: Color32,
}

impl PlotColors {
    /// Colours of the plot in the dark theme.
    pub(crate) const DARK: Self = Self {
        checker: [Color32::from_rgb(0x22, 0x25, 0x2b), Color32::from_rgb(0x2b, 0x2f, 0x36)],
        histogram: LOW_BAR,
        eye: PICTURE_TEXT,
        light: Color32::from_rgb(0xff, 0xc1, 0x4d),
        background: OUTLINE,
    };
    /// Colours of the plot in the light theme: each has at least the contrast of its dark counterpart.
    const LIGHT: Self = Self {
        checker: [Color32::from_rgb(0xf6, 0xf7, 0xf9), Color32::from_rgb(0xe7, 0xe9, 0xee)],
        histogram: Color32::from_rgb(0xb3, 0xbb, 0xc8),
        eye: Color32::from_rgb(0x20, 0x26, 0x30),
        light: Color32::from_rgb(0xa8, 0x5c, 0x00),
        background: Color32::from_rgb(0xff, 0xff, 0xff),
    };

    /// Returns the plot colours of the window's theme.
    pub(crate) fn for_visuals(visuals: &egui::Visuals) -> Self {
        if visuals.dark_mode { Self::DARK } else { Self::LIGHT }
    }
}

/// Frame of a panel without a fill of its own: the window's background is filled once, and cheaply.
pub(crate) fn panel(ui: &egui::Ui) -> egui::Frame {
    egui::Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT)
}

/// Colour of selected or active text on a panel, with a contrast of 4.5:1 on light ones, too.
pub(crate) fn accent(visuals: &egui::Visuals) -> Color32 {
    if visuals.dark_mode { ACCENT } else { Color32::from_rgb(0x85, 0x52, 0x00) }
}

/// Colour of text on a panel that confirms a valid input, with a contrast of 4.5:1 in both themes.
pub(crate) fn good(visuals: &egui::Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_rgb(0x7c, 0xcf, 0x86) } else { Color32::from_rgb(0x1d, 0x6b, 0x2b) }
}

const INK_ON_LIGHT: Color32 = Color32::from_rgb(0x24, 0x28, 0x30);
const DIM_ON_LIGHT: Color32 = Color32::from_rgb(0x59, 0x60, 0x6c);
const ERROR: Color32 = Color32::from_rgb(0xff, 0x8a, 0x7a);
const PANEL: Color32 = Color32::from_rgb(0x1e, 0x20, 0x26);
const WELL: Color32 = Color32::from_rgb(0x14, 0x16, 0x1a);
const TEXT: Color32 = Color32::from_rgb(0xd4, 0xd8, 0xe0);
const WEAK_TEXT: Color32 = Color32::from_rgb(0x98, 0xa0, 0xae);

/// Applies fonts, spacing and colours to the window: dark unless the user chooses otherwise.
pub(crate) fn apply(ctx: &egui::Context) {
    ctx.set_theme(egui::ThemePreference::Dark);
    ctx.style_mut_of(Theme::Dark, |style| {
        let visuals = &mut style.visuals;
        visuals.panel_fill = PANEL;
        visuals.window_fill = PANEL;
        visuals.extreme_bg_color = WELL;
        visuals.weak_text_color = Some(WEAK_TEXT);
        visuals.error_fg_color = ERROR;
        visuals.widgets.noninteractive.fg_stroke.color = TEXT;
        visuals.widgets.inactive.fg_stroke.color = TEXT;
        visuals.selection.bg_fill = Color32::from_rgb(0x6a, 0x4c, 0x16);
        visuals.selection.stroke.color = Color32::from_rgb(0xff, 0xe6, 0xb8);
    });
    ctx.style_mut_of(Theme::Light, |style| {
        let visuals = &mut style.visuals;
        visuals.weak_text_color = Some(DIM_ON_LIGHT);
        visuals.widgets.noninteractive.fg_stroke.color = INK_ON_LIGHT;
        visuals.widgets.inactive.fg_stroke.color = INK_ON_LIGHT;
        visuals.selection.bg_fill = Color32::from_rgb(0xf0, 0xcf, 0x8d);
        visuals.selection.stroke.color = Color32::from_rgb(0x40, 0x2b, 0x00);
    });
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = Vec2::new(6.0, 5.0);
        style.spacing.interact_size.y = 20.0;
        style.text_styles.insert(TextStyle::Body, FontId::proportional(FONT_SIZE));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(FONT_SIZE));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(11.0));
        style.visuals.slider_trailing_fill = true;
    });
}

/// Converts an sRGB colour of the settings, 0 to 1, for the painter.
pub(crate) fn color(srgb: [f32; 3]) -> Color32 {
    let [r, g, b] = srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}
