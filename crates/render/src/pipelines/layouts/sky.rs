//! Bind-group layouts of the shaders for sky visibility.

use super::{PYRAMID, ShaderLayouts, TABLE};
use crate::pipelines::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use crate::pipelines::uniforms;

/// Uniform of a batch of rays through blocks.
pub(super) const SWEEP: BindingSlot = BindingSlot::uniform::<uniforms::SweepUniform>(0, "bound_sweep");

/// List of the tiles in which rays are followed.
pub(super) const TILES: BindingSlot = BindingSlot::storage(4, "tiles", 4, BufferAccess::Read);

/// List of the cells of blocks in which something may attenuate light.
pub(super) const CELLS: BindingSlot = BindingSlot::storage(2, "cells", 4, BufferAccess::Read);

/// Sampler of blocks, and of the sheets through them.
pub(super) const BLOCK_SAMPLER: BindingSlot = BindingSlot::bind_sampler(2, "clamped");

/// Sums of the moments over the batches of directions.
const SUMS: BindingSlot = BindingSlot::storage(3, "sums", 16, BufferAccess::ReadWrite);

/// Own surface of each listed block.
const SURFACES: BindingSlot = BindingSlot::storage(6, "surfaces", 16, BufferAccess::Read);

/// Geometry of blocks, for their surfaces.
const SURFACE_BLOCKS: BindingSlot =
    BindingSlot::uniform::<uniforms::SurfaceBlocksUniform>(7, "bound_geometry");

const FLOOR_PLACE: BindingSlot = BindingSlot::uniform::<uniforms::FloorSkyMapUniform>(5, "bound_map");

/// Declares the texture of moments that is written.
const fn moments_slot(number: u32) -> BindingSlot {
    let format = StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float);
    BindingSlot::storage_texture(number, "moments", TextureShape::D3, format)
}

/// Layouts of the shaders in `shaders/sky`.
pub(super) const LAYOUTS: ShaderLayouts = &[
    ("sky/clear_margin.wgsl", &[&[BindingSlot::storage(0, "cells", 4, BufferAccess::Read), moments_slot(1)]]),
    (
        "sky/extinction_blocks.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::BlocksUniform>(0, "bound_blocks"),
                TABLE,
                CELLS,
                BindingSlot::storage_texture(3, "extinction", TextureShape::D3, StorageFormat::Storage),
            ],
            PYRAMID,
        ],
    ),
    (
        "sky/floor_map.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "transmittance", TextureShape::D3),
            BLOCK_SAMPLER,
            SUMS,
            moments_slot(4),
            FLOOR_PLACE,
        ]],
    ),
    (
        "sky/floor_sweep.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "extinction", TextureShape::D3),
            BLOCK_SAMPLER,
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
            BLOCK_SAMPLER,
            SUMS,
            moments_slot(4),
            BindingSlot::storage(5, "cells", 4, BufferAccess::Read),
            SURFACES,
            SURFACE_BLOCKS,
        ]],
    ),
    (
        "sky/sharpened_blocks.wgsl",
        &[&[
            BindingSlot::loaded_texture(1, "extinction", TextureShape::D3),
            BindingSlot::storage_texture(3, "sharpened", TextureShape::D3, StorageFormat::Storage),
            BindingSlot::storage(5, "cells", 4, BufferAccess::Read),
            SURFACE_BLOCKS,
        ]],
    ),
    (
        "sky/surfaces.wgsl",
        &[&[
            BindingSlot::sampled_texture(1, "extinction", TextureShape::D3),
            BLOCK_SAMPLER,
            BindingSlot::storage(5, "cells", 4, BufferAccess::Read),
            BindingSlot::storage(6, "surfaces", 16, BufferAccess::ReadWrite),
            SURFACE_BLOCKS,
            BindingSlot::uniform::<uniforms::SkyDirectionsUniform>(8, "bound_directions"),
        ]],
    ),
    (
        "sky/sweep.wgsl",
        &[&[
            SWEEP,
            BindingSlot::sampled_texture(1, "extinction", TextureShape::D3),
            BLOCK_SAMPLER,
            BindingSlot::storage_texture(3, "sheets", TextureShape::D3, StorageFormat::Storage),
            TILES,
        ]],
    ),
];
