//! Tests of results that cannot be written, and of messages beside results.

use std::fs;

use crate::program::ProgramFolder;

#[test]
fn results_that_cannot_be_written_are_io_errors() {
    let folder = ProgramFolder::new();
    fs::create_dir(folder.path("directory")).expect("the folder can be written to");
    for (args, name) in [
        ("render builtin:sphere:16 --size 16x16 -o no/such/folder/out.png", "no/such/folder/out.png"),
        ("light-volume builtin:sphere:16 -o no/such/folder/out.nrrd", "no/such/folder/out.nrrd"),
        ("render builtin:sphere:16 --size 16x16 -o directory", "directory"),
    ] {
        let said = folder.run_failing(args, 6);
        assert!(said.contains(name), "`{args}` should name the file: {said}");
    }
}

#[test]
fn failures_leave_an_older_result_as_it_was() {
    let folder = ProgramFolder::new();
    folder.write("short_8x8x8_uint8.raw", vec![0; 511]);
    folder.write("words.json", "this is no JSON");
    folder.run_successfully("render builtin:sphere:16 -o out.png --size 16x12");
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
        folder.run_failing(args, code);
        assert_eq!(folder.read("out.png"), older, "`{args}` changed the file that was there");
    }
}

#[test]
fn a_report_that_cannot_be_written_fails_the_command() {
    let folder = ProgramFolder::new();
    let args = "render builtin:sphere:16 --size 16x16 -o out.png --report no/such/folder/r.json";
    let outcome = folder.run(args);
    assert_eq!(outcome.code, Some(6), "{outcome:?}");
    assert!(outcome.stderr.contains("no/such/folder/r.json"), "{outcome:?}");
    assert_eq!(folder.names(), Vec::<String>::new(), "a failed command writes nothing");
}

#[test]
fn inputs_are_never_replaced() {
    let folder = ProgramFolder::new();
    folder.run_successfully("light-volume builtin:sphere:16 -o v.nrrd");
    folder.run_successfully("render builtin:sphere:16 --size 16x16 -o s.png --report s.json");
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
        // Pictures are not written under extensions of other formats.
        ("render builtin:sphere:16 --size 16x16 -o v.nrrd", 6),
        ("render builtin:sphere:16 --size 16x16 -o s.json", 6),
        ("compare builtin:sphere:16 --size 16x16 -o v.nrrd", 6),
        ("light-volume builtin:sphere:16 -o s.json", 6),
        ("light-volume builtin:sphere:16 --slice z:3 -o v.nrrd", 6),
    ] {
        let said = folder.run_failing(args, code);
        assert!(said.contains("choose") || said.contains("are written as"), "`{args}`: {said}");
        assert_eq!(names.map(|name| folder.read(name)), before, "`{args}` changed a file");
    }
}

#[cfg(unix)]
#[test]
fn only_files_are_replaced() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = ProgramFolder::new();
    let _socket = std::os::unix::net::UnixListener::bind(folder.path("x.png")).expect("a socket");
    std::os::unix::fs::symlink("x.png", folder.path("link.png")).expect("a link");
    for name in ["x.png", "link.png"] {
        let said = folder.run_failing(&format!("render builtin:sphere:16 --size 16x16 -o {name}"), 6);
        assert!(said.contains("socket") && said.contains(name), "{said}");
    }
    let kind = fs::metadata(folder.path("x.png")).expect("it is there").file_type();
    assert!(kind.is_socket(), "the socket must remain");
}

/// Exit code and standard error of a shell script, in which `$B` is the program.
#[cfg(unix)]
fn run_shell(folder: &ProgramFolder, script: &str) -> (Option<i32>, String) {
    let output = std::process::Command::new("sh")
        .args(["-c", script])
        .env("B", env!("CARGO_BIN_EXE_chiaroscuro"))
        .current_dir(folder.path(""))
        .output()
        .expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_is_full_or_closed_is_an_error() {
    let folder = ProgramFolder::new();
    for args in [
        "info builtin:sphere:16",
        "info builtin:sphere:16 --json",
        "convert builtin:sphere:16 -",
        "render builtin:sphere:16 --size 16x12 -o -",
        "--version",
        "--help",
        "help",
        "help render",
        "render --help",
    ] {
        for to in [">/dev/full", ">&-"] {
            let (code, said) = run_shell(&folder, &format!("$B {args} {to}"));
            assert_eq!(code, Some(6), "{args} {to}: {said}");
            assert!(said.contains("could not write to standard output"), "{args} {to}: {said}");
        }
        // Output to the null device is no error, however it was opened.
        for to in [">/dev/null", "<>/dev/null 1>&0"] {
            let (code, said) = run_shell(&folder, &format!("$B {args} {to}"));
            assert_eq!(code, Some(0), "{args} {to}: {said}");
        }
    }
    assert_eq!(folder.names(), Vec::<String>::new());
}

#[cfg(unix)]
#[test]
fn a_limit_of_file_sizes_is_a_full_disk() {
    let folder = ProgramFolder::new();
    let (code, said) = run_shell(&folder, "ulimit -f 4; $B convert builtin:sphere:64 f.nrrd");
    assert_eq!(code, Some(6), "{said}");
    assert!(said.contains("f.nrrd") && said.starts_with("error: "), "{said}");
    assert_eq!(folder.names(), Vec::<String>::new(), "nothing unfinished stays");
}

#[test]
fn error_messages_are_one_line() {
    let folder = ProgramFolder::new();
    image::RgbImage::from_fn(64, 32, |x, y| image::Rgb([x as u8, y as u8, 7]))
        .save(folder.path("whole.jpg"))
        .expect("the folder can be written to");
    folder.write("cut.jpg", &folder.read("whole.jpg")[..400]);
    let render = "render builtin:box:16 --size 16x16 -o out.png";
    for (args, code) in [("--surroundings cut.jpg", 3), ("--fault shader", 4)] {
        let outcome = folder.run(&format!("{render} {args}"));
        assert_eq!(outcome.code, Some(code), "{outcome:?}");
        let message = outcome.error_message().expect("a message");
        assert_eq!(message.trim_end_matches('\n').lines().count(), 1, "{message}");
        assert!(outcome.stderr.lines().all(|line| !line.trim().is_empty()), "{outcome:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_environment_is_named_where_it_hides_the_adapters() {
    let folder = ProgramFolder::new();
    let render = "render builtin:box:16 --size 16x16 -o out.png";
    let said = folder.fail_with(render, 4, &[("WGPU_ADAPTER_NAME", "nothing")]);
    assert!(said.contains("no adapter is called \"nothing\" (WGPU_ADAPTER_NAME): there are \""), "{said}");
    let said = folder.fail_with(render, 4, &[("WGPU_BACKEND", "gl")]);
    assert!(said.contains("WGPU_BACKEND is \"gl\"") && said.contains("vulkan"), "{said}");
}

#[cfg(all(target_os = "linux", feature = "window"))]
#[test]
fn without_a_display_the_reason_is_told_without_places_in_libraries() {
    let folder = ProgramFolder::new();
    let (code, said) =
        run_shell(&folder, "env -u DISPLAY -u WAYLAND_DISPLAY -u WAYLAND_SOCKET $B builtin:box:16");
    assert_eq!(code, Some(4), "{said}");
    assert!(said.contains("DISPLAY is set"), "{said}");
    assert!(!said.contains(".rs:") && !said.contains("registry"), "{said}");
}

#[test]
fn names_from_files_cannot_talk_to_the_terminal() {
    let folder = ProgramFolder::new();
    folder.write("e.json", "{\"\\u001b]0;taken\\u0007\": 1, \"shadows\": {\"\\u001b[2J\": 2}}");
    let outcome = folder.run("render builtin:sphere:16 --size 16x16 -o out.png --session e.json");
    assert!(outcome.stderr.contains("taken"), "unknown settings must be named: {outcome:?}");
    assert!(!outcome.stderr.contains('\u{1b}') && !outcome.stderr.contains('\u{7}'), "{outcome:?}");
}

/// Only on Linux can the drivers be hidden from a program.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_message_says_what_to_install() {
    let folder = ProgramFolder::new();
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
    // Commands that need no adapter still work.
    assert_eq!(folder.run_with("info builtin:sphere:16", &hidden).code, Some(0));
}

#[test]
fn progress_is_told_beside_the_result() {
    let folder = ProgramFolder::new();
    let outcome = folder.run("render builtin:sphere:16 -o out.png --size 16x16 --progress");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("loading") && outcome.stderr.contains("rendering"), "{outcome:?}");
    assert_eq!(outcome.stdout, "out.png\n");
}
