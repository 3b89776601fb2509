//! Lossless encoding of file paths as text, including names that are not UTF-8.
//!
//! On Unix a file's name is any bytes. Paths that are not UTF-8 are percent-encoded: `%` and two hexadecimal digits
//! for everything but plain ASCII, as in URLs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Encodes a path that is not UTF-8; `None` if it is UTF-8, or on systems where names are not bytes.
pub fn encode_path(path: &Path) -> Option<String> {
    if path.to_str().is_some() {
        return None;
    }
    let mut text = String::new();
    for &byte in path_bytes(path)? {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            text.push(char::from(byte));
        } else {
            write!(text, "%{byte:02X}").ok()?;
        }
    }
    Some(text)
}

/// Decodes a path encoded by [`encode_path`]; `None` if the text is malformed.
pub fn decode_path(text: &str) -> Option<PathBuf> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => 16 * hex_digit(rest.next()?)? + hex_digit(rest.next()?)?,
            plain => plain,
        });
    }
    path_from_bytes(bytes)
}

/// Returns the value of a hexadecimal digit.
fn hex_digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).and_then(|value| u8::try_from(value).ok())
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "other systems have no bytes")]
fn path_bytes(path: &Path) -> Option<&[u8]> {
    Some(std::os::unix::ffi::OsStrExt::as_bytes(path.as_os_str()))
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "on other systems not all bytes are a name")]
fn path_from_bytes(bytes: Vec<u8>) -> Option<PathBuf> {
    Some(PathBuf::from(<std::ffi::OsString as std::os::unix::ffi::OsStringExt>::from_vec(bytes)))
}

#[cfg(not(unix))]
fn path_bytes(_: &Path) -> Option<&[u8]> {
    None
}

#[cfg(not(unix))]
fn path_from_bytes(bytes: Vec<u8>) -> Option<PathBuf> {
    String::from_utf8(bytes).ok().map(PathBuf::from)
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    use super::*;

    #[test]
    fn no_byte_is_lost() {
        for (first, second) in
            (1..=u8::MAX).flat_map(|first| (1..=u8::MAX).map(move |second| (first, second)))
        {
            let name = [b'/', b'a', first, second, b'%'];
            let path = Path::new(OsStr::from_bytes(&name));
            match encode_path(path) {
                Some(text) => {
                    assert!(text.is_ascii());
                    assert_eq!(decode_path(&text).as_deref(), Some(path));
                }
                None => assert!(path.to_str().is_some(), "{name:?}"),
            }
        }
    }

    #[test]
    fn text_that_is_cut_off_or_no_number_is_no_path() {
        for text in ["%", "a%F", "%G0", "%é"] {
            assert_eq!(decode_path(text), None, "{text}");
        }
        assert_eq!(encode_path(Path::new(OsStr::from_bytes(b"/a b/\xff"))).as_deref(), Some("/a%20b/%FF"));
    }
}
