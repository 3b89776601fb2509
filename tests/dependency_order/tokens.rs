//! Tokeniser of Rust source text: words, `::` and single characters.

use std::iter::Peekable;
use std::str::Chars;

/// Splits source text into words, `::` and single characters; without comments, strings and white space.
pub(crate) fn tokens(source: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '/' if rest.peek() == Some(&'/') => while rest.next().is_some_and(|c| c != '\n') {},
            '/' if rest.peek() == Some(&'*') => skip_block_comment(&mut rest),
            '"' => skip_string(&mut rest),
            '\'' => skip_character(&mut rest),
            ':' if rest.peek() == Some(&':') => {
                rest.next();
                found.push("::".to_owned());
            }
            c if c.is_alphanumeric() || c == '_' => {
                let mut word = String::from(c);
                while let Some(&c) = rest.peek().filter(|c| c.is_alphanumeric() || **c == '_') {
                    word.push(c);
                    rest.next();
                }
                let starts_text = matches!(rest.peek(), Some('"' | '#'));
                if starts_text && ["r", "br", "cr"].contains(&word.as_str()) {
                    skip_raw_string(&mut rest);
                } else {
                    found.push(word);
                }
            }
            c if c.is_whitespace() => {}
            c => found.push(c.to_string()),
        }
    }
    found
}

/// Skips the rest of a block comment, which may contain nested ones.
fn skip_block_comment(rest: &mut Peekable<Chars<'_>>) {
    let (mut depth, mut last) = (0, '/');
    for c in rest.by_ref() {
        let joined = (last, c);
        // The character is consumed, so that `/*/` does not also close what it opens.
        last = if matches!(joined, ('/', '*') | ('*', '/')) { ' ' } else { c };
        match joined {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return;
        }
    }
}

fn skip_string(rest: &mut Peekable<Chars<'_>>) {
    while let Some(c) = rest.next() {
        match c {
            '\\' => drop(rest.next()),
            '"' => return,
            _ => {}
        }
    }
}

/// Skips a raw string from its hashes or quote on; `r#type` is no string, but an identifier that is not needed here.
fn skip_raw_string(rest: &mut Peekable<Chars<'_>>) {
    let mut hashes = 0;
    while rest.next_if_eq(&'#').is_some() {
        hashes += 1;
    }
    if rest.next_if_eq(&'"').is_none() {
        return;
    }
    while let Some(c) = rest.next() {
        if c == '"' && (0..hashes).all(|_| rest.next_if_eq(&'#').is_some()) {
            return;
        }
    }
}

/// Skips a character literal, or the quote of a lifetime.
fn skip_character(rest: &mut Peekable<Chars<'_>>) {
    let mut ahead = rest.clone();
    match (ahead.next(), ahead.next()) {
        (Some('\\'), _) => {
            rest.next();
            rest.next();
            while rest.next().is_some_and(|c| c != '\'') {}
        }
        (Some(_), Some('\'')) => {
            rest.next();
            rest.next();
        }
        _ => {}
    }
}
