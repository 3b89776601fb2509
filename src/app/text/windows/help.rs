//! Texts of the help windows, and of the hints on the first use of the program.

/// Title of the window of shortcuts, and name of its command.
pub(crate) const KEYS_AND_MOUSE: &str = "Keys and mouse";

/// Mouse actions in the picture and in the editor, each with its effect.
pub(crate) const MOUSE: [(&str, &str); 23] = [
    ("Drag the picture", "Orbit"),
    ("Double click on the volume", "Orbit about that point"),
    ("Hold L and drag", "Turn the selected light"),
    ("Hold Q and draw", "Hide what is inside; with Shift, all else"),
    ("Arrow keys, or with Shift", "Turn it by 1°, or by 10°"),
    ("Ctrl+Shift+1 … 9, Ctrl+1 … 9", "Save a view, return to it"),
    ("Shift-drag or middle drag", "Pan"),
    ("Right-drag the picture", "Level and window"),
    ("Wheel", "Zoom in or out at the pointer"),
    ("Drag a light's handle", "Move the light"),
    ("Wheel on a positional light's handle", "Change its distance"),
    ("Drag the square on a spotlight's cone", "Widen or narrow the cone"),
    ("Drag the sides of the crop box", "Crop more or less"),
    ("Drag or wheel on the clip plane's square", "Move it; turn it by the arrow"),
    ("Drag the line between two looks", "See more of one of them"),
    ("Click in the transfer function", "Add a point"),
    ("Drag around points, or click with Shift", "Select several"),
    ("Drag a point, or arrow keys", "Move the selected points"),
    ("Double click, or Delete", "Remove points"),
    ("Draw, then drag", "Draw the transfer function by hand"),
    ("Click with the probe on", "Keep the readout; two clicks measure"),
    ("Drag saved views and looks", "Reorder them"),
    ("Escape while dragging", "Cancel the drag"),
];

/// Title of the about window, and name of its command.
pub(crate) const ABOUT: &str = "About Chiaroscuro";
pub(crate) const PURPOSE: &str =
    "See the shape of volume data: true volumetric shadows by sheet-buffer splatting.";
pub(crate) const AFTER: &str = "After Splatting With Shadows (Nulkar and Mueller, 2001).";
pub(crate) const SOFTWARE_ADAPTER: &str =
    "This is a software adapter: previews are coarser, the final picture is the same.";

/// Hints over the picture on the first use of the program, each an action and its result.
pub(crate) const HINTS: [(&str, &str); 3] = [
    ("Drag a light's disc", "The shadows follow your hand"),
    ("Drag the picture, turn the wheel", "To orbit, and to zoom"),
    ("Drop a file on the window", "Ctrl+O opens one, Ctrl+P finds everything else"),
];
pub(crate) const CLOSE_HINTS: &str = "Close the hints";

/// Name of the program with its version.
pub(crate) fn program(version: &str) -> String {
    format!("Chiaroscuro {version}")
}

/// Name of the graphics adapter in use.
pub(crate) fn adapter(name: &str) -> String {
    format!("Graphics adapter {name}")
}

/// Graphics API and driver in use.
pub(crate) fn interface(driver: &str) -> String {
    format!("Graphics API {driver}")
}
