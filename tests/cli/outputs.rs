//! Tests of output files: targets, replacing existing files, and cleaning up when the program is terminated.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::{Folder, PATIENCE};

const RENDER: &str = "render builtin:sphere:16 --size 16x12";

#[test]
fn files_of_others_are_replaced_only_by_force() {
    let folder = Folder::new();
    let theirs = b"\x89PNG\r\n\x1a\n somebody's picture".to_vec();
    folder.write("p.png", &theirs);
    folder.write("l.nrrd", "NRRD0004\n# somebody's volume\n");
    folder.write("r.json", r#"{"notes": "somebody's"}"#);
    std::fs::create_dir(folder.path("turn")).expect("a folder");
    folder.write("turn/0001.png", &theirs);
    for args in [
        format!("{RENDER} -o p.png"),
        format!("{RENDER} -o q.png --report r.json"),
        "light-volume builtin:sphere:16 -o l.nrrd".to_owned(),
        "compare builtin:sphere:16 --size 16x12 -o p.png".to_owned(),
        "turntable builtin:sphere:16 --size 16x12 --frames 2 -o p.png".to_owned(),
        "turntable builtin:sphere:16 --size 16x12 --frames 2 -o turn".to_owned(),
    ] {
        let said = folder.fail(&args, 2);
        assert!(said.contains("--force"), "{said}");
    }
    assert_eq!(folder.read("p.png"), theirs);
    folder.succeed(&format!("{RENDER} -o p.png --force --report r.json"));
    assert_eq!(folder.json("r.json")["image_size"][0], 16);
    folder.write("again.png", &theirs);
    assert!(folder.fail("replay p.png -o again.png", 2).contains("--force"));
    assert_eq!(folder.read("again.png"), theirs);
    folder.succeed("replay p.png -o again.png --force");
    // Other files of a folder stay.
    folder.write("turn/notes.txt", "mine");
    folder.succeed("turntable builtin:sphere:16 --size 16x12 --frames 2 -o turn --force");
    assert_eq!(folder.read("turn/notes.txt"), b"mine");
    assert_ne!(folder.read("turn/0001.png"), theirs);
    // An empty file contains nothing to lose.
    folder.write("e.png", "");
    folder.succeed(&format!("{RENDER} -o e.png"));
}

#[test]
fn files_of_the_program_say_so_and_are_replaced() {
    let folder = Folder::new();
    let turn = "turntable builtin:sphere:16 --size 16x12 --frames 2";
    // Twice: files written by the first run may be replaced by the second.
    for _ in 0..2 {
        folder.succeed(&format!("{RENDER} -o p.png --report r.json"));
        folder.succeed(&format!("{RENDER} -o p.exr"));
        folder.succeed("light-volume builtin:sphere:16 -o l.nrrd");
        folder.succeed("light-volume builtin:sphere:16 -o slice.png --slice z:3");
        folder.succeed("compare builtin:sphere:16 --size 16x12 -o c.png");
        for file in ["t.png", "t.gif", "turn"] {
            folder.succeed(&format!("{turn} -o {file}"));
        }
    }
    let mark = chiaroscuro::model::MADE_BY.as_bytes();
    for name in
        ["p.png", "r.json", "p.exr", "l.nrrd", "slice.png", "c.png", "t.png", "t.gif", "turn/0001.png"]
    {
        let bytes = folder.read(name);
        assert!(bytes.windows(mark.len()).any(|window| window == mark), "{name}");
    }
    folder.succeed("info l.nrrd");
}

/// Runs a command whose standard output is binary, and returns the bytes.
fn standard_output(folder: &Folder, args: &str) -> Vec<u8> {
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
    let folder = Folder::new();
    folder.succeed(&format!("{RENDER} -o p.png"));
    let pixels = |bytes: &[u8]| image::load_from_memory(bytes).expect("a picture").to_rgba8().into_raw();
    let piped = standard_output(&folder, &format!("{RENDER} -o -"));
    assert!(pixels(&piped) == pixels(&folder.read("p.png")));
    folder.succeed("light-volume builtin:sphere:16 -o l.nrrd");
    assert!(standard_output(&folder, "light-volume builtin:sphere:16 -o -") == folder.read("l.nrrd"));
    let report = standard_output(&folder, &format!("{RENDER} -o p.png --report -"));
    let report: serde_json::Value = serde_json::from_slice(&report).expect("nothing but the report");
    assert_eq!(report["image_size"][1], 12);
    folder.fail(&format!("{RENDER} -o - --report -"), 2);
    folder.fail("turntable builtin:sphere:16 --frames 2 -o -", 2);
    assert_eq!(folder.names(), ["l.nrrd", "p.png"]);
}

/// Starts an animation export that is too long to wait for.
fn long_turn(folder: &Folder) -> std::process::Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_chiaroscuro"));
    begin_turn(&mut command, folder)
}

/// Starts the long animation export by a command that takes the program as its last argument, if it has arguments.
fn begin_turn(command: &mut Command, folder: &Folder) -> std::process::Child {
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
        assert!(begin.elapsed() < PATIENCE, "nothing was begun");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(folder.names()[0].contains(".part"), "{:?}", folder.names());
    child
}

#[cfg(unix)]
#[test]
fn what_is_half_written_goes_with_its_writer_or_with_the_next() {
    let folder = Folder::new();
    let send = |signal: &str, child: &std::process::Child| {
        let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(sent.expect("kill is there").success());
    };
    // Exit codes as in shells: 128 plus the number of the signal.
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let mut child = long_turn(&folder);
        send(signal, &child);
        assert_eq!(child.wait().expect("it ends").code(), Some(code), "{signal}");
        assert_eq!(folder.names(), Vec::<String>::new(), "{signal}");
    }
    // A program started with a signal ignored (`nohup`) continues, where the system reports that.
    #[cfg(target_os = "linux")]
    {
        let ignoring = ["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_chiaroscuro")];
        let mut child = begin_turn(Command::new("sh").args(ignoring), &folder);
        send("HUP", &child);
        std::thread::sleep(Duration::from_millis(300));
        assert!(child.try_wait().expect("it can be asked").is_none(), "it was not to end");
        send("TERM", &child);
        assert_eq!(child.wait().expect("it ends").code(), Some(143));
    }
    let mut child = long_turn(&folder);
    // The temporary file of a running process stays while another process writes beside it.
    folder.succeed(&format!("{RENDER} -o p.png"));
    assert_eq!(folder.names().len(), 2);
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    assert_eq!(folder.names().len(), 2, "nobody could tidy up");
    folder.succeed(&format!("{RENDER} -o p.png"));
    assert_eq!(folder.names(), ["p.png"]);
}

#[test]
fn a_full_disk_is_said_and_changes_nothing() {
    let folder = Folder::new();
    folder.succeed(&format!("{RENDER} -o p.png"));
    let before = folder.read("p.png");
    let said = folder.fail(&format!("{RENDER} -o p.png --set shadows.gain=2 --fault full-disk"), 6);
    assert!(said.contains("p.png"), "{said}");
    assert_eq!(folder.read("p.png"), before);
}

#[test]
fn refused_memory_and_lost_shaders_are_said() {
    let folder = Folder::new();
    folder.fail(&format!("{RENDER} -o p.png --fault oom@2"), 5);
    folder.fail(&format!("{RENDER} -o p.png --fault shader"), 4);
    folder.fail("info builtin:sphere:16 --fault fire", 2);
    folder.write("v_8x8x8_uint8.raw", vec![7; 512]);
    folder.fail("render v_8x8x8_uint8.raw -o p.png --fault read-error@1", 6);
    folder.succeed(&format!("{RENDER} -o p.png --fault slow:1"));
}

/// Drivers look for a desktop session, in a folder that containers and clusters do not set.
#[cfg(target_os = "linux")]
#[test]
fn good_runs_print_no_errors() {
    let folder = Folder::new();
    // Like a missing variable: only absolute paths count.
    for named in ["", "run"] {
        let outcome = folder.run_with(&format!("{RENDER} -o p.png --force"), &[("XDG_RUNTIME_DIR", named)]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        assert!(!outcome.stderr.lines().any(|line| line.starts_with("error")), "{outcome:?}");
    }
}
