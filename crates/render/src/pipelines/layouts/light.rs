//! Bind-group layouts of the shaders for light volumes.

use super::sky::{BLOCK_SAMPLER, CELLS};
use super::{EYE, LIGHTS, PYRAMID, ShaderLayouts, TABLE, VOLUME};
use crate::pipelines::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use crate::pipelines::uniforms;

/// Layouts of the shaders in `shaders/light`.
pub(super) const LAYOUTS: ShaderLayouts = &[
    (
        "light/area_light.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::AverageUniform>(0, "bound_average"),
            BindingSlot::storage(1, "bricks", 16, BufferAccess::Read),
            BindingSlot::loaded_texture(2, "point_0", TextureShape::D3),
            BindingSlot::loaded_texture(3, "point_1", TextureShape::D3),
            BindingSlot::loaded_texture(4, "point_2", TextureShape::D3),
            BindingSlot::loaded_texture(5, "point_3", TextureShape::D3),
            BindingSlot::loaded_texture(6, "before", TextureShape::D3),
            BindingSlot::storage_texture(
                7,
                "after",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::R32Float),
            ),
            BindingSlot::storage_texture(8, "attenuation", TextureShape::D3, StorageFormat::Target),
            BindingSlot::sampled_texture(9, "normals", TextureShape::D3),
            BindingSlot::bind_sampler(10, "clamped"),
        ]],
    ),
    (
        "light/backproject.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::BackprojectionUniform>(0, "bound_view"),
            BindingSlot::storage(1, "bricks", 16, BufferAccess::Read),
            BindingSlot::sampled_texture(2, "ring", TextureShape::D2Array),
            BindingSlot::bind_sampler(3, "ring_sampler"),
            BindingSlot::storage_texture(4, "attenuation", TextureShape::D3, StorageFormat::Target),
        ]],
    ),
    (
        "light/block_normals.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::BlockNormalsUniform>(0, "bound_near"),
            BindingSlot::sampled_texture(1, "opacity", TextureShape::D3),
            BLOCK_SAMPLER,
            BindingSlot::storage(3, "cells", 4, BufferAccess::Read),
            BindingSlot::storage_texture(
                4,
                "normals",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
        ]],
    ),
    (
        "light/clear_margin.wgsl",
        &[&[
            BindingSlot::storage(0, "bricks", 16, BufferAccess::Read),
            BindingSlot::storage_texture(1, "attenuation", TextureShape::D3, StorageFormat::Target),
        ]],
    ),
    (
        "light/colored_shadows.wgsl",
        &[&[
            BindingSlot::storage(0, "bricks", 16, BufferAccess::Read),
            BindingSlot::loaded_texture(1, "red", TextureShape::D3),
            BindingSlot::loaded_texture(2, "green", TextureShape::D3),
            BindingSlot::loaded_texture(3, "blue", TextureShape::D3),
            BindingSlot::storage_texture(4, "attenuation", TextureShape::D3, StorageFormat::Target),
        ]],
    ),
    (
        "light/combined_light.wgsl",
        &[
            &[
                EYE,
                TABLE,
                BindingSlot::uniform::<uniforms::CombineUniform>(2, "bound_combine"),
                BindingSlot::storage(3, "bricks", 16, BufferAccess::Read),
                BindingSlot::storage_texture(
                    4,
                    "combined",
                    TextureShape::D3,
                    StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
                ),
            ],
            PYRAMID,
            LIGHTS,
        ],
    ),
    (
        "light/floor_shadow.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::MarchUniform>(0, "bound_march"),
            BindingSlot::uniform::<uniforms::FloorShadowUniform>(1, "bound_floor_map"),
            BindingSlot::storage(2, "sums", 4, BufferAccess::ReadWrite),
            BindingSlot::storage(3, "transmittance", 4, BufferAccess::ReadWrite),
            BindingSlot::storage_texture(5, "shadow", TextureShape::D3, StorageFormat::Storage),
        ]],
    ),
    (
        "light/march.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::MarchUniform>(0, "bound_march"),
                TABLE,
                BindingSlot::sampled_texture(2, "distances", TextureShape::D3),
                BindingSlot::storage(3, "transmittance", 4, BufferAccess::ReadWrite),
                BindingSlot::storage_texture(4, "ring", TextureShape::D2Array, StorageFormat::Ring),
                BindingSlot::storage(5, "tiles", 4, BufferAccess::Read),
            ],
            VOLUME,
        ],
    ),
    (
        "light/opacity_blocks.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::BlocksUniform>(0, "bound_blocks"),
                TABLE,
                CELLS,
                BindingSlot::storage_texture(3, "opacity", TextureShape::D3, StorageFormat::Storage),
            ],
            PYRAMID,
        ],
    ),
    (
        "light/raycast.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::RaycastUniform>(0, "bound_raycast"),
                TABLE,
                BindingSlot::sampled_texture(2, "distances", TextureShape::D3),
                BindingSlot::storage(3, "bricks", 16, BufferAccess::Read),
                BindingSlot::storage_texture(4, "attenuation", TextureShape::D3, StorageFormat::Target),
            ],
            VOLUME,
        ],
    ),
];
