//! Tools over the picture: handles, overlays, comparison, probe and hints, with their state.

use crate::app::viewport::camera_transition::CameraTransition;
use crate::app::viewport::canvas::Canvas;
use crate::app::viewport::cut_handles::CutHandles;
use crate::app::viewport::cut_handles::shape_tool::ShapeCutTool;
use crate::app::viewport::first_use_hints::FirstUseHints;
use crate::app::viewport::light_handles::LightHandles;
use crate::app::viewport::light_probe::LightProbe;
use crate::app::viewport::light_probe::material_picker::MaterialPicker;
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::viewport::overlay::ViewportOverlay;
use crate::app::viewport::overlay::ct_preset_row::CtPresetRow;
use crate::app::viewport::overlay::export_marks_preview::ExportMarksPreview;

/// State of the tools over the picture.
#[derive(Default)]
pub(crate) struct PictureTools {
    /// Area of the picture in the last frame.
    pub canvas: Option<Canvas>,
    /// Handles of the lights in the picture.
    pub handles: LightHandles,
    /// Handles of the crop box and the clip plane.
    pub cut_handles: CutHandles,
    /// Tool that cuts by shapes.
    pub shape_cuts: ShapeCutTool,
    /// Tool that makes materials from clicks.
    pub material_picker: MaterialPicker,
    /// Overlay of light chips, bounding box, scale bar and orientation cube.
    pub overlay: ViewportOverlay,
    /// Preview of the marks that would be drawn over an exported picture.
    pub export_marks: ExportMarksPreview,
    /// State of the current camera orbit.
    pub orbit: OrbitDrag,
    /// Animated transition between two views.
    pub camera_animation: CameraTransition,
    /// Probe of the sample under the pointer.
    pub light_probe: LightProbe,
    /// Hints over the picture on the first use of the program.
    pub first_run_hints: FirstUseHints,
    /// Row of common CT presets.
    pub ct_looks: CtPresetRow,
}

impl PictureTools {
    /// Returns the size in physical pixels of a picture that fills the area.
    pub(crate) fn available_size(&self) -> [u32; 2] {
        // Before there is a picture: the resolution of the smallest common screens.
        self.canvas.map_or([1280, 720], |canvas| canvas.available_size.map(|n| n.max(1)))
    }
}
