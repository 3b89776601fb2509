//! Tests of memory limits against small hostile files: looks and pictures with false sizes, compressed bombs or
//! repetition.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use chiaroscuro_media::{ExportError, PixelRows, read_record, write_picture};
use chiaroscuro_scene::{ImageSpec, PixelFormat};

use crate::program::{COMMAND_TIMEOUT, ProgramFolder};
use crate::volumes::attached;

/// Memory that a hostile file may take beyond the same run without it, in MiB. Before limits were added, these took
/// 5.5 GB.
const MAX_EXTRA_MEBIBYTES: u64 = 200;

/// Time by which a hostile file may delay a run, on machines that are busy as well; 51 s before limits were added.
const MAX_EXTRA_TIME: Duration = Duration::from_secs(10);

/// Outcome and cost of a run.
#[derive(Debug)]
struct RunCost {
    code: Option<i32>,
    stderr: String,
    took: Duration,
    /// Peak memory (`VmHWM`) shortly before the end of the run, in MiB.
    peak: u64,
}

/// Runs the program and watches its memory, where the system reports it.
fn run_and_measure(folder: &ProgramFolder, args: &str) -> RunCost {
    let stderr = tempfile::NamedTempFile::new().expect("a temporary file");
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
        .args(args.split_whitespace())
        .current_dir(folder.path(""))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(stderr.reopen().expect("a second handle"))
        .spawn()
        .expect("the program can be started");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    let code = loop {
        if let Some(status) = child.try_wait().expect("the program can be waited for") {
            break status.code();
        }
        let text = fs::read_to_string(&status).unwrap_or_default();
        let now = text
            .lines()
            .find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")?.parse().ok());
        peak = peak.max(now.unwrap_or(0) >> 10);
        if start.elapsed() > COMMAND_TIMEOUT {
            child.kill().expect("the program can be ended");
            panic!("`{args}` takes longer than {COMMAND_TIMEOUT:?} and {peak} MiB");
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let stderr = fs::read_to_string(stderr.path()).expect("UTF-8");
    RunCost { code, stderr, took: start.elapsed(), peak }
}

/// Runs a command and compares its cost with that of a run without its file.
fn assert_cheap(folder: &ProgramFolder, args: &str, base: &RunCost, code: i32, said: &str) {
    let cost = run_and_measure(folder, args);
    assert_eq!(cost.code, Some(code), "`{args}`: {cost:?}");
    assert!(cost.stderr.contains(said), "`{args}` should say {said:?}: {:.2000}", cost.stderr);
    assert!(cost.stderr.len() < 20_000, "`{args}` says {} bytes", cost.stderr.len());
    assert!(
        cost.peak <= base.peak + MAX_EXTRA_MEBIBYTES,
        "`{args}`: {} MiB, {} without",
        cost.peak,
        base.peak
    );
    assert!(cost.took <= base.took + MAX_EXTRA_TIME, "`{args}`: {:?}, {:?} without", cost.took, base.took);
}

/// Writes a PNG of one pixel with a compressed text chunk.
fn write_png_with_text(text: &str, path: &std::path::Path) {
    let mut info = png::Info::with_size(1, 1);
    let mut chunk = png::text_metadata::ITXtChunk::new("chiaroscuro", text);
    chunk.compressed = true;
    chunk.compress_text().expect("it can be compressed");
    info.utf8_text.push(chunk);
    let file = fs::File::create(path).expect("the folder can be written to");
    let mut writer = png::Encoder::with_info(file, info).expect("a picture").write_header().expect("written");
    writer.write_image_data(&[0]).expect("written");
    writer.finish().expect("written");
}

#[test]
fn looks_cannot_make_much_of_little() {
    let folder = ProgramFolder::new();
    let render = "render builtin:box:16 -o o.png --size 16x16";
    let base = run_and_measure(&folder, render);
    assert_eq!(base.code, Some(0), "{base:?}");

    let lights = |count: usize| format!("{{\"lights\": [{}{{}}]}}", "{},".repeat(count - 1));
    write_png_with_text(&lights(2_000_000), &folder.path("lights.png"));
    assert!(read_record(&folder.path("lights.png")).is_err_and(|err| err.to_string().contains("space")));
    assert!(folder.read("lights.png").len() < 1 << 17, "a small file");
    write_png_with_text(&lights(340_000), &folder.path("fewer.png"));
    let named = |length: usize| format!("{{\"lights\": [{{\"name\": \"{}\"}}]}}", "n".repeat(length));
    folder.write("name.json", named(4_000_000));
    folder.write("shorter.json", named(1_000_000));
    let point = "{\"value\":0,\"opacity\":0},";
    let points = |count: usize| {
        format!("{{\"transfer\":{{\"points\":[{}]}}}}", point.repeat(count).trim_end_matches(','))
    };
    folder.write("points.json", points(60_000));
    folder.write("fewer.json", points(43_000));
    folder.write("nested.json", format!("{}1{}", "{\"a\":".repeat(200), "}".repeat(200)));
    folder.write(
        "fields.json",
        format!(
            "{{\"a\": {{{}\"\": 0}}}}",
            (0..90_000).map(|at| format!("\"{at:x}\":0,")).collect::<Vec<_>>().concat()
        ),
    );
    let lists = format!("[{}[]]", "[],".repeat(4000));
    folder.write("lists.json", format!("{{\"a\": [{}[]]}}", format!("{lists},").repeat(80)));
    for (file, code, said) in [
        ("lights.png", 6, "space"),
        ("fewer.png", 0, "340000 entries of `lights` were cut to 8"),
        ("name.json", 3, "a look has at most"),
        ("shorter.json", 0, "a text of 1000000 characters was cut to 200"),
        ("points.json", 3, "a look has at most"),
        ("fewer.json", 0, "43000 entries of `transfer.points` were cut to 4096"),
        ("nested.json", 3, "nested deeper"),
        ("fields.json", 0, "90001 entries of `a` were cut to 4096"),
        ("lists.json", 3, "more than the 197768 values"),
    ] {
        assert_cheap(&folder, &format!("{render} --session {file}"), &base, code, said);
    }
}

#[test]
fn pictures_are_measured_before_they_are_decoded() {
    let folder = ProgramFolder::new();
    folder.run_successfully("render builtin:box:16 -o good.png --size 8x8");
    let base = run_and_measure(&folder, "replay good.png");
    assert_eq!(base.code, Some(0), "{base:?}");

    // The header claims 32768 × 32768 pixels; the record says 8 × 8.
    let mut claims = folder.read("good.png");
    for at in [16, 20] {
        claims[at..at + 4].copy_from_slice(&32_768u32.to_be_bytes());
    }
    let mut sum = flate2::Crc::new();
    sum.update(&claims[12..29]);
    claims[29..33].copy_from_slice(&sum.sum().to_be_bytes());
    folder.write("claims.png", claims);
    assert_cheap(&folder, "replay claims.png", &base, 3, "[32768, 32768] pixels and not [8, 8]");

    // As many columns as a header can state.
    let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new([2, 2]) };
    let record = read_record(&folder.path("good.png")).expect("a picture").expect("a record");
    let mut rows = Some(PixelRows::Floats(vec![0.0; 16]));
    let mut next = || Ok::<_, ExportError>(rows.take());
    write_picture(&folder.path("claims.exr"), &image_spec, Some(&record), &mut next).expect("written");
    let mut claims = folder.read("claims.exr");
    for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        // A length of four bytes, then the smallest and the largest column and row.
        let at = claims.windows(name.len()).position(|bytes| bytes == name).expect("it is there")
            + name.len()
            + 12;
        claims[at..at + 4].copy_from_slice(&((1 << 24) - 1i32).to_le_bytes());
        claims[at + 4..at + 8].copy_from_slice(&((1 << 14) - 1i32).to_le_bytes());
    }
    folder.write("claims.exr", claims);
    assert_cheap(&folder, "replay claims.exr", &base, 6, "16777216 × 16384 pixels");
}

#[test]
fn data_that_no_number_can_span_and_unlike_spacings_are_refused_in_words() {
    let folder = ProgramFolder::new();
    let mut far = b"NRRD0004\ntype: double\ndimension: 3\nencoding: raw\nendian: little\nsizes: 2 1 1\nspacings: 1 1 1\n\n".to_vec();
    far.extend([-1.5e308f64, 1.5e308].into_iter().flat_map(f64::to_le_bytes));
    folder.write("far.nrrd", far);
    let said = folder.check_refused("far.nrrd", &[3]);
    assert!(said.contains("from -1.5e308 to 1.5e308"), "{said}");
    folder.write("flat.nrrd", attached("sizes: 4 4 4\nspacings: 1e-9 1e9 1", 64));
    // Spacings that are implausible together are corrected, with a note.
    let said = folder.run_successfully("info flat.nrrd");
    assert!(said.contains("1 × 1 × 1 mm") && said.contains("note"), "{said}");
    folder.write("x_4x4x4_uint8.raw", [0; 64]);
    let said = folder.check_refused("x_4x4x4_uint8.raw --spacing 1x1x20000", &[3]);
    assert!(said.contains("--spacing"), "{said}");
}

/// Under a limit on the address space, drivers abort the program if they get no memory, and the thread pool if it
/// gets no threads; with more cores both need more. Other systems have no such limit.
#[cfg(target_os = "linux")]
#[test]
fn too_few_addresses_are_an_error_and_no_crash() {
    let folder = ProgramFolder::new();
    let lower = [400_000, 600_000, 650_000, 700_000, 800_000, 900_000, 1_000_000, 1_100_000];
    for kibibytes in lower.into_iter().chain([1_200_000, 1_300_000, 1_400_000, 1_600_000, 1_800_000]) {
        let limited =
            format!("ulimit -v {kibibytes}; exec \"$0\" render builtin:sphere:200 -o o.png --size 64x64");
        let ran = Command::new("bash")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_chiaroscuro")])
            .current_dir(folder.path(""))
            .output()
            .expect("there is a shell");
        let code = ran.status.code();
        assert!(
            matches!(code, Some(0 | 4 | 5)),
            "{kibibytes} KiB: {code:?}: {}",
            String::from_utf8_lossy(&ran.stderr)
        );
    }
}

#[test]
fn files_that_unfold_to_a_gibibyte_are_spoken_of_and_thinned_for_a_glance() {
    use std::io::Write as _;
    // Zeros as 512 gzip members of 2 MiB each.
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&vec![0; 2 << 20]).expect("memory");
    let member = encoder.finish().expect("memory");
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nencoding: gzip\nsizes: 1024 1024 1024\n\n";
    let folder = ProgramFolder::new();
    folder.write("zeros.nrrd", [header.as_bytes(), &member.repeat(512)].concat());
    let base = folder.run("info builtin:box:16");
    let outcome = folder.run("info zeros.nrrd");
    assert_eq!((base.code, outcome.code), (Some(0), Some(0)), "{outcome:?}");
    for words in ["of files decompress to 1024 × 1024 × 1024 voxels (1.0 GiB)", "a stride of 3", "--every 1"]
    {
        assert!(outcome.stderr.contains(words), "{words}: {outcome:?}");
    }
    assert!(outcome.stdout.contains("342 × 342 × 342, uint8"), "{outcome:?}");
    assert!(outcome.stdout.contains("1024 × 1024 × 1024"), "{outcome:?}");
    // A user who states how much is read knows the size.
    let outcome = folder.run("info zeros.nrrd --every 64");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!outcome.stderr.contains("decompress"), "{outcome:?}");
    assert!(outcome.stdout.contains("16 × 16 × 16, uint8"), "{outcome:?}");
}
