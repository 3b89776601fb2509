//! Runner of the program that traces which files it opens, with `strace` where available.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest run over a small file, on a busy machine and while it is traced.
const RUN_TIMEOUT: Duration = Duration::from_secs(30);

/// True if opened files can be traced.
#[derive(Debug, Clone, Copy)]
pub(super) struct FileTrace(bool);

impl FileTrace {
    /// Detects a working `strace`.
    pub(super) fn detect() -> Self {
        let tried = Command::new("strace").args(["-e", "trace=file", "true"]).stderr(Stdio::null()).status();
        Self(tried.is_ok_and(|status| status.success()))
    }

    pub(super) fn is_available(self) -> bool {
        self.0
    }
}

impl std::fmt::Display for FileTrace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.0 {
            "what they opened was watched with strace"
        } else {
            "what they opened was NOT watched: there is no strace here that may watch"
        })
    }
}

/// Outcome of a run: exit code, output and traced calls.
#[derive(Debug)]
pub(super) struct TracedRun {
    pub(super) code: Option<i32>,
    /// Standard output and standard error together.
    pub(super) output: String,
    /// System calls that name files or network addresses, one per line.
    pub(super) opened_paths: Vec<String>,
}

/// Runs the program in a folder, and fails if it takes too long.
pub(super) fn run_traced(folder: &Path, args: &[OsString], trace: FileTrace) -> TracedRun {
    let temporary = || tempfile::NamedTempFile::new().expect("a temporary file");
    let (said, calls) = (temporary(), temporary());
    let handle = || said.reopen().expect("a second handle");
    let program = env!("CARGO_BIN_EXE_chiaroscuro");
    let mut command = if trace.is_available() {
        let mut strace = Command::new("strace");
        strace.args(["-f", "-qq", "-s", "4096", "-e", "trace=file,connect,bind,sendto", "-o"]);
        strace.arg(calls.path()).arg(program);
        strace
    } else {
        Command::new(program)
    };
    let begin = Instant::now();
    let mut child = command
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(handle())
        .stderr(handle())
        .spawn()
        .expect("the program can be started");
    let code = loop {
        if let Some(status) = child.try_wait().expect("it can be asked") {
            break status.code();
        }
        if begin.elapsed() > RUN_TIMEOUT {
            child.kill().expect("it can be ended");
            panic!("{args:?} takes longer than {RUN_TIMEOUT:?}");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let text = |path: &Path| String::from_utf8_lossy(&std::fs::read(path).expect("it is ours")).into_owned();
    // The call that starts the program is not its own.
    let opened =
        text(calls.path()).lines().filter(|line| !line.contains("execve(")).map(str::to_owned).collect();
    TracedRun { code, output: text(said.path()), opened_paths: opened }
}
