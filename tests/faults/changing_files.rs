//! Tests of volumes that another process truncates, overwrites, replaces or removes while they are read.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::Path;
use std::time::Instant;

use chiaroscuro_volume::{LoadControl, LoadErrorKind};
use chiaroscuro_volume_io::{LoadOptions, open};

use crate::random::Random;

/// Edge in voxels; 32 MiB, long enough to be changed during the read.
const EDGE_VOXELS: usize = 256;

/// Voxel data of a constant volume.
fn voxel_data(value: u8) -> Vec<u8> {
    vec![value; EDGE_VOXELS * EDGE_VOXELS * EDGE_VOXELS * 2]
}

/// Change of a file during the read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum FileChange {
    Truncated,
    Overwritten,
    Replaced,
    Removed,
}

const CHANGES: [FileChange; 4] =
    [FileChange::Truncated, FileChange::Overwritten, FileChange::Replaced, FileChange::Removed];

impl FileChange {
    fn apply(self, path: &Path, random: &mut Random, other: &[u8]) {
        match self {
            Self::Truncated => {
                let file = OpenOptions::new().write(true).open(path).expect("it is there");
                file.set_len(random.below(other.len()) as u64).expect("it can be cut");
            }
            Self::Overwritten => {
                let mut file = OpenOptions::new().write(true).open(path).expect("it is there");
                // From the end, so that a reader must encounter it.
                file.seek(SeekFrom::Start(other.len() as u64 / 2)).expect("it is long");
                file.write_all(&other[other.len() / 2..]).expect("room");
            }
            Self::Replaced => {
                let new = path.with_extension("new");
                fs::write(&new, other).expect("room");
                fs::rename(&new, path).expect("it can be replaced");
            }
            Self::Removed => fs::remove_file(path).expect("it is there"),
        }
    }
}

/// Changes files a number of times, each at a random time of the read.
fn change_files_while_reading(count: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let name = format!("v_{EDGE_VOXELS}x{EDGE_VOXELS}x{EDGE_VOXELS}_uint16");
    let paths = [folder.path().join(format!("{name}.raw")), folder.path().join("apart.nhdr")];
    let header = format!(
        "NRRD0004\ntype: uint16\ndimension: 3\nsizes: {EDGE_VOXELS} {EDGE_VOXELS} {EDGE_VOXELS}\nencoding: raw\nendian: little\ndata file: {name}.raw\n\n"
    );
    fs::write(&paths[1], header).expect("room");
    let contents = [voxel_data(3), voxel_data(200)];
    let load = |path: &Path| open(path, &LoadOptions::default(), &LoadControl::new());
    fs::write(&paths[0], &contents[0]).expect("room");
    let begin = Instant::now();
    let old = load(&paths[0]).expect("it is valid").content_id();
    let usual = begin.elapsed();
    fs::write(&paths[0], &contents[1]).expect("room");
    let new = load(&paths[0]).expect("it is valid").content_id();
    let mut random = Random::new(count as u64);
    let mut refused = 0;
    for at in 0..count {
        let (path, change) = (&paths[at % 2], CHANGES[at / 2 % CHANGES.len()]);
        let mut file = File::create(&paths[0]).expect("room");
        file.write_all(&contents[0]).expect("room");
        drop(file);
        let after = usual.mul_f64(random.below(1000) as f64 / 1000.0);
        let result = std::thread::scope(|threads| {
            let loader = threads.spawn(|| load(path));
            std::thread::sleep(after);
            change.apply(&paths[0], &mut random, &contents[1]);
            loader.join().expect("no panic")
        });
        match result {
            // Either all of the old data or all of the new.
            Ok(volume) => {
                let id = volume.content_id();
                assert!(id == old || (id == new && change == FileChange::Replaced), "{change:?} mixes");
            }
            Err(err) => {
                refused += 1;
                let expected = [LoadErrorKind::Io, LoadErrorKind::BadInput];
                assert!(expected.contains(&err.kind()), "{change:?}: {err}");
            }
        }
    }
    println!("{count} files changed while they were read, {refused} refused, none mixed");
    assert!(refused > 0);
}

#[test]
fn files_that_change_are_refused_or_read_as_they_were() {
    change_files_while_reading(16);
}

#[test]
#[ignore = "a minute"]
fn files_that_change_at_any_time_are_refused_or_read_as_they_were() {
    change_files_while_reading(160);
}
