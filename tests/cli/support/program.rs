//! Runner of the program in a temporary folder: arguments, outputs and files left behind.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Longest run of any command here; most take well under a second.
pub(crate) const COMMAND_TIMEOUT: Duration = Duration::from_mins(2);

/// Longest time until a volume is refused, whatever sizes its file claims.
pub(crate) const REFUSAL_TIMEOUT: Duration = Duration::from_secs(5);

/// Temporary folder, one for each test.
pub(crate) struct ProgramFolder(tempfile::TempDir);

/// Outcome of a command: exit code, outputs and duration.
#[derive(Debug)]
pub(crate) struct CommandOutcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    pub(crate) took: Duration,
}

impl CommandOutcome {
    /// Error message of the program: its output from the last line that begins with `error: `. Drivers and the log
    /// may have written before it.
    pub(crate) fn error_message(&self) -> Option<&str> {
        let start = self.stderr.rfind("\nerror: ").map(|end_of_line| end_of_line + 1);
        start.or_else(|| self.stderr.starts_with("error: ").then_some(0)).map(|at| &self.stderr[at..])
    }
}

impl ProgramFolder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for temporary files"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).expect("the folder can be written to");
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|err| panic!("{name} should be there: {err}"))
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).expect("valid JSON")
    }

    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(self.0.path())
            .expect("the folder can be listed")
            .map(|entry| entry.expect("it can be listed").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Runs the program in this folder.
    pub(crate) fn run(&self, args: &str) -> CommandOutcome {
        self.run_with(args, &[])
    }

    pub(crate) fn run_with(&self, args: &str, environment: &[(&str, &str)]) -> CommandOutcome {
        // Files instead of pipes: a pipe that is not drained would block the program.
        let file = || tempfile::NamedTempFile::new().expect("a temporary file");
        let (stdout, stderr) = (file(), file());
        let handle = |file: &tempfile::NamedTempFile| file.reopen().expect("a second handle");
        let start = Instant::now();
        let mut child = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
            .args(args.split_whitespace())
            .current_dir(self.0.path())
            .env_remove("RUST_LOG")
            .envs(environment.iter().copied())
            .stdin(Stdio::null())
            .stdout(handle(&stdout))
            .stderr(handle(&stderr))
            .spawn()
            .expect("the program can be started");
        let status = loop {
            if let Some(status) = child.try_wait().expect("the program can be waited for") {
                break status;
            }
            if start.elapsed() > COMMAND_TIMEOUT {
                child.kill().expect("the program can be ended");
                panic!("`{args}` takes longer than {COMMAND_TIMEOUT:?}");
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let text = |file: &tempfile::NamedTempFile| {
            fs::read_to_string(file.path()).expect("the output can be read and is UTF-8")
        };
        CommandOutcome {
            code: status.code(),
            took: start.elapsed(),
            stdout: text(&stdout),
            stderr: text(&stderr),
        }
    }

    /// Runs a command that must succeed, and returns its standard output.
    pub(crate) fn run_successfully(&self, args: &str) -> String {
        let outcome = self.run(args);
        assert_eq!(outcome.code, Some(0), "`{args}`: {outcome:?}");
        assert!(outcome.error_message().is_none(), "`{args}` is a good run: {outcome:?}");
        outcome.stdout
    }

    /// Runs a command that must fail with this code and leave the folder unchanged; returns its error message.
    pub(crate) fn run_failing(&self, args: &str, code: i32) -> String {
        self.fail_with(args, code, &[])
    }

    pub(crate) fn fail_with(&self, args: &str, code: i32, environment: &[(&str, &str)]) -> String {
        let before = self.names();
        let outcome = self.run_with(args, environment);
        assert_eq!(outcome.code, Some(code), "`{args}`: {outcome:?}");
        assert_eq!(self.names(), before, "`{args}` failed and left something behind");
        assert_eq!(outcome.stdout, "", "`{args}` failed: results belong to standard output only");
        assert!(!outcome.stderr.contains("panicked"), "`{args}`: {outcome:?}");
        outcome
            .error_message()
            .unwrap_or_else(|| panic!("`{args}` should say `error: …`: {outcome:?}"))
            .to_owned()
    }

    /// Checks that a volume is refused: `info` and `render` fail with one of these codes, quickly, and name the file.
    pub(crate) fn check_refused(&self, file: &str, codes: &[i32]) -> String {
        let before = self.names();
        let mut said = String::new();
        for args in [format!("info {file}"), format!("render {file} -o out.png --size 16x16")] {
            let outcome = self.run(&args);
            let code = outcome.code.unwrap_or(-1);
            assert!(codes.contains(&code), "`{args}` should end with {codes:?}: {outcome:?}");
            assert!(outcome.stderr.starts_with("error: "), "`{args}`: {outcome:?}");
            let name = file.split_whitespace().next().unwrap_or_default();
            let name = name.rsplit('/').next().unwrap_or(name);
            assert!(outcome.stderr.contains(name), "`{args}` should name the file: {outcome:?}");
            assert!(outcome.took < REFUSAL_TIMEOUT, "`{args}` took {:?}", outcome.took);
            assert_eq!(self.names(), before, "`{args}` failed and left something behind");
            said = outcome.stderr;
        }
        said
    }
}
