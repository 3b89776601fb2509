//! Every reader on valid files with a few bytes changed, cut or put in: it accepts or refuses, but does not panic, hang
//! or take memory without end.

use std::panic::catch_unwind;
use std::time::{Duration, Instant};

use crate::random::Random;
use crate::samples::{Sample, samples};

/// Longest that a tiny file may take, on a busy machine.
const PROMPT: Duration = Duration::from_secs(10);

/// Texts that have meant something to somebody's reader.
const WORDS: [&[u8]; 10] = [
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

/// A file with up to eight changes.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
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
            _ => drop(changed.splice(at..at, WORDS[random.below(WORDS.len())].iter().copied())),
        }
    }
    changed
}

/// Tries so many mutations of each kind.
fn mutations(of_each: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    for Sample { name, bytes, read } in samples(folder.path()) {
        let (mut accepted, mut slowest) = (0, Duration::ZERO);
        for seed in 0..of_each {
            let path = folder.path().join(&name);
            std::fs::write(&path, mutated(&bytes, &mut Random::new(seed))).expect("room");
            let begin = Instant::now();
            let result = catch_unwind(|| read(&path));
            accepted +=
                u64::from(*result.as_ref().unwrap_or_else(|_| panic!("{name} panics with seed {seed}")));
            slowest = slowest.max(begin.elapsed());
            assert!(slowest < PROMPT, "{name} with seed {seed} takes {slowest:?}");
        }
        println!("{name}: seeds 0 … {}, {accepted} accepted, slowest {slowest:?}", of_each - 1);
        assert!(accepted < of_each, "{name}: nothing is ever refused");
    }
}

#[test]
fn damaged_files_are_refused_or_read() {
    mutations(200);
}

#[test]
#[ignore = "a thousand of each kind: minutes"]
fn a_thousand_damaged_files_of_each_kind() {
    mutations(1000);
}
