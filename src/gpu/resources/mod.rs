//! What every pass is made of: buffers and textures that are used again, lists, uniforms, dispatches.

pub(super) mod binding;
pub(super) mod cached;
pub(super) mod layouts;

pub(super) mod listed_bricks;
pub(super) mod part;
pub(super) mod pass;
pub(super) mod pool;
pub(super) mod readback;
pub(super) mod tools;
#[cfg_attr(
    not(feature = "testing"),
    expect(
        unreachable_pub,
        clippy::struct_field_names,
        reason = "the tests that compare them with the shaders' reach them; names are those of the shaders"
    )
)]
pub mod uniforms;
pub(super) mod variant;
