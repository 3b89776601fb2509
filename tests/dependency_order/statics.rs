//! Check that state of the whole process stays where nothing else can hold it: all other state belongs to a value, so
//! that two windows, or two tests, do not share it.

use std::collections::BTreeSet;

use crate::sources::all_sources;
use crate::tokens::tokens;

/// Statics of the sources: file, name, and the reason why it is none of a value's fields.
const ALLOWED: [(&str, &str, &str); 15] = [
    (
        "crates/files/src/fault/hooks.rs",
        "FAULTS",
        "an option of the process, which everything that can fail asks about",
    ),
    (
        "crates/files/src/temporary_file.rs",
        "TEMPORARY_FILES",
        "removed by panic hook and handler of termination",
    ),
    ("crates/media/src/marks/layer.rs", "FONT", "constant"),
    ("crates/media/src/marks/layer.rs", "TYPEFACE", "constant, parsed once"),
    ("crates/render/src/pipelines/library_pool.rs", "BORROWED", "for tests that run in one process"),
    ("crates/render/src/pipelines/library_pool.rs", "POOL", "for tests that run in one process"),
    ("crates/render/src/pipelines/preprocessor.rs", "OPTIONS", "constant, read from the shaders once"),
    ("crates/render/src/pipelines/preprocessor.rs", "OVERRIDES", "constant, read from the shaders once"),
    ("crates/scene/src/transfer/label_colors.rs", "COLORS", "constant, computed once"),
    ("crates/volume-io/src/reading/chunk_codecs/checksum.rs", "TABLES", "constant, computed by the compiler"),
    (
        "crates/volume/src/cancellation.rs",
        "CURRENT_TOKEN",
        "loops over voxels, below accessors that take no token",
    ),
    (
        "src/app/persistence/autosave.rs",
        "EMERGENCY_SAVES",
        "written by panic hook and handler of termination",
    ),
    ("python/src/interruptible.rs", "FIRST_PROCESS", "a fork copies all values, and cannot be told by them"),
    ("src/cli/process/closed_output.rs", "IS_CLOSED", "set before main, where nothing else exists"),
    ("src/main.rs", "CHECK_OUTPUT", "constant, in a section that the loader reads"),
];

/// Names of the statics that a source text declares, those of `thread_local!` included.
fn statics(source: &str) -> Vec<String> {
    let words = tokens(source);
    let at = |index: usize| words.get(index).map_or("", String::as_str);
    let declared = |index: usize| {
        let name = index + 1 + usize::from(at(index + 1) == "mut");
        // A lifetime is followed by no name with a type.
        (at(index) == "static" && at(name + 1) == ":").then(|| at(name).to_owned())
    };
    (0..words.len()).filter_map(declared).collect()
}

#[test]
fn state_of_the_process_has_a_reason() {
    let found: BTreeSet<_> = all_sources()
        .iter()
        .flat_map(|file| statics(&file.text).into_iter().map(|name| (file.path.clone(), name)))
        .collect();
    let allowed: BTreeSet<_> =
        ALLOWED.iter().map(|(path, name, _)| ((*path).to_owned(), (*name).to_owned())).collect();
    let new: Vec<_> = found.difference(&allowed).collect();
    assert!(new.is_empty(), "make these statics fields of a value, or give a reason in this test: {new:?}");
    let gone: Vec<_> = allowed.difference(&found).collect();
    assert!(gone.is_empty(), "these statics are allowed and do not exist: {gone:?}");
    assert!(ALLOWED.iter().all(|(_, _, reason)| !reason.is_empty()));
}

#[test]
fn statics_are_noticed() {
    let source = "static A: u8 = 1; pub(crate) static mut B: u8 = 2; fn f() { static C: Mutex<()> = Mutex::new(()); } \
                  thread_local! { static D: Cell<u8> = const { Cell::new(0) }; }";
    assert_eq!(statics(source), ["A", "B", "C", "D"]);
    let source =
        "fn f<T: 'static>(a: &'static str) -> Box<dyn Fn() + 'static> { \"static E: u8\"; } // static F: u8";
    assert!(statics(source).is_empty());
}
