//! Memory layouts in Rust of the structs that it shares with shaders.

use chiaroscuro_render::uniforms;

/// Field of a struct: its name, offset and type in Rust's terms, `[f32; 3]` for a vector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FieldLayout {
    pub(crate) name: String,
    pub(crate) offset: usize,
    pub(crate) type_name: String,
}

/// Memory layout of a struct in one of the two languages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StructLayout {
    pub(crate) name: String,
    pub(crate) size: usize,
    pub(crate) fields: Vec<FieldLayout>,
}

/// Type name of a field, without module paths.
pub(crate) fn type_name_of<Whole, F>(_field: fn(&Whole) -> &F) -> String {
    let full = std::any::type_name::<F>();
    let (bracket, path) = full.split_at(usize::from(full.starts_with('[')));
    format!("{bracket}{}", path.rsplit("::").next().unwrap_or(path))
}

/// Rust layout of a struct of `gpu::uniforms`. Omitting a field is a compile error.
macro_rules! layout {
    ($name:ident { $($field:ident),+ $(,)? }) => {{
        let _all_fields = |whole: uniforms::$name| {
            let uniforms::$name { $($field: _),+ } = whole;
        };
        StructLayout {
            name: stringify!($name).to_owned(),
            size: size_of::<uniforms::$name>(),
            fields: vec![$(FieldLayout {
                name: stringify!($field).to_owned(),
                offset: std::mem::offset_of!(uniforms::$name, $field),
                type_name: type_name_of(|whole: &uniforms::$name| &whole.$field),
            }),+],
        }
    }};
}

/// All mirrored structs, each with a shader in which it appears.
pub(crate) fn mirrored_structs() -> Vec<(&'static str, StructLayout)> {
    let frame = layout!(SheetFrameUniform {
        origin,
        first_depth,
        origin_di,
        slab,
        origin_dj,
        pitch,
        direction,
        inverse_distance,
        direction_di,
        voxel_edge,
        direction_dj,
        slab_count,
        slope,
        slope_di,
        slope_dj,
        size,
    });
    let grid =
        layout!(GridUniform { dims, dilation, density_scale, pad0, pyramid_scale, pad1, cell_scale, pad2 });
    let light = layout!(LightUniform {
        position_or_direction,
        perspective,
        color,
        extinction_scale,
        lookup,
        cone_cos_inner,
        cone_axis,
        cone_cos_outer,
        last_step_extension,
        points,
        shape,
        near_steps,
        area_right,
        two_sided,
        area_up,
        pad0,
        area_near,
        pad1,
    });
    vec![
        ("eye/eye_pass.wgsl", frame.clone()),
        ("light/march.wgsl", frame.clone()),
        ("light/backproject.wgsl", frame),
        ("eye/eye_pass.wgsl", grid.clone()),
        ("light/march.wgsl", grid),
        ("eye/eye_pass.wgsl", layout!(CutUniform { low, pad0, high, pad1, plane })),
        (
            "light/march.wgsl",
            layout!(MarchUniform {
                frame,
                begin,
                end,
                layers,
                tiles,
                extinction_scale,
                cone_cos_inner,
                cone_cos_outer,
                reach,
                cone_axis,
                min_transmittance,
                shading_cut,
            }),
        ),
        (
            "light/area_light.wgsl",
            layout!(AverageUniform {
                dims,
                bricks,
                place,
                perspective,
                right,
                share,
                up,
                voxel_step,
                to_right,
                to_top,
                lookup,
                pad0,
                space,
            }),
        ),
        ("light/block_normals.wgsl", layout!(BlockNormalsUniform { space, dims, pad0, opacity_scale, pad1 })),
        (
            "light/floor_shadow.wgsl",
            layout!(FloorShadowUniform {
                origin,
                size,
                along_x,
                share,
                along_y,
                cube_face,
                up,
                perspective,
                place,
                pad0,
                centre,
                right,
                top,
                light_from_scene_x,
                light_from_scene_y,
                light_from_scene_z,
                first_pixel,
                first_texel,
            }),
        ),
        (
            "light/backproject.wgsl",
            layout!(BackprojectionUniform {
                frame,
                light_from_index_x,
                light_from_index_y,
                light_from_index_z,
                first_pixel,
                kernel_edge,
                voxel_step,
                dims,
                cube_face,
                begin,
                end,
                layers,
                bricks,
                ring_scale,
                pad0,
                pad1,
            }),
        ),
        ("light/raycast.wgsl", light.clone()),
        (
            "light/raycast.wgsl",
            layout!(RaycastUniform {
                light,
                space,
                dims,
                bricks,
                voxel_step,
                ray_step,
                max_optical_depth,
                pad0,
                shading_cut
            }),
        ),
        ("eye/eye_pass.wgsl", light),
        (
            "eye/eye_pass.wgsl",
            layout!(SpaceUniform {
                scene_from_index_x,
                scene_from_index_y,
                scene_from_index_z,
                index_from_scene_x,
                index_from_scene_y,
                index_from_scene_z,
            }),
        ),
        (
            "eye/eye_pass.wgsl",
            layout!(ShadingUniform {
                emission,
                ambient,
                diffuse,
                specular,
                shininess,
                surface_gradient,
                strength,
                ambient_offset,
                gain,
                bias,
                ray_step,
                max_optical_depth,
                anisotropy,
                amid,
                pad0,
                pad1
            }),
        ),
        (
            "eye/eye_pass.wgsl",
            layout!(EyeUniform {
                frame,
                shading,
                space,
                eye,
                first_row,
                end_row,
                dilation,
                min_transmittance,
                gradient_pixels,
                gradient_slabs,
                runs,
                voxel_edge,
                combined_lookup,
                max_undivided_share,
                visible_cut,
                face_cut,
                shading_cut,
                sky,
                scattered_light,
                lights
            }),
        ),
        (
            "eye/edges.wgsl",
            layout!(EdgesUniform { size, first_row, end_row, min_contrast, pad0, pad1, pad2 }),
        ),
        ("eye/eye_pass.wgsl", layout!(PixelRayUniform { place, is_listed, is_added, pad0, pad1 })),
        (
            "scatter/splat.wgsl",
            layout!(ScatterSlabUniform {
                frame,
                sheets_from_index_x,
                sheets_from_index_y,
                sheets_from_index_z,
                half_extents,
                stretch,
                dims,
                k,
                bricks,
                layers,
                first,
                count,
                pixel_share,
                voxel_step,
                light_dims,
                cube_face,
                first_pixel,
                sheet_count,
                first_slice,
                axis,
                slice_step,
                extinction_unit,
                pad0,
                pad1,
                pad2,
            }),
        ),
        (
            "scatter/footprints.wgsl",
            layout!(FootprintPhaseUniform { u, v, brick_u, brick_v, stride, pad0, pad1, pad2 }),
        ),
        (
            "eye/eye_pass.wgsl",
            layout!(ScatteredLightUniform { lookup, lookup_distance, share, pad0, pad1, pad2 }),
        ),
        (
            "diffusion/relax.wgsl",
            layout!(DiffusionLevelUniform { dims, first, coarser_dims, coarser_first, edges, share }),
        ),
        ("scattered_light/gather.wgsl", layout!(BounceUniform { dims, share, color, min_extinction })),
        (
            "scattered_light/single_scattering.wgsl",
            layout!(SingleScatteringUniform {
                space,
                block_scale,
                voxel_step,
                count,
                shadowed,
                edge,
                emission,
                slice,
                end,
                pad0,
                has_sky,
                lights
            }),
        ),
        ("eye/eye_pass.wgsl", layout!(SkyUniform { red, green, blue, lookup, lookup_distance })),
        (
            "sky/extinction_blocks.wgsl",
            layout!(BlocksUniform {
                dims,
                voxel_step,
                level,
                offset,
                edge,
                albedo,
                max_depth,
                pad0,
                pad1,
                pad2,
                shading_cut
            }),
        ),
        (
            "sky/surfaces.wgsl",
            layout!(SurfaceBlocksUniform {
                dims,
                has_surfaces,
                block_scale,
                directions,
                along_x,
                pad1,
                along_y,
                pad2,
                along_z,
                pad3
            }),
        ),
        ("sky/surfaces.wgsl", layout!(SkyDirectionsUniform { directions })),
        (
            "sky/floor_map.wgsl",
            layout!(FloorSkyMapUniform { origin, share, along_x, size, along_y, pad0, plane }),
        ),
        (
            "sky/sweep.wgsl",
            layout!(SweepRaysUniform {
                direction_to_light,
                step,
                drift,
                first,
                size,
                axis,
                is_ascending,
                incoming_radiance,
                layer,
                weight,
                first_tile,
                pad0,
                pad1
            }),
        ),
        (
            "sky/sweep.wgsl",
            layout!(SweepUniform { dims, share, block_scale, has_sums, sheet_scale, pad0, rays }),
        ),
        ("light/combined_light.wgsl", layout!(CombineUniform { dims, bricks, voxel_step, pad0, pad1, pad2 })),
        (
            "eye/floor.wgsl",
            layout!(FloorUniform {
                frame,
                space,
                shading,
                shading_cut,
                plane,
                up,
                height,
                color,
                opacity,
                radius,
                fade_width,
                inverse_balance,
                shadow_only,
                first_row,
                end_row,
                runs,
                pad0,
                sky,
                map_x,
                map_y,
                lights
            }),
        ),
        (
            "output/display.wgsl",
            layout!(DisplayUniform {
                top,
                bottom,
                transparent,
                clip,
                exposure,
                first_row,
                rows,
                first_column,
                dither_step,
                floor_exposure
            }),
        ),
        ("volume/prefilter.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
        ("volume/downsample.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
        ("volume/gradients.wgsl", layout!(PyramidLevelUniform { bricks, spacing, pad0, pad1 })),
    ]
}
