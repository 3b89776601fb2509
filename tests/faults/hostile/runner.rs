//! Runs the program and looks at what it opens, where the system has a tool for that.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest that the program may take over a small file, on a busy machine and while it is watched.
const PATIENCE: Duration = Duration::from_secs(30);

/// Whether it can be seen what is opened.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trace(bool);

impl Trace {
    /// Whether `strace` is there and may watch.
    pub(super) fn find() -> Self {
        let tried = Command::new("strace").args(["-e", "trace=file", "true"]).stderr(Stdio::null()).status();
        Self(tried.is_ok_and(|status| status.success()))
    }

    pub(super) fn is_there(self) -> bool {
        self.0
    }
}

impl std::fmt::Display for Trace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.0 {
            "what they opened was watched with strace"
        } else {
            "what they opened was NOT watched: there is no strace here that may watch"
        })
    }
}

/// What the program did.
#[derive(Debug)]
pub(super) struct Ended {
    pub(super) code: Option<i32>,
    /// Both outputs.
    pub(super) said: String,
    /// The calls that name files or places in a network, one a line.
    pub(super) opened: Vec<String>,
}

/// Runs the program in a folder, and fails when it takes too long.
pub(super) fn watch(folder: &Path, args: &[OsString], trace: Trace) -> Ended {
    let temporary = || tempfile::NamedTempFile::new().expect("a temporary file");
    let (said, calls) = (temporary(), temporary());
    let handle = || said.reopen().expect("a second handle");
    let program = env!("CARGO_BIN_EXE_chiaroscuro");
    let mut command = if trace.is_there() {
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
        if begin.elapsed() > PATIENCE {
            child.kill().expect("it can be ended");
            panic!("{args:?} takes longer than {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let text = |path: &Path| String::from_utf8_lossy(&std::fs::read(path).expect("it is ours")).into_owned();
    // How the program was started is no call of its own.
    let opened =
        text(calls.path()).lines().filter(|line| !line.contains("execve(")).map(str::to_owned).collect();
    Ended { code, said: text(said.path()), opened }
}
