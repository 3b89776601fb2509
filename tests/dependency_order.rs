//! Modules import downwards only (the table in `src/lib.rs`); the window library stays in the window
//! and the GPU library in the renderer; files say what they are and stay short.

use std::collections::BTreeSet;
use std::fs;
use std::iter::Peekable;
use std::path::{Path, PathBuf};
use std::str::Chars;

/// The modules, lowest first. Each may import those before it.
const ORDER: [&str; 10] =
    ["math", "data", "model", "plan", "export", "reference", "gpu", "app", "cli", "main"];

/// Imports that the order allows and the design does not: the renderer owes the reference nothing,
/// or comparing them would prove nothing.
const FORBIDDEN: [(&str, &str); 1] = [("gpu", "reference")];

/// Crates, and the modules that may name them.
const CONFINED: [(&str, &[&str]); 4] = [
    ("egui", &["app", "main"]),
    ("eframe", &["app", "main"]),
    ("egui_wgpu", &["app", "main"]),
    ("wgpu", &["gpu", "app"]),
];

/// Lines that a source file may have.
const LONGEST_FILE: usize = 400;

// ---------------------------------------------------------------------------------------------
// Reading source text
// ---------------------------------------------------------------------------------------------

/// Words, and `::` and single characters between them; no comments, strings or white space.
fn tokens(source: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '/' if rest.peek() == Some(&'/') => while rest.next().is_some_and(|c| c != '\n') {},
            '/' if rest.peek() == Some(&'*') => skip_block_comment(&mut rest),
            '"' => skip_string(&mut rest),
            '\'' => skip_character(&mut rest),
            ':' if rest.peek() == Some(&':') => {
                rest.next();
                found.push("::".to_owned());
            }
            c if c.is_alphanumeric() || c == '_' => {
                let mut word = String::from(c);
                while let Some(&c) = rest.peek().filter(|c| c.is_alphanumeric() || **c == '_') {
                    word.push(c);
                    rest.next();
                }
                let starts_text = matches!(rest.peek(), Some('"' | '#'));
                if starts_text && ["r", "br", "cr"].contains(&word.as_str()) {
                    skip_raw_string(&mut rest);
                } else {
                    found.push(word);
                }
            }
            c if c.is_whitespace() => {}
            c => found.push(c.to_string()),
        }
    }
    found
}

/// The rest of a block comment, which may hold others.
fn skip_block_comment(rest: &mut Peekable<Chars<'_>>) {
    let (mut depth, mut last) = (0, '/');
    for c in rest.by_ref() {
        let joined = (last, c);
        // The character is used up, so that `/*/` does not also close what it opens.
        last = if matches!(joined, ('/', '*') | ('*', '/')) { ' ' } else { c };
        match joined {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return;
        }
    }
}

fn skip_string(rest: &mut Peekable<Chars<'_>>) {
    while let Some(c) = rest.next() {
        match c {
            '\\' => drop(rest.next()),
            '"' => return,
            _ => {}
        }
    }
}

/// From the hashes or the quote on; `r#type` is no string, but a name that is of no use here.
fn skip_raw_string(rest: &mut Peekable<Chars<'_>>) {
    let mut hashes = 0;
    while rest.next_if_eq(&'#').is_some() {
        hashes += 1;
    }
    if rest.next_if_eq(&'"').is_none() {
        return;
    }
    while let Some(c) = rest.next() {
        if c == '"' && (0..hashes).all(|_| rest.next_if_eq(&'#').is_some()) {
            return;
        }
    }
}

/// A character in quotes, or the quote of a lifetime.
fn skip_character(rest: &mut Peekable<Chars<'_>>) {
    let mut ahead = rest.clone();
    match (ahead.next(), ahead.next()) {
        (Some('\\'), _) => {
            rest.next();
            rest.next();
            while rest.next().is_some_and(|c| c != '\'') {}
        }
        (Some(_), Some('\'')) => {
            rest.next();
            rest.next();
        }
        _ => {}
    }
}

/// Names below the crate's root that a file uses: `crate::X`, `crate::{X, Y}`, `super::super::X`,
/// `chiaroscuro::X`. `depth` says how many modules deep the file itself is.
fn roots(tokens: &[String], depth: usize) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    // Whether each open brace belongs to a module in the file.
    let mut braces: Vec<bool> = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let inner = depth + braces.iter().filter(|&&is_module| is_module).count();
        let starts = at == 0 || tokens[at - 1] != "::";
        match tokens[at].as_str() {
            "{" => braces.push(at >= 2 && tokens[at - 2] == "mod"),
            "}" => drop(braces.pop()),
            "crate" | "chiaroscuro" if starts => _ = follow(tokens, at + 1, 0, &mut found),
            "super" | "self" if starts => _ = follow(tokens, at, inner, &mut found),
            _ => {}
        }
        at += 1;
    }
    found
}

/// Follows a path from a token on, `depth` modules below the root, and notes the names at the root.
/// Returns where the path ends.
fn follow(tokens: &[String], mut at: usize, mut depth: usize, found: &mut BTreeSet<String>) -> usize {
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    loop {
        match token(at) {
            "::" if token(at + 1) != "<" => at += 1,
            "super" => {
                depth = depth.saturating_sub(1);
                at += 1;
            }
            "self" => at += 1,
            "{" => {
                at += 1;
                while !matches!(token(at), "}" | "") {
                    at = follow(tokens, at, depth, found).max(at + 1);
                }
                return at + 1;
            }
            name => {
                // Only what follows `::` (or opens a group) is a name of the path.
                let in_path = matches!(token(at.wrapping_sub(1)), "::" | "{" | ",");
                let is_name = name == "*" || name.starts_with(|c: char| c.is_alphabetic() || c == '_');
                if depth == 0 && in_path && is_name {
                    found.insert(name.to_owned());
                }
                if !in_path || !is_name {
                    return at;
                }
                // The rest of the path is below the root: walk it for its groups, deep enough.
                at += 1;
                depth = usize::MAX / 2;
            }
        }
    }
}

/// The first word of every path and `use`: the crates that a file names.
fn crates(tokens: &[String]) -> BTreeSet<&str> {
    let token = |at: Option<usize>| at.and_then(|at| tokens.get(at)).map_or("", String::as_str);
    let continues = |word: &str| {
        let is_name = word.starts_with(|c: char| c.is_alphabetic() || c == '_') || word == ">";
        is_name && !["use", "as", "in", "mut", "dyn", "impl", "return"].contains(&word)
    };
    (0..tokens.len())
        .filter(|&at| {
            let (before, after) = (token(at.checked_sub(1)), token(Some(at + 1)));
            let is_first = before != "::" || !continues(token(at.checked_sub(2)));
            let is_import = ["use", "crate"].contains(&before) && [";", "as"].contains(&after);
            is_first && after == "::" || is_import
        })
        .map(|at| tokens[at].as_str())
        .collect()
}

// ---------------------------------------------------------------------------------------------
// Rules
// ---------------------------------------------------------------------------------------------

/// A source file.
struct Source {
    /// Below `src/`, with `/` between folders.
    path: String,
    text: String,
}

impl Source {
    /// The folders and the stem, without `mod`: the module's path below the root.
    fn module(&self) -> Vec<&str> {
        let stem = self.path.strip_suffix(".rs").unwrap_or(&self.path);
        stem.split('/').filter(|part| *part != "mod").collect()
    }

    /// The module at the root that it belongs to.
    fn top(&self) -> &str {
        self.module()[0]
    }
}

fn violations(file: &Source) -> Vec<String> {
    let Source { path, text } = file;
    let top = file.top();
    let mut found = Vec::new();
    if !text.starts_with("//!") {
        found.push(format!("{path} does not begin with //! and what it is"));
    }
    let lines = text.lines().count();
    if lines > LONGEST_FILE && !path.contains("tests/") {
        found.push(format!("{path} has {lines} lines, {LONGEST_FILE} are allowed"));
    }

    let tokens = tokens(text);
    for (name, allowed) in CONFINED {
        if crates(&tokens).contains(name) && !allowed.contains(&top) {
            found.push(format!("{path} names the crate {name}, which belongs into {allowed:?}"));
        }
    }

    // The root itself declares all modules, in alphabetical order.
    if top == "lib" {
        return found;
    }
    let rank = |module: &str| ORDER.iter().position(|known| *known == module);
    let Some(own) = rank(top) else {
        found.push(format!("{path} is in {top}, which has no place in the order of modules"));
        return found;
    };
    let depth = if top == "main" { 0 } else { file.module().len() };
    for root in roots(&tokens, depth) {
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

/// All files below a folder of the project with this ending.
fn files(folder: &str, ending: &str) -> Vec<Source> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("the folder can be listed") {
            let path = entry.expect("the folder can be listed").path();
            if path.is_dir() {
                walk(&path, found);
            } else {
                found.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths = Vec::new();
    walk(&root, &mut paths);
    paths.sort();
    paths
        .iter()
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .map(|path| Source {
            path: path.strip_prefix(&root).expect("it is below").to_string_lossy().replace('\\', "/"),
            text: fs::read_to_string(path).expect("sources are text"),
        })
        .collect()
}

#[test]
fn source_files_keep_the_order_of_modules_and_the_rules_of_form() {
    let files = files("src", "rs");
    assert!(files.len() > 50, "the check must see the sources");
    let found: Vec<_> = files.iter().flat_map(violations).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn the_order_is_that_of_the_documentation() {
    let documented: Vec<_> = include_str!("../src/lib.rs")
        .lines()
        .filter_map(|line| line.strip_prefix("//! | [`"))
        .filter_map(|line| line.split('`').next())
        .map(|name| name.trim_start_matches("mod@"))
        .collect();
    assert_eq!(documented, ORDER[..ORDER.len() - 1]);
}

#[test]
fn shaders_begin_with_what_they_are_and_stay_short() {
    let shaders = files("shaders", "wgsl");
    assert!(shaders.len() > 6, "the check must see the shaders");
    for Source { path, text } in shaders {
        assert!(text.starts_with("// "), "{path} does not begin with a comment");
        assert!(text.lines().count() <= LONGEST_FILE, "{path} is too long");
    }
}

// ---------------------------------------------------------------------------------------------
// The check itself
// ---------------------------------------------------------------------------------------------

fn violations_of(path: &str, text: &str) -> Vec<String> {
    violations(&Source { path: path.to_owned(), text: format!("//! A file.\n{text}") })
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
fn files_without_a_heading_or_too_long_are_reported() {
    let bare = Source { path: "math/a.rs".to_owned(), text: "use glam::DVec3;\n".to_owned() };
    assert_eq!(violations(&bare).len(), 1);
    assert_eq!(violations_of("math/a.rs", &"\n".repeat(LONGEST_FILE)).len(), 1);
    assert_eq!(violations_of("math/a.rs", &"\n".repeat(LONGEST_FILE - 1)), Vec::<String>::new());
    assert_eq!(violations_of("math/tests/a.rs", &"\n".repeat(LONGEST_FILE)), Vec::<String>::new());
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
