//! Constants, tables and workgroups have the sizes that Rust counts on.

use chiaroscuro::data::{BRICK_EDGE, CELL_EDGE};
use chiaroscuro::gpu::SHADERS;
use chiaroscuro::model::{LUT_SIZE, MAX_LIGHTS};
use chiaroscuro::plan::{MAX_KERNEL_PIXELS, MAX_STRETCH_LEVEL, MIN_KERNEL_VOXELS};

use crate::sources::{check, code_of, entry_shaders, joined};

/// The value of a constant in a shader. The compiler drops constants without a type of their own, so
/// it is asked for one with a type.
fn constant(source: &str, name: &str) -> Option<f64> {
    let asked = format!("{source}\nconst ASKED_FOR: f32 = f32({name});\n");
    let module = check(&asked).ok()?;
    let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some("ASKED_FOR"))?;
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::F32(value)) => Some(f64::from(value)),
        _ => None,
    }
}

#[test]
fn constants_are_the_same_in_rust_and_in_the_shaders() {
    let expected: [(&str, f64, &[&str]); 5] = [
        ("MAX_LIGHTS", MAX_LIGHTS as f64, &["eye/gather.wgsl"]),
        ("TABLE_SIZE", LUT_SIZE as f64, &["eye/gather.wgsl", "light/march.wgsl"]),
        ("MIN_KERNEL_VOXELS", MIN_KERNEL_VOXELS, &["light/backproject.wgsl"]),
        ("MAX_KERNEL_PIXELS", MAX_KERNEL_PIXELS, &["light/backproject.wgsl"]),
        ("MAX_STRETCH_LEVEL", MAX_STRETCH_LEVEL, &["eye/gather.wgsl", "light/march.wgsl"]),
    ];
    for (name, value, shaders) in expected {
        for shader in shaders {
            assert_eq!(constant(&joined(shader), name), Some(value), "{name} in {shader}");
        }
    }
    assert_eq!(constant(&joined("eye/gather.wgsl"), "NOT_THERE"), None);
}

#[test]
fn the_table_has_room_for_all_entries() {
    for shader in ["eye/gather.wgsl", "light/march.wgsl"] {
        let module = check(&joined(shader)).expect("the shader is valid");
        let (_, table) = module
            .global_variables
            .iter()
            .find(|(_, global)| global.name.as_deref() == Some("table"))
            .expect("the shader has a table");
        let naga::TypeInner::Array { size, stride, .. } = module.types[table.ty].inner else {
            panic!("the table is an array")
        };
        assert_eq!(size, naga::ArraySize::Constant((LUT_SIZE as u32).try_into().expect("not 0")), "{shader}");
        assert_eq!(stride, 16, "{shader}");
    }
}

/// Bricks are written as plain numbers: dividing by a constant would not read better.
#[test]
fn bricks_have_the_same_edge_in_rust_and_in_the_shaders() {
    let file = |name: &str| {
        let (_, text) = SHADERS.iter().find(|(known, _)| *known == name).expect("the file is there");
        code_of(text)
    };
    let cells = file("density/cells.wgsl");
    let halves = format!("/ {CELL_EDGE}.0");
    assert_eq!(cells.matches(&halves).count(), 2, "density/cells.wgsl divides by the edge of a cell");

    // A workgroup is half a brick.
    let half = BRICK_EDGE / 2;
    let listed = file("common/listed_bricks.wgsl");
    for text in [
        format!("brick * {BRICK_EDGE}u + local"),
        format!("group.x % 2u * {half}u"),
        format!("local / {CELL_EDGE}u"),
    ] {
        assert!(listed.contains(&text), "common/listed_bricks.wgsl must have {text}");
    }
    let (scatter, voxels) = (file("scatter/slab.wgsl"), file("scatter/voxels.wgsl"));
    assert!(scatter.contains(&format!("floor(p / {BRICK_EDGE}.0)")), "scatter/slab.wgsl");
    assert!(
        voxels.contains(&format!("{BRICK_EDGE}u * (local.y + {BRICK_EDGE}u * local.z)")),
        "scatter/voxels.wgsl"
    );
    let footprints = file("scatter/footprints.wgsl");
    for text in [format!("voxel / {BRICK_EDGE};"), format!("brick * {BRICK_EDGE}u *")] {
        assert!(footprints.contains(&text), "scatter/footprints.wgsl must have {text}");
    }
    // Or a whole one, cell by cell.
    let backproject = file("light/backproject.wgsl");
    for text in
        [format!("unpacked(brick) * {BRICK_EDGE}u + place * {CELL_EDGE}u"), format!("lane / {BRICK_EDGE}u")]
    {
        assert!(backproject.contains(&text), "light/backproject.wgsl must have {text}");
    }
    let over_bricks =
        ["light/combine.wgsl", "light/raycast.wgsl", "scatter/normalise.wgsl", "scatter/splat.wgsl"];
    for name in over_bricks {
        let text = format!("@workgroup_size({BRICK_EDGE}, {BRICK_EDGE}, {half})");
        assert!(file(name).contains(&text), "{name} must have {text}");
    }
}

#[test]
fn workgroups_have_the_size_that_the_dispatches_count_on() {
    let expected = [
        ("eye/floor.wgsl", [8, 8, 1]),
        ("eye/gather.wgsl", [8, 8, 1]),
        // What LANES says, which the parser leaves open.
        ("light/backproject.wgsl", [1, 1, 1]),
        ("light/clear_margin.wgsl", [8, 8, 4]),
        ("light/combine.wgsl", [8, 8, 4]),
        ("light/march.wgsl", [8, 8, 1]),
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
        ("volume/downsample.wgsl", [8, 8, 4]),
        ("volume/gradients.wgsl", [8, 8, 4]),
        ("volume/prefilter.wgsl", [8, 8, 4]),
    ];
    let names: Vec<_> = expected.iter().map(|(name, _)| *name).collect();
    let passes: Vec<_> =
        entry_shaders().into_iter().filter(|name| joined(name).contains("@compute")).collect();
    assert_eq!(passes, names, "a new pass: say its size here");
    for (name, size) in expected {
        let module = check(&joined(name)).expect("the shader is valid");
        let [entry] = &module.entry_points[..] else { panic!("{name} has one entry point") };
        assert_eq!(entry.name, "main", "{name}");
        assert_eq!(entry.stage, naga::ShaderStage::Compute, "{name}");
        assert_eq!(entry.workgroup_size, size, "{name}");
    }
}
