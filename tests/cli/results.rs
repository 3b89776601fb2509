//! Results that are not written, and what is told beside those that are.

use std::fs;

use crate::program::Folder;

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
    folder.succeed("render builtin:sphere:16 -o out.png --size 16x12");
    let older = folder.read("out.png");
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

#[test]
fn what_is_read_is_never_replaced() {
    let folder = Folder::new();
    folder.succeed("light-volume builtin:sphere:16 -o v.nrrd");
    folder.succeed("render builtin:sphere:16 --size 16x16 -o s.png --report s.json");
    let names = ["v.nrrd", "s.png", "s.json"];
    let before = names.map(|name| folder.read(name));
    for (args, code) in [
        ("light-volume v.nrrd -o ./v.nrrd", 2),
        ("render v.nrrd -o v.nrrd", 2),
        ("render builtin:sphere:16 --session s.png -o s.png", 2),
        ("render builtin:sphere:16 --preset s.json -o a.png --report ./s.json", 2),
        ("render builtin:sphere:16 -o a.png --report a.png", 2),
        ("turntable builtin:sphere:16 --session s.png -o s.png --frames 2 --size 16x16", 2),
        ("replay s.png -o s.png", 2),
        // Nor do pictures get names of other things.
        ("render builtin:sphere:16 --size 16x16 -o v.nrrd", 6),
        ("render builtin:sphere:16 --size 16x16 -o s.json", 6),
        ("compare builtin:sphere:16 --size 16x16 -o v.nrrd", 6),
        ("light-volume builtin:sphere:16 -o s.json", 6),
        ("light-volume builtin:sphere:16 --slice z:3 -o v.nrrd", 6),
    ] {
        let said = folder.fail(args, code);
        assert!(said.contains("help") || said.contains("are written as"), "`{args}`: {said}");
        assert_eq!(names.map(|name| folder.read(name)), before, "`{args}` changed a file");
    }
}

#[cfg(unix)]
#[test]
fn only_files_are_replaced() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = Folder::new();
    let _socket = std::os::unix::net::UnixListener::bind(folder.path("x.png")).expect("a socket");
    std::os::unix::fs::symlink("x.png", folder.path("link.png")).expect("a link");
    for name in ["x.png", "link.png"] {
        let said = folder.fail(&format!("render builtin:sphere:16 --size 16x16 -o {name}"), 6);
        assert!(said.contains("socket") && said.contains(name), "{said}");
    }
    let kind = fs::metadata(folder.path("x.png")).expect("it is there").file_type();
    assert!(kind.is_socket(), "it is what it was");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("the device that is always full");
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
        .args(["info", "builtin:sphere:16", "--json"])
        .stdout(full)
        .status()
        .expect("the program can be started");
    assert_eq!(status.code(), Some(6));
}

#[test]
fn names_from_files_cannot_talk_to_the_terminal() {
    let folder = Folder::new();
    folder.write("e.json", "{\"\\u001b]0;taken\\u0007\": 1, \"shadows\": {\"\\u001b[2J\": 2}}");
    let outcome = folder.run("render builtin:sphere:16 --size 16x16 -o out.png --session e.json");
    assert!(outcome.stderr.contains("taken"), "what is unknown is named: {outcome:?}");
    assert!(!outcome.stderr.contains('\u{1b}') && !outcome.stderr.contains('\u{7}'), "{outcome:?}");
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

#[test]
fn progress_is_told_beside_the_result() {
    let folder = Folder::new();
    let outcome = folder.run("render builtin:sphere:16 -o out.png --size 16x16 --progress");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("loading") && outcome.stderr.contains("rendering"), "{outcome:?}");
    assert_eq!(outcome.stdout, "out.png\n");
}
