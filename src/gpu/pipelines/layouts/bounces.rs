//! Bind-group layouts of the shaders for scattered light.

use super::sky::{CELLS, SWEEP, TILES};
use super::{CLAMPED, GRID, Layouts, PYRAMID_TEXTURE, TABLE, TABLE_BYTES};
use crate::gpu::pipelines::binding::{Access, Format, Shape, Slot};
use crate::gpu::pipelines::uniforms;

const SIXTEEN_BITS: Format = Format::Of(wgpu::TextureFormat::Rgba16Float);

const BOUNCE: Slot = Slot::uniform::<uniforms::Bounce>(3, "bound_bounce");
const SCATTERING: Slot = Slot::list(4, "scattering", 16, Access::Read);
const SUMS: Slot = Slot::list(5, "sums", 16, Access::Read);

/// Layouts of the shaders in `shaders/bounces`.
pub(super) const LAYOUTS: Layouts = &[
    (
        "bounces/blocks.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::Blocks>(0, "bound_blocks"),
                TABLE,
                CELLS,
                Slot::list(4, "look_table", TABLE_BYTES, Access::Read),
                Slot::sampled(5, "look_pyramid", Shape::Volume),
                Slot::list(6, "scattering", 16, Access::ReadWrite),
                Slot::target(7, "medium", Shape::Volume, Format::Target),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED],
        ],
    ),
    (
        "bounces/first.wgsl",
        &[&[
            Slot::uniform::<uniforms::First>(0, "bound_scene"),
            Slot::sampled(1, "medium", Shape::Volume),
            Slot::sampler(2, "clamped"),
            BOUNCE,
            SCATTERING,
            SUMS,
            Slot::list(6, "first", 16, Access::ReadWrite),
        ]],
    ),
    (
        "bounces/gather.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "sheets", Shape::Volume),
            Slot::sampler(2, "clamped"),
            BOUNCE,
            SCATTERING,
            Slot::list(5, "sums", 16, Access::ReadWrite),
            Slot::list(6, "cells", 4, Access::Read),
        ]],
    ),
    (
        "bounces/outcome.wgsl",
        &[&[
            BOUNCE,
            SUMS,
            Slot::list(6, "cells", 4, Access::Read),
            Slot::target(10, "bounced", Shape::Volume, SIXTEEN_BITS),
        ]],
    ),
    (
        "bounces/ratio.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            SUMS,
            Slot::list(7, "last", 16, Access::Read),
            Slot::list(8, "change", 16, Access::Read),
            Slot::list(9, "ratio", 16, Access::ReadWrite),
        ]],
    ),
    (
        "bounces/source.wgsl",
        &[&[
            BOUNCE,
            SCATTERING,
            SUMS,
            Slot::list(6, "first", 16, Access::Read),
            Slot::list(7, "last", 16, Access::ReadWrite),
            Slot::list(8, "change", 16, Access::ReadWrite),
            Slot::target(9, "medium", Shape::Volume, Format::Target),
            Slot::list(10, "ratio", 16, Access::Read),
        ]],
    ),
    (
        "bounces/sweep.wgsl",
        &[&[
            SWEEP,
            Slot::sampled(1, "medium", Shape::Volume),
            Slot::sampler(2, "clamped"),
            Slot::target(3, "sheets", Shape::Volume, Format::Target),
            TILES,
        ]],
    ),
];
