//! Tests of hostile files, read by the program itself: it refuses them or shows their data, quickly, and opens no
//! file that they must not reach.

mod files;
mod runner;
mod volumes;

use self::files::{Hostile, all};
use self::runner::{Trace, watch};

/// Name of the folder that no file may make the program open.
const FORBIDDEN: &str = "forbidden-7f3a";

/// Runs every n-th file.
fn run(every: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    let forbidden = folder.path().join(FORBIDDEN);
    for folder in [&inside, &forbidden] {
        std::fs::create_dir(folder).expect("a folder");
    }
    std::fs::write(forbidden.join("voxels.raw"), [0; 512]).expect("room");
    let files = all(&inside, &forbidden);
    let trace = Trace::find();
    let mut counts = [0; 2];
    for Hostile { name, args } in files.iter().step_by(every) {
        let ended = watch(&inside, args, trace);
        assert!(matches!(ended.code, Some(0..=6)), "{name}: {args:?}: {ended:?}");
        assert!(!ended.said.contains("panicked"), "{name}: {ended:?}");
        assert!(ended.said.len() < 20_000, "{name} is answered with {} bytes", ended.said.len());
        for line in &ended.opened {
            // Reading a link that leads there is allowed.
            assert!(!line.contains(FORBIDDEN) || line.contains("readlink("), "{name}: {line}");
            // Local sockets, such as those of the window system, are no network.
            assert!(!line.contains("connect(") || line.contains("AF_UNIX"), "{name}: {line}");
        }
        counts[usize::from(ended.code == Some(0))] += 1;
    }
    let [refused, shown] = counts;
    println!("hostile files: {refused} refused, {shown} shown, of {}; {trace}", files.len());
    assert!(refused > shown, "most are refused");
}

#[test]
fn hostile_files_do_no_harm() {
    run(9);
}

#[test]
#[ignore = "minutes"]
fn no_hostile_file_does_harm() {
    run(1);
}

/// Guards the tracing itself: where `strace` works, opened files are seen.
#[test]
fn what_is_opened_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    let trace = Trace::find();
    let ended = watch(folder.path(), &["info".into(), format!("{FORBIDDEN}.nrrd").into()], trace);
    assert_eq!(ended.code, Some(6));
    assert_eq!(trace.is_there(), ended.opened.iter().any(|line| line.contains(FORBIDDEN)), "{ended:?}");
}
