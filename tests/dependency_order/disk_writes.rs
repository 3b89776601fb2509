//! Check that only `crates/files/` opens files for writing, renames and removes them.

use crate::sources::all_sources;
use crate::tokens::tokens;

/// Only crate that may write to the disk.
const WRITER_CRATE: &str = "crates/files/";

/// Functions of `fs` that modify the disk, by the last word of their path.
const FS_FUNCTIONS: [&str; 12] = [
    "write",
    "rename",
    "copy",
    "remove_file",
    "remove_dir",
    "remove_dir_all",
    "create_dir",
    "create_dir_all",
    "hard_link",
    "soft_link",
    "set_permissions",
    "symlink",
];
const FILE_FUNCTIONS: [&str; 3] = ["create", "create_new", "options"];
const WRITER_TYPES: [&str; 3] = ["OpenOptions", "DirBuilder", "tempfile"];

/// Calls in a source text that modify the disk, except in its tests.
fn disk_writes(source: &str) -> Vec<String> {
    let (before, tests) = source.split_once("\nmod tests {").unwrap_or((source, ""));
    let after = tests.split_once("\n}\n").map_or("", |(_, after)| after);
    let words = tokens(&[before, after].concat());
    let at = |index: Option<usize>| index.and_then(|index| words.get(index)).map_or("", String::as_str);
    // In `use std::fs::{self, write};` the whole group belongs to `fs`.
    let of_group = |index: usize| {
        let open = words[..index].iter().rposition(|word| word == "{")?;
        let is_list = words[open..index].iter().all(|word| word != ";" && word != "}");
        (is_list && at(open.checked_sub(1)) == "::").then(|| at(open.checked_sub(2)))
    };
    let is_writer = |index: usize, word: &str| {
        let is_named = at(index.checked_sub(1)) == "::";
        let of = if is_named { at(index.checked_sub(2)) } else { of_group(index).unwrap_or("") };
        WRITER_TYPES.contains(&word)
            || of == "fs" && FS_FUNCTIONS.contains(&word)
            || of == "File" && FILE_FUNCTIONS.contains(&word)
            || ["fs", "File"].contains(&word) && at(Some(index + 1)) == "as"
            // An imported name can be used without its path.
            || of.is_empty() && ["remove_file", "create_dir_all", "hard_link"].contains(&word)
    };
    words
        .iter()
        .enumerate()
        .filter(|(index, word)| is_writer(*index, word))
        .map(|(_, word)| word.clone())
        .collect()
}

#[test]
fn nothing_else_opens_files_for_writing() {
    let sources = all_sources();
    assert!(
        sources
            .iter()
            .any(|source| source.path.starts_with(WRITER_CRATE) && !disk_writes(&source.text).is_empty())
    );
    let elsewhere = sources.iter().filter(|source| {
        !source.path.starts_with(WRITER_CRATE)
            && !source.path.ends_with("/tests.rs")
            && !source.path.contains("/tests/")
    });
    let found: Vec<_> = elsewhere
        .flat_map(|source| {
            disk_writes(&source.text).into_iter().map(|word| format!("{}: {word}", source.path))
        })
        .collect();
    assert!(found.is_empty(), "{WRITER_CRATE} is the place for this:\n{}", found.join("\n"));
}

#[test]
fn writers_are_noticed() {
    for text in [
        "fn f() { std::fs::write(a, b) }",
        "use std::fs; fn f() { fs::rename(a, b) }",
        "fn f() { let file = File::create(path)?; }",
        "fn f() { std::fs::File::options().write(true) }",
        "use std::fs::OpenOptions;",
        "use std::fs::remove_file;",
        "use std::fs::{self, write};",
        "use std::{fs::{File, rename}, io};",
        "use std::fs as disk;",
        "#[cfg(test)]\nmod tests {\n    fn g() {}\n}\nfn f() { std::fs::write(a, b) }",
        "fn f() { tempfile::tempdir() }",
    ] {
        assert!(!disk_writes(text).is_empty(), "{text}");
    }
    for text in [
        "fn f() { std::fs::read(a); File::open(b); stdout().write(c) }",
        "// std::fs::write\nfn f() { \"fs::write\" }",
        "fn f() {}\n#[cfg(test)]\nmod tests {\n    fn g() { std::fs::write(a, b) }\n}\nfn h() {}",
        "use std::fs::{self, File}; fn f() { x.write(a) } struct A { write: u8 }",
    ] {
        assert!(disk_writes(text).is_empty(), "{text}");
    }
}
