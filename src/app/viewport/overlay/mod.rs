//! Overlay over the picture: the volume's box, a scale bar, and an orientation cube. The window paints it, so it
//! never appears in an export; while an export is being prepared, the marks of the export replace it.

pub(crate) mod ct_preset_row;
pub(crate) mod export_marks_preview;
pub(crate) mod orientation_letters;
pub(crate) mod outlined_text;

use eframe::egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};
use glam::DVec3;

use self::outlined_text::paint_outlined_text;
use super::view_projection::ViewProjection;
use crate::app::common::theme;
use chiaroscuro_media::{SCENE_SIDES, orientation_letters, scale_bar as bar_for};
use chiaroscuro_scene::{Camera, StandardView};
use chiaroscuro_volume::math::SceneSpace;

/// Edge length of the unrotated cube, in points.
const CUBE_EDGE: f32 = 44.0;

/// Visibility of the overlay.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ViewportOverlay {
    /// True if the overlay is shown, false to hide all of it.
    pub visible: bool,
}

impl Default for ViewportOverlay {
    fn default() -> Self {
        Self { visible: true }
    }
}

impl ViewportOverlay {
    /// Paints the scale bar and the orientation cube, and for anatomical data the orientation letters into `body`, a
    /// part of the picture. Returns the view of the cube's face that was clicked, if any.
    pub(crate) fn show(
        self,
        ui: &Ui,
        picture: Rect,
        camera: &Camera,
        (scene, has_unknown_scale): (&SceneSpace, bool),
        body: Option<Rect>,
    ) -> Option<StandardView> {
        if !self.visible || picture.width() < 4.0 * CUBE_EDGE || picture.height() < 4.0 * CUBE_EDGE {
            return None;
        }
        let painter = ui.painter_at(picture);
        scale_bar(&painter, picture, camera, (scene, has_unknown_scale));
        if let Some(part) = body {
            orientation_letters::paint_orientation_letters(
                &painter,
                part,
                orientation_letters(camera),
                orientation_letters::MARGIN,
            );
        }
        show_orientation_cube(ui, &painter, picture, camera, body.is_some())
    }

    /// Paints the grid's bounding box while something is being dragged or the pointer requests it.
    pub(crate) fn show_bounding_box(
        self,
        ui: &Ui,
        picture: Rect,
        camera: &Camera,
        scene: &SceneSpace,
        strength: f32,
    ) {
        if !self.visible || strength <= 0.0 {
            return;
        }
        let painter = ui.painter_at(picture);
        let view_projection = ViewProjection { camera: camera.clone(), picture };
        let dims = DVec3::from(scene.dims.map(|n| n as f64));
        let corner = |at: usize| {
            let side = |axis: usize| if at >> axis & 1 == 0 { -0.5 } else { dims[axis] - 0.5 };
            let point = scene.scene_from_index.transform_point3(DVec3::new(side(0), side(1), side(2)));
            view_projection.project(point)
        };
        let stroke = Stroke::new(1.0, theme::GUIDE.gamma_multiply(0.45 * strength));
        for from in 0..8_usize {
            for axis in 0..3 {
                let to = from | 1 << axis;
                if to != from
                    && let (Some(a), Some(b)) = (corner(from), corner(to))
                {
                    painter.line_segment([a, b], stroke);
                }
            }
        }
    }
}

/// Paints a scale bar at the bottom left; its length is exact at the depth of the view's target.
fn scale_bar(
    painter: &Painter,
    picture: Rect,
    camera: &Camera,
    (scene, has_unknown_scale): (&SceneSpace, bool),
) {
    let [width, height] = [picture.width(), picture.height().max(1.0)].map(f64::from);
    let mm_per_point = camera.pixel_at_target(width, height) * scene.mm_per_unit;
    let Some(bar) = bar_for(mm_per_point * width, has_unknown_scale) else { return };
    let length = (bar.length_mm / mm_per_point) as f32;
    let left = pos2(picture.left() + 16.0, picture.bottom() - 16.0);
    let right = left + vec2(length, 0.0);
    for (width, ink) in [(4.0, theme::OUTLINE), (1.5, theme::PICTURE_TEXT)] {
        let stroke = Stroke::new(width, ink);
        painter.line_segment([left, right], stroke);
        for end in [left, right] {
            painter.line_segment([end - vec2(0.0, 4.0), end + vec2(0.0, 4.0)], stroke);
        }
    }
    let middle = left + vec2(length / 2.0, -6.0);
    paint_outlined_text(painter, middle, Align2::CENTER_BOTTOM, &bar.label);
}

/// Paints the orientation cube at the top right; its faces can be clicked.
fn show_orientation_cube(
    ui: &Ui,
    painter: &Painter,
    picture: Rect,
    camera: &Camera,
    is_anatomical: bool,
) -> Option<StandardView> {
    let middle = pos2(picture.right() - 1.1 * CUBE_EDGE, picture.top() + 1.1 * CUBE_EDGE);
    let view = camera.scene_from_view();
    let seen = |point: DVec3| {
        let local = view.transpose() * point;
        middle + vec2(local.x as f32, -local.y as f32) * (CUBE_EDGE / 2.0)
    };
    let mut clicked = None;
    let pointer = ui.ctx().pointer_hover_pos();
    for (normal, names) in SCENE_SIDES {
        let name = names[usize::from(is_anatomical)];
        let facing = view.z_axis.dot(normal);
        if facing <= 0.02 {
            continue;
        }
        let (a, b) = (DVec3::new(normal.y, normal.z, normal.x), DVec3::new(normal.z, normal.x, normal.y));
        let corners = [a + b, b - a, -a - b, a - b].map(|corner| seen(normal + corner));
        let area = Rect::from_points(&corners);
        let hovered = pointer.is_some_and(|pointer| contains(&corners, pointer));
        let view = StandardView::nearest_side(normal, camera.up);
        // The face under the pointer receives the clicks of its bounding box.
        if hovered {
            let response = ui.interact(area, ui.scope_id().with(("cube", name)), Sense::click());
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, view.name(camera.up)));
            if response.clicked() {
                clicked = Some(view);
            }
            response.on_hover_text(view.name(camera.up));
        }
        let shade = 0.35 + 0.45 * facing as f32;
        let fill = if hovered {
            theme::ACCENT.gamma_multiply(0.8)
        } else {
            theme::GUIDE.gamma_multiply(shade * 0.35)
        };
        painter.add(Shape::convex_polygon(
            corners.to_vec(),
            composite_over(theme::OUTLINE, fill),
            Stroke::new(1.0, theme::GUIDE.gamma_multiply(0.6)),
        ));
        if facing > 0.35 {
            painter.text(
                seen(normal),
                Align2::CENTER_CENTER,
                name,
                FontId::proportional(12.0),
                theme::PICTURE_TEXT.gamma_multiply(facing.sqrt() as f32),
            );
        }
    }
    clicked
}

/// Composites a translucent colour over an opaque one.
fn composite_over(below: Color32, ink: Color32) -> Color32 {
    let blend = |a: u8, b: u8| (f32::from(a) * (1.0 - f32::from(ink.a()) / 255.0)).round() as u8 + b;
    let [r, g, b, _] = below.to_array();
    Color32::from_rgb(
        blend(r, 0).saturating_add(ink.r()),
        blend(g, 0).saturating_add(ink.g()),
        blend(b, 0).saturating_add(ink.b()),
    )
}

/// Returns true if a convex polygon contains a point.
fn contains(corners: &[Pos2; 4], point: Pos2) -> bool {
    let cross = |a: Vec2, b: Vec2| a.x * b.y - a.y * b.x;
    let side = |at: usize| cross(corners[(at + 1) % 4] - corners[at], point - corners[at]);
    let sides = [0, 1, 2, 3].map(side);
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_hold_what_is_in_them() {
        let square = [pos2(0.0, 0.0), pos2(4.0, 0.0), pos2(4.0, 4.0), pos2(0.0, 4.0)];
        assert!(contains(&square, pos2(1.0, 3.0)) && !contains(&square, pos2(5.0, 1.0)));
    }
}
