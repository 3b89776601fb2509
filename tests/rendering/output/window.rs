//! Pictures in the window: every byte is displayed unchanged, whatever the window's format.

use chiaroscuro_render::{GpuContext, WindowPainter};

use crate::common::context;
use crate::thresholds::EIGHT_BITS;

/// Size of target and picture in pixels; a row of 256 bytes can be read back without padding.
pub(super) const SIZE: [u32; 2] = [64, 8];

/// Bytes in which every value occurs in every channel.
fn picture() -> Vec<u8> {
    (0..SIZE[0] * SIZE[1]).flat_map(|i| [i as u8, (i * 5 + 3) as u8, (i * 11 + 7) as u8, 255]).collect()
}

/// Bytes of a target after a drawing over black.
pub(super) fn drawn(
    context: &GpuContext,
    format: wgpu::TextureFormat,
    draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
) -> Vec<u8> {
    let [width, height] = SIZE;
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let target = context.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let texel = format.block_copy_size(None).expect("a format of colours");
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("bytes"),
        size: u64::from(texel * width * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    draw(&mut pass);
    drop(pass);
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * width), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        size,
    );
    context.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("it can be read"));
    context.wait().expect("the device works");
    buffer.get_mapped_range(..).expect("it is mapped").to_vec()
}

#[test]
fn pictures_reach_the_window_byte_for_byte() {
    let context = context();
    for format in [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba8UnormSrgb] {
        let painter = WindowPainter::new(&context.device, &context.queue, format).expect("a painter");
        let shown = painter.upload(None, SIZE, &picture(), true);
        assert!(drawn(&context, format, |pass| shown.draw(pass, 255, 0)) == picture(), "{format:?}");
        // A second picture replaces the first.
        let black = vec![[0, 0, 0, 255]; (SIZE[0] * SIZE[1]) as usize].concat();
        let shown = painter.upload(Some(shown), SIZE, &black, true);
        assert!(drawn(&context, format, |pass| shown.draw(pass, 255, 0)) == black, "{format:?}");
    }
}

/// Moved pictures are shifted to either side; beyond the edge the edge's colour is repeated.
#[test]
fn moved_pictures_are_moved_by_whole_pixels() {
    let context = context();
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let painter = WindowPainter::new(&context.device, &context.queue, format).expect("a painter");
    let shown = painter.upload(None, SIZE, &picture(), true);
    let [width, height] = SIZE.map(|n| n as usize);
    for moved in [-3_i16, 5] {
        let found = drawn(&context, format, |pass| shown.draw(pass, 255, moved));
        for (at, got) in found.chunks(4).enumerate() {
            let (x, y) = (at % width, at / width);
            let from = (x as isize - isize::from(moved)).clamp(0, width as isize - 1) as usize;
            assert_eq!(got, &picture()[4 * (from + y * width)..][..4], "{moved}: {x}, {y}");
        }
        assert_eq!(found.len(), 4 * width * height);
    }
}

#[test]
fn a_fading_picture_lets_the_ground_through() {
    let context = context();
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let painter = WindowPainter::new(&context.device, &context.queue, format).expect("a painter");
    let floor = [40_u8, 80, 120];
    let filled = drawn(&context, format, |pass| painter.fill(pass, floor));
    assert!(filled.chunks(4).all(|pixel| pixel == [40, 80, 120, 255]), "{:?}", &filled[..4]);
    let shown = painter.upload(None, SIZE, &picture(), true);
    for opacity in [0_u8, 85, 255] {
        let both = drawn(&context, format, |pass| {
            painter.fill(pass, floor);
            shown.draw(pass, opacity, 0);
        });
        let share = f64::from(opacity) / 255.0;
        for (got, on_top) in both.chunks(4).zip(picture().chunks(4)) {
            for channel in 0..3 {
                let wanted = f64::from(on_top[channel]) * share + f64::from(floor[channel]) * (1.0 - share);
                // Blended values may be rounded to either side.
                let apart = (f64::from(got[channel]) - wanted).abs() / 255.0;
                assert!(apart <= EIGHT_BITS, "{opacity}: {got:?}, {on_top:?}");
            }
        }
    }
}
