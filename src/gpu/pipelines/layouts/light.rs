//! Bind-group layouts of the shaders for light volumes.

use super::{EYE, LIGHTS, Layouts, PYRAMID, TABLE, VOLUME};
use crate::gpu::pipelines::binding::{Access, Format, Shape, Slot};
use crate::gpu::pipelines::uniforms;

/// Layouts of the shaders in `shaders/light`.
pub(super) const LAYOUTS: Layouts = &[
    (
        "light/average.wgsl",
        &[&[
            Slot::uniform::<uniforms::Average>(0, "bound_average"),
            Slot::list(1, "bricks", 16, Access::Read),
            Slot::loaded(2, "point_0", Shape::Volume),
            Slot::loaded(3, "point_1", Shape::Volume),
            Slot::loaded(4, "point_2", Shape::Volume),
            Slot::loaded(5, "point_3", Shape::Volume),
            Slot::loaded(6, "before", Shape::Volume),
            Slot::target(7, "after", Shape::Volume, Format::Of(wgpu::TextureFormat::R32Float)),
            Slot::target(8, "attenuation", Shape::Volume, Format::Target),
        ]],
    ),
    (
        "light/backproject.wgsl",
        &[&[
            Slot::uniform::<uniforms::Backprojection>(0, "bound_view"),
            Slot::list(1, "bricks", 16, Access::Read),
            Slot::sampled(2, "ring", Shape::Sheets),
            Slot::sampler(3, "ring_sampler"),
            Slot::target(4, "attenuation", Shape::Volume, Format::Target),
        ]],
    ),
    (
        "light/clear_margin.wgsl",
        &[&[
            Slot::list(0, "bricks", 16, Access::Read),
            Slot::target(1, "attenuation", Shape::Volume, Format::Target),
        ]],
    ),
    (
        "light/colors.wgsl",
        &[&[
            Slot::list(0, "bricks", 16, Access::Read),
            Slot::loaded(1, "red", Shape::Volume),
            Slot::loaded(2, "green", Shape::Volume),
            Slot::loaded(3, "blue", Shape::Volume),
            Slot::target(4, "attenuation", Shape::Volume, Format::Target),
        ]],
    ),
    (
        "light/combine.wgsl",
        &[
            &[
                EYE,
                TABLE,
                Slot::uniform::<uniforms::Combine>(2, "bound_combine"),
                Slot::list(3, "bricks", 16, Access::Read),
                Slot::target(4, "combined", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            ],
            PYRAMID,
            LIGHTS,
        ],
    ),
    (
        "light/floor_shadow.wgsl",
        &[&[
            Slot::uniform::<uniforms::March>(0, "bound_march"),
            Slot::uniform::<uniforms::FloorShadow>(1, "bound_floor_map"),
            Slot::list(2, "sums", 4, Access::ReadWrite),
            Slot::list(3, "transmittance", 4, Access::ReadWrite),
            Slot::target(5, "shadow", Shape::Volume, Format::Storage),
        ]],
    ),
    (
        "light/march.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::March>(0, "bound_march"),
                TABLE,
                Slot::sampled(2, "distances", Shape::Volume),
                Slot::list(3, "transmittance", 4, Access::ReadWrite),
                Slot::target(4, "ring", Shape::Sheets, Format::Ring),
                Slot::list(5, "tiles", 4, Access::Read),
            ],
            VOLUME,
        ],
    ),
    (
        "light/raycast.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::Raycast>(0, "bound_raycast"),
                TABLE,
                Slot::sampled(2, "distances", Shape::Volume),
                Slot::list(3, "bricks", 16, Access::Read),
                Slot::target(4, "attenuation", Shape::Volume, Format::Target),
            ],
            VOLUME,
        ],
    ),
];
