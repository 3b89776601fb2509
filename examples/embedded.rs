//! Example of the renderer inside another wgpu program, whose own texture receives the picture; pixels stay on the
//! GPU.
//! `cargo run --example embedded`
#![expect(clippy::print_stdout, reason = "it says what it made")]

use std::error::Error;

use chiaroscuro_render::{
    GpuContext, PicturePainter, RenderOptions, Renderer, device_descriptor, first_look,
};
use chiaroscuro_volume::{Dataset, synthetic};

fn main() -> Result<(), Box<dyn Error>> {
    // The other program opens its device itself, with at least the features and limits of `device_descriptor`.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(&adapter)))?;
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the program's own texture"),
        size: wgpu::Extent3d { width: 320, height: 240, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Bgra8UnormSrgb,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());

    // Once: a renderer on that device, and a painter for targets of that format.
    let context = GpuContext::new(&adapter, device.clone(), queue.clone())?;
    let mut renderer = Renderer::new(&context)?;
    let painter = PicturePainter::new(&context, target.format())?;
    let dataset = Dataset::new(synthetic::builtin("chair", Some(32))?);
    let settings = first_look(&mut renderer, &dataset)?;

    // For every picture: draw it, and paint it in a render pass of the program, here into a part of its texture.
    // Programs that must not block run the renderer's work step by step (`Renderer::new`).
    let size = [200, 150];
    renderer.draw(&dataset, &settings, size, &RenderOptions::default())?;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLUE),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_viewport(60.0, 45.0, size[0] as f32, size[1] as f32, 0.0, 1.0);
    painter.paint(&renderer, &mut pass)?;
    drop(pass);
    queue.submit([encoder.finish()]);
    context.wait()?;
    println!("{size:?} pixels in the middle of a texture of {:?}", target.format());
    Ok(())
}
