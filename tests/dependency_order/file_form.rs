//! Check of file headings and sizes: files state their subject and stay short, folders have few entries, and modules
//! with submodules have one form.

use std::collections::{BTreeMap, BTreeSet};

use crate::sources::{SourceFile, file_paths, source_files};

/// Largest number of lines of a file; a longer file has two subjects.
const LONGEST_FILE: usize = 400;

/// Largest number of files and folders in a folder.
const LARGEST_FOLDER: usize = 15;

/// Folders without a size limit: snapshots, files on which readers have failed, and reference files written by other
/// programs.
const UNLIMITED_FOLDERS: [&str; 4] = ["snapshots", "found", "written", "phantom"];

/// Violations of a file: a missing heading, which states its subject, or too many lines.
fn file_violations(file: &SourceFile, heading: &str) -> Vec<String> {
    let SourceFile { path, text } = file;
    let mut found = Vec::new();
    if !text.starts_with(heading) {
        found.push(format!("{path} does not begin with {heading} and what it is"));
    }
    let lines = text.lines().count();
    if lines > LONGEST_FILE {
        found.push(format!("{path} has {lines} lines, {LONGEST_FILE} are allowed"));
    }
    found
}

/// Folders with more than [`LARGEST_FOLDER`] entries, except [`UNLIMITED_FOLDERS`].
fn crowded_folders(paths: &[String]) -> Vec<String> {
    let mut folders: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for path in paths {
        for (at, _) in path.match_indices('/') {
            let entry = path[at + 1..].split('/').next().unwrap_or_default();
            folders.entry(&path[..at]).or_default().insert(entry);
        }
    }
    let is_full = |(folder, entries): &(&str, BTreeSet<&str>)| {
        entries.len() > LARGEST_FOLDER
            && !folder.rsplit('/').next().is_some_and(|name| UNLIMITED_FOLDERS.contains(&name))
    };
    let folders = folders.into_iter().filter(is_full);
    folders.map(|(folder, entries)| format!("{folder} has {} entries", entries.len())).collect()
}

/// Files `x.rs` beside a folder `x`; here such modules are `x/mod.rs`.
fn modules_beside_folders(paths: &[String]) -> Vec<String> {
    let is_folder = |stem: &str| paths.iter().any(|path| path.starts_with(&format!("{stem}/")));
    let files = paths.iter().filter(|path| path.strip_suffix(".rs").is_some_and(is_folder));
    files.map(|path| format!("{path} lies beside its folder, not in it as mod.rs")).collect()
}

/// Paths below these folders, each with the folder's name.
fn all_paths(folders: &[&str]) -> Vec<String> {
    let below = |folder: &&str| {
        file_paths(folder).into_iter().map(|path| format!("{folder}/{path}")).collect::<Vec<_>>()
    };
    folders.iter().flat_map(below).collect()
}

#[test]
fn files_say_what_they_are_and_stay_short() {
    let mut found = Vec::new();
    for (folder, ending, heading, least) in [
        ("src", "rs", "//!", 50),
        ("crates", "rs", "//!", 500),
        ("tests", "rs", "//!", 20),
        ("examples", "rs", "//!", 3),
        ("shaders", "wgsl", "// ", 20),
    ] {
        let files = source_files(folder, ending);
        assert!(files.len() > least, "the check must see the files of {folder}");
        found.extend(
            files
                .iter()
                .flat_map(|file| file_violations(file, heading))
                .map(|flaw| format!("{folder}/{flaw}")),
        );
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn folders_are_small_and_modules_have_one_form() {
    let paths = all_paths(&["src", "crates", "shaders", "tests"]);
    let found = [crowded_folders(&paths), modules_beside_folders(&paths)].concat();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn files_without_a_heading_or_too_long_are_reported() {
    let flaws_of = |text: &str| {
        file_violations(&SourceFile { path: "math/a.rs".to_owned(), text: text.to_owned() }, "//!").len()
    };
    assert_eq!(flaws_of("use glam::DVec3;\n"), 1);
    let lines = |count: usize| format!("//! A file.\n{}", "\n".repeat(count - 1));
    assert_eq!(flaws_of(&lines(LONGEST_FILE)), 0);
    assert_eq!(flaws_of(&lines(LONGEST_FILE + 1)), 1);
    assert_eq!(flaws_of(&"\n".repeat(LONGEST_FILE + 1)), 2);
}

#[test]
fn crowded_folders_are_reported() {
    let files =
        |folder: &str, count: usize| (0..count).map(|i| format!("{folder}/{i}.rs")).collect::<Vec<_>>();
    assert_eq!(crowded_folders(&files("src/gpu", LARGEST_FOLDER)), Vec::<String>::new());
    assert_eq!(crowded_folders(&files("src/gpu", LARGEST_FOLDER + 1)), ["src/gpu has 16 entries"]);
    // A folder is one entry, however many files it contains.
    let nested = [files("src/gpu", LARGEST_FOLDER - 1), files("src/gpu/eye", 5)].concat();
    assert_eq!(crowded_folders(&nested), Vec::<String>::new());
    let nested = [files("src/gpu", LARGEST_FOLDER), files("src/gpu/eye", 5)].concat();
    assert_eq!(crowded_folders(&nested), ["src/gpu has 16 entries"]);
    assert_eq!(crowded_folders(&files("tests/app/snapshots", 40)), Vec::<String>::new());
    assert_eq!(crowded_folders(&files("tests/snapshots/app", 40)).len(), 1);
}

#[test]
fn modules_beside_their_folder_are_reported() {
    let paths = |list: &[&str]| list.iter().map(|&path| path.to_owned()).collect::<Vec<_>>();
    assert_eq!(
        modules_beside_folders(&paths(&["src/a.rs", "src/b/mod.rs", "src/ab/c.rs"])),
        Vec::<String>::new()
    );
    assert_eq!(modules_beside_folders(&paths(&["src/a.rs", "src/a/b.rs"])).len(), 1);
    assert_eq!(modules_beside_folders(&paths(&["src/a/b.rs", "src/a/b/mod.rs"])).len(), 1);
}
