//! Check of the layering: modules import lower modules only, and some crates are confined to some modules.

use std::collections::BTreeSet;

use crate::module_paths::{crates, paths};
use crate::sources::{SourceFile, source_files};
use crate::tokens::tokens;

/// Modules from the lowest layer up. Each may import those before it.
const ORDER: [&str; 11] =
    ["fault", "math", "data", "model", "plan", "export", "reference", "gpu", "app", "cli", "main"];

/// Imports that the order allows and the design forbids: the renderer must not use the reference, or comparing them
/// would prove nothing.
const FORBIDDEN: [(&str, &str); 1] = [("gpu", "reference")];

/// Crates that only these modules may name.
const CONFINED: [(&str, &[&str]); 4] = [
    ("egui", &["app", "main"]),
    ("eframe", &["app", "main"]),
    ("egui_wgpu", &["app", "main"]),
    ("wgpu", &["gpu", "app"]),
];

fn violations(file: &SourceFile) -> Vec<String> {
    let SourceFile { path, text } = file;
    let top = file.top_module();
    let mut found = Vec::new();
    let tokens = tokens(text);
    for (name, allowed) in CONFINED {
        if crates(&tokens).contains(name) && !allowed.contains(&top) {
            found.push(format!("{path} names the crate {name}, which belongs into {allowed:?}"));
        }
    }

    // The root declares all modules, in alphabetical order.
    if top == "lib" {
        return found;
    }
    let rank = |module: &str| ORDER.iter().position(|known| *known == module);
    let Some(own) = rank(top) else {
        found.push(format!("{path} is in {top}, which has no place in the order of modules"));
        return found;
    };
    let module = if top == "main" { Vec::new() } else { file.module_path() };
    let roots: BTreeSet<String> =
        paths(&tokens, &module).into_iter().filter_map(|path| path.into_iter().next()).collect();
    for root in roots {
        let is_own_item = top == "main" && rank(&root).is_none();
        match rank(&root) {
            Some(other) if other > own => {
                found.push(format!("{path}: {top} imports {root}, which is above it"));
            }
            Some(_) if FORBIDDEN.contains(&(top, root.as_str())) => {
                found.push(format!("{path}: {top} must not import {root}"));
            }
            None if !is_own_item => found.push(format!("{path} uses {root} of the root, which is no module")),
            _ => {}
        }
    }
    found
}

#[test]
fn source_files_keep_the_order_of_modules() {
    let files = source_files("src", "rs");
    assert!(files.len() > 50, "the check must see the sources");
    let found: Vec<_> = files.iter().flat_map(violations).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn the_order_is_that_of_the_documentation() {
    let documented: Vec<_> = include_str!("../../src/lib.rs")
        .lines()
        // Modules behind a feature are listed without a link.
        .filter_map(|line| line.strip_prefix("//! | [`").or_else(|| line.strip_prefix("//! | `")))
        .filter_map(|line| line.split('`').next())
        .map(|name| name.trim_start_matches("mod@"))
        .collect();
    assert_eq!(documented, ORDER[..ORDER.len() - 1]);
}

fn violations_of(path: &str, text: &str) -> Vec<String> {
    violations(&SourceFile { path: path.to_owned(), text: text.to_owned() })
}

#[test]
fn upward_imports_are_reported() {
    for (path, text) in [
        ("model/light.rs", "use crate::gpu::Renderer;"),
        ("model/light.rs", "use crate::{data::Volume, plan};"),
        ("model/light.rs", "use crate::{\n    math::{a, b},\n    cli::{self, CliError},\n};"),
        ("model/light.rs", "fn f() -> u8 { let x = crate::plan::plan(); x }"),
        ("model/light.rs", "use super::super::app::theme;"),
        ("model/light.rs", "use super::{super::app::theme, Settings};"),
        ("model/mod.rs", "use super::plan;"),
        ("model/mod.rs", "mod tests {\n    use super::super::plan;\n}"),
        ("model/a/b.rs", "fn f() { super::super::super::cli::main() }"),
        ("model/light.rs", "pub(in crate::gpu) fn f() {}"),
        ("model/light.rs", "use crate::*;"),
        ("model/light.rs", "use crate::nowhere::x;"),
        ("reference/kernel.rs", "use crate::gpu::Context;"),
        ("gpu/renderer.rs", "use crate::reference::render;"),
        ("app/mod.rs", "use crate::cli::CliError;"),
        ("elsewhere/mod.rs", ""),
    ] {
        assert_eq!(violations_of(path, text).len(), 1, "{path}: {text}: {:?}", violations_of(path, text));
    }
}

#[test]
fn confined_crates_are_reported() {
    for (path, text) in [
        ("cli/mod.rs", "fn f(ui: &mut egui::Ui) {}"),
        ("gpu/mod.rs", "use eframe::App;"),
        ("gpu/mod.rs", "use egui_wgpu::RenderState;"),
        ("plan/mod.rs", "use wgpu::Device;"),
        ("plan/mod.rs", "use {::wgpu::Device};"),
        ("plan/mod.rs", "fn f(d: &::wgpu::Device) {}"),
        ("plan/mod.rs", "use ::wgpu::Device;"),
        ("main.rs", "fn f(device: &wgpu::Device) {}"),
        ("plan/mod.rs", "use wgpu as w;"),
    ] {
        let found = violations_of(path, text);
        assert_eq!(found.len(), 1, "{path}: {text}: {found:?}");
    }
}

#[test]
fn what_is_allowed_is_not_reported() {
    for (path, text) in [
        ("model/light.rs", "use crate::{data::{Volume, gpu}, math};"),
        ("model/light.rs", "use super::Settings;\nuse self::gpu::x;"),
        ("model/a/b.rs", "use super::super::plan;"),
        ("model/mod.rs", "mod tests {\n    use super::plan;\n}\nuse self::cli;"),
        ("model/mod.rs", "mod tests { fn f() {} }\nmod gpu { use super::super::math; }"),
        ("model/light.rs", "// crate::gpu::x\n/* crate::gpu /* nested */ crate::cli */"),
        ("model/light.rs", "/// See [`crate::gpu`].\nfn f() {}"),
        ("model/light.rs", "const A: &str = \"crate::gpu \\\" crate::cli\"; const B: char = '\"';"),
        ("model/light.rs", "const A: &str = r#\"crate::gpu \" crate::cli\"#; fn f<'a>(x: &'a str) {}"),
        ("model/light.rs", "fn f(gpu: u8, x: crate::math::Bounds) { x.gpu::<u8>(); egui(); }"),
        ("model/light.rs", "fn f() { Length::egui::<u8>(); crate::math::wgpu::x() }"),
        ("model/light.rs", "pub(crate) fn f() -> Vec<crate::data::Volume> { vec![] }"),
        ("app/mod.rs", "use eframe::egui;\nuse crate::gpu::Context;\nfn f(d: wgpu::Device) {}"),
        ("main.rs", "use chiaroscuro::{app, cli::{self, CliError}};\nfn f() { eframe::run() }"),
        ("cli/mod.rs", "use std::io::Write as _;\nuse crate::app;"),
        ("lib.rs", "pub mod app;\npub mod math;"),
    ] {
        assert_eq!(violations_of(path, text), Vec::<String>::new(), "{path}: {text}");
    }
}
