//! Painting into render passes of another program: every byte of the picture, whatever the format of its target.

use chiaroscuro_render::{GpuContext, PictureOptions, PicturePainter, RenderOptions, Renderer};
use chiaroscuro_scene::PixelFormat;
use wgpu::TextureFormat;

use super::window::{SIZE, drawn};
use crate::common::{Dataset, context};
use crate::scenes::{creature, look};

/// Bytes of a target into which a picture was painted, and those that the renderer reads back.
fn painted_and_read(context: &GpuContext, format: TextureFormat, options: &RenderOptions) -> [Vec<u8>; 2] {
    let loaded = Dataset::new(creature(16, glam::DVec3::ONE));
    let mut renderer = Renderer::new(context).expect("a renderer");
    let painter = PicturePainter::new(context, format).expect("a painter");
    renderer.draw(&loaded, &look(), SIZE, options).expect("a picture");
    let painted = drawn(context, format, |pass| painter.paint(&renderer, pass).expect("there is a picture"));
    [painted, renderer.read_display().expect("it is read back")]
}

#[test]
fn pictures_reach_textures_of_others_byte_for_byte() {
    let context = context();
    for transparent in [false, true] {
        let eight = RenderOptions::from(PictureOptions { transparent, ..PictureOptions::default() });
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb] {
            let [painted, read] = painted_and_read(&context, format, &eight);
            assert!(painted == read, "{format:?}, transparent: {transparent}");
            let first = &read[..4];
            assert!(read.chunks(4).any(|texel| texel != first), "something is to be seen");
        }
        for format in [TextureFormat::Bgra8Unorm, TextureFormat::Bgra8UnormSrgb] {
            let [mut painted, read] = painted_and_read(&context, format, &eight);
            painted.chunks_mut(4).for_each(|texel| texel.swap(0, 2));
            assert!(painted == read, "{format:?}, transparent: {transparent}");
        }
        for depth in [PixelFormat::Sixteen, PixelFormat::Linear] {
            let deep = RenderOptions::from(PictureOptions { depth, ..eight.picture.clone() });
            let [painted, read] = painted_and_read(&context, TextureFormat::Rgba32Float, &deep);
            assert!(painted == read, "{depth:?}, transparent: {transparent}");
        }
    }
}

#[test]
fn what_cannot_be_painted_is_refused() {
    let context = context();
    let format = TextureFormat::Rgba8Unorm;
    let painter = PicturePainter::new(&context, format).expect("a painter");
    let renderer = Renderer::new(&context).expect("a renderer");
    drawn(&context, format, |pass| {
        let outcome = painter.paint(&renderer, pass);
        assert!(outcome.is_err(), "nothing was drawn");
    });
    assert!(PicturePainter::new(&context, TextureFormat::Depth32Float).is_err(), "no colours");
}

#[test]
fn a_device_opened_without_the_features_says_so() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = adapters.first().expect("an adapter");
    let descriptor = wgpu::DeviceDescriptor::default();
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    let outcome = GpuContext::new(adapter, device, queue).map(|_| ());
    let message = outcome.expect_err("16-bit volumes cannot be stored").to_string();
    assert!(message.contains("device_descriptor"), "{message}");
}
