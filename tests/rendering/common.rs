//! What the rendering tests share: a device and ways to render.

pub(crate) use chiaroscuro::data::Dataset;
use chiaroscuro::gpu::{Context, Picture, RenderOptions, Renderer, ShaderLibrary};
use chiaroscuro::model::Settings;

/// A device, or a failed test: without one nothing is checked, and that must be seen.
pub(crate) fn context() -> Context {
    Context::headless().unwrap_or_else(|err| panic!("the rendering tests need a graphics adapter: {err}"))
}

/// A picture with everything as the settings say.
pub(crate) fn render(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    size: [u32; 2],
) -> Picture {
    renderer.render(loaded, settings, size, &RenderOptions::default()).expect("the picture is rendered")
}

/// A light's attenuation volume, filled everywhere.
pub(crate) fn attenuation(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    light: usize,
) -> Vec<f32> {
    let options = RenderOptions { fill_everything: true, ..RenderOptions::default() };
    renderer.draw(loaded, settings, [8, 8], &options).expect("the light volume is filled");
    let request = chiaroscuro::plan::Request {
        volume: loaded.volume().id(),
        settings: settings.clone(),
        size: [8, 8],
        coarse: None,
    };
    renderer.attenuation(&request, light).expect("it is read back").expect("the light has a volume").values
}

/// A renderer whose shaders have something else in place of `from`.
pub(crate) fn damaged(from: &str, to: &str) -> Renderer {
    let context = context();
    let shaders = ShaderLibrary::with_mutation(&context, from, to);
    Renderer::with_shaders(&context, shaders).expect("a renderer")
}
