//! Tests of arguments: help, manual pages and completions list them all, and invalid ones are refused with a message.

use std::fs;
use std::path::Path;

use crate::program::ProgramFolder;

#[test]
fn help_and_version_are_no_errors() {
    let folder = ProgramFolder::new();
    assert!(folder.run_successfully("--version").contains(env!("CARGO_PKG_VERSION")));
    let help = folder.run_successfully("--help");
    for command in ["render", "compare", "light-volume", "convert", "info", "bench"] {
        assert!(help.contains(command), "{command} is missing: {help}");
        assert!(!folder.run_successfully(&format!("{command} --help")).is_empty());
    }
}

/// Names of the commands that the help lists, without `help` itself.
fn command_names(folder: &ProgramFolder) -> Vec<String> {
    let help = folder.run_successfully("--help");
    let list = help.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    let names = list.take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn completions_name_all_commands() {
    let folder = ProgramFolder::new();
    let names = command_names(&folder);
    assert!(names.len() > 8, "the check must see the commands: {names:?}");
    for shell in ["bash", "zsh", "fish"] {
        let script = folder.run_successfully(&format!("completions {shell}"));
        for word in names.iter().map(String::as_str).chain(["session", "trust-paths"]) {
            assert!(script.contains(word), "{shell}: {word} is missing");
        }
        // Control characters would have been replaced by this one.
        assert!(!script.contains('·'), "{shell}: {script}");
    }
    assert!(folder.run_failing("completions tcl", 2).contains("bash"), "the known shells");
}

#[test]
fn man_pages_are_written_for_all_commands() {
    let folder = ProgramFolder::new();
    let printed = folder.run_successfully("man-pages new/man1");
    let mut expected: Vec<_> =
        command_names(&folder).iter().map(|name| format!("chiaroscuro-{name}.1")).collect();
    expected.push("chiaroscuro.1".to_owned());
    let mut written: Vec<_> = printed.lines().filter_map(|line| line.rsplit('/').next()).collect();
    expected.sort();
    written.sort_unstable();
    assert_eq!(written, expected);
    for name in written {
        let text = String::from_utf8(folder.read(&format!("new/man1/{name}"))).expect("pages are UTF-8");
        assert!(text.contains(".TH chiaroscuro"), "{name} begins with a title: {text}");
        assert!(text.contains(env!("CARGO_PKG_VERSION")), "{name} names the version: {text}");
        assert!(!text.contains("\\-fault"), "{name}: hidden options are not described");
    }
    let render = String::from_utf8(folder.read("new/man1/chiaroscuro-render.1")).expect("pages are UTF-8");
    assert!(render.contains("transparent"), "options are described: {render}");
    // Pages have no room for the mark of this program.
    assert!(folder.run_failing("man-pages new/man1", 2).contains("--force"));
    folder.run_successfully("man-pages new/man1 --force");
    folder.write("file", "none");
    assert!(folder.run_failing("man-pages file", 6).contains("file"));
}

#[test]
fn unknown_words_are_usage_errors() {
    let folder = ProgramFolder::new();
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
        folder.run_failing(args, 2);
    }
    let said = folder.run_failing("render builtin:sphere:16 -o out.png --shadows sometimes", 2);
    assert!(said.contains("splat") && said.contains("off"), "the known words: {said}");
    // Arguments are quoted in messages, without control sequences for the terminal.
    let said = folder.run_failing("render builtin:sphere:16 -o out.png --no-such\u{1b}]0;taken\u{7}", 2);
    assert!(said.contains("taken") && !said.contains(['\u{1b}', '\u{7}']), "{said:?}");
    let said = folder.run_failing("render builtin:nothing -o out.png", 3);
    assert!(said.contains("chair") && said.contains("marschner-lobb"), "the known volumes: {said}");
}

#[test]
fn unknown_settings_are_usage_errors_that_list_the_known_ones() {
    let folder = ProgramFolder::new();
    let render = "render builtin:sphere:16 -o out.png --size 16x16 --set";
    let said = folder.run_failing(&format!("{render} shadows.strenght=1"), 2);
    assert!(said.contains("shadows.strenght"), "the unknown path: {said}");
    for known in ["strength", "gain", "bias"] {
        assert!(said.contains(known), "the known names: {said}");
    }
    assert!(folder.run_failing(&format!("{render} schema=1"), 2).contains("at the top level there are: "));
    let said = folder.run_failing(&format!("{render} no_such=1"), 2);
    assert!(said.contains("shadows") && said.contains("camera"), "the known names: {said}");
    for assignment in ["shadows.strength", "shadows.strength=much", "lights.99.intensity=1", "=1", ""] {
        folder.run_failing(&format!("{render}={assignment}"), 2);
    }
}

#[test]
fn presets_and_sessions_that_cannot_be_used_are_refused() {
    let folder = ProgramFolder::new();
    folder.write("words.json", "this is no JSON");
    folder.write("list.json", "[1, 2, 3]");
    folder.write("form.json", r#"{"shadows": {"strength": "much"}}"#);
    folder.write("binary.json", [0xff, 0xfe, 0x00, 0x80]);
    fs::create_dir(folder.path("directory.json")).expect("the folder can be written to");
    for option in ["--preset", "--session"] {
        let refused = |file: &str, code: i32| {
            let args = format!("render builtin:sphere:16 -o out.png --size 16x16 {option} {file}");
            let said = folder.run_failing(&args, code);
            assert!(said.contains(file), "`{args}` should name the file: {said}");
        };
        refused("words.json", 3);
        refused("list.json", 3);
        refused("form.json", 3);
        refused("missing.json", 6);
        refused("directory.json", 6);
        // Not even text: no preset, although the file can be read.
        refused("binary.json", 3);
    }
}

#[test]
fn settings_out_of_range_are_told_and_the_schema_is_not_set() {
    let folder = ProgramFolder::new();
    let render = "render builtin:sphere:16 -o out.png --size 16x16 --report r.json";
    let outcome = folder.run(&format!("{render} --set shadows.strength=-1e308"));
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(
        outcome.stderr.contains("`shadows.strength`") && outcome.stderr.contains("0.0 is used"),
        "{outcome:?}"
    );
    assert_eq!(folder.json("r.json")["settings"]["shadows"]["strength"], 0.0);
    let outcome = folder.run(&format!("{render} --set shadows.strength=0.5"));
    assert!(outcome.code == Some(0) && !outcome.stderr.contains("out of range"), "{outcome:?}");
    let said = folder.run_failing(&format!("{render} --set schema=99999"), 2);
    assert!(said.contains("no setting `schema`"), "{said}");
}

/// Lines and code spans of a document that call the program, as lists of words.
fn calls(document: &str) -> Vec<Vec<&str>> {
    let blocks = document.split("```").skip(1).step_by(2).flat_map(str::lines);
    let prose = document.split("```").step_by(2).flat_map(|prose| prose.split('`').skip(1).step_by(2));
    let calls = blocks.chain(prose).filter_map(|line| line.trim().strip_prefix("chiaroscuro "));
    calls.map(|call| call.split(" #").next().unwrap_or(call).split_whitespace().collect()).collect()
}

/// Words of a call that the program does not know: an option, or a command before the first file.
fn unknown_words<'a>(folder: &ProgramFolder, call: &[&'a str]) -> Vec<&'a str> {
    let general = folder.run_successfully("--help");
    let is_command =
        |word: &str| general.lines().any(|line| line.trim_start().starts_with(&format!("{word} ")));
    let Some(&first) = call.first() else { return Vec::new() };
    let is_file = first.contains(['.', ':', '-']) || first.chars().all(char::is_uppercase);
    if !is_command(first) && !is_file {
        return vec![first];
    }
    let help = if is_command(first) { folder.run_successfully(&format!("{first} --help")) } else { general };
    let name = |word: &'a str| word.split('=').next().unwrap_or(word);
    let options = call.iter().copied().map(name).filter(|word| word.starts_with("--"));
    options.filter(|option| !help.split([' ', ',', '=', '\n']).any(|word| word == *option)).collect()
}

#[test]
fn commands_in_documents_are_known() {
    let folder = ProgramFolder::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    let mut found = Vec::new();
    for document in
        ["README.md", "CONTRIBUTING.md", "docs/USING.md", "docs/LABORATORY.md", "docs/PERFORMANCE.md"]
    {
        let text = fs::read_to_string(root.join(document)).expect("documents are text");
        for call in calls(&text) {
            count += 1;
            let unknown = unknown_words(&folder, &call);
            found.extend(unknown.into_iter().map(|word| format!("{document}: {word} in {}", call.join(" "))));
        }
    }
    assert!(count > 20, "the check must see the commands, and sees {count}");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
    let unknown = |call: &str| unknown_words(&folder, &call.split(' ').collect::<Vec<_>>()).len();
    assert_eq!(unknown("render scan.nrrd -o a.png --no-such"), 1);
    assert_eq!(unknown("paint scan.nrrd"), 1);
    assert_eq!(unknown("render scan.nrrd --size 8x8"), 0);
}
