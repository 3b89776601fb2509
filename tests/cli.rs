//! The command line as scripts see it: exit codes, messages, and what is written and what is not.
//!
//! Exit codes: 0 ok, 1 a check that does not hold, 2 usage, 3 bad input, 4 no usable graphics adapter, 5 out of memory or over a
//! limit, 6 input or output.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use chiaroscuro::export::{ExportError, export_png, read_picture, read_record, write_picture};
use chiaroscuro::model::{Depth, Shot};
use serde_json::Value;

/// Longest that any command may take here; most take well under a second.
const PATIENCE: Duration = Duration::from_mins(2);

/// Longest that a refusal may take, whatever sizes a file claims.
const PROMPT: Duration = Duration::from_secs(5);

/// A folder of its own for each test.
struct Folder(tempfile::TempDir);

/// What a command did.
#[derive(Debug)]
struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
    took: Duration,
}

impl Outcome {
    /// What the program says went wrong: from the last line that begins with `error: `. Drivers and
    /// the log may have written before it.
    fn message(&self) -> Option<&str> {
        let start = self.stderr.rfind("\nerror: ").map(|end_of_line| end_of_line + 1);
        start.or_else(|| self.stderr.starts_with("error: ").then_some(0)).map(|at| &self.stderr[at..])
    }
}

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for temporary files"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).expect("the folder can be written to");
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|err| panic!("{name} should be there: {err}"))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).expect("valid JSON")
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(self.0.path())
            .expect("the folder can be listed")
            .map(|entry| entry.expect("it can be listed").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Runs the program in this folder.
    fn run(&self, args: &str) -> Outcome {
        self.run_with(args, &[])
    }

    fn run_with(&self, args: &str, environment: &[(&str, &str)]) -> Outcome {
        // Files instead of pipes: a pipe that nobody empties would block the program.
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
            if start.elapsed() > PATIENCE {
                child.kill().expect("the program can be ended");
                panic!("`{args}` takes longer than {PATIENCE:?}");
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let text = |file: &tempfile::NamedTempFile| {
            fs::read_to_string(file.path()).expect("the output can be read and is UTF-8")
        };
        Outcome { code: status.code(), took: start.elapsed(), stdout: text(&stdout), stderr: text(&stderr) }
    }

    /// Runs a command that must work; gives its standard output.
    fn succeed(&self, args: &str) -> String {
        let outcome = self.run(args);
        assert_eq!(outcome.code, Some(0), "`{args}`: {outcome:?}");
        outcome.stdout
    }

    /// Runs a command that must fail with this code and leave the folder as it was; gives what it
    /// says.
    fn fail(&self, args: &str, code: i32) -> String {
        self.fail_with(args, code, &[])
    }

    fn fail_with(&self, args: &str, code: i32, environment: &[(&str, &str)]) -> String {
        let before = self.names();
        let outcome = self.run_with(args, environment);
        assert_eq!(outcome.code, Some(code), "`{args}`: {outcome:?}");
        assert_eq!(self.names(), before, "`{args}` failed and left something behind");
        assert_eq!(outcome.stdout, "", "`{args}` failed: results belong to standard output only");
        assert!(!outcome.stderr.contains("panicked"), "`{args}`: {outcome:?}");
        outcome.message().unwrap_or_else(|| panic!("`{args}` should say `error: …`: {outcome:?}")).to_owned()
    }

    /// A volume that no command accepts: `info` and `render` fail with one of these codes, soon, and
    /// name the file.
    fn refuse(&self, file: &str, codes: &[i32]) -> String {
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
            assert!(outcome.took < PROMPT, "`{args}` took {:?}", outcome.took);
            assert_eq!(self.names(), before, "`{args}` failed and left something behind");
            said = outcome.stderr;
        }
        said
    }
}

/// A NRRD header of 8-bit voxels with these further lines, 1 mm apart unless they say it.
fn header(lines: &str) -> String {
    let spacings = if lines.contains("spac") { "" } else { "\nspacings: 1 1 1" };
    format!("NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\n{lines}{spacings}\n\n")
}

fn attached(lines: &str, voxels: usize) -> Vec<u8> {
    let mut bytes = header(lines).into_bytes();
    bytes.extend((0..voxels).map(|i| i as u8));
    bytes
}

fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("memory can be written to");
    encoder.finish().expect("memory can be written to")
}

/// A ball of 8³ voxels.
fn small_ball() -> Vec<u8> {
    let distance = |at: usize| {
        let p = [at % 8, at / 8 % 8, at / 64].map(|c| c as f64 - 3.5);
        p.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    (0..512).map(|at| if distance(at) < 3.0 { 200 } else { 0 }).collect()
}

/// Width, height and RGBA of a PNG.
fn pixels(path: &Path) -> (u32, u32, Vec<[u8; 4]>) {
    let image = image::open(path).expect("a PNG that can be decoded").to_rgba8();
    (image.width(), image.height(), image.pixels().map(|pixel| pixel.0).collect())
}

fn assert_shows_something(path: &Path, size: [u32; 2]) {
    let (width, height, pixels) = pixels(path);
    assert_eq!([width, height], size);
    let middle = pixels[(height / 2 * width + width / 2) as usize];
    assert_ne!(middle, pixels[0], "the middle of the picture must differ from its corner");
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<_> = value.as_object().expect("an object").keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

fn assert_has_keys(value: &Value, expected: &[&str]) {
    for key in expected {
        assert!(keys(value).contains(key), "{key} is missing in {:?}", keys(value));
    }
}

// ---------------------------------------------------------------------------------------------
// Volumes that are refused
// ---------------------------------------------------------------------------------------------

#[test]
fn files_that_are_not_there_or_no_files_are_io_errors() {
    let folder = Folder::new();
    fs::create_dir(folder.path("directory.raw")).expect("the folder can be written to");
    for file in ["missing.raw", "missing.nrrd", "no/such/folder/x.nrrd", "directory.raw", "."] {
        folder.refuse(file, &[6]);
    }
}

#[cfg(unix)]
#[test]
fn files_that_may_not_be_read_are_io_errors() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new();
    folder.write("secret_8x8x8_uint8.raw", small_ball());
    let path = folder.path("secret_8x8x8_uint8.raw");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).expect("it is our file");
    if fs::File::open(&path).is_ok() {
        println!("this user may read everything: files that may not be read are not checked");
        return;
    }
    folder.refuse("secret_8x8x8_uint8.raw", &[6]);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_and_never_waited_for() {
    let folder = Folder::new();
    let made = Command::new("mkfifo").arg(folder.path("pipe.raw")).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo is part of every Unix");
    folder.refuse("pipe.raw", &[6]);
    folder.refuse("/dev/zero", &[6]);
}

#[test]
fn volumes_of_the_wrong_size_are_bad_input() {
    let folder = Folder::new();
    folder.write("short_8x8x8_uint8.raw", vec![0; 511]);
    folder.write("long_8x8x8_uint8.raw", vec![0; 513]);
    folder.write("empty_8x8x8_uint8.raw", b"");
    folder.write("zero_0x8x8_uint8.raw", b"");
    folder.write("nameless.raw", small_ball());
    folder.write("zero.nrrd", attached("sizes: 8 0 8", 0));
    folder.write("short.nrrd", attached("sizes: 8 8 8", 511));
    folder.write("negative.nrrd", attached("sizes: 8 -8 8", 512));
    for file in [
        "short_8x8x8_uint8.raw",
        "long_8x8x8_uint8.raw",
        "empty_8x8x8_uint8.raw",
        "zero_0x8x8_uint8.raw",
        "nameless.raw",
        "zero.nrrd",
        "short.nrrd",
        "negative.nrrd",
    ] {
        folder.refuse(file, &[3]);
    }
    let said = folder.fail("info short_8x8x8_uint8.raw", 3);
    assert!(said.contains("512") && said.contains("511"), "expected and found sizes: {said}");
}

#[test]
fn truncated_compressed_volumes_are_bad_input() {
    let folder = Folder::new();
    // Noise, so that the compressed file is long enough to be cut.
    let noise: Vec<u8> = (0..4096u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let whole = gzipped(&noise);
    folder.write("whole_16x16x16_uint8.raw.gz", &whole);
    folder.succeed("info whole_16x16x16_uint8.raw.gz");
    folder.write("half_16x16x16_uint8.raw.gz", &whole[..whole.len() / 2]);
    folder.write("tail_16x16x16_uint8.raw.gz", &whole[..whole.len() - 4]);
    folder.write("fewer_16x16x16_uint8.raw.gz", gzipped(&noise[..4000]));
    let mut nrrd = header("sizes: 16 16 16").replace("encoding: raw", "encoding: gzip").into_bytes();
    nrrd.extend(&whole[..whole.len() / 2]);
    folder.write("half.nrrd", nrrd);
    for file in [
        "half_16x16x16_uint8.raw.gz",
        "tail_16x16x16_uint8.raw.gz",
        "fewer_16x16x16_uint8.raw.gz",
        "half.nrrd",
    ] {
        folder.refuse(file, &[3]);
    }
}

#[test]
fn enormous_claims_are_refused_at_once() {
    let folder = Folder::new();
    folder.write("huge.nrrd", attached("sizes: 1000000 1000000 1000000", 64));
    let mut zipped = header("sizes: 1000000 1000000 1000000").replace("raw", "gzip").into_bytes();
    zipped.extend(gzipped(&[0; 4096]));
    folder.write("huge-gzip.nrrd", zipped);
    folder.write("huge-text.nrrd", header("sizes: 1000000 1000000 1000000").replace("raw", "ascii"));
    folder.write("beyond.nrrd", attached("sizes: 18446744073709551615 18446744073709551615 2", 64));
    folder.write("huge_1000000x1000000x1000000_float64.raw", [0; 64]);
    folder.write("huge_99999999999999999999999x1x1_uint8.raw", [0; 64]);
    folder.write("x.bin", [0; 64]);
    for file in [
        "huge.nrrd",
        "huge-gzip.nrrd",
        "huge-text.nrrd",
        "beyond.nrrd",
        "huge_1000000x1000000x1000000_float64.raw",
        "huge_99999999999999999999999x1x1_uint8.raw",
        "x.bin --dims 1000000x1000000x1000000 --type uint8",
    ] {
        folder.refuse(file, &[3, 5]);
    }
    folder.fail("info builtin:sphere:100000", 3);
    // Behind a header without an end.
    folder.write("endless.nrrd", [b"NRRD0004\n".to_vec(), vec![b'x'; 4 << 20]].concat());
    folder.refuse("endless.nrrd", &[3, 5]);
}

#[test]
fn spacings_that_are_no_lengths_are_bad_input() {
    let folder = Folder::new();
    folder.write("ball_8x8x8_uint8.raw", small_ball());
    for spacing in ["nanx1x1", "infx1x1", "0x1x1", "-1x1x1", "1e300x1x1"] {
        folder.refuse(&format!("ball_8x8x8_uint8.raw --spacing={spacing}"), &[2, 3]);
    }
    for (name, line) in [
        ("infinite.nrrd", "spacings: inf 1 1"),
        ("zero.nrrd", "spacings: 0 1 1"),
        ("words.nrrd", "spacings: a b c"),
        ("few.nrrd", "spacings: 1 1"),
        ("nan.nrrd", "space: left-posterior-superior\nspace directions: (nan,0,0) (0,1,0) (0,0,1)"),
        ("flat.nrrd", "space: left-posterior-superior\nspace directions: (1,0,0) (1,0,0) (0,0,1)"),
    ] {
        folder.write(name, attached(&format!("sizes: 8 8 8\n{line}"), 512));
        folder.refuse(name, &[3]);
    }
    // NRRD writes nan for a spacing that nobody knows: 1 mm then.
    folder.write("unknown.nrrd", attached("sizes: 8 8 8\nspacings: nan 1 2", 512));
    let facts: Value = serde_json::from_str(&folder.succeed("info unknown.nrrd --json")).expect("valid JSON");
    assert_eq!(facts["spacing_mm"], serde_json::json!([1.0, 1.0, 2.0]));
}

#[test]
fn headers_cannot_name_files_outside_their_folder() {
    let folder = Folder::new();
    folder.write("outside.raw", small_ball());
    fs::create_dir(folder.path("inside")).expect("the folder can be written to");
    let absolute = folder.path("outside.raw").to_string_lossy().into_owned();
    for data_file in
        ["../../etc/passwd", "../outside.raw", "/etc/passwd", &absolute, "x/../../outside.raw", "C:\\x", ".."]
    {
        folder.write("inside/bad.nhdr", header(&format!("sizes: 8 8 8\ndata file: {data_file}")));
        let said = folder.refuse("inside/bad.nhdr", &[3]);
        assert!(!said.contains("root:"), "nothing of the file may be shown: {said}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("outside.raw"), folder.path("inside/link.raw"))
            .expect("links can be made");
        folder.write("inside/bad.nhdr", header("sizes: 8 8 8\ndata file: link.raw"));
        folder.refuse("inside/bad.nhdr", &[3]);
    }
    folder.write("good.nhdr", header("sizes: 8 8 8\ndata file: ./outside.raw"));
    folder.succeed("info good.nhdr");
}

// ---------------------------------------------------------------------------------------------
// Arguments that are refused
// ---------------------------------------------------------------------------------------------

#[test]
fn unknown_words_are_usage_errors() {
    let folder = Folder::new();
    for args in [
        "--no-such-flag",
        "no-such-command x y",
        "render builtin:sphere:16",
        "render builtin:sphere:16 -o out.png --no-such-flag",
        "render builtin:sphere:16 -o out.png --shadows sometimes",
        "render builtin:sphere:16 -o out.png --size 0x5",
        "render builtin:sphere:16 -o out.png --size 64",
        "render builtin:sphere:16 -o out.png --size 1000000x1000000",
        "render builtin:sphere:16 -o out.png --dims 1x2",
        "render builtin:sphere:16 -o out.png --type complex",
        "bench --only nothing",
        "bench --frames 0",
        "info",
    ] {
        folder.fail(args, 2);
    }
    let said = folder.fail("render builtin:sphere:16 -o out.png --shadows sometimes", 2);
    assert!(said.contains("splat") && said.contains("off"), "the known words: {said}");
    let said = folder.fail("render builtin:nothing -o out.png", 3);
    assert!(said.contains("chair") && said.contains("marschner-lobb"), "the known volumes: {said}");
}

#[test]
fn unknown_settings_are_usage_errors_that_list_the_known_ones() {
    let folder = Folder::new();
    let render = "render builtin:sphere:16 -o out.png --size 16x16 --set";
    let said = folder.fail(&format!("{render} shadows.strenght=1"), 2);
    assert!(said.contains("shadows.strenght"), "what was wrong: {said}");
    for known in ["strength", "gain", "bias"] {
        assert!(said.contains(known), "the known names: {said}");
    }
    let said = folder.fail(&format!("{render} no_such=1"), 2);
    assert!(said.contains("shadows") && said.contains("camera"), "the known names: {said}");
    for assignment in ["shadows.strength", "shadows.strength=much", "lights.99.intensity=1", "=1", ""] {
        folder.fail(&format!("{render}={assignment}"), 2);
    }
}

#[test]
fn presets_and_sessions_that_cannot_be_used_are_refused() {
    let folder = Folder::new();
    folder.write("words.json", "this is no JSON");
    folder.write("list.json", "[1, 2, 3]");
    folder.write("form.json", r#"{"shadows": {"strength": "much"}}"#);
    folder.write("binary.json", [0xff, 0xfe, 0x00, 0x80]);
    fs::create_dir(folder.path("directory.json")).expect("the folder can be written to");
    for option in ["--preset", "--session"] {
        let refused = |file: &str, code: i32| {
            let args = format!("render builtin:sphere:16 -o out.png --size 16x16 {option} {file}");
            let said = folder.fail(&args, code);
            assert!(said.contains(file), "`{args}` should name the file: {said}");
        };
        refused("words.json", 3);
        refused("list.json", 3);
        refused("form.json", 3);
        refused("missing.json", 6);
        refused("directory.json", 6);
        // Not even text: no preset, and the file can be read.
        refused("binary.json", 3);
    }
}

// ---------------------------------------------------------------------------------------------
// Results that are not written
// ---------------------------------------------------------------------------------------------

#[test]
fn results_that_cannot_be_written_are_io_errors() {
    let folder = Folder::new();
    fs::create_dir(folder.path("directory")).expect("the folder can be written to");
    for (args, name) in [
        ("render builtin:sphere:16 --size 16x16 -o no/such/folder/out.png", "no/such/folder/out.png"),
        ("light-volume builtin:sphere:16 -o no/such/folder/out.nrrd", "no/such/folder/out.nrrd"),
        ("render builtin:sphere:16 --size 16x16 -o directory", "directory"),
    ] {
        let said = folder.fail(args, 6);
        assert!(said.contains(name), "`{args}` should name the file: {said}");
    }
}

#[test]
fn failures_leave_an_older_result_as_it_was() {
    let folder = Folder::new();
    folder.write("short_8x8x8_uint8.raw", vec![0; 511]);
    folder.write("words.json", "this is no JSON");
    let older = b"what was there before".to_vec();
    folder.write("out.png", &older);
    for (args, code) in [
        ("render missing.raw -o out.png", 6),
        ("render short_8x8x8_uint8.raw -o out.png", 3),
        ("render builtin:sphere:16 -o out.png --size 0x0", 2),
        ("render builtin:sphere:16 -o out.png --preset words.json", 3),
        ("render builtin:sphere:16 -o out.png --set shadows.strenght=1", 2),
        ("light-volume builtin:sphere:16 -o out.png --light 99", 2),
        ("light-volume builtin:sphere:16 -o out.png --shadows off", 2),
        ("light-volume builtin:sphere:16 -o out.png --slice z:16", 2),
        ("light-volume builtin:sphere:16 -o out.png --slice w:1", 2),
    ] {
        folder.fail(args, code);
        assert_eq!(folder.read("out.png"), older, "`{args}` changed the file that was there");
    }
}

#[test]
fn a_report_that_cannot_be_written_fails_the_command() {
    let folder = Folder::new();
    let args = "render builtin:sphere:16 --size 16x16 -o out.png --report no/such/folder/r.json";
    let outcome = folder.run(args);
    assert_eq!(outcome.code, Some(6), "{outcome:?}");
    assert!(outcome.stderr.contains("no/such/folder/r.json"), "{outcome:?}");
    assert_eq!(folder.names(), Vec::<String>::new(), "a failed command writes nothing");
}

/// On other systems the drivers cannot be hidden from a program.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_message_says_what_to_install() {
    let folder = Folder::new();
    let hidden = [
        ("VK_DRIVER_FILES", "/nonexistent.json"),
        ("VK_ICD_FILENAMES", "/nonexistent.json"),
        ("WGPU_BACKEND", "vulkan"),
    ];
    for args in [
        "render builtin:sphere:16 -o out.png",
        "light-volume builtin:sphere:16 -o out.nrrd",
        "bench --json --volume builtin:sphere:16",
    ] {
        let said = folder.fail_with(args, 4, &hidden);
        assert!(said.contains("adapter") && said.contains("install"), "`{args}`: {said}");
    }
    // What needs no adapter works all the same.
    assert_eq!(folder.run_with("info builtin:sphere:16", &hidden).code, Some(0));
}

// ---------------------------------------------------------------------------------------------
// What works
// ---------------------------------------------------------------------------------------------

#[test]
fn help_and_version_are_no_errors() {
    let folder = Folder::new();
    assert!(folder.succeed("--version").contains(env!("CARGO_PKG_VERSION")));
    let help = folder.succeed("--help");
    for command in ["render", "compare", "light-volume", "info", "bench"] {
        assert!(help.contains(command), "{command} is missing: {help}");
        assert!(!folder.succeed(&format!("{command} --help")).is_empty());
    }
}

#[test]
fn a_picture_and_its_report_are_written() {
    let folder = Folder::new();
    folder.succeed("render builtin:sphere:24 -o out.png --size 64x48 --report r.json");
    assert_eq!(folder.names(), ["out.png", "r.json"], "and nothing else");
    assert_shows_something(&folder.path("out.png"), [64, 48]);

    let report = folder.json("r.json");
    assert_has_keys(
        &report,
        &[
            "adapter",
            "image_size",
            "volume_dims",
            "stages_ms",
            "light_rebuilds",
            "slabs",
            "peak_gpu_bytes",
            "settings_hash",
            "settings",
        ],
    );
    assert_eq!(
        keys(&report["stages_ms"]),
        ["bricks", "eye", "light_backproject", "light_march", "light_raycast", "readback", "upload"]
    );
    for (stage, took) in report["stages_ms"].as_object().expect("an object") {
        assert!(took.as_f64().is_some_and(|ms| (0.0..60_000.0).contains(&ms)), "{stage}: {took}");
    }
    assert!(report["adapter"].as_str().is_some_and(|name| !name.is_empty()));
    assert_eq!(report["image_size"], serde_json::json!([64, 48]));
    assert_eq!(report["volume_dims"], serde_json::json!([24, 24, 24]));
    // The key light casts shadows, so its volume was made for the picture; the fill light casts none.
    assert_eq!(report["light_rebuilds"][0], 1, "{}", report["light_rebuilds"]);
    assert!(report["slabs"].as_u64().is_some_and(|slabs| slabs >= 24), "{}", report["slabs"]);
    assert!(report["peak_gpu_bytes"].as_u64().is_some_and(|bytes| bytes > 2 * 24 * 24 * 24));
    assert_eq!(report["settings_hash"].as_str().map(str::len), Some(16));
}

#[test]
fn blocks_of_voxels_are_averaged_when_that_is_asked_for() {
    let folder = Folder::new();
    folder.succeed("render builtin:sphere:48 --reduce 2 -o out.png --size 64x48 --report r.json");
    assert_shows_something(&folder.path("out.png"), [64, 48]);
    let report = folder.json("r.json");
    assert_eq!(report["volume_dims"], serde_json::json!([24, 24, 24]));
    assert_eq!(report["volume_file_dims"], serde_json::json!([48, 48, 48]));
    let replayed = folder.run("replay out.png --check");
    assert_eq!(replayed.code, Some(3), "it is of other voxels: {replayed:?}");
    folder.succeed("replay out.png --check --reduce 2");
    folder.fail("render builtin:sphere:48 --reduce 0 -o none.png", 2);
}

#[test]
fn volumes_beyond_the_adapter_are_shown_with_fewer_voxels() {
    let folder = Folder::new();
    // Longer than any adapter's axes.
    folder.write("long_20000x3x3_uint8.raw", vec![200; 20000 * 9]);
    let outcome = folder.run("render long_20000x3x3_uint8.raw -o out.png --size 64x48 --report r.json");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("20000 × 3 × 3 voxels were averaged to"), "{outcome:?}");
    let report = folder.json("r.json");
    assert_eq!(report["volume_file_dims"], serde_json::json!([20000, 3, 3]));
    assert!(report["volume_dims"][0].as_u64().is_some_and(|n| n < 20000), "{}", report["volume_dims"]);
    assert_eq!(report["volume_dims"][1], 3, "the other axes are short enough");
    // Nobody mistakes it for the whole.
    let bench = "bench --volume long_20000x3x3_uint8.raw --only orbit --frames 1 --size 16x16";
    let said = folder.fail(bench, 2);
    assert!(said.contains("full resolution"), "{said}");
}

#[test]
fn the_same_command_gives_the_same_bytes() {
    let folder = Folder::new();
    for name in ["a", "b"] {
        folder.succeed(&format!("render builtin:cloud:24 -o {name}.png --size 64x48"));
        folder.succeed(&format!("light-volume builtin:cloud:24 -o {name}.nrrd"));
    }
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_eq!(folder.read("a.nrrd"), folder.read("b.nrrd"));
    // An older result is replaced.
    folder.write("b.png", b"older");
    folder.succeed("render builtin:cloud:24 -o b.png --size 64x48");
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
}

#[test]
fn a_transparent_picture_has_nothing_in_its_corner() {
    let folder = Folder::new();
    folder.succeed("render builtin:sphere:24 -o clear.png --size 64x48 --transparent");
    let image = image::open(folder.path("clear.png")).expect("a PNG that can be decoded");
    assert_eq!(image.color(), image::ColorType::Rgba8);
    let (_, _, clear) = pixels(&folder.path("clear.png"));
    assert_eq!(clear[0][3], 0, "the corner");
    assert!(clear.iter().any(|pixel| pixel[3] > 200), "the object");

    folder.succeed("render builtin:sphere:24 -o solid.png --size 64x48");
    let image = image::open(folder.path("solid.png")).expect("a PNG that can be decoded");
    assert_eq!(image.color(), image::ColorType::Rgb8);
}

#[test]
fn shadows_change_the_picture() {
    let folder = Folder::new();
    let render = "render builtin:sphere:24 --size 64x48 -o";
    folder.succeed(&format!("{render} with.png"));
    folder.succeed(&format!("{render} off.png --shadows off"));
    folder.succeed(&format!("{render} none.png --set shadows.algorithm=off"));
    folder.succeed(&format!("{render} splat.png --shadows splat"));
    assert_ne!(folder.read("with.png"), folder.read("off.png"));
    assert_eq!(folder.read("off.png"), folder.read("none.png"), "two ways to say the same");
    assert_eq!(folder.read("with.png"), folder.read("splat.png"), "splatting is the default");
}

#[test]
fn progress_is_told_beside_the_result() {
    let folder = Folder::new();
    let outcome = folder.run("render builtin:sphere:16 -o out.png --size 16x16 --progress");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("loading") && outcome.stderr.contains("rendering"), "{outcome:?}");
    assert_eq!(outcome.stdout, "out.png\n");
}

#[test]
fn settings_of_a_report_restore_the_picture() {
    let folder = Folder::new();
    folder.succeed(
        "render builtin:chair:24 -o first.png --size 64x48 --report first.json --set camera.azimuth_deg=77.7 \
         --set shadows.strength=0.7 --set sampling.kernel={\"gaussian\":{\"sigma\":0.55}}",
    );
    // As text: reading a number and writing it again may already change its last digit.
    let settings = |name: &str| {
        let text = String::from_utf8(folder.read(name)).expect("JSON is UTF-8");
        let (_, after) = text.split_once("\"settings\": ").expect("the report has the settings");
        after.trim_end().strip_suffix('}').expect("they are its last part").trim_end().to_owned()
    };
    let first = folder.json("first.json");
    assert_eq!(first["settings"]["camera"]["azimuth_deg"], 77.7);
    folder.write("session.json", settings("first.json"));
    for option in ["--session", "--preset"] {
        folder.succeed(&format!(
            "render builtin:chair:24 -o second.png --size 64x48 --report second.json {option} session.json"
        ));
        assert!(folder.read("first.png") == folder.read("second.png"), "{option}: another picture");
        let changed: Vec<_> = std::iter::zip(settings("first.json").lines(), settings("second.json").lines())
            .filter(|(before, after)| before != after)
            .map(|(before, after)| format!("{} became {}", before.trim(), after.trim()))
            .collect();
        assert!(changed.is_empty(), "{option}: {changed:?}");
        assert_eq!(first["settings_hash"], folder.json("second.json")["settings_hash"], "{option}");
    }
}

#[test]
fn presets_that_come_with_the_program_are_known_by_name() {
    let folder = Folder::new();
    let outcome = folder.run("render builtin:chair:24 -o out.png --size 32x32 --preset bench/creature");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!outcome.stderr.contains("warning: preset"), "{outcome:?}");
}

#[test]
fn unknown_names_in_a_preset_are_warnings() {
    let folder = Folder::new();
    folder.write("typo.json", r#"{"shadows": {"strenght": 0.5}, "_remark": "free"}"#);
    let outcome = folder.run("render builtin:sphere:16 -o out.png --size 16x16 --preset typo.json");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("shadows.strenght"), "{outcome:?}");
    assert!(!outcome.stderr.contains("_remark"), "{outcome:?}");
}

#[test]
fn turntables_are_files_that_move_or_folders() {
    let folder = Folder::new();
    folder.succeed("turntable builtin:chair:16 -o turn.png --size 40x30 --frames 4 --rate 8");
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(folder.read("turn.png")))
        .expect("a PNG file");
    assert!(decoder.is_apng().expect("it can be read"));
    let frames = image::AnimationDecoder::into_frames(decoder.apng().expect("it moves"));
    let frames: Vec<_> = frames.map(|frame| frame.expect("a frame").into_buffer().into_raw()).collect();
    assert_eq!(frames.len(), 4);
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]), "the camera turns");

    folder.succeed("turntable builtin:chair:16 -o pictures --size 40x30 --frames 3 --light 1");
    let names = ["0000.png", "0001.png", "0002.png"].map(|name| format!("pictures/{name}"));
    assert!(names.iter().all(|name| folder.path(name).exists()));
    assert!(folder.succeed("replay pictures/0001.png --check").contains("identical"));
    folder.succeed("turntable builtin:chair:16 -o turn.gif --size 40x30 --frames 3 --transparent");
    let gif =
        image::codecs::gif::GifDecoder::new(std::io::Cursor::new(folder.read("turn.gif"))).expect("a GIF");
    let frames = image::AnimationDecoder::into_frames(gif).collect_frames().expect("its pictures");
    assert_eq!(frames.len(), 3);
    let alphas = |frame: &image::Frame| frame.buffer().pixels().filter(|pixel| pixel.0[3] == 0).count();
    assert!(frames.iter().all(|frame| (300..1150).contains(&alphas(frame))), "the background is left out");
    let outcome = folder.run("turntable builtin:chair:16 -o x.mp4 --size 40x30 --frames 3 --transparent");
    assert_eq!(outcome.code, Some(6), "{outcome:?}");
    assert!(outcome.stderr.contains("no transparency"), "{outcome:?}");
    let outcome = folder.run("turntable builtin:chair:16 -o x.png --light 9");
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("no light 9"), "{outcome:?}");
}

#[test]
fn presets_of_the_library_can_be_named() {
    let folder = Folder::new();
    folder.succeed("render builtin:chair:16 -o own.png --size 40x30");
    folder.succeed("render builtin:chair:16 -o paper.png --size 40x30 --preset paper/chair");
    assert_shows_something(&folder.path("paper.png"), [40, 30]);
    assert!(folder.read("own.png") != folder.read("paper.png"));
}

#[test]
fn pictures_can_be_made_again_from_themselves() {
    let folder = Folder::new();
    folder.write("x_8x8x8_uint8.raw", small_ball());
    folder.succeed("render x_8x8x8_uint8.raw -o shot.png --size 48x36 --transparent --set shadows.gain=1.3");
    assert!(folder.succeed("replay shot.png --check").contains("identical"));
    folder.succeed("replay shot.png -o again.png");
    assert!(folder.read("again.png") == folder.read("shot.png"), "all bytes, the record included");

    // Another look is noticed, and only a failure when that was asked for.
    let text = read_record(&folder.path("shot.png")).expect("a picture").expect("a record");
    let changed = text.replace("\"gain\": 1.3", "\"gain\": 0.4");
    assert_ne!(changed, text);
    let pixels = image::open(folder.path("shot.png")).expect("a picture").to_rgba8().into_raw();
    export_png([48, 36], &pixels, true, Some(&changed), &folder.path("changed.png")).expect("written");
    assert!(folder.succeed("replay changed.png").contains("different"));
    let outcome = folder.run("replay changed.png --check");
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stderr.contains("RMSE"), "{outcome:?}");

    // Another volume, a moved one, and pictures that carry nothing.
    folder.write(
        "y_8x8x8_uint8.raw",
        vec![7; 512].iter().zip(0..).map(|(a, b): (&u8, i32)| a ^ b as u8).collect::<Vec<_>>(),
    );
    let outcome = folder.run("replay shot.png --volume y_8x8x8_uint8.raw");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("another volume"), "{outcome:?}");
    std::fs::rename(folder.path("x_8x8x8_uint8.raw"), folder.path("z_8x8x8_uint8.raw")).expect("moved");
    assert_ne!(folder.run("replay shot.png").code, Some(0));
    assert!(folder.succeed("replay shot.png --check --volume z_8x8x8_uint8.raw").contains("identical"));
    export_png([48, 36], &pixels, true, None, &folder.path("plain.png")).expect("written");
    let outcome = folder.run("replay plain.png");
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("carries no settings"), "{outcome:?}");
    assert_eq!(folder.run("replay nothing.png").code, Some(6));
}

#[test]
fn fine_pictures_can_be_made_again_from_themselves() {
    let folder = Folder::new();
    for (name, options) in [
        ("deep.png", "--bits 16 --samples 2"),
        ("deep_alpha.png", "--bits 16 --transparent"),
        ("light.exr", "--samples 3"),
        ("light_alpha.exr", "--transparent"),
    ] {
        folder.succeed(&format!("render builtin:chair:16 -o {name} --size 48x36 {options}"));
        assert!(folder.succeed(&format!("replay {name} --check")).contains("identical"), "{name}");
        folder.succeed(&format!("replay {name} -o again_{name}"));
        let [found, again] = [name.to_owned(), format!("again_{name}")].map(|name| folder.path(&name));
        assert!(
            read_picture(&found).expect("a picture") == read_picture(&again).expect("a picture"),
            "{name}"
        );
        assert_eq!(read_record(&found).expect("a record"), read_record(&again).expect("a record"), "{name}");
    }
    let deep = image::open(folder.path("deep.png")).expect("a picture");
    assert_eq!(deep.color(), image::ColorType::Rgb16);
    let words = deep.to_rgb16().into_raw();
    assert!(words.iter().filter(|&&word| word % 257 != 0).count() > words.len() / 4, "more than bytes");
    // Another look is noticed in these, too.
    let text = read_record(&folder.path("light.exr")).expect("a picture").expect("a record");
    let (size, rows) = read_picture(&folder.path("light.exr")).expect("a picture");
    let changed = text.replace("\"gain\": 1.0", "\"gain\": 0.4");
    assert_ne!(changed, text);
    let shot = Shot { depth: Depth::Linear, ..Shot::new(size) };
    let mut rows = Some(rows);
    let mut next = || Ok::<_, ExportError>(rows.take());
    write_picture(&folder.path("changed.exr"), &shot, Some(&changed), &mut next).expect("written");
    assert_eq!(folder.run("replay changed.exr --check").code, Some(1));
    // A look can be taken from any of them.
    folder.succeed("render builtin:chair:16 -o from.png --size 48x36 --session light.exr");
    export_png([1, 1], &[0; 4], false, None, &folder.path("bare.png")).expect("written");
    let outcome = folder.run("render builtin:chair:16 -o x.png --session bare.png");
    assert!(outcome.code == Some(3) && outcome.stderr.contains("carries no settings"), "{outcome:?}");
    let outcome = folder.run("render builtin:chair:16 -o x.gif --size 48x36");
    assert!(outcome.code == Some(6) && outcome.stderr.contains(".png or .exr"), "{outcome:?}");
    assert_ne!(folder.run("render builtin:chair:16 -o x.png --samples 5").code, Some(0));
    assert_ne!(folder.run("render builtin:chair:16 -o x.png --bits 12").code, Some(0));
}

#[test]
fn pictures_may_be_larger_than_textures() {
    let folder = Folder::new();
    // Wider than adapters draw at once (16384 here and on most).
    let said = folder.succeed("render builtin:chair:16 -o wide.png --size 20000x3 --set sampling.slab=4");
    assert!(said.contains("wide.png"));
    let wide = image::open(folder.path("wide.png")).expect("a picture").to_rgb8();
    assert_eq!((wide.width(), wide.height()), (20000, 3));
    assert!(folder.succeed("replay wide.png --check").contains("identical"));
}

#[test]
fn raw_files_say_their_format_in_the_name_or_in_options() {
    let folder = Folder::new();
    folder.write("x_8x8x8_uint8.raw", small_ball());
    folder.write("x.bin", small_ball());
    folder.write("padded.bin", [vec![9; 10], small_ball()].concat());
    folder.write("x_8x8x8_uint8.raw.gz", gzipped(&small_ball()));
    let render = |file: &str, out: &str| {
        folder.succeed(&format!("render {file} -o {out} --size 32x24"));
        assert_shows_something(&folder.path(out), [32, 24]);
        // The pixels: beside them, a picture says of which file it is.
        image::open(folder.path(out)).expect("a picture").to_rgba8().into_raw()
    };
    let named = render("x_8x8x8_uint8.raw", "named.png");
    assert!(named == render("x.bin --dims 8x8x8 --type uint8", "options.png"));
    assert!(named == render("padded.bin --dims 8x8x8 --type uint8 --offset 10", "offset.png"));
    assert!(named == render("x_8x8x8_uint8.raw.gz", "zipped.png"));
    assert!(named != render("x_8x8x8_uint8.raw --spacing 1x1x3", "stretched.png"), "spacing counts");

    let facts = |args: &str| -> Value {
        serde_json::from_str(&folder.succeed(&format!("info --json {args}"))).expect("valid JSON")
    };
    folder.write("wide.bin", [1, 0, 0, 2].repeat(4));
    let little = facts("wide.bin --dims 2x2x2 --type uint16 --endian little");
    let big = facts("wide.bin --dims 2x2x2 --type uint16 --endian big");
    assert_eq!(little["range"], serde_json::json!([1.0, 512.0]));
    assert_eq!(big["range"], serde_json::json!([2.0, 256.0]));
}

#[test]
fn an_attenuation_volume_can_be_loaded_back() {
    let folder = Folder::new();
    folder.succeed("light-volume builtin:box:16 -o l.nrrd");
    assert_eq!(folder.names(), ["l.nrrd"]);
    let facts: Value = serde_json::from_str(&folder.succeed("info l.nrrd --json")).expect("valid JSON");
    let source: Value =
        serde_json::from_str(&folder.succeed("info builtin:box:16 --json")).expect("valid JSON");
    assert_eq!(facts["type"], "float32");
    assert_eq!(facts["dims"], source["dims"]);
    assert_eq!(facts["spacing_mm"], source["spacing_mm"]);
    assert_eq!(facts["non_finite_voxels"], 0);
    let (low, high) = (facts["range"][0].as_f64(), facts["range"][1].as_f64());
    let (low, high) = (low.expect("a number"), high.expect("a number"));
    assert!(0.0 <= low && high <= 1.0, "light is never more than all of it: {low} … {high}");
    assert!(low < 0.5 && high > 0.9, "the box casts a shadow: {low} … {high}");
}

#[test]
fn info_says_what_is_in_a_volume() {
    let folder = Folder::new();
    let facts: Value =
        serde_json::from_str(&folder.succeed("info builtin:chair:16 --json")).expect("valid JSON");
    assert_has_keys(&facts, &["name", "dims", "type", "spacing_mm", "range", "percentiles"]);
    assert!(keys(&facts).iter().any(|key| key.ends_with("bytes") || key.contains("bytes_")), "memory");
    assert_eq!(facts["dims"], serde_json::json!([16, 16, 16]));
    assert_eq!(facts["type"], "uint8");
    assert_eq!(facts["spacing_mm"], serde_json::json!([8.0, 8.0, 8.0]));
    let percentiles: Vec<f64> = ["p1", "p5", "p25", "p50", "p75", "p95", "p99"]
        .iter()
        .map(|name| facts["percentiles"][name].as_f64().unwrap_or_else(|| panic!("{name} is missing")))
        .collect();
    assert!(percentiles.is_sorted(), "{percentiles:?}");

    let text = folder.succeed("info builtin:chair:16");
    assert!(text.contains("16 × 16 × 16") && text.contains("uint8"), "{text}");
}

#[test]
fn orbiting_is_timed_and_rebuilds_no_light_volume() {
    let folder = Folder::new();
    let text = folder.succeed(
        "bench --json --volume builtin:sphere:16 --size 32x32 --frames 1 --only orbit --set sampling.slab=1",
    );
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    assert_has_keys(&result, &["adapter", "driver", "cases"]);
    let cases = result["cases"].as_array().expect("a list");
    let orbit = cases.iter().find(|case| case["name"] == "orbit").expect("the case that was asked for");
    assert_has_keys(
        orbit,
        &["name", "volume", "dims", "size", "frames", "wall_ms", "cpu_ms", "stages", "light_rebuilds"],
    );
    assert_eq!(orbit["light_rebuilds"], 0);
    assert_eq!(orbit["frames"], 1);
    assert_eq!(orbit["size"], serde_json::json!([32, 32]));
    assert_eq!(orbit["dims"], serde_json::json!([16, 16, 16]));
    assert_eq!(keys(&orbit["wall_ms"]), ["max", "median", "min"]);
    assert_has_keys(&orbit["stages"], &["eye", "light_march", "light_raycast", "light_backproject"]);
    assert!(orbit["wall_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{orbit}");
    assert!(cases.iter().all(|case| case["name"] != "light-drag"), "only what was asked for");

    let text =
        folder.succeed("bench --json --volume builtin:sphere:16 --size 32x32 --frames 2 --only light-drag");
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let cases = result["cases"].as_array().expect("a list");
    let drag = cases.iter().find(|case| case["name"] == "light-drag").expect("the case that was asked for");
    assert_eq!(drag["light_rebuilds"], 2, "one for every frame");
}

#[test]
fn the_table_of_the_paper_has_its_three_variants() {
    let folder = Folder::new();
    let text = folder.succeed("bench --json --volume builtin:sphere:16 --size 32x32 --frames 1 --only paper");
    let result: Value = serde_json::from_str(&text).expect("one JSON object and nothing else");
    let cases = result["cases"].as_array().expect("a list");
    let names: Vec<_> = cases.iter().filter_map(|case| case["name"].as_str()).collect();
    assert_eq!(names, ["paper-1-direct", "paper-2-raycast", "paper-3-splat"]);
    let light = |at: usize| cases[at]["light_volume_ms"].as_f64().expect("a number");
    assert_eq!((light(0), &cases[0]["light_rebuilds"]), (0.0, &serde_json::json!(0)), "no light volume");
    assert!(light(1) > 0.0 && light(2) > 0.0, "{cases:?}");
    let ratio = &result["ratios"]["light_volume_raycast_over_splat"];
    assert_eq!(keys(ratio), ["measured", "paper"]);
}

#[test]
fn a_slice_of_light_is_a_picture_in_false_colours() {
    let folder = Folder::new();
    folder.succeed("light-volume builtin:sphere:16 -o slice.png --slice y:4 --set shadows.resolution=half");
    let slice = image::open(folder.path("slice.png")).expect("a picture").to_rgb8();
    assert_eq!(slice.dimensions(), (8, 8));
    let luma = |pixel: &image::Rgb<u8>| pixel.0.iter().map(|&c| u32::from(c)).sum::<u32>();
    let (dark, bright) = slice.pixels().map(luma).fold((u32::MAX, 0), |(a, b), l| (a.min(l), b.max(l)));
    assert!(dark < 300 && bright > 500, "a ball has a lit and a dark side: {dark} … {bright}");
}

#[test]
fn looks_stand_side_by_side_with_their_distances() {
    let folder = Folder::new();
    let text = folder.succeed("compare builtin:sphere:16 -o row.png --size 40x30 --looks splat,splat,off");
    let row = image::open(folder.path("row.png")).expect("a picture").to_rgba8();
    assert_eq!(row.dimensions(), (3 * 40 + 2 * 4, 30));
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[1].starts_with("splat") && lines[1].contains("RMSE   0.00"), "{text}");
    assert!(lines[2].starts_with("off") && !lines[2].contains("RMSE   0.00"), "{text}");
}
