//! Check for import cycles between sibling modules, including indirect ones: a reader of one need not read all.
//!
//! A folder's `mod.rs` is exempt: it is the folder, and its files are parts of it. Re-exports of a `mod.rs` are
//! resolved to the module that defines the name.

use std::collections::{BTreeMap, BTreeSet};

use crate::module_paths::{ModulePath, imports, paths, without_tests};
use crate::sources::{LAYERS, SourceFile, source_files};
use crate::tokens::tokens;

/// Modules that each module of a folder imports, with a file that does.
type ImportedModules = BTreeMap<String, BTreeMap<String, String>>;

/// Import edges between the modules of each folder.
type ImportEdges = BTreeMap<String, ImportedModules>;

/// Modules of a crate, and the re-exports of its root and of their `mod.rs`.
struct ModuleTree {
    modules: BTreeSet<ModulePath>,
    reexports: BTreeMap<ModulePath, ModulePath>,
}

impl ModuleTree {
    fn from_sources(files: &[SourceFile]) -> Self {
        let owned = |module: Vec<&str>| module.into_iter().map(str::to_owned).collect::<ModulePath>();
        let known: BTreeSet<ModulePath> = files.iter().map(|file| owned(file.module_path())).collect();
        let mut handed_on = BTreeMap::new();
        for file in files.iter().filter(|file| file.path.ends_with("/mod.rs") || file.path == "lib.rs") {
            let module = file.module_path();
            for (name, path) in imports(&tokens(&file.text), &module) {
                let place: ModulePath = [owned(module.clone()), vec![name]].concat();
                if place != path {
                    handed_on.insert(place, path);
                }
            }
        }
        Self { modules: known, reexports: handed_on }
    }

    /// Module that defines the item at a path, with re-exports resolved.
    fn module_of(&self, path: &ModulePath) -> Option<ModulePath> {
        let mut path = path.clone();
        // More hops than a name is reasonably re-exported.
        for _ in 0..8 {
            let length = (0..=path.len()).rev().find(|&length| self.modules.contains(&path[..length]))?;
            let hop = path.get(..=length).and_then(|name| self.reexports.get(name));
            let Some(hop) = hop else { return Some(path[..length].to_vec()) };
            path = [hop.as_slice(), &path[length + 1..]].concat();
        }
        None
    }
}

/// Collects the import edges between sibling modules, except those of tests.
fn import_edges(files: &[SourceFile]) -> ImportEdges {
    let modules = ModuleTree::from_sources(files);
    let mut found = ImportEdges::new();
    for file in files.iter().filter(|file| !file.module_path().contains(&"tests")) {
        let module = file.module_path();
        let tokens = without_tests(&tokens(&file.text));
        for target in paths(&tokens, &module).iter().filter_map(|path| modules.module_of(path)) {
            let shared = module.iter().zip(&target).take_while(|(own, other)| *own == other).count();
            let (Some(own), Some(other)) = (module.get(shared), target.get(shared)) else { continue };
            let named =
                found.entry(module[..shared].join("/")).or_default().entry((*own).to_owned()).or_default();
            named.entry(other.clone()).or_insert_with(|| file.path.clone());
        }
    }
    found
}

/// Modules that are reachable from a module; itself only through others.
fn reachable_modules<'a>(named: &'a ImportedModules, from: &str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(next) = open.pop() {
        for other in named.get(next).into_iter().flat_map(BTreeMap::keys) {
            if found.insert(other.as_str()) {
                open.push(other);
            }
        }
    }
    found
}

/// Import cycles: a folder, and modules in it of which each is reachable from each.
fn import_cycles(edges: &ImportEdges) -> Vec<(String, BTreeSet<String>)> {
    let mut found = Vec::new();
    for (folder, named) in edges {
        let mut seen = BTreeSet::new();
        for module in named.keys() {
            let forth = reachable_modules(named, module);
            if forth.contains(module.as_str()) && !seen.contains(module) {
                let back = |other: &&&str| reachable_modules(named, other).contains(module.as_str());
                let circle: BTreeSet<String> =
                    forth.iter().filter(back).map(|&name| name.to_owned()).collect();
                seen.extend(circle.clone());
                found.push((folder.clone(), circle));
            }
        }
    }
    found
}

/// Links of the cycles, one per line, for the error message.
fn cycle_links(edges: &ImportEdges, circles: &[(String, BTreeSet<String>)]) -> String {
    let mut lines = Vec::new();
    for (folder, circle) in circles {
        for (module, named) in edges[folder].iter().filter(|(module, _)| circle.contains(*module)) {
            for (other, file) in named.iter().filter(|(other, _)| circle.contains(*other)) {
                lines.push(format!("{folder}: {module} names {other}, in {file}"));
            }
        }
    }
    lines.join("\n")
}

#[test]
fn no_modules_side_by_side_import_each_other() {
    let mut count = 0;
    for (name, folder, _) in LAYERS {
        let edges = import_edges(&source_files(folder, "rs"));
        count += edges.values().flatten().count();
        let circles = import_cycles(&edges);
        assert!(circles.is_empty(), "in {name}:\n{}", cycle_links(&edges, &circles));
    }
    assert!(count > 50, "the check must see the modules");
}

/// Import cycles of given files, as folder and modules.
fn cycles_of_files(list: &[(&str, &str)]) -> Vec<String> {
    let source =
        |(path, text): &(&str, &str)| SourceFile { path: (*path).to_owned(), text: (*text).to_owned() };
    let files: Vec<SourceFile> = list.iter().map(source).collect();
    let name = |(folder, circle): (String, BTreeSet<String>)| {
        format!("{folder}: {}", circle.into_iter().collect::<Vec<_>>().join(" "))
    };
    import_cycles(&import_edges(&files)).into_iter().map(name).collect()
}

#[test]
fn circles_are_reported() {
    let gpu = "mod a; mod b; mod c; pub use a::A; pub(crate) use self::{b::{B, make as made}, c::C};";
    for (a, b, c) in [
        ("use super::b::B;", "use super::a::A;", ""),
        ("use crate::gpu::{b, c::C};", "fn f() { crate::gpu::a::g() }", ""),
        // Through re-exports of the folder.
        ("use super::B;", "use crate::gpu::A;", ""),
        ("use super::made;", "use super::super::gpu::A;", ""),
        // Through a third module.
        ("use super::b::B;", "use super::c::C;", "use super::a::A;"),
        ("use super::*; use super::b::B;", "mod inner { use super::super::a::A; }", ""),
    ] {
        let found =
            cycles_of_files(&[("gpu/mod.rs", gpu), ("gpu/a.rs", a), ("gpu/b.rs", b), ("gpu/c.rs", c)]);
        let expected = if c.is_empty() { "gpu: a b" } else { "gpu: a b c" };
        assert_eq!(found, [expected], "{a} {b} {c}");
    }
    // Between folders, and through their re-exports.
    let found = cycles_of_files(&[
        ("gpu/eye/mod.rs", "pub use gather::Gather;"),
        ("gpu/eye/gather.rs", "use crate::gpu::light::march::March;"),
        ("gpu/light/mod.rs", ""),
        ("gpu/light/march.rs", "use crate::gpu::eye::Gather;"),
        ("gpu/mod.rs", ""),
    ]);
    assert_eq!(found, ["gpu: eye light"]);
}

#[test]
fn what_is_no_circle_is_not_reported() {
    for (a, b) in [
        ("use super::b::B;", ""),
        ("use super::b::B;", "use crate::math::A;"),
        ("use super::b::B;", "#[cfg(test)]\nmod tests { use super::super::a::A; }"),
        ("use super::b::B;", "#[cfg(all(test, unix))]\nuse super::a::A;"),
        ("use super::b::B;", "// use super::a::A;"),
        ("use super::b::B;", "fn f(self) { self.a.g() }"),
        // Items of the folder itself may be used by its parts.
        ("use super::b::B;", "use super::Shared;"),
        ("use super::Shared;", "use super::Shared;"),
    ] {
        let files = [
            ("gpu/mod.rs", "pub struct Shared; use a::A;"),
            ("gpu/a.rs", a),
            ("gpu/b.rs", b),
            ("math/mod.rs", ""),
        ];
        assert_eq!(cycles_of_files(&files), [""; 0], "{a} {b}");
    }
}
