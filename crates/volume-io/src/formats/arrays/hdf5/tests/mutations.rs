//! Mutations of valid files: they are read or refused, without a panic, a hang or much memory.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::{LoadOptions, load};
use chiaroscuro_volume::{LoadControl, VolumeChoice};

/// Longest time for a small file, on a busy machine.
const READ_TIMEOUT: Duration = Duration::from_secs(10);

/// Numbers that are likely to be taken for others: none of the bits set, few, or all.
const SPECIAL_BYTES: [u8; 8] = [0, 1, 2, 0x0f, 0x7f, 0x80, 0xfe, 0xff];

/// Generator of random numbers (xorshift).
struct TestRandom(u64);

impl TestRandom {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % limit.max(1)
    }
}

/// Files of HDF5 that other programs wrote.
pub(super) fn written_files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracle/written");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_hdf5 = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("hdf5_") && !name.ends_with(".xml")
    };
    let mut found: Vec<PathBuf> = paths.filter(is_hdf5).collect();
    found.sort();
    found
}

/// Copy of a file with up to six changes of one byte or several; half of the copies are changed near each other, where
/// one block of metadata has them.
fn mutate(bytes: &[u8], random: &mut TestRandom) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    let (near, is_near) = (random.below(changed.len()), random.below(2) == 0);
    for _ in 0..=random.below(6) {
        let at = if is_near {
            (near + random.below(64)) % changed.len().max(1)
        } else {
            random.below(changed.len())
        };
        match random.below(8) {
            0 | 1 if at < changed.len() => changed[at] ^= 1 << random.below(8),
            2 | 3 if at < changed.len() => changed[at] = SPECIAL_BYTES[random.below(SPECIAL_BYTES.len())],
            4 => {
                let special = SPECIAL_BYTES[random.below(SPECIAL_BYTES.len())];
                let end = (at + 1 + random.below(8)).min(changed.len());
                changed[at..end].fill(special);
            }
            5 => {
                // An address or length of another place.
                let from = random.below(changed.len().saturating_sub(8)) & !7;
                let end = (at + 8).min(changed.len());
                let piece = changed[from..from + (end - at)].to_vec();
                changed[at..end].copy_from_slice(&piece);
            }
            6 if random.below(4) == 0 => changed.truncate(at),
            _ if at < changed.len() => changed[at] = random.below(256) as u8,
            _ => {}
        }
    }
    changed
}

fn test_mutations(of_each: u64) {
    let folder = tempfile::tempdir().unwrap();
    let (mut accepted, mut tried, mut slowest) = (0, 0, Duration::ZERO);
    for (number, source) in written_files().into_iter().enumerate() {
        let bytes = std::fs::read(&source).unwrap();
        let path = folder.path().join(source.file_name().unwrap());
        for seed in 0..of_each {
            let mut random = TestRandom(1 + seed + ((number as u64) << 32));
            std::fs::write(&path, mutate(&bytes, &mut random)).unwrap();
            let choice = VolumeChoice::default().with_first_as_fallback();
            let options = LoadOptions { choice, memory_budget_bytes: 64 << 20, ..LoadOptions::default() };
            let begin = Instant::now();
            let read = load(&path, &options, &LoadControl::new());
            let took = begin.elapsed();
            assert!(took < READ_TIMEOUT, "{} with seed {seed} takes {took:?}", path.display());
            if let Err(error) = &read {
                let message = error.to_string();
                assert!(message.contains(';') && message.contains("hdf5_"), "{message}");
            }
            accepted += u64::from(read.is_ok());
            tried += 1;
            slowest = slowest.max(took);
        }
    }
    println!("{tried} mutations, {accepted} accepted, slowest {slowest:?}");
    assert!(accepted < tried, "nothing is ever refused");
}

#[test]
fn damaged_files_are_refused_or_read() {
    test_mutations(300);
}

#[test]
#[ignore = "five thousand of each file: minutes"]
fn thousands_of_damaged_files() {
    test_mutations(5000);
}
