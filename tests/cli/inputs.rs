//! Tests of volumes that are refused as input.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::program::ProgramFolder;
use crate::volumes::{attached, gzipped, header, small_ball};

#[test]
fn files_that_are_not_there_or_no_files_are_io_errors() {
    let folder = ProgramFolder::new();
    fs::create_dir(folder.path("directory.raw")).expect("the folder can be written to");
    for file in ["missing.raw", "missing.nrrd", "no/such/folder/x.nrrd"] {
        folder.check_refused(file, &[6]);
    }
    // A folder may be a volume of slices.
    for file in ["directory.raw", "."] {
        folder.check_refused(file, &[3]);
    }
}

#[cfg(unix)]
#[test]
fn files_that_may_not_be_read_are_io_errors() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = ProgramFolder::new();
    folder.write("secret_8x8x8_uint8.raw", small_ball());
    let path = folder.path("secret_8x8x8_uint8.raw");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).expect("it is our file");
    if fs::File::open(&path).is_ok() {
        println!("not checked: file permissions, which do not restrict this user (root?)");
        return;
    }
    folder.check_refused("secret_8x8x8_uint8.raw", &[6]);
}

/// Files that open and look like any other, but cannot be read by any user, root included.
#[cfg(target_os = "linux")]
#[test]
fn files_whose_reading_fails_are_io_errors() {
    let folder = ProgramFolder::new();
    // Memory of the program itself: the start of the address space is not mapped.
    let memory = "/proc/self/mem";
    assert!(fs::metadata(memory).expect("it is there").is_file() && fs::read(memory).is_err());
    for file in ["memory.nrrd", "memory.nhdr", "memory_8x8x8_uint8.raw.gz"] {
        std::os::unix::fs::symlink(memory, folder.path(file)).expect("the folder can be written to");
        folder.check_refused(file, &[6]);
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_and_never_waited_for() {
    let folder = ProgramFolder::new();
    let made = Command::new("mkfifo").arg(folder.path("pipe.raw")).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo is part of every Unix");
    folder.check_refused("pipe.raw", &[6]);
    folder.check_refused("/dev/zero", &[6]);
}

#[test]
fn volumes_of_the_wrong_size_are_bad_input() {
    let folder = ProgramFolder::new();
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
        folder.check_refused(file, &[3]);
    }
    let said = folder.run_failing("info short_8x8x8_uint8.raw", 3);
    assert!(said.contains("512") && said.contains("511"), "expected and found sizes: {said}");
}

#[test]
fn truncated_compressed_volumes_are_bad_input() {
    let folder = ProgramFolder::new();
    // Noise, so that the compressed file is long enough to be truncated.
    let noise: Vec<u8> = (0..4096u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let whole = gzipped(&noise);
    folder.write("whole_16x16x16_uint8.raw.gz", &whole);
    folder.run_successfully("info whole_16x16x16_uint8.raw.gz");
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
        folder.check_refused(file, &[3]);
    }
}

#[test]
fn enormous_claims_are_refused_at_once() {
    let folder = ProgramFolder::new();
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
        folder.check_refused(file, &[3, 5]);
    }
    folder.run_failing("info builtin:sphere:100000", 3);
    // Data behind a header that does not end.
    folder.write("endless.nrrd", [b"NRRD0004\n".to_vec(), vec![b'x'; 4 << 20]].concat());
    folder.check_refused("endless.nrrd", &[3, 5]);
}

#[test]
fn spacings_that_are_no_lengths_are_bad_input() {
    let folder = ProgramFolder::new();
    folder.write("ball_8x8x8_uint8.raw", small_ball());
    for spacing in ["nanx1x1", "infx1x1", "0x1x1", "-1x1x1", "1e300x1x1"] {
        folder.check_refused(&format!("ball_8x8x8_uint8.raw --spacing={spacing}"), &[2, 3]);
    }
    for (name, line) in [("words.nrrd", "spacings: a b c"), ("few.nrrd", "spacings: 1 1")] {
        folder.write(name, attached(&format!("sizes: 8 8 8\n{line}"), 512));
        folder.check_refused(name, &[3]);
    }
    // Impossible values are corrected, with a note.
    for (name, line) in [
        ("infinite.nrrd", "spacings: inf 1 1"),
        ("zero.nrrd", "spacings: 0 1 1"),
        ("nan.nrrd", "space: left-posterior-superior\nspace directions: (nan,0,0) (0,1,0) (0,0,1)"),
        ("flat.nrrd", "space: left-posterior-superior\nspace directions: (1,0,0) (1,0,0) (0,0,1)"),
    ] {
        folder.write(name, attached(&format!("sizes: 8 8 8\n{line}"), 512));
        let facts = folder.run_successfully(&format!("info {name} --json"));
        let facts: Value = serde_json::from_str(&facts).expect("valid JSON");
        assert_eq!(facts["spacing_mm"], serde_json::json!([1.0, 1.0, 1.0]), "{name}");
        assert!(facts["remarks"].as_array().is_some_and(|remarks| !remarks.is_empty()), "{name}: {facts}");
    }
    // NRRD writes nan for an unknown spacing, which becomes 1 mm.
    folder.write("unknown.nrrd", attached("sizes: 8 8 8\nspacings: nan 1 2", 512));
    let facts: Value =
        serde_json::from_str(&folder.run_successfully("info unknown.nrrd --json")).expect("valid JSON");
    assert_eq!(facts["spacing_mm"], serde_json::json!([1.0, 1.0, 2.0]));
}

#[test]
fn headers_cannot_name_files_outside_their_folder() {
    let folder = ProgramFolder::new();
    folder.write("outside.raw", small_ball());
    fs::create_dir(folder.path("inside")).expect("the folder can be written to");
    let absolute = folder.path("outside.raw").to_string_lossy().into_owned();
    for data_file in
        ["../../etc/passwd", "../outside.raw", "/etc/passwd", &absolute, "x/../../outside.raw", "C:\\x", ".."]
    {
        folder.write("inside/bad.nhdr", header(&format!("sizes: 8 8 8\ndata file: {data_file}")));
        let said = folder.check_refused("inside/bad.nhdr", &[3]);
        assert!(!said.contains("root:"), "nothing of the file may be shown: {said}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("outside.raw"), folder.path("inside/link.raw"))
            .expect("links can be made");
        folder.write("inside/bad.nhdr", header("sizes: 8 8 8\ndata file: link.raw"));
        folder.check_refused("inside/bad.nhdr", &[3]);
    }
    folder.write("good.nhdr", header("sizes: 8 8 8\ndata file: ./outside.raw"));
    folder.run_successfully("info good.nhdr");
}

#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_opened() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = ProgramFolder::new();
    let name = std::ffi::OsStr::from_bytes(b"a\xff_8x8x8_uint8.raw");
    fs::write(folder.path("x").with_file_name(name), small_ball()).expect("the folder can be written to");
    for args in [&["info"][..], &["render", "-o", "out.png", "--size", "16x16"]] {
        let status = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
            .args(args)
            .arg(name)
            .current_dir(folder.path(""))
            .output()
            .expect("the program can be started");
        assert!(status.status.success(), "{args:?}: {status:?}");
    }
    assert!(folder.names().contains(&"out.png".to_owned()));
}
