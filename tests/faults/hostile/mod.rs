//! Tests of hostile files, read by the program itself: it refuses them or shows their data, quickly, and opens no
//! file that they must not reach.

mod files;
mod runner;
mod volumes;

use self::files::{HostileFile, all_hostile_files};
use self::runner::{FileTrace, run_traced};

/// Name of the folder that no file may make the program open.
const FORBIDDEN_FOLDER: &str = "forbidden-7f3a";

/// Runs every n-th file.
fn run_hostile_files(every: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    let forbidden = folder.path().join(FORBIDDEN_FOLDER);
    for folder in [&inside, &forbidden] {
        std::fs::create_dir(folder).expect("a folder");
    }
    std::fs::write(forbidden.join("voxels.raw"), [0; 512]).expect("room");
    let files = all_hostile_files(&inside, &forbidden);
    let trace = FileTrace::detect();
    let mut counts = [0; 2];
    for HostileFile { name, args } in files.iter().step_by(every) {
        let ended = run_traced(&inside, args, trace);
        assert!(matches!(ended.code, Some(0..=6)), "{name}: {args:?}: {ended:?}");
        assert!(!ended.output.contains("panicked"), "{name}: {ended:?}");
        assert!(ended.output.len() < 20_000, "{name} is answered with {} bytes", ended.output.len());
        for line in &ended.opened_paths {
            // Reading a link that leads there is allowed.
            assert!(!line.contains(FORBIDDEN_FOLDER) || line.contains("readlink("), "{name}: {line}");
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
    run_hostile_files(9);
}

#[test]
#[ignore = "minutes"]
fn no_hostile_file_does_harm() {
    run_hostile_files(1);
}

/// Guards the tracing itself: where `strace` works, opened files are seen.
#[test]
fn opened_files_are_traced() {
    let folder = tempfile::tempdir().expect("a folder");
    let trace = FileTrace::detect();
    let ended = run_traced(folder.path(), &["info".into(), format!("{FORBIDDEN_FOLDER}.nrrd").into()], trace);
    assert_eq!(ended.code, Some(6));
    assert_eq!(
        trace.is_available(),
        ended.opened_paths.iter().any(|line| line.contains(FORBIDDEN_FOLDER)),
        "{ended:?}"
    );
}
