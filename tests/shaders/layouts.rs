//! Memory layouts in Rust of the structs that it shares with shaders.

use chiaroscuro::gpu::uniforms;

/// Field of a struct: its name, offset and type in Rust's terms, `[f32; 3]` for a vector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) offset: usize,
    pub(crate) kind: String,
}

/// Memory layout of a struct in one of the two languages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) name: String,
    pub(crate) size: usize,
    pub(crate) fields: Vec<Field>,
}

/// Type name of a field, without module paths.
pub(crate) fn kind_of<Whole, F>(_field: fn(&Whole) -> &F) -> String {
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
        Layout {
            name: stringify!($name).to_owned(),
            size: size_of::<uniforms::$name>(),
            fields: vec![$(Field {
                name: stringify!($field).to_owned(),
                offset: std::mem::offset_of!(uniforms::$name, $field),
                kind: kind_of(|whole: &uniforms::$name| &whole.$field),
            }),+],
        }
    }};
}

/// All mirrored structs, each with a shader in which it appears.
pub(crate) fn mirrored() -> Vec<(&'static str, Layout)> {
    let frame = layout!(SheetFrame {
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
    let grid = layout!(Grid { dims, dilation, density_scale, pad0, pyramid_scale, pad1, cell_scale, pad2 });
    let light = layout!(Light {
        place,
        perspective,
        color,
        extinction_scale,
        lookup,
        hood_inner,
        hood_axis,
        hood_outer,
        near_ahead,
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
        ("eye/gather.wgsl", frame.clone()),
        ("light/march.wgsl", frame.clone()),
        ("light/backproject.wgsl", frame),
        ("eye/gather.wgsl", grid.clone()),
        ("light/march.wgsl", grid),
        ("eye/gather.wgsl", layout!(Cut { low, pad0, high, pad1, plane })),
        (
            "light/march.wgsl",
            layout!(March {
                frame,
                begin,
                end,
                layers,
                tiles,
                extinction_scale,
                hood_inner,
                hood_outer,
                reach,
                hood_axis,
                dark,
                shading_cut,
            }),
        ),
        ("light/average.wgsl", layout!(Average { dims, bricks, share, pad0, pad1, pad2 })),
        (
            "light/floor_shadow.wgsl",
            layout!(FloorShadow {
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
                light_from_scene_x,
                light_from_scene_y,
                light_from_scene_z,
                first_pixel,
                first_texel,
            }),
        ),
        (
            "light/backproject.wgsl",
            layout!(Backprojection {
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
            layout!(Raycast { light, space, dims, bricks, voxel_step, ray_step, dark, pad0, shading_cut }),
        ),
        ("eye/gather.wgsl", light),
        (
            "eye/gather.wgsl",
            layout!(Space {
                scene_from_index_x,
                scene_from_index_y,
                scene_from_index_z,
                index_from_scene_x,
                index_from_scene_y,
                index_from_scene_z,
            }),
        ),
        (
            "eye/gather.wgsl",
            layout!(Shading {
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
                dark_depth,
                anisotropy,
                pad0,
                pad1,
                pad2
            }),
        ),
        (
            "eye/gather.wgsl",
            layout!(Eye {
                frame,
                shading,
                space,
                eye,
                first_row,
                end_row,
                dilation,
                dark,
                gradient_pixels,
                gradient_slabs,
                runs,
                near_edge,
                combined_lookup,
                pad0,
                seen,
                faces,
                shading_cut,
                sky,
                bounces,
                lights
            }),
        ),
        (
            "scatter/splat.wgsl",
            layout!(Scatter {
                frame,
                sheets_from_index_x,
                sheets_from_index_y,
                sheets_from_index_z,
                half,
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
        ("scatter/footprints.wgsl", layout!(Phase { u, v, brick_u, brick_v, stride, pad0, pad1, pad2 })),
        ("eye/gather.wgsl", layout!(Bounces { lookup, ahead, share, pad0, pad1, pad2 })),
        ("bounces/gather.wgsl", layout!(Bounce { dims, share, color, least })),
        (
            "bounces/first.wgsl",
            layout!(First {
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
        ("eye/gather.wgsl", layout!(Sky { red, green, blue, lookup, ahead })),
        ("sky/blocks.wgsl", layout!(Blocks { dims, voxel_step, level, offset, edge, albedo, shading_cut })),
        ("sky/floor_map.wgsl", layout!(FloorMap { origin, share, along_x, size, along_y, pad0, plane })),
        (
            "sky/sweep.wgsl",
            layout!(SkyRays {
                towards,
                step,
                drift,
                first,
                size,
                axis,
                rises,
                arriving,
                layer,
                weight,
                first_tile,
                pad0,
                pad1
            }),
        ),
        ("sky/sweep.wgsl", layout!(Sweep { dims, share, block_scale, has_sums, sheet_scale, pad0, rays })),
        ("light/combine.wgsl", layout!(Combine { dims, bricks, voxel_step, pad0, pad1, pad2 })),
        (
            "eye/floor.wgsl",
            layout!(Floor {
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
                fade,
                light_share,
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
            layout!(Display {
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
        ("volume/prefilter.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
        ("volume/downsample.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
        ("volume/gradients.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
    ]
}
