//! Bind-group layouts of the shaders for sky visibility.

use super::{CLAMPED, GRID, PYRAMID_TEXTURE, ShaderLayouts, TABLE};
use crate::pipelines::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use crate::pipelines::uniforms;

/// Uniform of a batch of rays through blocks.
pub(super) const SWEEP: BindingSlot = BindingSlot::uniform::<uniforms::SweepUniform>(0, "bound_sweep");

/// List of the tiles in which rays are followed.
pub(super) const TILES: BindingSlot = BindingSlot::storage(4, "tiles", 4, BufferAccess::Read);

/// List of the cells of blocks in which something may attenuate light.
pub(super) const CELLS: BindingSlot = BindingSlot::storage(2, "cells", 4, BufferAccess::Read);

const FLOOR_PLACE: BindingSlot = BindingSlot::uniform::<uniforms::FloorSkyMapUniform>(5, "bound_map");

/// Layouts of the shaders in `shaders/sky`.
pub(super) const LAYOUTS: ShaderLayouts = &[
    (
        "sky/clear_margin.wgsl",
        &[&[
            BindingSlot::storage(0, "cells", 4, BufferAccess::Read),
            BindingSlot::storage_texture(
                1,
                "moments",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
        ]],
    ),
    (
        "sky/extinction_blocks.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::BlocksUniform>(0, "bound_blocks"),
                TABLE,
                CELLS,
                BindingSlot::storage_texture(3, "extinction", TextureShape::D3, StorageFormat::Storage),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED],
        ],
    ),
    (
        "sky/floor_map.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "transmittance", TextureShape::D3),
            BindingSlot::bind_sampler(2, "clamped"),
            BindingSlot::storage(3, "sums", 16, BufferAccess::ReadWrite),
            BindingSlot::storage_texture(
                4,
                "moments",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
            FLOOR_PLACE,
        ]],
    ),
    (
        "sky/floor_sweep.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "extinction", TextureShape::D3),
            BindingSlot::bind_sampler(2, "clamped"),
            BindingSlot::storage_texture(3, "transmittance", TextureShape::D3, StorageFormat::Storage),
            TILES,
            FLOOR_PLACE,
        ]],
    ),
    (
        "sky/moments.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "sheets", TextureShape::D3),
            BindingSlot::bind_sampler(2, "clamped"),
            BindingSlot::storage(3, "sums", 16, BufferAccess::ReadWrite),
            BindingSlot::storage_texture(
                4,
                "moments",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
            BindingSlot::storage(5, "cells", 4, BufferAccess::Read),
        ]],
    ),
    (
        "sky/sweep.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "extinction", TextureShape::D3),
            BindingSlot::bind_sampler(2, "clamped"),
            BindingSlot::storage_texture(3, "sheets", TextureShape::D3, StorageFormat::Storage),
            TILES,
        ]],
    ),
];
