//! Shared helpers of the rendering tests: a device and ways to render.

use chiaroscuro_render::{
    GpuContext, RenderOptions, RenderedPicture, Renderer, ShaderLibrary, WorkOptions, pooled_library,
};
use chiaroscuro_scene::Settings;
pub(crate) use chiaroscuro_volume::Dataset;

/// Returns a device with its pipelines, or fails the test: a check that did not run must be seen.
pub(crate) fn shaders() -> ShaderLibrary {
    pooled_library().unwrap_or_else(|err| panic!("the rendering tests need a graphics adapter: {err}"))
}

/// Returns the device of the test.
pub(crate) fn context() -> GpuContext {
    shaders().context().clone()
}

/// Creates a renderer with the pipelines of other tests.
pub(crate) fn new_renderer() -> Renderer {
    let shaders = shaders();
    Renderer::with_shaders(&shaders.context().clone(), shaders).expect("a renderer")
}

/// Creates a renderer that stores light and pictures in 32 bits.
pub(crate) fn full_precision_renderer() -> Renderer {
    let shaders = shaders().with_full_precision();
    Renderer::with_shaders(&shaders.context().clone(), shaders).expect("a renderer")
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
    let shaders = shaders().with_mutation(from, to);
    Renderer::with_shaders(&shaders.context().clone(), shaders).expect("a renderer")
}
