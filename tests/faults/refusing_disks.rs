//! Tests of disks that refuse writes, in every way: the old file stays unchanged, and the program says why.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Writers of the command line, with the extensions of their files.
const WRITERS: [(&str, &str); 6] = [
    ("render builtin:sphere:16 --size 64x48", "png"),
    ("render builtin:sphere:16 --size 64x48", "exr"),
    ("light-volume builtin:sphere:32", "nrrd"),
    ("compare builtin:sphere:16 --size 64x48", "png"),
    ("turntable builtin:sphere:16 --size 64x48 --frames 3", "gif"),
    ("turntable builtin:sphere:16 --size 64x48 --frames 3", "png"),
];

/// Exit code of a refused write.
const INPUT_OR_OUTPUT: Option<i32> = Some(6);

/// Longest run of a command, on a busy machine.
const PATIENCE: Duration = Duration::from_mins(1);

fn program(folder: &Path, command: &mut Command, args: &str, output: &Path) -> Output {
    command
        .args(args.split_whitespace())
        .arg("-o")
        .arg(output)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program can be started")
}

fn run(folder: &Path, args: &str, output: &Path) -> Output {
    program(folder, &mut Command::new(env!("CARGO_BIN_EXE_chiaroscuro")), args, output)
}

fn names(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("an entry").path())
        .collect()
}

/// Fails unless the program has ended with an error message about a file, and without a panic.
fn assert_refused(ended: &Output, what: &str, file: &Path) {
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), INPUT_OR_OUTPUT, "{what}: {said}");
    let name = file.file_name().expect("a name").to_string_lossy();
    assert!(said.contains("error: ") && said.contains(&*name), "{what} should name {name}: {said}");
    assert!(!said.contains("panicked"), "{what}: {said}");
}

/// Refuses writes in the middle by a limit on file sizes, like a full or broken disk.
#[cfg(target_os = "linux")]
fn refused_in_the_middle(shares: &[f64]) {
    for (args, ending) in WRITERS {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join(format!("out.{ending}"));
        assert!(run(folder.path(), args, &file).status.success(), "{args}");
        let before = std::fs::read(&file).expect("it was written");
        for share in shares {
            let blocks = (share * (before.len() - 1) as f64) as usize / 1024;
            let limited = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let mut shell = Command::new("bash");
            shell.args(["-c", &limited, env!("CARGO_BIN_EXE_chiaroscuro")]);
            let ended = program(folder.path(), &mut shell, args, &file);
            assert_refused(&ended, &format!("{args} with {blocks} KiB"), &file);
            assert_eq!(std::fs::read(&file).expect("it is there"), before, "{args}");
            assert_eq!(names(folder.path()), std::slice::from_ref(&file), "{args}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn files_that_cannot_be_finished_leave_what_was_there() {
    refused_in_the_middle(&[0.5]);
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "a minute"]
fn files_that_cannot_be_finished_leave_what_was_there_wherever_they_end() {
    refused_in_the_middle(&[0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0]);
}

/// Folders in which no user may write, not even root.
#[cfg(target_os = "linux")]
#[test]
fn folders_that_refuse_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    for (args, ending) in WRITERS {
        for place in ["/sys", "no/such/folder"] {
            let file = Path::new(place).join(format!("out.{ending}"));
            let ended = run(folder.path(), args, &file);
            assert_refused(&ended, &format!("{args} into {place}"), &file);
        }
        assert_eq!(names(folder.path()), Vec::<PathBuf>::new(), "{args}");
    }
}

/// A folder that is removed while a file is written into it.
#[cfg(unix)]
#[test]
fn folders_that_go_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    std::fs::create_dir(&inside).expect("a folder");
    let mut child = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
        .args("turntable builtin:sphere:16 --size 64x48 --frames 60 -o inside/turn.gif".split_whitespace())
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program can be started");
    let begin = Instant::now();
    while names(&inside).is_empty() {
        assert!(begin.elapsed() < PATIENCE && child.try_wait().expect("it can be asked").is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    std::fs::remove_dir_all(&inside).expect("it can be removed");
    let ended = child.wait_with_output().expect("it ends");
    assert_refused(&ended, "a turn", Path::new("turn.gif"));
    assert_eq!(names(folder.path()), Vec::<PathBuf>::new());
}

/// A link to a file on another disk: the file is replaced there, and the link stays.
#[cfg(target_os = "linux")]
#[test]
fn links_to_other_disks_are_followed() {
    use std::os::unix::fs::MetadataExt as _;
    let folder = tempfile::tempdir().expect("a folder");
    let Ok(elsewhere) = tempfile::tempdir_in("/dev/shm") else {
        panic!("this needs a second place for files, /dev/shm");
    };
    let disk = |path: &Path| std::fs::metadata(path).expect("it is there").dev();
    assert_ne!(disk(folder.path()), disk(elsewhere.path()), "two disks are needed");
    for (args, ending) in WRITERS {
        let (link, file) = (folder.path().join("link").with_extension(ending), elsewhere.path().join("file"));
        std::fs::write(&file, "").expect("room");
        std::os::unix::fs::symlink(&file, &link).expect("links can be made");
        let ended = run(folder.path(), args, &link);
        assert!(ended.status.success(), "{args}: {}", String::from_utf8_lossy(&ended.stderr));
        assert!(std::fs::symlink_metadata(&link).expect("it is there").is_symlink());
        assert!(!std::fs::read(&file).expect("it was written").is_empty());
        assert_eq!((names(folder.path()).len(), names(elsewhere.path()).len()), (1, 1), "{args}");
        for path in [link, file] {
            std::fs::remove_file(path).expect("it can be removed");
        }
    }
}
