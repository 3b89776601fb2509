//! Sanitising of text from untrusted files, and its hash.

/// Sanitises untrusted text for a message: at most `longest` characters, with control characters replaced by `·`.
pub fn sanitised(text: &str, longest: usize) -> String {
    let mut characters = text.chars().map(|c| if is_unsafe_character(c) { '·' } else { c });
    let mut short: String = characters.by_ref().take(longest).collect();
    if characters.next().is_some() {
        short.push('…');
    }
    short
}

/// Sanitises untrusted text for storage: one line of at most `longest` characters, with control characters removed.
pub fn sanitised_line(text: &str, longest: usize) -> String {
    text.chars().filter(|&c| !is_unsafe_character(c)).take(longest).collect()
}

/// Sanitises text for a terminal: control characters other than line feeds become `·`.
pub fn without_controls(text: &str) -> String {
    text.chars().map(|c| if c != '\n' && is_unsafe_character(c) { '·' } else { c }).collect()
}

/// Joins untrusted text to one line for a terminal; control characters other than line breaks become `·`.
pub fn one_line(text: &str) -> String {
    let mut line = String::new();
    for part in text.lines().map(str::trim).filter(|part| !part.is_empty()) {
        if !line.is_empty() && !part.starts_with([',', ';', '.', ':', ')']) {
            line.push(' ');
        }
        line.push_str(part);
    }
    without_controls(&line)
}

/// Returns a hash of a text that is stable across versions and machines: 64-bit FNV-1a
/// (<https://datatracker.ietf.org/doc/html/rfc9923>).
pub fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Returns true if a character could disturb a terminal or change the writing direction of a line.
fn is_unsafe_character(c: char) -> bool {
    // The replacement character is included: it stands for bytes that were not valid text, and few fonts have it.
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || c == char::REPLACEMENT_CHARACTER
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn untrusted_text_is_sanitised() {
        assert_eq!(sanitised("abcdef", 3), "abc…");
        assert_eq!(sanitised("abc", 3), "abc");
        assert_eq!(sanitised("a\u{202e}b", 9), "a·b");
        assert_eq!(one_line("found 0\n; expected\r\n  a\u{1b}[2J\n\n"), "found 0; expected a·[2J");
        assert_eq!((one_line("a: b"), one_line("\n")), ("a: b".to_owned(), String::new()));
        assert_eq!(sanitised_line("a\u{202e}\u{1b}[2J\nb\u{2069}cd", 6), "a[2Jbc");
    }
}
