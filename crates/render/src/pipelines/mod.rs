//! Shader sources, pipelines and their variants, bindings by name, uniforms.

pub(super) mod binding;
pub(super) mod layouts;
#[cfg(feature = "testing")]
pub(super) mod library_pool;
mod pipeline_cache;
pub(super) mod pipeline_variant;
pub(super) mod preprocessor;
pub(super) mod shader_files;
pub(super) mod shader_library;
#[cfg_attr(
    not(feature = "testing"),
    expect(unreachable_pub, reason = "the tests that compare them with those of the shaders reach them")
)]
pub mod uniforms;
