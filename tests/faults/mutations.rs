//! Mutation tests: every reader on valid files with a few bytes changed, removed or inserted. It accepts or refuses
//! them, but does not panic, hang or allocate without limit.

use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::random::Random;
use crate::samples::{SampleFile, samples};

/// Longest time for a tiny file, on a busy machine.
const READ_TIMEOUT: Duration = Duration::from_secs(10);

/// Texts that have special meanings in some reader.
const SPECIAL_TEXTS: [&[u8]; 10] = [
    b"-1",
    b"0",
    b"nan",
    b"1e999",
    b"4294967296",
    b"18446744073709551616",
    b"\0",
    b"\xff\xff\xff\xff",
    b"[[[[[[[[",
    b"../../../etc/passwd",
];

/// Copy of a file with up to eight random changes.
fn mutate(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(changed.len());
        match random.below(6) {
            0 if !changed.is_empty() => changed[at] ^= 1 << random.below(8),
            1 if !changed.is_empty() => changed[at] = random.byte(),
            2 => changed.truncate(at),
            3 => {
                let until = (at + random.below(64)).min(changed.len());
                drop(changed.drain(at..until));
            }
            4 => {
                let from = random.below(changed.len());
                let piece = changed[from..(from + random.below(64)).min(changed.len())].to_vec();
                drop(changed.splice(at..at, piece));
            }
            _ => {
                drop(
                    changed.splice(at..at, SPECIAL_TEXTS[random.below(SPECIAL_TEXTS.len())].iter().copied()),
                );
            }
        }
    }
    changed
}

/// Reads a file, which must neither panic nor take long; returns whether it was accepted, and the duration.
fn try_read(path: &Path, read: fn(&Path) -> bool, what: &str) -> (bool, Duration) {
    let begin = Instant::now();
    let result = catch_unwind(|| read(path));
    let took = begin.elapsed();
    assert!(took < READ_TIMEOUT, "{what} takes {took:?}");
    (result.unwrap_or_else(|_| panic!("{what} panics")), took)
}

/// Tries a number of mutations of each kind of file.
fn test_mutations(of_each: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    for SampleFile { name, bytes, read } in samples(folder.path()) {
        let (mut accepted, mut slowest) = (0, Duration::ZERO);
        for seed in 0..of_each {
            let path = folder.path().join(&name);
            std::fs::write(&path, mutate(&bytes, &mut Random::new(seed))).expect("room");
            let (is_accepted, took) = try_read(&path, read, &format!("{name} with seed {seed}"));
            accepted += u64::from(is_accepted);
            slowest = slowest.max(took);
        }
        println!("{name}: seeds 0 … {}, {accepted} accepted, slowest {slowest:?}", of_each - 1);
        assert!(accepted < of_each, "{name}: nothing is ever refused");
    }
}

#[test]
fn damaged_files_are_refused_or_read() {
    test_mutations(200);
}

#[test]
#[ignore = "a thousand of each kind: minutes"]
fn a_thousand_damaged_files_of_each_kind() {
    test_mutations(1000);
}

/// `found/READER/` contains inputs found by `script/fuzz` and, for each reader, an input that got far into it.
#[test]
fn fuzz_findings_are_fixed() {
    let found = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults/found");
    let folder = tempfile::tempdir().expect("a folder");
    for SampleFile { name, read, .. } in samples(folder.path()) {
        let inputs = std::fs::read_dir(found.join(&name)).unwrap_or_else(|why| panic!("{name}: {why}"));
        let path = folder.path().join(&name);
        let mut count = 0;
        for input in inputs {
            let input = input.expect("it is there").path();
            std::fs::copy(&input, &path).expect("room");
            try_read(&path, read, &input.display().to_string());
            count += 1;
        }
        assert!(count > 0, "{name}: nothing is kept");
    }
}
