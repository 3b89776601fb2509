//! Tests of writers that are killed while writing: existing files stay whole, and no temporary file remains for good.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use crate::random::Random;

fn start(folder: &Path, args: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
        .args(args.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program can be started")
}

/// Kills a command that writes files repeatedly, each time at another moment; the files always stay complete.
fn kill_repeatedly(args: &str, files: &[&str], kills: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let read = || files.iter().map(|file| std::fs::read(folder.path().join(file))).collect::<Vec<_>>();
    let begin = Instant::now();
    assert!(start(folder.path(), args).wait().expect("it ends").success(), "{args}");
    let usual = begin.elapsed();
    let whole: Vec<_> = read().into_iter().map(|file| file.expect("it was written")).collect();
    let mut random = Random::new(kills as u64);
    let (mut in_the_middle, mut broken) = (0, 0);
    for _ in 0..kills {
        let mut child = start(folder.path(), args);
        std::thread::sleep(usual.mul_f64(random.below(1000) as f64 / 1000.0));
        in_the_middle += usize::from(child.try_wait().expect("it can be asked").is_none());
        child.kill().expect("it can be killed");
        child.wait().expect("it ends");
        broken +=
            read().into_iter().zip(&whole).filter(|(now, whole)| now.as_ref().ok() != Some(whole)).count();
    }
    println!("{args}: {kills} kills, {in_the_middle} in the middle, {broken} files broken or lost");
    assert_eq!(broken, 0);
    assert!(in_the_middle > kills / 4, "{in_the_middle} of {kills} were killed in time");
    assert!(start(folder.path(), args).wait().expect("it ends").success());
    let names = std::fs::read_dir(folder.path()).expect("the folder is there");
    let left: Vec<_> = names.map(|entry| entry.expect("an entry").file_name()).collect();
    assert_eq!(left.len(), files.len(), "{left:?}");
}

/// Kills the writers of the command line. A report is not among them, since it contains times.
fn kill_all_writers(kills: usize) {
    kill_repeatedly("render builtin:sphere:16 --size 64x48 -o p.png", &["p.png"], kills);
    kill_repeatedly("render builtin:sphere:16 --size 64x48 -o p.exr", &["p.exr"], kills);
    kill_repeatedly("light-volume builtin:sphere:16 -o l.nrrd", &["l.nrrd"], kills);
    kill_repeatedly("turntable builtin:sphere:16 --size 64x48 --frames 3 -o t.gif", &["t.gif"], kills);
}

#[test]
fn killed_writers_break_nothing() {
    kill_all_writers(8);
}

#[test]
#[ignore = "two thousand kills: half an hour"]
fn writers_that_are_killed_again_and_again_break_nothing() {
    kill_all_writers(500);
}
