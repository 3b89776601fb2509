//! Pictures and backgrounds of the window as shapes of egui, drawn by pipelines of our own
//! (`shaders/output/window.wgsl` says why).

use eframe::egui::{Color32, PaintCallbackInfo, Rect, Shape};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait};
use eframe::wgpu;

use crate::gpu::{WindowPainter, WindowPicture};

enum Drawing {
    /// With an opacity.
    Picture(WindowPicture, u8),
    Fill(WindowPainter, [u8; 3]),
}

impl CallbackTrait for Drawing {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        match self {
            Self::Picture(picture, opacity) => picture.draw(pass, *opacity),
            Self::Fill(painter, color) => painter.fill(pass, *color),
        }
    }
}

/// A picture, stretched over a rectangle.
pub(in crate::app) fn picture(rect: Rect, picture: &WindowPicture, opacity: u8) -> Shape {
    Shape::Callback(Callback::new_paint_callback(rect, Drawing::Picture(picture.clone(), opacity)))
}

/// A rectangle of one opaque colour.
pub(in crate::app) fn fill(rect: Rect, painter: &WindowPainter, color: Color32) -> Shape {
    let [red, green, blue, _] = color.to_array();
    Shape::Callback(Callback::new_paint_callback(rect, Drawing::Fill(painter.clone(), [red, green, blue])))
}
