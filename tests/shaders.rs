//! Every shader is valid, and agrees with the Rust code about structs, constants and sizes. Needs no
//! GPU: shaders are parsed and looked into.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use chiaroscuro::data::{BRICK_EDGE, CELL_EDGE};
use chiaroscuro::gpu::{SHADERS, ShaderLibrary, uniforms};
use chiaroscuro::model::{LUT_SIZE, MAX_LIGHTS};
use chiaroscuro::plan::{MAX_KERNEL_PIXELS, MAX_STRETCH_LEVEL, MIN_KERNEL_VOXELS};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::TextureFormat;

/// The formats that storage textures can have.
const FORMATS: [TextureFormat; 2] = [TextureFormat::R16Float, TextureFormat::R32Float];

/// Shaders with an entry point.
fn entry_shaders() -> Vec<&'static str> {
    let has_entry = |text: &str| text.contains("@compute") || text.contains("@fragment");
    SHADERS.iter().filter(|(_, text)| has_entry(text)).map(|(name, _)| *name).collect()
}

/// A shader with its imports.
fn joined(name: &str) -> String {
    ShaderLibrary::source(name, TextureFormat::R16Float, TextureFormat::R16Float)
        .expect("the shader and its imports are there")
}

/// Parses and validates; no capability beyond what every adapter has is allowed.
fn check(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|err| err.emit_to_string(source))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|err| err.emit_to_string(source))?;
    Ok(module)
}

/// Text without line comments.
fn code_of(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Files that a shader file imports itself.
fn imports_of(text: &str) -> Vec<&str> {
    text.lines()
        .filter_map(|line| line.trim().strip_prefix("#import"))
        .map(|rest| rest.trim().trim_matches('"'))
        .collect()
}

// ---------------------------------------------------------------------------------------------
// Validity
// ---------------------------------------------------------------------------------------------

#[test]
fn every_shader_is_valid_for_both_storage_formats() {
    let mut failures = String::new();
    for name in entry_shaders() {
        for format in FORMATS {
            let outcome = ShaderLibrary::source(name, format, format)
                .map_err(|err| err.to_string())
                .and_then(|source| check(&source));
            if let Err(err) = outcome {
                writeln!(failures, "{name} with {format:?}:\n{err}").expect("strings can be written to");
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(entry_shaders().len() >= 6, "the check must see the passes: {:?}", entry_shaders());
}

#[test]
fn storage_formats_reach_the_shader() {
    for (format, wgsl) in [(TextureFormat::R16Float, "r16float"), (TextureFormat::R32Float, "r32float")] {
        let source =
            ShaderLibrary::source("volume/downsample.wgsl", format, format).expect("the shader is there");
        assert!(source.contains(&format!("texture_storage_3d<{wgsl}, write>")), "{format:?}");
        assert!(!source.contains("STORAGE_FORMAT"), "{format:?}");
    }
}

#[test]
fn broken_shaders_are_reported() {
    let source = joined("output/display.wgsl");
    assert!(check(&source).is_ok());
    for (from, to, what) in [
        ("let w = 1.0 - SHOULDER;", "let w = 1.0 - SHOULDERS;", "an unknown name"),
        ("let w = 1.0 - SHOULDER;", "let w = 1.0 - SHOULDER", "a missing semicolon"),
        ("let w = 1.0 - SHOULDER;", "let w = 1u - SHOULDER;", "a mix of types"),
        ("@group(0) @binding(1)", "@group(0) @binding(0)", "two things in one binding"),
    ] {
        assert!(source.contains(from), "{from}");
        assert!(check(&source.replace(from, to)).is_err(), "{what} must be noticed");
    }
}

/// Uniforms that are not copied by the first statements of a shader's entry, or read from elsewhere.
fn uniforms_read_late(source: &str) -> Vec<String> {
    let code = code_of(source);
    let entry = code.split("@compute").nth(1).and_then(|rest| rest.split_once(") {\n"));
    let body = entry.map(|(_, body)| body).unwrap_or_default();
    let copies: BTreeSet<_> =
        body.lines().map(str::trim).take_while(|line| line.contains(" = bound_")).collect();
    let declared = code.split("var<uniform> ").skip(1).filter_map(|rest| rest.split(':').next());
    // Of an array whose index varies there is no copy.
    let reads = |name: &str| code.replace(&format!("{name}.lights[i]"), "").matches(name).count();
    let is_late = |name: &&str| {
        let copy = name.strip_prefix("bound_").map(|own| format!("{own} = {name};"));
        !copy.is_some_and(|copy| copies.contains(copy.as_str())) || reads(name) != 2
    };
    declared.filter(is_late).map(str::to_owned).collect()
}

/// A software driver reads them lane by lane behind a branch (density/volume.wgsl).
#[test]
fn uniforms_are_copied_before_anything_branches() {
    let late: Vec<_> = entry_shaders()
        .into_iter()
        .map(|name| (name, uniforms_read_late(&joined(name))))
        .filter(|(_, late)| !late.is_empty())
        .collect();
    assert!(late.is_empty(), "{late:?}");
}

#[test]
fn uniforms_read_late_are_noticed() {
    let source = joined("eye/gather.wgsl");
    for (from, to, name) in [
        ("    grid = bound_grid;\n", "", "bound_grid"),
        ("grid = bound_grid;", "if (true) {}\n    grid = bound_grid;", "bound_grid"),
        ("let s = eye.shading;", "let s = bound_eye.shading;", "bound_eye"),
        ("var<uniform> bound_eye", "var<uniform> given_eye", "given_eye"),
    ] {
        assert!(source.contains(from), "{from}");
        assert_eq!(uniforms_read_late(&source.replace(from, to)), [name], "{from}");
    }
}

#[test]
fn every_shader_file_is_embedded_and_used() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut on_disk = BTreeSet::new();
    for folder in ["", "common/"] {
        for entry in std::fs::read_dir(root.join(folder)).expect("the folder of shaders is there") {
            let name = entry.expect("it can be listed").file_name().to_string_lossy().into_owned();
            if std::path::Path::new(&name).extension().is_some_and(|ending| ending == "wgsl") {
                on_disk.insert(format!("{folder}{name}"));
            }
        }
    }
    let embedded: BTreeSet<_> = SHADERS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(on_disk, embedded);

    let imported: BTreeSet<_> = SHADERS.iter().flat_map(|(_, text)| imports_of(text)).collect();
    let entries = entry_shaders();
    for (name, _) in SHADERS {
        assert!(entries.contains(&name) || imported.contains(name), "{name} is in no shader");
    }
}

#[test]
fn imports_of_missing_files_are_errors() {
    let err = ShaderLibrary::source("common/missing.wgsl", TextureFormat::R16Float, TextureFormat::R16Float)
        .expect_err("there is no such file");
    assert!(err.to_string().contains("common/missing.wgsl"), "{err}");
    for (name, text) in SHADERS {
        for import in imports_of(text) {
            assert!(SHADERS.iter().any(|(known, _)| *known == import), "{name} imports {import}");
        }
    }
}

#[test]
fn every_imported_file_appears_exactly_once() {
    for name in entry_shaders() {
        let source = joined(name);
        assert!(!source.contains("#import"), "{name}: an import was not resolved");
        // What is to be there: the file and what it imports, directly or not.
        let mut wanted = BTreeSet::from([name]);
        let mut open = vec![name];
        while let Some(next) = open.pop() {
            let (_, text) = SHADERS.iter().find(|(known, _)| *known == next).expect("imports exist");
            open.extend(imports_of(text).into_iter().filter(|import| wanted.insert(import)));
        }
        for (file, text) in SHADERS {
            let first_line = text.lines().next().expect("no shader is empty");
            let expected = usize::from(wanted.contains(file));
            assert_eq!(source.matches(first_line).count(), expected, "{file} in {name}");
        }
    }
}

// ---------------------------------------------------------------------------------------------
// Structs
// ---------------------------------------------------------------------------------------------

/// A field: its name, offset and type as WGSL calls it, `[f32; 3]` for a vector.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Field {
    name: String,
    offset: usize,
    kind: String,
}

/// A struct as one of the two languages lays it out.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Layout {
    name: String,
    size: usize,
    fields: Vec<Field>,
}

/// The type of a field, without the modules in which structs live.
fn kind_of<Whole, F>(_field: fn(&Whole) -> &F) -> String {
    let full = std::any::type_name::<F>();
    let (bracket, path) = full.split_at(usize::from(full.starts_with('[')));
    format!("{bracket}{}", path.rsplit("::").next().unwrap_or(path))
}

/// The Rust layout of a struct of `gpu::uniforms`. A field that is left out does not compile.
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

/// Every mirrored struct, with a shader in which it appears.
fn mirrored() -> Vec<(&'static str, Layout)> {
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
        place_in_index,
        pad0,
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
                pad1,
                combined_lookup,
                pad2,
                seen,
                shading_cut,
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
        ("light/combine.wgsl", layout!(Combine { dims, bricks, voxel_step, pad0, pad1, pad2 })),
        (
            "eye/floor.wgsl",
            layout!(Floor {
                frame,
                space,
                shading,
                shading_cut,
                plane,
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
                lights
            }),
        ),
        (
            "output/display.wgsl",
            layout!(Display { top, bottom, transparent, clip, exposure, first_row, rows, pad0, pad1, pad2 }),
        ),
        ("volume/prefilter.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
        ("volume/downsample.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
        ("volume/gradients.wgsl", layout!(Resample { bricks, spacing, pad0, pad1 })),
    ]
}

/// What Rust would call a WGSL type.
fn kind_in(module: &naga::Module, ty: naga::Handle<naga::Type>) -> String {
    let scalar = |scalar: naga::Scalar| {
        let letter = match scalar.kind {
            naga::ScalarKind::Float => 'f',
            naga::ScalarKind::Sint => 'i',
            naga::ScalarKind::Uint => 'u',
            other => panic!("{other:?} cannot be shared"),
        };
        format!("{letter}{}", u32::from(scalar.width) * 8)
    };
    let ty = &module.types[ty];
    match &ty.inner {
        naga::TypeInner::Scalar(kind) => scalar(*kind),
        naga::TypeInner::Vector { size, scalar: kind } => format!("[{}; {}]", scalar(*kind), *size as u32),
        naga::TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
            format!("[{}; {count}]", kind_in(module, *base))
        }
        naga::TypeInner::Struct { .. } => ty.name.clone().expect("structs have names"),
        other => format!("{other:?}"),
    }
}

/// The WGSL layout of a struct.
fn layout_in(module: &naga::Module, name: &str) -> Option<Layout> {
    let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name))?;
    let naga::TypeInner::Struct { members, span } = &ty.inner else { return None };
    let fields = members
        .iter()
        .map(|member| Field {
            name: member.name.clone().unwrap_or_default(),
            offset: member.offset as usize,
            kind: kind_in(module, member.ty),
        })
        .collect();
    Some(Layout { name: name.to_owned(), size: *span as usize, fields })
}

/// All that differs between both layouts of a struct, one line each.
fn differences(rust: &Layout, module: &naga::Module) -> Vec<String> {
    let name = &rust.name;
    let Some(wgsl) = layout_in(module, name) else { return vec![format!("{name} is not in the shader")] };
    let mut found = Vec::new();
    if rust.size != wgsl.size {
        found.push(format!("{name}: {} bytes in Rust, {} in WGSL", rust.size, wgsl.size));
    }
    for index in 0..rust.fields.len().max(wgsl.fields.len()) {
        let (ours, theirs) = (rust.fields.get(index), wgsl.fields.get(index));
        if ours != theirs {
            found.push(format!("{name}, field {index}: {ours:?} in Rust, {theirs:?} in WGSL"));
        }
    }
    found
}

#[test]
fn shared_structs_have_the_same_fields_in_the_same_places() {
    let mut found = Vec::new();
    for (shader, layout) in mirrored() {
        let module = check(&joined(shader)).expect("the shader is valid");
        found
            .extend(differences(&layout, &module).iter().map(|difference| format!("{shader}: {difference}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_shared_struct_is_compared() {
    let declared: BTreeSet<_> = include_str!("../src/gpu/uniforms.rs")
        .lines()
        .filter_map(|line| line.strip_prefix("pub struct "))
        .map(|rest| rest.trim_end_matches(" {").to_owned())
        .collect();
    let compared: BTreeSet<_> = mirrored().into_iter().map(|(_, layout)| layout.name).collect();
    assert_eq!(declared, compared);

    // And every buffer that a shader reads as a struct is one of them.
    for name in entry_shaders() {
        let module = check(&joined(name)).expect("the shader is valid");
        for (_, global) in module.global_variables.iter() {
            if global.space == naga::AddressSpace::Uniform {
                let kind = kind_in(&module, global.ty);
                assert!(compared.contains(&kind), "{name}: uniform {kind} is not compared");
            }
        }
    }
}

#[test]
fn differing_structs_are_reported() {
    let source = joined("light/march.wgsl");
    let layout_of = |name: &str| {
        let found = mirrored()
            .into_iter()
            .find(|(shader, layout)| *shader == "light/march.wgsl" && layout.name == name);
        found.expect("it is compared").1
    };
    let (march, grid) = (layout_of("March"), layout_of("Grid"));
    let wrong = |layout: &Layout, from: &str, to: &str| {
        assert!(source.contains(from), "{from}");
        let module = check(&source.replacen(from, to, 1)).expect("a valid shader all the same");
        differences(layout, &module)
    };
    assert_eq!(wrong(&march, "struct March", "struct March"), Vec::<String>::new());
    let swapped = wrong(&march, "begin: u32,\n    end: u32,", "end: u32,\n    begin: u32,");
    assert_eq!(swapped.len(), 2, "{swapped:?}");
    let retyped = wrong(&grid, "pad2: f32,\n}", "pad2: u32,\n}");
    assert_eq!(retyped.len(), 1, "{retyped:?}");
    let longer = wrong(&grid, "pad2: f32,\n}", "pad2: f32,\n    more: vec4f,\n}");
    assert_eq!(longer.len(), 2, "the size and the field: {longer:?}");
    let absent = Layout { name: "Marsch".to_owned(), ..march.clone() };
    let module = check(&source).expect("the shader is valid");
    assert_eq!(differences(&absent, &module), ["Marsch is not in the shader"]);
}

// ---------------------------------------------------------------------------------------------
// Constants and sizes
// ---------------------------------------------------------------------------------------------

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
        ("output/display.wgsl", [8, 8, 1]),
        ("output/display_deep.wgsl", [8, 8, 1]),
        ("volume/downsample.wgsl", [8, 8, 4]),
        ("eye/gather.wgsl", [8, 8, 1]),
        ("volume/gradients.wgsl", [8, 8, 4]),
        ("eye/floor.wgsl", [8, 8, 1]),
        ("light/clear_margin.wgsl", [8, 8, 4]),
        // What LANES says, which the parser leaves open.
        ("light/backproject.wgsl", [1, 1, 1]),
        ("light/combine.wgsl", [8, 8, 4]),
        ("light/march.wgsl", [8, 8, 1]),
        ("light/raycast.wgsl", [8, 8, 4]),
        ("volume/prefilter.wgsl", [8, 8, 4]),
        ("scatter/eye.wgsl", [8, 8, 1]),
        ("scatter/footprints.wgsl", [64, 1, 1]),
        ("scatter/light.wgsl", [8, 8, 1]),
        ("scatter/normalise.wgsl", [8, 8, 4]),
        ("scatter/resolve.wgsl", [8, 8, 1]),
        ("scatter/reverse.wgsl", [8, 8, 1]),
        ("scatter/splat.wgsl", [8, 8, 4]),
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

/// Whether an expression is made of uniforms and constants alone, and of any uniform.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Origin {
    Constant,
    Uniform,
    Other,
}

fn origin_of(module: &naga::Module, function: &naga::Function, at: naga::Handle<naga::Expression>) -> Origin {
    use naga::Expression as E;
    let of = |at| origin_of(module, function, at);
    let join = |parts: &[naga::Handle<E>]| {
        parts.iter().map(|&part| of(part)).fold(Origin::Constant, |all, part| match (all, part) {
            (Origin::Other, _) | (_, Origin::Other) => Origin::Other,
            (Origin::Uniform, _) | (_, Origin::Uniform) => Origin::Uniform,
            _ => Origin::Constant,
        })
    };
    match &function.expressions[at] {
        E::Literal(_) | E::Constant(_) | E::Override(_) | E::ZeroValue(_) => Origin::Constant,
        // Private variables are copies of uniforms.
        E::GlobalVariable(global)
            if matches!(
                module.global_variables[*global].space,
                naga::AddressSpace::Uniform | naga::AddressSpace::Private
            ) =>
        {
            Origin::Uniform
        }
        E::Load { pointer } => of(*pointer),
        E::AccessIndex { base, .. } => of(*base),
        E::Access { base, index } => join(&[*base, *index]),
        E::Splat { value, .. } => of(*value),
        E::Swizzle { vector, .. } => of(*vector),
        E::Compose { components, .. } => join(components),
        E::Unary { expr, .. } | E::As { expr, .. } => of(*expr),
        E::Binary { left, right, .. } => join(&[*left, *right]),
        E::Select { condition, accept, reject } => join(&[*condition, *accept, *reject]),
        E::Relational { argument, .. } => of(*argument),
        E::Math { arg, arg1, arg2, arg3, .. } => {
            let all: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect();
            join(&all)
        }
        _ => Origin::Other,
    }
}

fn branches_on_uniforms(module: &naga::Module, function: &naga::Function, block: &naga::Block) -> usize {
    let inner = |block| branches_on_uniforms(module, function, block);
    block
        .iter()
        .map(|statement| match statement {
            naga::Statement::Block(block) => inner(block),
            naga::Statement::If { condition, accept, reject } => {
                let found = origin_of(module, function, *condition) == Origin::Uniform;
                usize::from(found) + inner(accept) + inner(reject)
            }
            naga::Statement::Loop { body, continuing, .. } => inner(body) + inner(continuing),
            naga::Statement::Switch { cases, .. } => cases.iter().map(|case| inner(&case.body)).sum(),
            _ => 0,
        })
        .sum()
}

fn branches_on_uniforms_in(module: &naga::Module) -> usize {
    let functions = module.functions.iter().map(|(_, function)| function);
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    functions.chain(entries).map(|function| branches_on_uniforms(module, function, &function.body)).sum()
}

/// Mesa's software driver writes uniforms that alone decide a branch into the shader: it makes the shader
/// anew for each dispatch, which takes time, and keeps it, which takes 150 KiB.
#[test]
fn no_branch_depends_on_uniforms_alone() {
    for name in entry_shaders() {
        let module = check(&joined(name)).expect("the shader is valid");
        assert_eq!(branches_on_uniforms_in(&module), 0, "{name}");
    }
    // And such branches are found.
    let wrong = joined("output/display.wgsl").replacen(
        "    if (any(",
        "    if (display.clip + 1u > 1u) {\n        return;\n    }\n    if (any(",
        1,
    );
    assert_eq!(branches_on_uniforms_in(&check(&wrong).expect("a valid shader")), 1);
}
