//! Odd and broken volume files in every format, generated here: false headers, truncated files, paths that lead out
//! of the folder, decompression bombs, endless nesting.
//!
//! Each is read in this process, which observes panics, time and memory; some of them, and in the long run all, by
//! the program as well, whose file accesses are traced.

mod binary_headers;
mod bombs;
mod external_paths;
mod packed_parts;
mod text_headers;
mod truncations;

use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use chiaroscuro_volume::{LoadControl, LoadError, LoadErrorKind};
use chiaroscuro_volume_io::{LoadOptions, load};

use super::FORBIDDEN_FOLDER;
use super::runner::{FileTrace, run_traced};

/// Longest time for a small file.
const READ_TIMEOUT: Duration = Duration::from_secs(10);

/// Memory that a refused file may need beyond four times its own length, in bytes.
const MAX_EXTRA_BYTES: u64 = 64 << 20;

/// Smallest number of files of this kind.
const MIN_CASES: usize = 400;

/// Test file, to be opened.
struct BrokenVolume {
    /// Description of the fault.
    fault: String,
    path: PathBuf,
    /// True if it leads to another folder, and must not be opened.
    is_forbidden: bool,
}

/// Writer of test files, each in a folder of its own.
struct BrokenVolumeMaker {
    folder: PathBuf,
    cases: Vec<BrokenVolume>,
}

impl BrokenVolumeMaker {
    /// Writes a file, and adds it to the cases.
    fn add(&mut self, what: impl Into<String>, name: &str, bytes: &[u8]) {
        let folder = self.folder.join(format!("{:04}", self.cases.len()));
        std::fs::create_dir(&folder).expect("a folder");
        // Data files of headers and descriptions.
        for (beside, length) in [("described.raw", 24), ("listed.raw", 120)] {
            std::fs::write(folder.join(beside), vec![7; length]).expect("room");
        }
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("room");
        self.cases.push(BrokenVolume { fault: what.into(), path, is_forbidden: false });
    }
}

fn all_broken_volumes(root: &Path) -> Vec<BrokenVolume> {
    let mut made = BrokenVolumeMaker { folder: root.to_owned(), cases: Vec::new() };
    truncations::add_truncations(&mut made);
    text_headers::add_text_headers(&mut made);
    binary_headers::add_binary_headers(&mut made);
    bombs::add_bombs(&mut made);
    packed_parts::add_packed_parts(&mut made);
    external_paths::add_external_paths(&mut made, &root.join(FORBIDDEN_FOLDER));
    made.cases
}

/// Runs a check on all files, beside a folder from which nothing may be opened.
fn check_all(check: impl FnOnce(&[BrokenVolume])) {
    let folder = tempfile::tempdir().expect("a folder");
    let forbidden = folder.path().join(FORBIDDEN_FOLDER);
    std::fs::create_dir(&forbidden).expect("a folder");
    std::fs::write(forbidden.join("voxels.raw"), [0; 512]).expect("room");
    check(&all_broken_volumes(folder.path()));
}

/// Meter of this process's peak memory since the last reset, if the system reports it and no other test runs in this
/// process.
struct PeakMemory(bool);

impl PeakMemory {
    fn detect() -> Self {
        // The runner that gives each test a process of its own sets this.
        let is_alone = std::env::var_os("NEXTEST").is_some();
        Self(is_alone && Self::reset() && Self::read_every_nth().is_some())
    }

    /// Resets the peak to the current memory.
    fn reset() -> bool {
        std::fs::write("/proc/self/clear_refs", "5").is_ok()
    }

    fn read_every_nth() -> Option<u64> {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
        line.trim().strip_suffix(" kB")?.parse::<u64>().ok().map(|kib| kib << 10)
    }

    /// Runs a function and measures its peak memory in bytes, 0 if it cannot be measured.
    fn measure<T>(&self, what: impl FnOnce() -> T) -> (T, u64) {
        if !self.0 {
            return (what(), 0);
        }
        Self::reset();
        let before = Self::read_every_nth().unwrap_or(0);
        let done = what();
        (done, Self::read_every_nth().unwrap_or(0).saturating_sub(before))
    }
}

/// Deficiency of an error message, if it has one.
fn message_deficiency(error: &LoadError, path: &Path) -> Option<String> {
    let explanation = match error {
        LoadError::BadInput(explanation)
        | LoadError::Limit(explanation)
        | LoadError::Io { explanation, .. }
        | LoadError::Several { explanation, .. } => explanation,
        LoadError::Cancelled => return Some("nobody has cancelled it".to_owned()),
    };
    let said = error.to_string();
    let folder = path.parent().unwrap_or(Path::new("")).to_string_lossy().into_owned();
    // Names the file itself, or one beside it.
    let is_named = explanation.place.contains(&folder);
    let is_missing = said.contains("no such file");
    if !is_named || explanation.help.is_empty() {
        Some(format!("it does not say where, or what helps: {said}"))
    } else if error.kind() == LoadErrorKind::Io && !is_missing {
        Some(format!("it blames the disk: {said}"))
    } else if said.len() > 4096 || said.chars().any(char::is_control) {
        Some(format!("it is long, or has signs that terminals obey: {said:?}"))
    } else {
        None
    }
}

/// Reads a file; returns all faults of the answer, and whether the file was refused.
fn read_and_check(case: &BrokenVolume, peak: &PeakMemory) -> (Vec<String>, bool) {
    let bytes = std::fs::metadata(&case.path).map_or(0, |data| data.len());
    let begin = Instant::now();
    let read = || catch_unwind(|| load(&case.path, &LoadOptions::default(), &LoadControl::new()));
    let (done, memory) = peak.measure(read);
    let took = begin.elapsed();
    let mut wrong = Vec::new();
    if took > READ_TIMEOUT {
        wrong.push(format!("it takes {took:?}"));
    }
    let mut is_refused = true;
    match done {
        Err(_) => wrong.push("panics".to_owned()),
        Ok(Ok(_)) => {
            is_refused = false;
            wrong.extend(case.is_forbidden.then(|| "it is opened".to_owned()));
        }
        Ok(Err(error)) => {
            wrong.extend(message_deficiency(&error, &case.path));
            if memory > 4 * bytes + MAX_EXTRA_BYTES {
                wrong.push(format!("{} MiB are taken before {error}", memory >> 20));
            }
        }
    }
    let name = case.path.file_name().unwrap_or_default().to_string_lossy();
    (wrong.into_iter().map(|flaw| format!("{name}, {}: {flaw}", case.fault)).collect(), is_refused)
}

/// Reads every n-th file in this process.
fn read(every: usize) {
    check_all(|cases| {
        let peak = PeakMemory::detect();
        let (mut wrong, mut refused, mut tried) = (Vec::new(), 0, 0);
        for case in cases.iter().step_by(every) {
            let (flaws, is_refused) = read_and_check(case, &peak);
            wrong.extend(flaws);
            refused += usize::from(is_refused);
            tried += 1;
        }
        let memory = if peak.0 { "their memory was measured" } else { "their memory was NOT measured" };
        println!("odd volumes: {refused} refused of {tried}, of {}; {memory}", cases.len());
        assert!(wrong.is_empty(), "{} flaws:\n{}", wrong.len(), wrong.join("\n"));
        assert!(tried >= MIN_CASES, "{tried} files");
        assert!(refused > tried / 2, "most are refused");
    });
}

#[test]
fn odd_and_broken_volumes_are_refused_or_read() {
    read(5);
}

#[test]
#[ignore = "half a minute"]
fn all_odd_and_broken_volumes_are_refused_or_read() {
    read(1);
}

/// Lets the program read every n-th file.
fn run_every_nth(every: usize) {
    check_all(|cases| {
        let trace = FileTrace::detect();
        for case in cases.iter().step_by(every) {
            let BrokenVolume { fault: what, path, .. } = case;
            let ended = run_traced(path.parent().expect("a folder"), &["info".into(), path.into()], trace);
            // Code 6 is allowed for a missing file that a header names.
            let is_missing = ended.output.contains("no such file");
            let is_right = matches!(ended.code, Some(0 | 3 | 5)) || ended.code == Some(6) && is_missing;
            assert!(is_right, "{what}: {}: {ended:?}", path.display());
            for line in &ended.opened_paths {
                assert!(!line.contains(FORBIDDEN_FOLDER) || line.contains("readlink("), "{what}: {line}");
                assert!(!line.contains("connect(") || line.contains("AF_UNIX"), "{what}: {line}");
            }
        }
        println!("odd volumes: {} read by the program; {trace}", cases.len().div_ceil(every));
    });
}

#[test]
fn odd_volumes_lead_the_program_nowhere() {
    // A prime, so that all formats and faults take part.
    run_every_nth(61);
}

#[test]
#[ignore = "minutes"]
fn no_odd_volume_leads_the_program_anywhere() {
    run_every_nth(1);
}
