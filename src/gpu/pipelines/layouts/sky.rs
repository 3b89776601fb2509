//! What the shaders of a sky bind.

use super::{CLAMPED, GRID, Layouts, NEAREST, PYRAMID_TEXTURE, TABLE};
use crate::gpu::pipelines::binding::{Access, Format, Shape, Slot};
use crate::gpu::pipelines::uniforms;

/// Rays through blocks.
pub(super) const SWEEP: Slot = Slot::uniform::<uniforms::Sweep>(0, "bound_sweep");

/// Shaders in `shaders/sky`.
pub(super) const LAYOUTS: Layouts = &[
    (
        "sky/blocks.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::Blocks>(0, "bound_blocks"),
                TABLE,
                Slot::sampled(2, "distances", Shape::Volume),
                Slot::target(3, "extinction", Shape::Volume, Format::Storage),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED, NEAREST],
        ],
    ),
    (
        "sky/floor_map.wgsl",
        &[&[
            SWEEP,
            Slot::uniform::<uniforms::FloorMap>(1, "bound_map"),
            Slot::loaded(2, "sheets", Shape::Volume),
            Slot::list(3, "sums", 16, Access::ReadWrite),
            Slot::target(4, "moments", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
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
        ]],
    ),
    (
        "sky/sweep.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "extinction", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::target(3, "sheets", Shape::Volume, Format::Storage),
        ]],
    ),
];
