//! Pictures and backgrounds of the window as shapes of egui, drawn by pipelines of our own
//! (`shaders/output/window.wgsl` says why).

use eframe::egui::{Color32, PaintCallbackInfo, Rect, Shape};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait};
use eframe::wgpu;

use crate::gpu::{WindowPainter, WindowPicture};

enum Drawing {
    /// With an opacity, and moved to the right by so many pixels.
    Picture(WindowPicture, u8, i16),
    Fill(WindowPainter, [u8; 3]),
}

impl CallbackTrait for Drawing {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        match self {
            Self::Picture(picture, opacity, moved) => picture.draw(pass, *opacity, *moved),
            Self::Fill(painter, color) => painter.fill(pass, *color),
        }
    }
}

/// A picture, stretched over a rectangle.
pub(in crate::app) fn picture(rect: Rect, picture: &WindowPicture, opacity: u8) -> Shape {
    drawing(rect, Drawing::Picture(picture.clone(), opacity, 0))
}

/// A picture, stretched over a rectangle and moved within it to the right by a share of its width.
pub(in crate::app) fn moved_picture(rect: Rect, picture: &WindowPicture, share: f32) -> Shape {
    let pixels = (share * picture.width() as f32).round() as i16;
    drawing(rect, Drawing::Picture(picture.clone(), u8::MAX, pixels))
}

fn drawing(rect: Rect, drawing: Drawing) -> Shape {
    Shape::Callback(Callback::new_paint_callback(rect, drawing))
}

/// A rectangle of one opaque colour.
pub(in crate::app) fn fill(rect: Rect, painter: &WindowPainter, color: Color32) -> Shape {
    let [red, green, blue, _] = color.to_array();
    drawing(rect, Drawing::Fill(painter.clone(), [red, green, blue]))
}
