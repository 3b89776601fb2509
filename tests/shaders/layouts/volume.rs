//! Uniform structs of the shaders that compose voxels and fill pyramids, and of pages.

use chiaroscuro_render::uniforms;

use crate::struct_layout::{FieldLayout, StructLayout, type_name_of};

/// Lists the structs with a shader that declares them.
pub(super) fn mirrored_structs() -> Vec<(&'static str, StructLayout)> {
    vec![
        ("eye/eye_pass.wgsl", layout!(PageLevelUniform { scale, first, pages, pad0 })),
        (
            "eye/eye_pass.wgsl",
            layout!(PagesUniform {
                coarse,
                count,
                texel,
                level_in_memory,
                level_0,
                level_1,
                level_2,
                level_3,
                first_level,
                pad0,
                pad1,
                pad2
            }),
        ),
        ("volume/composed_voxels.wgsl", layout!(LayersUniform { count, largest, voxel, pad0, layers })),
        (
            "volume/composed_voxels.wgsl",
            layout!(LayerUniform {
                blend,
                is_label,
                opacity_unit,
                edges,
                material_count,
                ignores_cuts,
                pad1,
                pad2,
                materials
            }),
        ),
        ("volume/composed_voxels.wgsl", layout!(MaterialUniform { densities, changes, matter })),
        ("volume/prefilter.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
        ("volume/downsample.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
        ("volume/gradients.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
    ]
}
