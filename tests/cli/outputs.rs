//! Tests of output files: targets, replacing existing files, and cleaning up when the program is terminated.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::{COMMAND_TIMEOUT, ProgramFolder};

const RENDER: &str = "render builtin:sphere:16 --size 16x12";

#[test]
fn files_of_other_programs_are_replaced_only_by_force() {
    let folder = ProgramFolder::new();
    let other_picture = b"\x89PNG\r\n\x1a\n somebody's picture".to_vec();
    folder.write("p.png", &other_picture);
    folder.write("l.nrrd", "NRRD0004\n# somebody's volume\n");
    folder.write("r.json", r#"{"notes": "somebody's"}"#);
    std::fs::create_dir(folder.path("turn")).expect("a folder");
    folder.write("turn/0001.png", &other_picture);
    for args in [
        format!("{RENDER} -o p.png"),
        format!("{RENDER} -o q.png --report r.json"),
        "light-volume builtin:sphere:16 -o l.nrrd".to_owned(),
        "compare builtin:sphere:16 --size 16x12 -o p.png".to_owned(),
        "turntable builtin:sphere:16 --size 16x12 --frames 2 -o p.png".to_owned(),
        "turntable builtin:sphere:16 --size 16x12 --frames 2 -o turn".to_owned(),
    ] {
        let said = folder.run_failing(&args, 2);
        assert!(said.contains("--force"), "{said}");
    }
    assert_eq!(folder.read("p.png"), other_picture);
    folder.run_successfully(&format!("{RENDER} -o p.png --force --report r.json"));
    assert_eq!(folder.json("r.json")["image_size"][0], 16);
    folder.write("again.png", &other_picture);
    assert!(folder.run_failing("replay p.png -o again.png", 2).contains("--force"));
    assert_eq!(folder.read("again.png"), other_picture);
    folder.run_successfully("replay p.png -o again.png --force");
    // Other files of a folder stay.
    folder.write("turn/notes.txt", "mine");
    folder.run_successfully("turntable builtin:sphere:16 --size 16x12 --frames 2 -o turn --force");
    assert_eq!(folder.read("turn/notes.txt"), b"mine");
    assert_ne!(folder.read("turn/0001.png"), other_picture);
    // An empty file contains nothing to lose.
    folder.write("e.png", "");
    folder.run_successfully(&format!("{RENDER} -o e.png"));
}

#[test]
fn files_of_the_program_say_so_and_are_replaced() {
    let folder = ProgramFolder::new();
    let turn = "turntable builtin:sphere:16 --size 16x12 --frames 2";
    // Twice: files written by the first run may be replaced by the second.
    for _ in 0..2 {
        folder.run_successfully(&format!("{RENDER} -o p.png --report r.json"));
        folder.run_successfully(&format!("{RENDER} -o p.exr"));
        folder.run_successfully("light-volume builtin:sphere:16 -o l.nrrd");
        folder.run_successfully("light-volume builtin:sphere:16 -o slice.png --slice z:3");
        folder.run_successfully("compare builtin:sphere:16 --size 16x12 -o c.png");
        for file in ["t.png", "t.gif", "turn"] {
            folder.run_successfully(&format!("{turn} -o {file}"));
        }
    }
    let mark = chiaroscuro_files::PROVENANCE_MARK.as_bytes();
    for name in
        ["p.png", "r.json", "p.exr", "l.nrrd", "slice.png", "c.png", "t.png", "t.gif", "turn/0001.png"]
    {
        let bytes = folder.read(name);
        assert!(bytes.windows(mark.len()).any(|window| window == mark), "{name}");
    }
    folder.run_successfully("info l.nrrd");
}

/// Runs a command whose standard output is binary, and returns the bytes.
fn standard_output(folder: &ProgramFolder, args: &str) -> Vec<u8> {
    let output = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
        .args(args.split_whitespace())
        .current_dir(folder.path(""))
        .output()
        .expect("the program can be started");
    assert!(output.status.success(), "{args}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn a_dash_is_standard_output() {
    let folder = ProgramFolder::new();
    folder.run_successfully(&format!("{RENDER} -o p.png"));
    let pixels = |bytes: &[u8]| image::load_from_memory(bytes).expect("a picture").to_rgba8().into_raw();
    let piped = standard_output(&folder, &format!("{RENDER} -o -"));
    assert!(pixels(&piped) == pixels(&folder.read("p.png")));
    folder.run_successfully("light-volume builtin:sphere:16 -o l.nrrd");
    assert!(standard_output(&folder, "light-volume builtin:sphere:16 -o -") == folder.read("l.nrrd"));
    let report = standard_output(&folder, &format!("{RENDER} -o p.png --report -"));
    let report: serde_json::Value = serde_json::from_slice(&report).expect("nothing but the report");
    assert_eq!(report["image_size"][1], 12);
    let stages = report["to_picture_ms"].as_object().expect("times from the start to the picture");
    let of = |stage: &str| stages[stage].as_f64().expect("a time");
    let named: f64 = stages
        .keys()
        .filter(|stage| !["all", "parallel"].contains(&stage.as_str()))
        .map(|stage| of(stage))
        .sum();
    assert!(
        (named - of("all")).abs() < 1e-6 * named && of("shaders") > 0.0 && of("picture") > 0.0,
        "{stages:?}"
    );
    for part in ["volume", "instance", "device"] {
        assert!(stages["parallel"][part].as_f64() > Some(0.0), "{part}: {stages:?}");
    }
    folder.run_failing(&format!("{RENDER} -o - --report -"), 2);
    folder.run_failing("turntable builtin:sphere:16 --frames 2 -o -", 2);
    assert_eq!(folder.names(), ["l.nrrd", "p.png"]);
}

/// Starts an animation export that is too long to wait for.
fn start_long_animation(folder: &ProgramFolder) -> std::process::Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"));
    start_animation(&mut command, folder)
}

/// Starts the long animation export by a command that takes the program as its last argument, if it has arguments.
fn start_animation(command: &mut Command, folder: &ProgramFolder) -> std::process::Child {
    let child = command
        .args("turntable builtin:sphere:16 --size 640x480 --frames 3600 -o t.png".split_whitespace())
        .current_dir(folder.path(""))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program can be started");
    let begin = Instant::now();
    while folder.names().is_empty() {
        assert!(begin.elapsed() < COMMAND_TIMEOUT, "no output file was created");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(folder.names()[0].contains(".part"), "{:?}", folder.names());
    child
}

#[cfg(unix)]
#[test]
fn temporary_files_are_removed() {
    let folder = ProgramFolder::new();
    let send = |signal: &str, child: &std::process::Child| {
        let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(sent.expect("kill is there").success());
    };
    // Exit codes as in shells: 128 plus the number of the signal.
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let mut child = start_long_animation(&folder);
        send(signal, &child);
        assert_eq!(child.wait().expect("it ends").code(), Some(code), "{signal}");
        assert_eq!(folder.names(), Vec::<String>::new(), "{signal}");
    }
    // A program started with a signal ignored (`nohup`) continues, where the system reports that.
    #[cfg(target_os = "linux")]
    {
        let ignoring = ["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_chiaroscuro")];
        let mut child = start_animation(Command::new("sh").args(ignoring), &folder);
        send("HUP", &child);
        std::thread::sleep(Duration::from_millis(300));
        assert!(child.try_wait().expect("its state is known").is_none(), "the signal must be ignored");
        send("TERM", &child);
        assert_eq!(child.wait().expect("it ends").code(), Some(143));
    }
    let mut child = start_long_animation(&folder);
    // The temporary file of a running process stays while another process writes beside it.
    folder.run_successfully(&format!("{RENDER} -o p.png"));
    assert_eq!(folder.names().len(), 2);
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    assert_eq!(folder.names().len(), 2, "a killed process removes no files");
    folder.run_successfully(&format!("{RENDER} -o p.png"));
    assert_eq!(folder.names(), ["p.png"]);
}

#[test]
fn a_full_disk_is_reported_and_changes_nothing() {
    let folder = ProgramFolder::new();
    folder.run_successfully(&format!("{RENDER} -o p.png"));
    let before = folder.read("p.png");
    let said = folder.run_failing(&format!("{RENDER} -o p.png --set shadows.gain=2 --fault full-disk"), 6);
    assert!(said.contains("p.png"), "{said}");
    assert_eq!(folder.read("p.png"), before);
}

#[test]
fn refused_memory_and_lost_shaders_are_said() {
    let folder = ProgramFolder::new();
    folder.run_failing(&format!("{RENDER} -o p.png --fault oom@2"), 5);
    folder.run_failing(&format!("{RENDER} -o p.png --fault shader"), 4);
    folder.run_failing("info builtin:sphere:16 --fault fire", 2);
    folder.write("v_8x8x8_uint8.raw", vec![7; 512]);
    folder.run_failing("render v_8x8x8_uint8.raw -o p.png --fault read-error@1", 6);
    folder.run_successfully(&format!("{RENDER} -o p.png --fault slow:1"));
}

/// Drivers look for a desktop session, in a folder that containers and clusters do not set.
#[cfg(target_os = "linux")]
#[test]
fn good_runs_print_no_errors() {
    let folder = ProgramFolder::new();
    // Like a missing variable: only absolute paths count.
    for named in ["", "run"] {
        let outcome = folder.run_with(&format!("{RENDER} -o p.png --force"), &[("XDG_RUNTIME_DIR", named)]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        assert!(!outcome.stderr.lines().any(|line| line.starts_with("error")), "{outcome:?}");
    }
}
