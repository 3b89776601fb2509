//! Checks of words: doc comments open with a noun or verb and can be understood alone, types have names of their own,
//! constructors and visibility are those of Rust, and retired words are no identifiers.

use std::collections::{BTreeMap, BTreeSet};

use crate::sources::{SourceFile, all_sources, source_files};
use crate::tokens::tokens;

/// Words with which a doc comment begins that describes its item by a relative clause.
const RELATIVE: [&str; 8] = ["what", "how", "which", "where", "of", "its", "their", "that"];

/// Words with which a doc comment of a condition begins.
const CONDITION: [&str; 2] = ["whether", "when"];

/// Share of doc comments that may open with [`RELATIVE`]. Eight Rust projects of this kind have 0.1 to 4.0 %.
const RELATIVE_SHARE: f64 = 0.04;

/// Share of doc comments that may open with [`RELATIVE`] or [`CONDITION`].
const UNNAMED_SHARE: f64 = 0.05;

/// Words that are too few for a doc comment that can be understood alone.
const FEWEST_WORDS: usize = 2;

/// Words of a short doc comment, and the share of such: eight Rust projects of this kind have 4 to 15 %.
const SHORT: (usize, f64) = (4, 0.08);

/// Parts of identifiers that the glossary lists as replaced.
const RETIRED: [&str; 12] = [
    "shot",
    "shots",
    "reel",
    "reels",
    "lamp",
    "lamps",
    "leap",
    "leaps",
    "easel",
    "collapsed",
    "shelf",
    "settled",
];

/// A doc comment: its line, from 1, and its text in one line.
struct DocComment {
    line: usize,
    text: String,
}

/// Doc comments of a source file, `///` and `//!`.
fn doc_comments(source: &str) -> Vec<DocComment> {
    let mut found: Vec<DocComment> = Vec::new();
    let mut open = "";
    for (at, line) in source.lines().enumerate() {
        let line = line.trim_start();
        let marker = ["///", "//!"].into_iter().find(|marker| line.starts_with(marker)).unwrap_or("");
        let text = line[marker.len()..].trim();
        match found.last_mut() {
            Some(last) if !marker.is_empty() && marker == open => last.text = format!("{} {text}", last.text),
            _ if !marker.is_empty() => found.push(DocComment { line: at + 1, text: text.to_owned() }),
            _ => {}
        }
        open = marker;
    }
    found
}

/// Number of words of a text: runs of characters between spaces with a letter or digit among them.
fn word_count(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}

/// True where a text begins with one of these words, or with "the same".
fn opens_with(text: &str, words: &[&str]) -> bool {
    let mut parts = text.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    let first = parts.next().unwrap_or_default().to_lowercase();
    words.contains(&first.as_str()) || (first == "the" && parts.next() == Some("same"))
}

/// Doc comments of some files for which a condition holds, with their places.
fn listed(files: &[SourceFile], condition: impl Fn(&str) -> bool) -> (Vec<String>, usize) {
    let mut found = Vec::new();
    let mut count = 0;
    for file in files {
        for comment in doc_comments(&file.text) {
            count += 1;
            if condition(&comment.text) {
                found.push(format!("{}:{}: {}", file.path, comment.line, comment.text));
            }
        }
    }
    (found, count)
}

/// Fails where more than a share of all doc comments are listed.
fn at_most(share: f64, (found, count): (Vec<String>, usize), flaw: &str) {
    assert!(count > 5000, "the check must see the doc comments, and sees {count}");
    let most = (share * count as f64) as usize;
    assert!(
        found.len() <= most,
        "\n{}\n{} of {count} doc comments {flaw}; {most} are allowed",
        found.join("\n"),
        found.len()
    );
}

/// Types that a file declares at its top level or in modules: structs, enums, traits, unions and aliases, but not
/// the associated types of traits.
fn declared_types(tokens: &[String]) -> Vec<&str> {
    let mut found = Vec::new();
    let mut depth = 0_usize;
    // Depths at which a block of a trait or an implementation was opened.
    let mut members: Vec<usize> = Vec::new();
    let mut is_member_block = false;
    for (at, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "{" => {
                depth += 1;
                if std::mem::take(&mut is_member_block) {
                    members.push(depth);
                }
            }
            "}" => {
                if members.last() == Some(&depth) {
                    members.pop();
                }
                depth = depth.saturating_sub(1);
            }
            "impl"
                if matches!(
                    tokens.get(at.wrapping_sub(1)).map(String::as_str),
                    None | Some("}" | ";" | "]" | "{" | "unsafe")
                ) =>
            {
                is_member_block = true;
            }
            keyword @ ("struct" | "enum" | "trait" | "union" | "type") => {
                if keyword == "trait" {
                    is_member_block = true;
                }
                let is_associated = keyword == "type" && !members.is_empty();
                let name = tokens.get(at + 1).map_or("", String::as_str);
                if !is_associated && name.starts_with(char::is_uppercase) {
                    found.push(name);
                }
            }
            _ => {}
        }
    }
    found
}

/// Parts of an identifier: `light_lamp`, `LightLamp` and `LIGHT_LAMP` have `light` and `lamp`.
fn parts(identifier: &str) -> Vec<String> {
    if !identifier.contains(char::is_lowercase) {
        return identifier.split('_').map(str::to_lowercase).collect();
    }
    let mut found = vec![String::new()];
    for c in identifier.chars() {
        if c == '_' || c.is_uppercase() {
            found.push(String::new());
        }
        if let Some(last) = found.last_mut().filter(|_| c != '_') {
            last.extend(c.to_lowercase());
        }
    }
    found.retain(|part| !part.is_empty());
    found
}

#[test]
fn doc_comments_open_with_a_noun_or_a_verb() {
    let sources = all_sources();
    at_most(
        RELATIVE_SHARE,
        listed(&sources, |text| opens_with(text, &RELATIVE)),
        "open with a relative clause",
    );
    let unnamed = [RELATIVE.as_slice(), &CONDITION].concat();
    at_most(
        UNNAMED_SHARE,
        listed(&sources, |text| opens_with(text, &unnamed)),
        "name neither a thing nor an act",
    );
}

#[test]
fn doc_comments_can_be_understood_alone() {
    let sources = all_sources();
    at_most(0.0, listed(&sources, |text| word_count(text) <= FEWEST_WORDS), "have a word or two");
    at_most(SHORT.1, listed(&sources, |text| word_count(text) <= SHORT.0), "have four words or fewer");
}

#[test]
fn types_have_names_of_their_own() {
    let sources = all_sources();
    let mut places: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for file in &sources {
        for name in declared_types(&tokens(&file.text)) {
            places.entry(name.to_owned()).or_default().push(&file.path);
        }
    }
    assert!(places.len() > 500, "the check must see the types, and sees {}", places.len());
    places.retain(|_, files| files.len() > 1);
    let found: Vec<_> = places.iter().map(|(name, files)| format!("{name}: {}", files.join(", "))).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn constructors_and_visibility_are_those_of_rust() {
    let mut found = BTreeSet::new();
    for file in all_sources() {
        let tokens = tokens(&file.text);
        for window in tokens.windows(3) {
            let [a, b, c] = window else { continue };
            if (a == "fn" && b == "of") || (a == "pub" && b == "(" && c == "in") {
                found.insert(format!("{}: {a} {b}", file.path));
            }
        }
    }
    assert!(found.is_empty(), "\n{}", found.into_iter().collect::<Vec<_>>().join("\n"));
}

#[test]
fn retired_words_are_no_identifiers() {
    let mut found = BTreeSet::new();
    for file in all_sources().into_iter().chain(source_files("shaders", "wgsl")) {
        for token in tokens(&file.text) {
            if parts(&token).iter().any(|part| RETIRED.contains(&part.as_str())) {
                found.insert(format!("{}: {token}", file.path));
            }
        }
    }
    assert!(found.is_empty(), "\n{}", found.into_iter().collect::<Vec<_>>().join("\n"));
}

#[test]
fn flaws_of_words_are_reported() {
    let comments =
        doc_comments("//! A file.\n\n/// Which volume.\n/// More of it.\nfn a() {}\n    /// Twice.\n// no\n");
    let texts: Vec<_> = comments.iter().map(|comment| (comment.line, comment.text.as_str())).collect();
    assert_eq!(texts, [(1, "A file."), (3, "Which volume. More of it."), (6, "Twice.")]);
    assert!(opens_with("What's left.", &RELATIVE) && opens_with("The same for rows.", &RELATIVE));
    assert!(!opens_with("The volume, which is read.", &RELATIVE) && !opens_with("Offset.", &RELATIVE));
    assert_eq!(word_count("Width × height, in `mm`."), 4);
    let source = "struct A; impl B for A { type C = u8; fn f() { struct D {} } } \
                  trait E { type F; } mod t { type G = A; }";
    assert_eq!(declared_types(&tokens(source)), ["A", "D", "E", "G"]);
    assert_eq!(parts("light_lampShade"), ["light", "lamp", "shade"]);
    assert_eq!(parts("MOST_LAMPS"), ["most", "lamps"]);
}
