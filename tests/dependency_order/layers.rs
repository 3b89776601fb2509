//! Check of the layering: the manifest of each crate depends on lower crates only, and the libraries of the window and
//! of the GPU stay where they belong.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::module_paths::crates;
use crate::sources::{LAYERS, SourceFile, all_sources, source_files};
use crate::tokens::tokens;

/// Prefix of the names of the project's own crates.
const OWN: &str = "chiaroscuro-";

/// Renderer of which the reference uses only the plan: geometry that both must share, without any rendering.
const RENDERER: &str = "chiaroscuro_render";

/// Libraries that only sources with these prefixes may name.
const CONFINED: [(&str, &[&str]); 4] = [
    ("egui", &["src/app/", "src/main.rs"]),
    ("eframe", &["src/app/", "src/main.rs"]),
    ("egui_wgpu", &["src/app/", "src/main.rs"]),
    ("wgpu", &["crates/render/src/", "src/app/"]),
];

/// Parts of the crates named above that do without these libraries all the same: what a picture needs is planned
/// without a GPU.
const EXCLUDED: [(&str, &str); 1] = [("wgpu", "crates/render/src/plan/")];

/// Crates of the project on which a manifest depends, without those of tests.
fn own_dependencies(manifest: &str) -> BTreeSet<&str> {
    let mut found = BTreeSet::new();
    let mut is_list = false;
    for line in manifest.lines() {
        if let Some(table) = line.strip_prefix('[') {
            is_list = table.ends_with("dependencies]")
                && !table.contains("dev-dependencies")
                && !table.starts_with("workspace");
        } else if let Some(name) = line.strip_prefix(OWN).filter(|_| is_list) {
            found.insert(name.split(['.', ' ', '=']).next().unwrap_or_default());
        }
    }
    found
}

/// Uses of confined libraries in a source file outside their places.
fn confinement_violations(file: &SourceFile) -> Vec<String> {
    let tokens = tokens(&file.text);
    let named = crates(&tokens);
    let is_allowed = |name: &str, allowed: &[&str]| {
        allowed.iter().any(|place| file.path.starts_with(place))
            && !EXCLUDED.iter().any(|(library, place)| *library == name && file.path.starts_with(place))
    };
    CONFINED
        .into_iter()
        .filter(|(name, allowed)| named.contains(name) && !is_allowed(name, allowed))
        .map(|(name, allowed)| format!("{} names {name}, which belongs into {allowed:?}", file.path))
        .collect()
}

#[test]
fn crates_depend_on_lower_crates_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut lower = BTreeSet::new();
    for (name, folder, allowed) in LAYERS {
        let path = root.join(folder).with_file_name("Cargo.toml");
        let manifest = fs::read_to_string(&path).expect("each crate has a manifest");
        assert!(manifest.contains(&format!("name = \"{name}\"")), "{}", path.display());
        assert_eq!(own_dependencies(&manifest), allowed.iter().copied().collect(), "{name}");
        assert!(allowed.iter().all(|other| lower.contains(other)), "{name} depends on a crate above it");
        lower.insert(name.trim_start_matches(OWN));
    }
    let manifest = fs::read_to_string(root.join("Cargo.toml")).expect("the workspace has a manifest");
    let members = manifest
        .split_once("members = [")
        .and_then(|(_, rest)| rest.split_once(']'))
        .map_or("", |(list, _)| list);
    let members = members.matches(',').count();
    assert_eq!(members, LAYERS.len() - 1, "each crate has its place in the order");
}

#[test]
fn the_order_is_that_of_the_documentation() {
    let documented: Vec<_> = include_str!("../../src/lib.rs")
        .lines()
        .filter_map(|line| line.strip_prefix("//! | `"))
        .filter_map(|line| line.split('`').next())
        .collect();
    assert_eq!(documented, LAYERS.map(|(name, ..)| name));
}

#[test]
fn libraries_stay_in_their_places() {
    let files = all_sources();
    assert!(files.len() > 500, "the check must see the sources, and sees {}", files.len());
    let found: Vec<_> = files.iter().flat_map(confinement_violations).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Paths in the reference renderer that name the renderer itself, rather than its plan.
fn uses_of_the_renderer(text: &str) -> usize {
    let tokens = tokens(text);
    tokens.windows(3).filter(|part| part[0] == RENDERER && part[1] == "::" && part[2] != "plan").count()
}

#[test]
fn the_reference_does_without_the_renderer() {
    let files = source_files("crates/reference/src", "rs");
    assert!(files.iter().any(|file| file.text.contains("use chiaroscuro_render::plan")));
    let found: Vec<_> =
        files.iter().filter(|file| uses_of_the_renderer(&file.text) > 0).map(|file| &file.path).collect();
    assert!(found.is_empty(), "they would be compared with themselves: {found:?}");
    assert_eq!(uses_of_the_renderer("use chiaroscuro_render::{plan, Renderer};"), 1);
    assert_eq!(uses_of_the_renderer("use chiaroscuro_render::plan::EyeKey;"), 0);
}

#[test]
fn dependencies_are_read_from_manifests() {
    let manifest = "[package]\nname = \"chiaroscuro-x\"\n[dependencies]\nchiaroscuro-files.workspace = true\n\
                    glam = \"1\"\n[dev-dependencies]\nchiaroscuro-media = { path = \"..\" }\n\
                    [target.'cfg(unix)'.dependencies]\nchiaroscuro-scene = { workspace = true }\n";
    assert_eq!(own_dependencies(manifest), BTreeSet::from(["files", "scene"]));
}

#[test]
fn confined_libraries_are_reported() {
    let violations = |path: &str, text: &str| {
        confinement_violations(&SourceFile { path: path.to_owned(), text: text.to_owned() })
    };
    for (path, text) in [
        ("src/cli/mod.rs", "fn f(ui: &mut egui::Ui) {}"),
        ("crates/render/src/lib.rs", "use eframe::App;"),
        ("crates/render/src/lib.rs", "use egui_wgpu::RenderState;"),
        ("crates/render/src/plan/mod.rs", "use wgpu::Device;"),
        ("crates/scene/src/lib.rs", "use {::wgpu::Device};"),
        ("crates/scene/src/lib.rs", "fn f(d: &::wgpu::Device) {}"),
        ("src/main.rs", "fn f(device: &wgpu::Device) {}"),
        ("crates/volume/src/lib.rs", "use wgpu as w;"),
    ] {
        assert_eq!(violations(path, text).len(), 1, "{path}: {text}");
    }
    for (path, text) in [
        ("crates/scene/src/lib.rs", "fn f() { Length::egui::<u8>(); crate::math::wgpu::x() }"),
        ("src/app/mod.rs", "use eframe::egui;\nfn f(d: wgpu::Device) {}"),
        ("src/main.rs", "fn f() { eframe::run() }"),
        ("crates/render/src/eye/mod.rs", "use wgpu::Device;"),
    ] {
        assert_eq!(violations(path, text), Vec::<String>::new(), "{path}: {text}");
    }
}
