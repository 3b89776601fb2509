//! Bind-group layouts of the shaders for sky visibility.

use super::{CLAMPED, GRID, Layouts, PYRAMID_TEXTURE, TABLE};
use crate::gpu::pipelines::binding::{Access, Format, Shape, Slot};
use crate::gpu::pipelines::uniforms;

/// Uniform of a batch of rays through blocks.
pub(super) const SWEEP: Slot = Slot::uniform::<uniforms::Sweep>(0, "bound_sweep");

/// List of the tiles in which rays are followed.
pub(super) const TILES: Slot = Slot::list(4, "tiles", 4, Access::Read);

/// List of the cells of blocks in which something may attenuate light.
pub(super) const CELLS: Slot = Slot::list(2, "cells", 4, Access::Read);

const FLOOR_PLACE: Slot = Slot::uniform::<uniforms::FloorMap>(5, "bound_map");

/// Layouts of the shaders in `shaders/sky`.
pub(super) const LAYOUTS: Layouts = &[
    (
        "sky/blocks.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::Blocks>(0, "bound_blocks"),
                TABLE,
                CELLS,
                Slot::target(3, "extinction", Shape::Volume, Format::Storage),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED],
        ],
    ),
    (
        "sky/clear_margin.wgsl",
        &[&[
            Slot::list(0, "cells", 4, Access::Read),
            Slot::target(1, "moments", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
        ]],
    ),
    (
        "sky/floor_map.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "left", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::list(3, "sums", 16, Access::ReadWrite),
            Slot::target(4, "moments", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            FLOOR_PLACE,
        ]],
    ),
    (
        "sky/floor_sweep.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "extinction", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::target(3, "left", Shape::Volume, Format::Storage),
            TILES,
            FLOOR_PLACE,
        ]],
    ),
    (
        "sky/moments.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "sheets", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::list(3, "sums", 16, Access::ReadWrite),
            Slot::target(4, "moments", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            Slot::list(5, "cells", 4, Access::Read),
        ]],
    ),
    (
        "sky/sweep.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "extinction", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::target(3, "sheets", Shape::Volume, Format::Storage),
            TILES,
        ]],
    ),
];
