//! Test harness that decides at run time which tests are ignored, and gives the reason in their names. It supports
//! the options that `cargo test` and `cargo nextest` pass.
//!
//! A library for this would enable features of the command-line library in all tests: they would no longer test the
//! program as it is otherwise built.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Named test with its check.
pub(crate) struct NamedTest {
    /// Name of the test, with the missing data as a prefix, if any.
    name: String,
    ignored: bool,
    check: Box<dyn Fn()>,
}

impl NamedTest {
    /// Creates a test that is ignored if something is missing. If run nevertheless, it fails.
    pub(crate) fn new(name: &str, missing: Option<String>, check: impl Fn() + 'static) -> Self {
        let Some(missing) = missing else {
            return Self { name: name.to_owned(), ignored: false, check: Box::new(check) };
        };
        let name = format!("[{missing}] {name}");
        Self { name, ignored: true, check: Box::new(move || panic!("not run: {missing}")) }
    }
}

/// Options of the test run.
#[derive(Debug, Default)]
struct TestOptions {
    list: bool,
    exact: bool,
    /// True to run only ignored tests.
    ignored: bool,
    include_ignored: bool,
    filters: Vec<String>,
    skip: Vec<String>,
}

impl TestOptions {
    fn new(args: impl IntoIterator<Item = String>) -> Self {
        let mut asked = Self::default();
        let mut args = args.into_iter();
        while let Some(arg) = args.next() {
            match arg.as_str() {
                "--list" => asked.list = true,
                "--exact" => asked.exact = true,
                "--ignored" => asked.ignored = true,
                "--include-ignored" => asked.include_ignored = true,
                "--skip" => asked.skip.extend(args.next()),
                // Other options that are followed by a value of their own.
                "--format" | "--color" | "--test-threads" | "--logfile" | "-Z" => drop(args.next()),
                flag if flag.starts_with('-') => {}
                _ => asked.filters.push(arg),
            }
        }
        asked
    }

    fn matches(&self, name: &str, filter: &str) -> bool {
        if self.exact { name == filter } else { name.contains(filter) }
    }

    fn selects(&self, trial: &NamedTest) -> bool {
        let is_chosen = self.filters.is_empty() || self.filters.iter().any(|f| self.matches(&trial.name, f));
        let is_left_out = self.skip.iter().any(|filter| self.matches(&trial.name, filter));
        is_chosen && !is_left_out && (trial.ignored || !self.ignored)
    }

    /// Returns true if a test is run. Tests without their data run only under their full names, even if ignored tests
    /// are included.
    fn runs(&self, trial: &NamedTest) -> bool {
        !trial.ignored || self.exact && (self.ignored || self.include_ignored)
    }
}

/// Lists or runs the tests selected by the arguments; fails if any of them fails.
pub(crate) fn run(trials: &[NamedTest]) -> ExitCode {
    let asked = TestOptions::new(std::env::args().skip(1));
    let meant: Vec<_> = trials.iter().filter(|trial| asked.selects(trial)).collect();
    if asked.list {
        for trial in meant {
            println!("{}: test", trial.name);
        }
        return ExitCode::SUCCESS;
    }
    println!("\nrunning {} tests", meant.len());
    let (mut failed, mut ignored) = (0, 0);
    for trial in &meant {
        if !asked.runs(trial) {
            ignored += 1;
            println!("test {} ... ignored", trial.name);
        } else if catch_unwind(AssertUnwindSafe(|| (trial.check)())).is_ok() {
            println!("test {} ... ok", trial.name);
        } else {
            failed += 1;
            println!("test {} ... FAILED", trial.name);
        }
    }
    let passed = meant.len() - failed - ignored;
    let outcome = if failed == 0 { "ok" } else { "FAILED" };
    println!("\ntest result: {outcome}. {passed} passed; {failed} failed; {ignored} ignored\n");
    // Exit code of the standard harness.
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(101) }
}

/// Test of the harness: tests without their data are ignored.
pub(crate) fn tests_without_their_data_are_ignored() {
    let asked = |line: &str| TestOptions::new(line.split_whitespace().map(str::to_owned));
    let here = NamedTest::new("here", None, || {});
    let absent = NamedTest::new("absent", Some("needs DATA".to_owned()), || {});
    assert_eq!(absent.name, "[needs DATA] absent");
    for (line, meant, run) in [
        ("", [true, true], [true, false]),
        ("--list --format terse", [true, true], [true, false]),
        ("--list --format terse --ignored", [false, true], [true, false]),
        ("--exact here --nocapture", [true, false], [true, false]),
        ("--exact her", [false, false], [true, false]),
        ("her --test-threads 1", [true, false], [true, false]),
        ("--include-ignored --skip here", [false, true], [true, false]),
        ("--exact absent --ignored", [false, false], [true, true]),
    ] {
        let asked = asked(line);
        assert_eq!([&here, &absent].map(|trial| asked.selects(trial)), meant, "{line}");
        assert_eq!([&here, &absent].map(|trial| asked.runs(trial)), run, "{line}");
    }
    assert!(catch_unwind(AssertUnwindSafe(|| (here.check)())).is_ok());
    assert!(catch_unwind(AssertUnwindSafe(|| (absent.check)())).is_err(), "it never passes unseen");
}
