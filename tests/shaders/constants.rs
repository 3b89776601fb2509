//! Check that constants, table sizes and workgroup sizes agree between Rust and the shaders.

use chiaroscuro_render::{
    LISTED_PER_ROW,
    plan::{
        END_SLICE_BIT, MAX_KERNEL_PIXELS, MAX_STRETCH_LEVEL, MIN_KERNEL_VOXELS, TILE_EDGE, TILE_FIRST_BIT,
        TILE_ROW_BIT,
    },
};
use chiaroscuro_scene::{LUT_SIZE, MAX_LIGHTS, MAX_SLAB_PARTS};
use chiaroscuro_volume::{BRICK_EDGE, CELL_EDGE};

use crate::sources::{entry_shaders, shader_source, validate_shader};

/// Value of a constant in a shader. The compiler drops untyped constants, so a typed one is appended.
fn constant(source: &str, name: &str) -> Option<f64> {
    let asked = format!("{source}\nconst ASKED_FOR: f32 = f32({name});\n");
    let module = validate_shader(&asked).ok()?;
    let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some("ASKED_FOR"))?;
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::F32(value)) => Some(f64::from(value)),
        _ => None,
    }
}

#[test]
fn constants_are_the_same_in_rust_and_in_the_shaders() {
    let expected: [(&str, f64, &[&str]); 6] = [
        ("MAX_LIGHTS", MAX_LIGHTS as f64, &["eye/eye_pass.wgsl"]),
        ("TABLE_SIZE", LUT_SIZE as f64, &["eye/eye_pass.wgsl", "light/march.wgsl"]),
        ("STEP_SLABS", f64::from(MAX_SLAB_PARTS), &["eye/eye_pass.wgsl"]),
        ("MIN_KERNEL_VOXELS", MIN_KERNEL_VOXELS, &["light/backproject.wgsl"]),
        ("MAX_KERNEL_PIXELS", MAX_KERNEL_PIXELS, &["light/backproject.wgsl"]),
        ("MAX_STRETCH_LEVEL", MAX_STRETCH_LEVEL, &["eye/eye_pass.wgsl", "light/march.wgsl"]),
    ];
    for (name, value, shaders) in expected {
        for shader in shaders {
            assert_eq!(constant(&shader_source(shader), name), Some(value), "{name} in {shader}");
        }
    }
    assert_eq!(constant(&shader_source("eye/eye_pass.wgsl"), "NOT_THERE"), None);
}

#[test]
fn the_table_has_room_for_all_entries() {
    for shader in ["eye/eye_pass.wgsl", "light/march.wgsl"] {
        let module = validate_shader(&shader_source(shader)).expect("the shader is valid");
        let (_, table) = module
            .global_variables
            .iter()
            .find(|(_, global)| global.name.as_deref() == Some("table"))
            .expect("the shader has a table");
        let naga::TypeInner::Struct { members, .. } = &module.types[table.ty].inner else {
            panic!("the table is a struct")
        };
        for (member, bytes) in members.iter().zip([16, 4]) {
            let naga::TypeInner::Array { size, stride, .. } = module.types[member.ty].inner else {
                panic!("{member:?} is an array")
            };
            let entries = naga::ArraySize::Constant((LUT_SIZE as u32).try_into().expect("not 0"));
            assert_eq!((size, stride), (entries, bytes), "{member:?} in {shader}");
        }
    }
}

/// Workgroups cover half a brick, or a tile. Other passes have sizes of their own.
#[test]
fn workgroups_fill_bricks_and_tiles() {
    let (brick, tile) = (BRICK_EDGE as u32, TILE_EDGE);
    let half_bricks =
        ["light/clear_margin", "light/combined_light", "light/raycast", "scatter/normalise", "scatter/splat"];
    let tiles = ["eye/edges", "eye/floor", "eye/eye_pass", "light/march"];
    for (names, size) in [(&half_bricks[..], [brick, brick, brick / 2]), (&tiles, [tile, tile, 1])] {
        for name in names {
            let module =
                validate_shader(&shader_source(&format!("{name}.wgsl"))).expect("the shader is valid");
            assert_eq!(module.entry_points[0].workgroup_size, size, "{name}");
        }
    }
}

/// Constants of `common/sizes.wgsl`: name, value in Rust, another value of the same number of digits, and shaders
/// that use it.
const SIZES: [(&str, usize, usize, &[&str]); 9] = [
    (
        "BRICK_EDGE",
        BRICK_EDGE,
        4,
        &["light/backproject", "light/combined_light", "light/raycast", "scatter/splat"],
    ),
    ("BRICK_EDGE", BRICK_EDGE, 4, &["scatter/eye", "scatter/footprints", "scatter/normalise"]),
    ("CELL_EDGE", CELL_EDGE, 4, &["eye/eye_pass", "light/backproject", "light/march", "light/raycast"]),
    (
        "CELL_EDGE",
        CELL_EDGE,
        4,
        &[
            "scattered_light/blocks",
            "scattered_light/gather",
            "sky/extinction_blocks",
            "sky/clear_margin",
            "sky/moments",
        ],
    ),
    (
        "LISTED_PER_ROW",
        LISTED_PER_ROW as usize,
        32768,
        &["light/backproject", "light/combined_light", "light/march"],
    ),
    (
        "TILE_EDGE",
        TILE_EDGE as usize,
        4,
        &["scattered_light/sweep", "eye/edges", "eye/floor", "eye/eye_pass", "light/march"],
    ),
    ("TILE_ROW_BIT", TILE_ROW_BIT as usize, 14, &["light/march"]),
    ("TILE_FIRST_BIT", TILE_FIRST_BIT as usize, 30, &["light/march"]),
    ("END_SLICE_BIT", END_SLICE_BIT as usize, 15, &["scattered_light/sweep", "sky/floor_sweep", "sky/sweep"]),
];

#[test]
fn sizes_are_the_same_in_rust_and_in_the_shaders() {
    for (name, value, other, shaders) in SIZES {
        for shader in shaders {
            let source = shader_source(&format!("{shader}.wgsl"));
            assert_eq!(constant(&source, name), Some(value as f64), "{name} in {shader}");
            // The shader depends on the constant, and on no equal literal.
            let changed = source.replace(&format!("{name} = {value};"), &format!("{name} = {other};"));
            assert_ne!(statements(&source), statements(&changed), "{shader} does not use {name}");
        }
    }
}

/// Functions of a shader as text, comparable between two shaders of the same length.
fn statements(source: &str) -> String {
    let module = validate_shader(source).expect("the shader is valid");
    format!("{:?} {:?}", module.functions, module.entry_points)
}

#[test]
fn workgroups_have_the_size_that_the_dispatches_count_on() {
    let expected = [
        ("diffusion/coarser_stencil.wgsl", [4, 4, 4]),
        ("diffusion/coarsest.wgsl", [4, 4, 4]),
        ("diffusion/relax.wgsl", [4, 4, 4]),
        ("diffusion/restrict.wgsl", [4, 4, 4]),
        ("diffusion/right_side.wgsl", [4, 4, 4]),
        ("diffusion/stencil.wgsl", [4, 4, 4]),
        ("eye/edges.wgsl", [8, 8, 1]),
        ("eye/eye_pass.wgsl", [8, 8, 1]),
        ("eye/floor.wgsl", [8, 8, 1]),
        ("light/area_light.wgsl", [8, 8, 4]),
        // Size given by LANES, which the parser leaves open.
        ("light/backproject.wgsl", [1, 1, 1]),
        ("light/block_normals.wgsl", [64, 1, 1]),
        ("light/clear_margin.wgsl", [8, 8, 4]),
        ("light/colored_shadows.wgsl", [8, 8, 4]),
        ("light/combined_light.wgsl", [8, 8, 4]),
        ("light/floor_shadow.wgsl", [8, 8, 1]),
        ("light/march.wgsl", [8, 8, 1]),
        ("light/opacity_blocks.wgsl", [64, 1, 1]),
        ("light/raycast.wgsl", [8, 8, 4]),
        ("output/display.wgsl", [8, 8, 1]),
        ("output/display_deep.wgsl", [8, 8, 1]),
        ("scatter/eye.wgsl", [8, 8, 1]),
        ("scatter/footprints.wgsl", [64, 1, 1]),
        ("scatter/light.wgsl", [8, 8, 1]),
        ("scatter/normalise.wgsl", [8, 8, 4]),
        ("scatter/resolve.wgsl", [8, 8, 1]),
        ("scatter/reverse.wgsl", [8, 8, 1]),
        ("scatter/splat.wgsl", [8, 8, 4]),
        ("scattered_light/blocks.wgsl", [64, 1, 1]),
        ("scattered_light/gather.wgsl", [64, 1, 1]),
        ("scattered_light/mixing.wgsl", [256, 1, 1]),
        ("scattered_light/received_light.wgsl", [4, 4, 4]),
        ("scattered_light/result.wgsl", [64, 1, 1]),
        ("scattered_light/single_scattering.wgsl", [4, 4, 4]),
        ("scattered_light/source.wgsl", [4, 4, 4]),
        ("scattered_light/sweep.wgsl", [8, 8, 1]),
        ("sky/clear_margin.wgsl", [64, 1, 1]),
        ("sky/extinction_blocks.wgsl", [64, 1, 1]),
        ("sky/floor_map.wgsl", [8, 8, 1]),
        ("sky/floor_sweep.wgsl", [8, 8, 1]),
        ("sky/moments.wgsl", [64, 1, 1]),
        ("sky/sharpened_blocks.wgsl", [64, 1, 1]),
        ("sky/surfaces.wgsl", [64, 1, 1]),
        ("sky/sweep.wgsl", [8, 8, 1]),
        ("volume/composed_voxels.wgsl", [8, 8, 4]),
        ("volume/downsample.wgsl", [8, 8, 4]),
        ("volume/gradients.wgsl", [8, 8, 4]),
        ("volume/preclassified.wgsl", [8, 8, 4]),
        ("volume/prefilter.wgsl", [8, 8, 4]),
    ];
    let names: Vec<_> = expected.iter().map(|(name, _)| *name).collect();
    let passes: Vec<_> =
        entry_shaders().into_iter().filter(|name| shader_source(name).contains("@compute")).collect();
    assert_eq!(passes, names, "a new pass: say its size here");
    for (name, size) in expected {
        let module = validate_shader(&shader_source(name)).expect("the shader is valid");
        let [entry] = &module.entry_points[..] else { panic!("{name} has one entry point") };
        assert_eq!(entry.name, "main", "{name}");
        assert_eq!(entry.stage, naga::ShaderStage::Compute, "{name}");
        assert_eq!(entry.workgroup_size, size, "{name}");
    }
}
