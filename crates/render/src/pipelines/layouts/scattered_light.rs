//! Bind-group layouts of the shaders for scattered light.

use super::sky::{BLOCK_SAMPLER, CELLS, SWEEP, TILES};
use super::{PYRAMID, ShaderLayouts, TABLE, TABLE_BYTES};
use crate::pipelines::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use crate::pipelines::uniforms;

const RGBA16: StorageFormat = StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float);

const BOUNCE: BindingSlot = BindingSlot::uniform::<uniforms::BounceUniform>(3, "bound_bounce");
const SCATTERING: BindingSlot = BindingSlot::storage(4, "scattering", 16, BufferAccess::Read);
const SUMS: BindingSlot = BindingSlot::storage(5, "sums", 16, BufferAccess::Read);
const RECEIVED: BindingSlot = BindingSlot::storage(5, "received", 16, BufferAccess::Read);

const LAST: BindingSlot = BindingSlot::storage(7, "last", 16, BufferAccess::ReadWrite);
const STEP_BEFORE: BindingSlot = BindingSlot::storage(8, "step_before", 16, BufferAccess::ReadWrite);
const SOLUTION_OF_SERIES: BindingSlot = BindingSlot::storage(11, "solution", 16, BufferAccess::Read);

const LEVEL: BindingSlot = BindingSlot::uniform::<uniforms::DiffusionLevelUniform>(0, "bound_level");
/// Scattering of the blocks, in the shaders of diffusion.
const DIFFUSION_SCATTERING: BindingSlot = BindingSlot::storage(1, "scattering", 16, BufferAccess::Read);
/// Bindings of the shaders that balance the solution of the diffusion equation.
const DIFFUSION: &[BindingSlot] = &[
    LEVEL,
    BindingSlot::storage(1, "stencils", 16, BufferAccess::Read),
    BindingSlot::storage(2, "right_sides", 16, BufferAccess::ReadWrite),
    BindingSlot::storage(3, "solution", 16, BufferAccess::ReadWrite),
];

/// Layouts of the shaders in `shaders/scattered_light` and `shaders/diffusion`.
pub(super) const LAYOUTS: ShaderLayouts = &[
    (
        "diffusion/coarser_stencil.wgsl",
        &[&[LEVEL, BindingSlot::storage(1, "stencils", 16, BufferAccess::ReadWrite)]],
    ),
    ("diffusion/coarsest.wgsl", &[DIFFUSION]),
    ("diffusion/relax.wgsl", &[DIFFUSION]),
    ("diffusion/restrict.wgsl", &[DIFFUSION]),
    (
        "diffusion/right_side.wgsl",
        &[&[
            LEVEL,
            BindingSlot::storage(1, "stencils", 16, BufferAccess::Read),
            BindingSlot::storage(2, "right_sides", 16, BufferAccess::ReadWrite),
            BindingSlot::storage(3, "solution", 16, BufferAccess::ReadWrite),
            BindingSlot::storage(4, "scattering", 16, BufferAccess::Read),
            BindingSlot::storage(5, "received", 16, BufferAccess::Read),
            BindingSlot::storage(6, "first", 16, BufferAccess::Read),
            BindingSlot::storage(7, "last", 16, BufferAccess::Read),
        ]],
    ),
    (
        "diffusion/stencil.wgsl",
        &[&[LEVEL, DIFFUSION_SCATTERING, BindingSlot::storage(2, "stencils", 16, BufferAccess::ReadWrite)]],
    ),
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
            PYRAMID,
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
        "scattered_light/mixing.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            RECEIVED,
            LAST,
            STEP_BEFORE,
            SOLUTION_OF_SERIES,
            BindingSlot::storage(9, "mixing", 16, BufferAccess::ReadWrite),
        ]],
    ),
    (
        "scattered_light/received_light.wgsl",
        &[&[BOUNCE, SCATTERING, SUMS, BindingSlot::storage(6, "received", 16, BufferAccess::ReadWrite)]],
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
            RECEIVED,
            BindingSlot::storage(6, "first", 16, BufferAccess::ReadWrite),
        ]],
    ),
    (
        "scattered_light/source.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            RECEIVED,
            BindingSlot::storage(6, "first", 16, BufferAccess::Read),
            LAST,
            STEP_BEFORE,
            SOLUTION_OF_SERIES,
            BindingSlot::storage_texture(9, "medium", TextureShape::D3, StorageFormat::Target),
            BindingSlot::storage(10, "mixing", 16, BufferAccess::Read),
            BindingSlot::storage(12, "reached_before", 16, BufferAccess::ReadWrite),
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
