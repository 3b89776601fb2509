//! Paths that documents name: each exists, in links and in code.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::sources::{SourceFile, source_files};

/// Folders and scripts of the project with which a path in a document begins.
const ROOMS: [&str; 12] = [
    "src/",
    "crates/",
    "shaders/",
    "tests/",
    "script/",
    "docs/",
    "presets/",
    "assets/",
    "examples/",
    "benches/",
    "fuzz/",
    "packaging/",
];

/// Documents at the top of the project; the change log names what was there when a version was made.
const TOP: [&str; 2] = ["README.md", "CONTRIBUTING.md"];

/// Top folder of the project.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All documents, with paths below the top folder.
fn documents() -> Vec<SourceFile> {
    let below = source_files("docs", "md").into_iter();
    let below = below.map(|file| SourceFile { path: format!("docs/{}", file.path), ..file });
    let text = |path: &str| fs::read_to_string(root().join(path)).expect("documents are text");
    TOP.into_iter().map(|path| SourceFile { path: path.to_owned(), text: text(path) }).chain(below).collect()
}

/// Paths in code spans and code blocks, without arguments and line numbers.
fn paths_in_code(text: &str) -> Vec<&str> {
    let blocks = text.split("```").skip(1).step_by(2).flat_map(str::lines);
    let prose = text.split("```").step_by(2).flat_map(|prose| prose.split('`').skip(1).step_by(2));
    let words = blocks.chain(prose).filter_map(|span| span.split_whitespace().next());
    let words = words.map(|word| word.split(':').next().unwrap_or(word));
    words.filter(|word| ROOMS.iter().any(|room| word.starts_with(room))).collect()
}

/// Targets of links to files, without anchors.
fn linked_files(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let targets = targets.map(|target| target.split('#').next().unwrap_or(target));
    targets.filter(|target| !target.is_empty() && !target.contains("://")).collect()
}

/// True where a part of a path is to be replaced by the reader, as `NAME` in `src/gpu/NAME.rs`.
fn is_template(path: &str) -> bool {
    let stem = |part: &str| part.split('.').next().unwrap_or_default().to_owned();
    path.split('/').map(stem).any(|part| part.len() > 1 && part.chars().all(char::is_uppercase))
}

/// Paths of a document, below the top folder, that do not exist.
fn missing(document: &SourceFile) -> Vec<String> {
    let folder = Path::new(&document.path).parent().unwrap_or(Path::new(""));
    let named =
        paths_in_code(&document.text).into_iter().filter(|path| !is_template(path)).map(PathBuf::from);
    let linked = linked_files(&document.text).into_iter().map(|target| folder.join(target));
    let mut found = Vec::new();
    for path in named.chain(linked) {
        let mut plain = PathBuf::new();
        for component in path.components() {
            if component == Component::ParentDir {
                plain.pop();
            } else {
                plain.push(component);
            }
        }
        if !root().join(&plain).exists() {
            found.push(format!("{} names {}", document.path, plain.display()));
        }
    }
    found
}

#[test]
fn paths_in_documents_exist() {
    let documents = documents();
    let count: usize = documents.iter().map(|file| paths_in_code(&file.text).len()).sum();
    assert!(count > 200, "the check must see the paths in documents, and sees {count}");
    let found: Vec<_> = documents.iter().flat_map(missing).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn missing_paths_are_reported() {
    let text = "`src/lib.rs:3`, `src/no_such.rs`, `src/gpu/NAME.rs`, `a/b`, \
                [here](docs/USING.md#a), [gone](no.md), [out](https://a.b)\n\
                ```\nscript/test ARGS\nscript/no_such\n```\n`tests/no_such*`";
    let found = missing(&SourceFile { path: "README.md".to_owned(), text: text.to_owned() });
    let names = ["script/no_such", "src/no_such.rs", "tests/no_such*", "no.md"];
    assert_eq!(found, names.map(|name| format!("README.md names {name}")));
    let text = "[up](../README.md) [beside](LABORATORY.md) [gone](gone.md)";
    let found = missing(&SourceFile { path: "docs/USING.md".to_owned(), text: text.to_owned() });
    assert_eq!(found, ["docs/USING.md names docs/gone.md"]);
}
