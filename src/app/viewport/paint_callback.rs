//! Paint callbacks: pictures and backgrounds of the window as egui shapes, drawn by the viewer's own pipelines
//! (`shaders/output/painter.wgsl` says why).

use eframe::egui::{Color32, PaintCallbackInfo, Rect, Shape};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait};
use eframe::wgpu;

use chiaroscuro_render::{WindowPainter, WindowPicture};

enum PictureCallback {
    /// Picture with its opacity (0 to 255) and its shift to the right in pixels.
    Picture(WindowPicture, u8, i16),
    Fill(WindowPainter, [u8; 3]),
}

impl CallbackTrait for PictureCallback {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        match self {
            Self::Picture(picture, opacity, moved) => picture.draw(pass, *opacity, *moved),
            Self::Fill(painter, color) => painter.fill(pass, *color),
        }
    }
}

/// Returns the shape of a picture that is stretched over a rectangle.
pub(crate) fn picture_shape(rect: Rect, picture: &WindowPicture, opacity: u8) -> Shape {
    callback_shape(rect, PictureCallback::Picture(picture.clone(), opacity, 0))
}

/// Returns the shape of a picture that is stretched over a rectangle and shifted to the right by a fraction of its
/// width.
pub(crate) fn shifted_picture_shape(rect: Rect, picture: &WindowPicture, share: f32) -> Shape {
    let pixels = (share * picture.width() as f32).round() as i16;
    callback_shape(rect, PictureCallback::Picture(picture.clone(), u8::MAX, pixels))
}

fn callback_shape(rect: Rect, drawing: PictureCallback) -> Shape {
    Shape::Callback(Callback::new_paint_callback(rect, drawing))
}

/// Returns the shape of a rectangle in one opaque colour.
pub(crate) fn fill_shape(rect: Rect, painter: &WindowPainter, color: Color32) -> Shape {
    let [red, green, blue, _] = color.to_array();
    callback_shape(rect, PictureCallback::Fill(painter.clone(), [red, green, blue]))
}
