//! Shader sources, pipelines and their variants, bindings by name, uniforms.

pub(super) mod binding;
pub(super) mod layouts;
mod pipeline_cache;
pub(super) mod pipeline_variant;
pub(super) mod preprocessor;
pub(super) mod shader_files;
pub(super) mod shader_library;
#[cfg_attr(
    not(feature = "testing"),
    expect(
        unreachable_pub,
        clippy::struct_field_names,
        reason = "the tests that compare them with the shaders' reach them; names are those of the shaders"
    )
)]
pub mod uniforms;
