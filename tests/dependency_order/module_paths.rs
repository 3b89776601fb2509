//! Parser of module paths and crate names in source text.

use std::collections::BTreeSet;

/// Path below the crate's root, such as `gpu::eye::DisplayUniform`; `*` for a glob import.
pub(crate) type ModulePath = Vec<String>;

/// Paths below the crate's root that a module names: `crate::X`, `crate::{X, Y}`, `super::super::X`, `self::X`,
/// `chiaroscuro::X`.
pub(crate) fn paths(tokens: &[String], module: &[&str]) -> Vec<ModulePath> {
    let mut found = Vec::new();
    // For each open brace the module that it begins, if it begins one.
    let mut braces: Vec<Option<&str>> = Vec::new();
    for at in 0..tokens.len() {
        let starts = at == 0 || tokens[at - 1] != "::";
        match tokens[at].as_str() {
            "{" => braces.push((at >= 2 && tokens[at - 2] == "mod").then(|| tokens[at - 1].as_str())),
            "}" => drop(braces.pop()),
            "crate" | "chiaroscuro" if starts => {
                _ = parse_path(tokens, at + 1, ModulePath::new(), &mut found);
            }
            "super" | "self" if starts => {
                let inner = module.iter().copied().chain(braces.iter().copied().flatten());
                parse_path(tokens, at, inner.map(str::to_owned).collect(), &mut found);
            }
            _ => {}
        }
    }
    found
}

/// Parses a path from a token on, starting in `module`, and records its target, if it names anything. Returns the
/// index after the path.
fn parse_path(tokens: &[String], mut at: usize, module: ModulePath, found: &mut Vec<ModulePath>) -> usize {
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    let mut path = module;
    let mut names = 0;
    loop {
        let before = token(at.wrapping_sub(1));
        match token(at) {
            "::" if token(at + 1) != "<" => at += 1,
            "super" => {
                path.pop();
                at += 1;
            }
            "self" => at += 1,
            "{" if before == "::" => {
                at += 1;
                while !matches!(token(at), "}" | "") {
                    at = parse_path(tokens, at, path.clone(), found).max(at + 1);
                }
                return at + 1;
            }
            // Only a token after `::` (or in a group) is a name of the path.
            name if is_name(name) && matches!(before, "::" | "{" | ",") => {
                path.push(name.to_owned());
                names += 1;
                at += 1;
            }
            _ => {
                if names > 0 {
                    found.push(path);
                }
                return at;
            }
        }
    }
}

fn is_name(token: &str) -> bool {
    token == "*" || token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// First word of every path and `use`: the crates that a file names.
pub(crate) fn crates(tokens: &[String]) -> BTreeSet<&str> {
    let token = |at: Option<usize>| at.and_then(|at| tokens.get(at)).map_or("", String::as_str);
    let continues = |word: &str| {
        let is_name = word.starts_with(|c: char| c.is_alphabetic() || c == '_') || word == ">";
        is_name && !["use", "as", "in", "mut", "dyn", "impl", "return"].contains(&word)
    };
    (0..tokens.len())
        .filter(|&at| {
            let (before, after) = (token(at.checked_sub(1)), token(Some(at + 1)));
            let is_first = before != "::" || !continues(token(at.checked_sub(2)));
            let is_import = ["use", "crate"].contains(&before) && [";", "as"].contains(&after);
            is_first && after == "::" || is_import
        })
        .map(|at| tokens[at].as_str())
        .collect()
}

/// Aliases of a module: for each `use` the name in the module and the path that it refers to. Paths may begin with a
/// module beside the file or below it.
pub(crate) fn imports(tokens: &[String], module: &[&str]) -> Vec<(String, ModulePath)> {
    let mut found = Vec::new();
    for at in (0..tokens.len()).filter(|&at| tokens[at] == "use") {
        parse_use_entry(tokens, at + 1, module.iter().map(|&name| name.to_owned()).collect(), &mut found);
    }
    found
}

/// Parses one entry of a `use`: a path, perhaps a group, perhaps renamed. Returns the index after it.
fn parse_use_entry(
    tokens: &[String],
    mut at: usize,
    start: ModulePath,
    found: &mut Vec<(String, ModulePath)>,
) -> usize {
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    let mut path = start;
    loop {
        match token(at) {
            "::" | "self" => {}
            "crate" | "chiaroscuro" => path.clear(),
            "super" => drop(path.pop()),
            "{" => {
                at += 1;
                while !matches!(token(at), "}" | "") {
                    at = parse_use_entry(tokens, at, path.clone(), found);
                    at += usize::from(token(at) == ",");
                }
                return at + 1;
            }
            "as" => {
                found.push((token(at + 1).to_owned(), path));
                return at + 2;
            }
            name if is_name(name) => path.push(name.to_owned()),
            _ => {
                let name = path.last().cloned().unwrap_or_default();
                found.push((name, path));
                return at.max(1);
            }
        }
        at += 1;
    }
}

/// Removes tokens that only tests see: items behind `#[cfg(test)]` and `#[cfg(all(test, …))]`.
pub(crate) fn without_tests(tokens: &[String]) -> Vec<String> {
    let is = |at: usize, words: &[&str]| {
        words.iter().enumerate().all(|(i, w)| tokens.get(at + i).is_some_and(|t| t == w))
    };
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if is(at, &["#", "[", "cfg", "(", "test", ")"]) || is(at, &["#", "[", "cfg", "(", "all", "(", "test"])
        {
            at = end_of_item(tokens, at);
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

/// Index after an item with its attributes: after its `;` or the brace that closes its body.
fn end_of_item(tokens: &[String], mut at: usize) -> usize {
    let (mut brackets, mut braces) = (0, 0);
    while at < tokens.len() {
        match tokens[at].as_str() {
            "[" | "(" => brackets += 1,
            "]" | ")" => brackets -= 1,
            "{" => braces += 1,
            "}" => braces -= 1,
            _ => {}
        }
        let ends = matches!(tokens[at].as_str(), ";" | "}");
        at += 1;
        if ends && brackets == 0 && braces == 0 {
            return at;
        }
    }
    at
}
