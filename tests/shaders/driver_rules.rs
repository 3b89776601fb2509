//! Check that shaders avoid constructs that make Mesa's software driver (llvmpipe) slow.

use std::collections::BTreeSet;

use naga::valid::{Capabilities, GlobalUse, ValidationFlags, Validator};
use wgpu::TextureFormat;

use crate::sources::{entry_shaders, shader_source, validate_shader, variants, without_comments};

/// Uniforms that are not copied by the first statements of a shader's entry point, or are read elsewhere.
fn uniforms_read_late(source: &str) -> Vec<String> {
    let code = without_comments(source);
    let entry = code.split("@compute").nth(1).and_then(|rest| rest.split_once(") {\n"));
    let body = entry.map(|(_, body)| body).unwrap_or_default();
    let copies: BTreeSet<_> =
        body.lines().map(str::trim).take_while(|line| line.contains(" = bound_")).collect();
    let declared = code.split("var<uniform> ").skip(1).filter_map(|rest| rest.split(':').next());
    // An array with a varying index cannot be copied.
    let reads = |name: &str| {
        let arrays = [".lights[i]", ".rays[i]", ".rays[id.z]", ".directions[i]", ".layers[i].materials[at]"]
            .map(|of| format!("{name}{of}"));
        arrays.iter().fold(code.clone(), |code, of| code.replace(of, "")).matches(name).count()
    };
    let is_late = |name: &&str| {
        let Some(own) = name.strip_prefix("bound_") else { return true };
        let is_copied = copies.contains(format!("{own} = {name};").as_str()) && reads(name) == 2;
        // A shader that needs no copy makes none: imported files may declare uniforms for others.
        let is_unused = || reads(name) == 1 && !is_variable_used(source, own);
        !is_copied && !is_unused()
    };
    declared.filter(is_late).map(str::to_owned).collect()
}

/// Returns true if a shader's entry point, or a function that it calls, uses a variable of the module.
fn is_variable_used(source: &str, name: &str) -> bool {
    let module = naga::front::wgsl::parse_str(source).expect("a shader");
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
    let info = info.expect("a valid shader");
    let used = |(handle, variable): (_, &naga::GlobalVariable)| {
        variable.name.as_deref() == Some(name) && info.get_entry_point(0)[handle] != GlobalUse::empty()
    };
    module.global_variables.iter().any(used)
}

/// Behind a branch, a software driver reads uniforms lane by lane (volume/field.wgsl).
#[test]
fn uniforms_are_copied_before_anything_branches() {
    let late: Vec<_> = entry_shaders()
        .into_iter()
        .flat_map(|name| {
            variants(name, TextureFormat::R16Float, TextureFormat::R16Float)
                .into_iter()
                .map(move |(what, source)| (name, what, source))
        })
        .map(|(name, what, source)| (name, what, uniforms_read_late(&source)))
        .filter(|(_, _, late)| !late.is_empty())
        .collect();
    assert!(late.is_empty(), "{late:?}");
}

#[test]
fn uniforms_read_late_are_noticed() {
    let source = shader_source("eye/eye_pass.wgsl");
    for (from, to, name) in [
        // Used without a copy.
        ("    grid = bound_grid;\n", "", "bound_grid"),
        ("grid = bound_grid;", "if (true) {}\n    grid = bound_grid;", "bound_grid"),
        ("let s = eye.shading;", "let s = bound_eye.shading;", "bound_eye"),
        ("var<uniform> bound_eye", "var<uniform> given_eye", "given_eye"),
    ] {
        assert!(source.contains(from), "{from}");
        assert_eq!(uniforms_read_late(&source.replace(from, to)), [name], "{from}");
    }
}

/// Origin of an expression: constants, uniforms and constants, or others.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ExpressionOrigin {
    Constant,
    Uniform,
    Other,
}

fn origin_of(
    module: &naga::Module,
    function: &naga::Function,
    at: naga::Handle<naga::Expression>,
) -> ExpressionOrigin {
    use naga::Expression as E;
    let of = |at| origin_of(module, function, at);
    let join = |parts: &[naga::Handle<E>]| {
        parts.iter().map(|&part| of(part)).fold(ExpressionOrigin::Constant, |all, part| match (all, part) {
            (ExpressionOrigin::Other, _) | (_, ExpressionOrigin::Other) => ExpressionOrigin::Other,
            (ExpressionOrigin::Uniform, _) | (_, ExpressionOrigin::Uniform) => ExpressionOrigin::Uniform,
            _ => ExpressionOrigin::Constant,
        })
    };
    match &function.expressions[at] {
        E::Literal(_) | E::Constant(_) | E::Override(_) | E::ZeroValue(_) => ExpressionOrigin::Constant,
        // Private variables are copies of uniforms.
        E::GlobalVariable(global)
            if matches!(
                module.global_variables[*global].space,
                naga::AddressSpace::Uniform | naga::AddressSpace::Private
            ) =>
        {
            ExpressionOrigin::Uniform
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
        _ => ExpressionOrigin::Other,
    }
}

fn branches_on_uniforms(module: &naga::Module, function: &naga::Function, block: &naga::Block) -> usize {
    let inner = |block| branches_on_uniforms(module, function, block);
    block
        .iter()
        .map(|statement| match statement {
            naga::Statement::Block(block) => inner(block),
            naga::Statement::If { condition, accept, reject } => {
                let found = origin_of(module, function, *condition) == ExpressionOrigin::Uniform;
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

/// Mesa's software driver specialises a shader on uniforms that alone decide a branch: it recompiles the shader for
/// each dispatch, which takes time, and caches it, which takes 150 KiB.
#[test]
fn no_branch_depends_on_uniforms_alone() {
    for name in entry_shaders() {
        for (what, source) in variants(name, TextureFormat::R16Float, TextureFormat::R16Float) {
            let module = validate_shader(&source).expect("the shader is valid");
            assert_eq!(branches_on_uniforms_in(&module), 0, "{name}, {what}");
        }
    }
    // Guards the check itself: such a branch is detected.
    let wrong = shader_source("output/display.wgsl").replacen(
        "    if (any(",
        "    if (display.clip + 1u > 1u) {\n        return;\n    }\n    if (any(",
        1,
    );
    assert_eq!(branches_on_uniforms_in(&validate_shader(&wrong).expect("a valid shader")), 1);
}
