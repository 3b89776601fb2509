//! Crash tests: processes are killed while they write a window's files.
//!
//! Nothing that was reported as written may be lost.

use std::cell::Cell;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{gain_of, look, remember};
use crate::app::document::session::SessionFile;
use chiaroscuro_scene::{LookRecord, VolumeRecord};
use chiaroscuro_volume::VolumeChoice;

/// Environment variable with the folder of the process to be killed, which is this test itself.
const KILLED_FOLDER_VARIABLE: &str = "CHIAROSCURO_TEST_KILLED_IN";

/// Writes a window's files again and again: its look, recent files, a session and a preset. Prints a number to
/// standard output when all files that hold it are written.
fn write_until_killed(folder: &Path) -> ! {
    let mut memory = remember(folder);
    let mut session = None;
    let volume = Path::new("builtin:chair");
    let words = memory.emergency_save().unwrap();
    for gain in 2.. {
        let settings = look(f64::from(gain) / 1000.0);
        memory.add_recent(Path::new(&format!("/{gain}.nrrd")), &VolumeChoice::default());
        memory.autosave(&settings, super::volume(volume, 7));
        words.write();
        for name in ["session.json", "preset.json"] {
            let volume = VolumeRecord::new(volume, 7, Some(folder));
            SessionFile::save(&mut session, &folder.join(name), &settings, Some(&volume)).unwrap();
        }
        // Unlike `println`, this is not captured by the test.
        writeln!(std::io::stdout(), "kept {gain}").unwrap();
    }
    unreachable!("it is killed before it runs out of numbers")
}

/// Starts a writer and kills it after a while; returns the last number that it printed.
fn kill_writer(folder: &Path, after: Duration) -> u32 {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "--nocapture"])
        .arg(concat!(module_path!(), "::killed_windows_lose_nothing").split_once("::").unwrap().1)
        .env(KILLED_FOLDER_VARIABLE, folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(child.stdout.take().unwrap());
    let (mut line, mut last) = (String::new(), 0);
    let number = |line: &str| line.trim().strip_prefix("kept ").and_then(|number| number.parse().ok());
    while last == 0 {
        line.clear();
        assert!(said.read_line(&mut line).unwrap() > 0, "it has ended before anything was kept");
        last = number(&line).unwrap_or(0);
    }
    let begin = Instant::now();
    std::thread::sleep(after.saturating_sub(begin.elapsed()));
    child.kill().unwrap();
    child.wait().unwrap();
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    // The last line may be cut.
    let whole = rest.rsplit_once('\n').map_or("", |(whole, _)| whole);
    whole.lines().filter_map(number).next_back().unwrap_or(last)
}

/// Kills a writer `count` times, and checks its files each time. Returns the number of saved looks that were intact.
fn kill_repeatedly(count: u32) -> u32 {
    let folder = tempfile::tempdir().unwrap();
    let intact = Cell::new(0);
    for at in 0..count {
        // At varying times within the milliseconds that one round takes.
        let kept =
            f64::from(kill_writer(folder.path(), Duration::from_micros(u64::from(at) * 7919 % 20_000)));
        let is_kept = |path: &Path| {
            let found = gain_of(path) * 1000.0;
            // The write in progress may have been completed.
            assert!((-0.5..1.5).contains(&(found - kept)), "{}: {found} not {kept}", path.display());
            intact.set(intact.get() + 1);
        };
        is_kept(&folder.path().join("session.json"));
        is_kept(&folder.path().join("preset.json"));
        // A backup exists from the second save on.
        let backups: &[_] = if at > 0 || kept > 2.0 { &["session.json.bak", "preset.json.bak"] } else { &[] };
        for backup in backups {
            let text = fs::read_to_string(folder.path().join(backup)).unwrap();
            assert!(LookRecord::parse(&text).unwrap().schema().is_some());
        }
        let mut memory = remember(folder.path());
        assert_eq!(memory.take_notices(), Vec::<String>::new(), "nothing is damaged");
        let run = memory.earlier_runs().first().expect("it is offered");
        assert!(run.crashed);
        is_kept(&run.look);
        let opened = std::path::PathBuf::from(format!("/{kept}.nrrd"));
        assert!(
            memory.recent().iter().any(|file| file.path == opened),
            "{} is not in {:?}",
            opened.display(),
            memory.recent()
        );
        memory.acknowledge_crashes();
        drop(memory);
        chiaroscuro_files::remove_abandoned_temporary_files(folder.path());
        let names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        let left = names.iter().filter(|name| name.to_string_lossy().contains(".part")).count();
        assert_eq!(left, 0, "{names:?}");
    }
    println!("a window's files: {count} kills, 0 broken or lost");
    intact.get()
}

#[test]
fn killed_windows_lose_nothing() {
    match std::env::var_os(KILLED_FOLDER_VARIABLE) {
        Some(folder) => write_until_killed(Path::new(&folder)),
        // The session, the preset and the look of the run.
        None => assert_eq!(kill_repeatedly(8), 3 * 8),
    }
}

#[test]
#[ignore = "five hundred kills: minutes"]
fn windows_that_are_killed_again_and_again_lose_nothing() {
    assert_eq!(kill_repeatedly(500), 3 * 500);
}
