//! Shared helpers of the rendering tests: a device and ways to render.

use chiaroscuro_render::{GpuContext, RenderOptions, RenderedPicture, Renderer, ShaderLibrary, WorkOptions};
use chiaroscuro_scene::Settings;
pub(crate) use chiaroscuro_volume::Dataset;

/// Opens a device, or fails the test: a check that did not run must be seen.
pub(crate) fn context() -> GpuContext {
    GpuContext::headless().unwrap_or_else(|err| panic!("the rendering tests need a graphics adapter: {err}"))
}

/// Renders a picture with default options.
pub(crate) fn render(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    size: [u32; 2],
) -> RenderedPicture {
    renderer.render(loaded, settings, size, &RenderOptions::default()).expect("the picture is rendered")
}

/// Attenuation volume of a light, filled everywhere.
pub(crate) fn full_attenuation(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    light: usize,
) -> Vec<f32> {
    let options = RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
    renderer.draw(loaded, settings, [8, 8], &options).expect("the light volume is filled");
    let request = chiaroscuro_render::plan::RenderRequest {
        volume: loaded.id(),
        settings: settings.clone(),
        size: [8, 8],
        preview_resolution: None,
    };
    renderer.attenuation(&request, light).expect("it is read back").expect("the light has a volume").values
}

/// Creates a renderer whose shaders have `from` replaced by `to`.
pub(crate) fn damaged_renderer(from: &str, to: &str) -> Renderer {
    let context = context();
    let shaders = ShaderLibrary::with_mutation(&context, from, to);
    Renderer::with_shaders(&context, shaders).expect("a renderer")
}
