//! Localisation check: all texts of the window are in `src/app/text/`, no other file of the window contains any.

use std::fs;
use std::path::{Path, PathBuf};

/// Code before string literals that users do not see: ids and names for the UI library and the operating system, log
/// messages for developers, and errors, whose types contain the text.
const NOT_SHOWN: [&str; 15] = [
    "var_os(",
    "Id::unique(",
    "id_salt(",
    "Grid::new(",
    "load_texture(",
    "advanced_group(ui,",
    "log::debug!(",
    "log::info!(",
    "log::warn!(",
    "log::error!(",
    "#[error(",
    "reason =",
    "debug_struct(",
    "write!(f,",
    "const GET_PROPERTY: &str =",
];

/// String literal, with the code before it in its statement.
#[derive(Debug, PartialEq)]
struct StringLiteral {
    line: usize,
    before: String,
    text: String,
}

/// Returns all string literals of a source text, except those in comments and in its tests.
fn literals(source: &str) -> Vec<StringLiteral> {
    let source = source.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut before = String::new();
    let mut line = 1;
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        line += usize::from(c == '\n');
        match c {
            '/' if rest.peek() == Some(&'/') => {
                while rest.peek().is_some_and(|&c| c != '\n') {
                    rest.next();
                }
            }
            '\'' if rest.peek() == Some(&'"') => {
                rest.next();
            }
            '"' => {
                let mut text = String::new();
                let first_line = line;
                while let Some(c) = rest.next() {
                    line += usize::from(c == '\n');
                    match c {
                        '"' => break,
                        '\\' => {
                            let escaped = rest.next();
                            line += usize::from(escaped == Some('\n'));
                            text.extend(escaped.filter(|c| *c == '"'));
                        }
                        c => text.push(c),
                    }
                }
                found.push(StringLiteral { line: first_line, before: before.clone(), text });
            }
            ';' | '{' | '}' => before.clear(),
            c => before.push(c),
        }
    }
    found
}

/// Returns true if a text reads like a sentence or label: two words in a row, or one with a capital. Placeholders in
/// braces are ignored.
fn reads_like_text(text: &str) -> bool {
    let mut depth = 0;
    let shown: String = text
        .chars()
        .filter(|c| {
            depth += i32::from(*c == '{') - i32::from(*c == '}');
            depth == 0 && *c != '}'
        })
        .collect();
    let letters = |word: &str| word.chars().filter(|c| c.is_alphabetic()).count();
    let words: Vec<&str> = shown.split_whitespace().filter(|word| letters(word) > 0).collect();
    // Names of environment variables contain underscores.
    let capital =
        |word: &&str| letters(word) > 1 && word.starts_with(char::is_uppercase) && !word.contains('_');
    words.len() > 1 || words.iter().any(capital)
}

fn is_user_visible(literal: &StringLiteral) -> bool {
    let before = literal.before.trim_end().trim_end_matches("format!(").trim_end();
    reads_like_text(&literal.text) && !NOT_SHOWN.iter().any(|name| before.ends_with(name))
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).expect("the sources are here");
    for entry in entries {
        let path = entry.expect("the sources can be read").path();
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn window_texts_are_in_one_module() {
    let app = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/app");
    let mut found = Vec::new();
    files(&app, &mut found);
    // Messages of tests are not shown to users.
    found.retain(|path| {
        !path.ends_with("tests.rs") && !path.components().any(|part| part.as_os_str() == "tests")
    });
    let (texts, others): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|path| path.starts_with(app.join("text")));
    let words = |path: &PathBuf| literals(&fs::read_to_string(path).unwrap());
    let count: usize = texts.iter().map(|path| words(path).len()).sum();
    assert!(count > 300, "only {count} texts were found where all of them should be");
    let strays: Vec<String> = others
        .iter()
        .flat_map(|path| {
            let strays = words(path).into_iter().filter(is_user_visible);
            strays.map(|StringLiteral { line, text, .. }| format!("{}:{line}: {text}", path.display()))
        })
        .collect();
    assert!(strays.is_empty(), "these belong into src/app/text:\n{}", strays.join("\n"));
}

#[test]
fn texts_outside_are_detected() {
    let shown = |source: &str| literals(source).iter().filter(|literal| is_user_visible(literal)).count();
    for source in [
        "ui.label(\"Width\");",
        "ui.label(format!(\"{count} of {total} parts\"));",
        "log::warn!(\"no window\"); ui.label(\"no window\");",
        "ui.button(\"Say \\\"yes\\\"\");",
        "interact(ui, Id::unique(\"side\"), \"Clip plane, position\");",
        "let quote = '\"'; ui.label(\"casts shadows\");",
    ] {
        assert_eq!(shown(source), 1, "{source}");
    }
    for source in [
        "let id = Id::unique(\"crop side\");",
        "// ui.label(\"Width\");",
        "format!(\"{Name:?}\")",
        "#[error(\"the window is closed\")]",
        "#[cfg(test)]\nmod tests { ui.label(\"Width\"); }",
    ] {
        assert_eq!(shown(source), 0, "{source}");
    }
}
