//! Shader sources with resolved imports, and their variants.

use chiaroscuro_render::{SHADERS, ShaderLibrary, shader_conditions};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::TextureFormat;

/// Formats of storage textures to be tested.
pub(crate) const FORMATS: [TextureFormat; 2] = [TextureFormat::R16Float, TextureFormat::R32Float];

/// Names of shaders with an entry point.
pub(crate) fn entry_shaders() -> Vec<&'static str> {
    let has_entry = |text: &str| text.contains("@compute") || text.contains("@fragment");
    SHADERS.iter().filter(|(_, text)| has_entry(text)).map(|(name, _)| *name).collect()
}

/// Source of a shader with its imports.
pub(crate) fn shader_source(name: &str) -> String {
    ShaderLibrary::source(name, TextureFormat::R16Float, TextureFormat::R16Float)
        .expect("the shader and its imports are there")
}

/// Variants of a shader, with a description: all conditional parts, none, each alone, and all others.
pub(crate) fn variants(
    name: &str,
    storage: TextureFormat,
    attenuation: TextureFormat,
) -> Vec<(String, String)> {
    let source = |what: String, value: &dyn Fn(&str) -> f64| {
        let source = ShaderLibrary::preprocessed_source(name, storage, attenuation, value);
        (what, source.expect("the shader, its imports and its conditions are there"))
    };
    let mut all = vec![source("all".to_owned(), &|_| 9.0), source("none".to_owned(), &|_| 0.0)];
    for one in shader_conditions() {
        let is_one = |condition: &str| f64::from(u8::from(condition == one));
        all.push(source(format!("{one} alone"), &is_one));
        all.push(source(format!("all but {one}"), &|condition| 9.0 * (1.0 - is_one(condition))));
    }
    all
}

/// Parses and validates a shader; no capability beyond the core is allowed.
pub(crate) fn validate_shader(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|err| err.emit_to_string(source))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|err| err.emit_to_string(source))?;
    Ok(module)
}

/// Source text without line comments.
pub(crate) fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Files that a shader file imports directly.
pub(crate) fn imports_of(text: &str) -> Vec<&str> {
    text.lines()
        .filter_map(|line| line.trim().strip_prefix("#import"))
        .map(|rest| rest.trim().trim_matches('"'))
        .collect()
}
