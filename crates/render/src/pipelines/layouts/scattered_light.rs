//! Bind-group layouts of the shaders for scattered light.

use super::sky::{BLOCK_SAMPLER, CELLS, SWEEP, TILES};
use super::{CLAMPED, GRID, PYRAMID_TEXTURE, ShaderLayouts, TABLE, TABLE_BYTES};
use crate::pipelines::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use crate::pipelines::uniforms;

const RGBA16: StorageFormat = StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float);

const BOUNCE: BindingSlot = BindingSlot::uniform::<uniforms::BounceUniform>(3, "bound_bounce");
const SCATTERING: BindingSlot = BindingSlot::storage(4, "scattering", 16, BufferAccess::Read);
const SUMS: BindingSlot = BindingSlot::storage(5, "sums", 16, BufferAccess::Read);

/// Layouts of the shaders in `shaders/scattered_light`.
pub(super) const LAYOUTS: ShaderLayouts = &[
    (
        "scattered_light/blocks.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::BlocksUniform>(0, "bound_blocks"),
                TABLE,
                CELLS,
                BindingSlot::storage(27, "look_table", TABLE_BYTES, BufferAccess::Read),
                BindingSlot::sampled_texture(23, "look_pyramid", TextureShape::D3),
                BindingSlot::storage(6, "scattering", 16, BufferAccess::ReadWrite),
                BindingSlot::storage_texture(7, "medium", TextureShape::D3, StorageFormat::Target),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED],
        ],
    ),
    (
        "scattered_light/gather.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "sheets", TextureShape::D3),
            BLOCK_SAMPLER,
            BOUNCE,
            SCATTERING,
            BindingSlot::storage(5, "sums", 16, BufferAccess::ReadWrite),
            BindingSlot::storage(6, "cells", 4, BufferAccess::Read),
        ]],
    ),
    (
        "scattered_light/ratio.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            SUMS,
            BindingSlot::storage(7, "last", 16, BufferAccess::Read),
            BindingSlot::storage(8, "change", 16, BufferAccess::Read),
            BindingSlot::storage(9, "ratio", 16, BufferAccess::ReadWrite),
        ]],
    ),
    (
        "scattered_light/result.wgsl",
        &[&[
            BOUNCE,
            SUMS,
            BindingSlot::storage(6, "cells", 4, BufferAccess::Read),
            BindingSlot::storage_texture(10, "bounced", TextureShape::D3, RGBA16),
        ]],
    ),
    (
        "scattered_light/single_scattering.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::SingleScatteringUniform>(0, "bound_scene"),
            BindingSlot::sampled_texture(1, "medium", TextureShape::D3),
            BLOCK_SAMPLER,
            BOUNCE,
            SCATTERING,
            SUMS,
            BindingSlot::storage(6, "first", 16, BufferAccess::ReadWrite),
        ]],
    ),
    (
        "scattered_light/source.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            SUMS,
            BindingSlot::storage(6, "first", 16, BufferAccess::Read),
            BindingSlot::storage(7, "last", 16, BufferAccess::ReadWrite),
            BindingSlot::storage(8, "change", 16, BufferAccess::ReadWrite),
            BindingSlot::storage_texture(9, "medium", TextureShape::D3, StorageFormat::Target),
            BindingSlot::storage(10, "ratio", 16, BufferAccess::Read),
        ]],
    ),
    (
        "scattered_light/sweep.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "medium", TextureShape::D3),
            BLOCK_SAMPLER,
            BindingSlot::storage_texture(3, "sheets", TextureShape::D3, StorageFormat::Target),
            TILES,
        ]],
    ),
];
