//! Check that structs shared by Rust and shaders have the same fields at the same offsets.

use std::collections::BTreeSet;

use crate::layouts::mirrored_structs;
use crate::sources::{entry_shaders, shader_source, validate_shader};
use crate::struct_layout::{FieldLayout, StructLayout};

/// Rust's name of a WGSL type.
fn rust_type_name(module: &naga::Module, ty: naga::Handle<naga::Type>) -> String {
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
            format!("[{}; {count}]", rust_type_name(module, *base))
        }
        naga::TypeInner::Struct { .. } => ty.name.clone().expect("structs have names"),
        other => format!("{other:?}"),
    }
}

/// Layout of a struct in WGSL.
fn wgsl_layout(module: &naga::Module, name: &str) -> Option<StructLayout> {
    let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name))?;
    let naga::TypeInner::Struct { members, span } = &ty.inner else { return None };
    let fields = members
        .iter()
        .map(|member| FieldLayout {
            name: member.name.clone().unwrap_or_default(),
            offset: member.offset as usize,
            type_name: rust_type_name(module, member.ty),
        })
        .collect();
    Some(StructLayout { name: name.to_owned(), size: *span as usize, fields })
}

/// All differences between both layouts of a struct, one line each.
fn differences(rust: &StructLayout, module: &naga::Module) -> Vec<String> {
    let name = &rust.name;
    let Some(wgsl) = wgsl_layout(module, name) else { return vec![format!("{name} is not in the shader")] };
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
    for (shader, layout) in mirrored_structs() {
        let module = validate_shader(&shader_source(shader)).expect("the shader is valid");
        found
            .extend(differences(&layout, &module).iter().map(|difference| format!("{shader}: {difference}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_shared_struct_is_compared() {
    let files = [
        include_str!("../../crates/render/src/pipelines/uniforms/mod.rs"),
        include_str!("../../crates/render/src/pipelines/uniforms/layers.rs"),
        include_str!("../../crates/render/src/pipelines/uniforms/light.rs"),
        include_str!("../../crates/render/src/pipelines/uniforms/pages.rs"),
        include_str!("../../crates/render/src/pipelines/uniforms/scattered_light.rs"),
        include_str!("../../crates/render/src/pipelines/uniforms/sky.rs"),
    ];
    let declared: BTreeSet<_> = files
        .into_iter()
        .flat_map(str::lines)
        .filter_map(|line| line.strip_prefix("pub struct "))
        .map(|rest| rest.trim_end_matches(" {").to_owned())
        .collect();
    let compared: BTreeSet<_> = mirrored_structs().into_iter().map(|(_, layout)| layout.name).collect();
    assert_eq!(declared, compared);

    // Every buffer that a shader reads as a struct is compared as well.
    for name in entry_shaders() {
        let module = validate_shader(&shader_source(name)).expect("the shader is valid");
        for (_, global) in module.global_variables.iter() {
            if global.space == naga::AddressSpace::Uniform {
                let kind = rust_type_name(&module, global.ty);
                assert!(compared.contains(&kind), "{name}: uniform {kind} is not compared");
            }
        }
    }
}

#[test]
fn differing_structs_are_reported() {
    let source = shader_source("light/march.wgsl");
    let layout_of = |name: &str| {
        let found = mirrored_structs()
            .into_iter()
            .find(|(shader, layout)| *shader == "light/march.wgsl" && layout.name == name);
        found.expect("it is compared").1
    };
    let (march, grid) = (layout_of("MarchUniform"), layout_of("GridUniform"));
    let wrong = |layout: &StructLayout, from: &str, to: &str| {
        assert!(source.contains(from), "{from}");
        let module = validate_shader(&source.replacen(from, to, 1)).expect("a valid shader all the same");
        differences(layout, &module)
    };
    assert_eq!(wrong(&march, "struct March", "struct March"), Vec::<String>::new());
    let swapped = wrong(&march, "begin: u32,\n    end: u32,", "end: u32,\n    begin: u32,");
    assert_eq!(swapped.len(), 2, "{swapped:?}");
    let retyped = wrong(&grid, "pad2: f32,\n}", "pad2: u32,\n}");
    assert_eq!(retyped.len(), 1, "{retyped:?}");
    let longer = wrong(&grid, "pad2: f32,\n}", "pad2: f32,\n    more: vec4f,\n}");
    assert_eq!(longer.len(), 2, "the size and the field: {longer:?}");
    let absent = StructLayout { name: "Marsch".to_owned(), ..march.clone() };
    let module = validate_shader(&source).expect("the shader is valid");
    assert_eq!(differences(&absent, &module), ["Marsch is not in the shader"]);
}
