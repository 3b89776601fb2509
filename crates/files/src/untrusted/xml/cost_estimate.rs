//! Cost estimate of parsing an XML text: the name comparisons of the parser, counted in one pass over the bytes.

use super::{MAX_XML_BYTES, XmlError};

/// Maximum number of `<`, and of `=`, in a text. Each node begins with one, and each attribute has one; the parser
/// reserves memory by their number, 64 and 48 bytes each.
const MAX_MARKUP_CHARACTERS: usize = 8 << 20;

/// Maximum nesting depth: OME-XML has about ten levels, VTK files five.
const MAX_DEPTH: usize = 256;

/// Comparisons of names that any text may cost: 0.1 s to 0.2 s at 3 ns to 5 ns each. An element may have 8000
/// attributes.
const FREE_COMPARISONS: u64 = 32 << 20;

/// Additional comparisons allowed per byte of text, likewise 0.3 s to 0.4 s for every 10 MB. An attribute has six
/// bytes at least, so that any number of elements with 96 attributes may follow each other; those of OME-XML have up
/// to 25.
const COMPARISONS_PER_BYTE: u64 = 8;

/// Bytes of a name that are compared at once; longer names count as several comparisons.
const WORD_BYTES: usize = 32;

/// Running count of the comparisons that parsing a text requires.
#[derive(Debug, Default)]
pub(super) struct XmlCostEstimate {
    /// Number of namespaces in scope of each open element, the innermost last.
    open: Vec<u64>,
    comparisons: u64,
    most_attributes: u64,
    most_namespaces: u64,
    /// Length in bytes of the longest namespace URI so far, and of the longest prefix.
    longest_uri: usize,
    longest_prefix: usize,
}

/// Counts of attributes and namespaces in a start tag.
#[derive(Debug, Default)]
struct StartTagCounts {
    length: usize,
    is_empty: bool,
    attributes: u64,
    prefixed: u64,
    namespaces: u64,
    longest_name: usize,
}

impl XmlCostEstimate {
    /// Rejects a text that would take long to parse. Text that is not well-formed passes: the parser stops there.
    pub(super) fn check(text: &str) -> Result<(), XmlError> {
        let bytes = text.as_bytes();
        let within = |what, found, most| {
            if found > most { Err(XmlError::Length { what, found, max: most }) } else { Ok(()) }
        };
        within("bytes", bytes.len(), MAX_XML_BYTES)?;
        within("tags", text.matches('<').count(), MAX_MARKUP_CHARACTERS)?;
        within("equals signs", text.matches('=').count(), MAX_MARKUP_CHARACTERS)?;
        Self::default().scan(bytes)
    }

    /// Scans a whole text, finding the end of each tag by the parser's own rules.
    fn scan(&mut self, bytes: &[u8]) -> Result<(), XmlError> {
        let most = FREE_COMPARISONS + COMPARISONS_PER_BYTE * bytes.len() as u64;
        let mut at = 0;
        while let Some(begin) = position(bytes, at, b'<') {
            let rest = &bytes[begin..];
            let length = if rest.starts_with(b"<!--") {
                length_through(rest, 4, b"-->")
            } else if rest.starts_with(b"<![CDATA[") {
                length_through(rest, 9, b"]]>")
            } else if rest.starts_with(b"<?") {
                length_through(rest, 2, b"?>")
            } else if rest.starts_with(b"</") {
                self.open.pop();
                length_through(rest, 2, b">")
            } else if rest.starts_with(b"<!") {
                // A document type or an error: the parser stops here.
                None
            } else if let Some(tag) = start_tag(rest, &mut self.longest_uri, &mut self.longest_prefix) {
                self.count(&tag)?;
                if self.comparisons > most {
                    return Err(XmlError::Comparisons {
                        attributes: self.most_attributes as usize,
                        namespaces: self.most_namespaces as usize,
                    });
                }
                Some(tag.length)
            } else {
                None
            };
            let Some(length) = length else { break };
            at = begin + length;
        }
        Ok(())
    }

    /// Adds the comparisons that a start tag requires.
    fn count(&mut self, tag: &StartTagCounts) -> Result<(), XmlError> {
        let words = |bytes: usize| 1 + (bytes / WORD_BYTES) as u64;
        let outside = self.open.last().copied().unwrap_or(0);
        // An upper bound: assumes that no declaration overrides the prefix of an outer one.
        let scope = outside + tag.namespaces;
        let all_namespaces = if tag.namespaces > 0 { scope } else { 0 };
        for (pairs, name_bytes) in [
            // Each attribute with those before it: by its own name and, if it has a prefix, by its namespace's URI.
            (tag.attributes * tag.attributes / 2, tag.longest_name),
            (tag.prefixed * tag.prefixed / 2, self.longest_uri),
            // The prefix of the element and of each attribute with every namespace in scope.
            ((tag.prefixed + 1) * scope, self.longest_prefix),
            // Where a namespace is declared, those in scope are copied, each compared with those already copied.
            (all_namespaces * all_namespaces, self.longest_prefix),
        ] {
            self.comparisons = self.comparisons.saturating_add(pairs.saturating_mul(words(name_bytes)));
        }
        self.most_attributes = self.most_attributes.max(tag.attributes);
        self.most_namespaces = self.most_namespaces.max(scope);
        if !tag.is_empty {
            self.open.push(scope);
        }
        if self.open.len() > MAX_DEPTH { Err(XmlError::Depth { most: MAX_DEPTH }) } else { Ok(()) }
    }
}

/// Parses the start tag at the beginning of `bytes` to counts; `None` if the parser would stop within it.
fn start_tag(bytes: &[u8], longest_uri: &mut usize, longest_prefix: &mut usize) -> Option<StartTagCounts> {
    let mut tag = StartTagCounts::default();
    let mut at = name_end(bytes, 1);
    loop {
        at = space_end(bytes, at);
        match *bytes.get(at)? {
            b'>' => break,
            b'/' if bytes.get(at + 1) == Some(&b'>') => {
                at += 1;
                tag.is_empty = true;
                break;
            }
            _ => {}
        }
        let begin = at;
        at = name_end(bytes, begin);
        let name = &bytes[begin..at];
        at = space_end(bytes, at);
        if name.is_empty() || bytes.get(at) != Some(&b'=') {
            return None;
        }
        at = space_end(bytes, at + 1);
        let quote = bytes.get(at).copied().filter(|byte| matches!(byte, b'"' | b'\''))?;
        let end = position(bytes, at + 1, quote)?;
        let value_bytes = end - at - 1;
        at = end + 1;
        let colon = name.iter().position(|&byte| byte == b':');
        let (prefix, local) = colon.map_or((&b""[..], name), |colon| (&name[..colon], &name[colon + 1..]));
        if prefix == b"xmlns" || local == b"xmlns" {
            tag.namespaces += 1;
            *longest_uri = value_bytes.max(*longest_uri);
            *longest_prefix = name.len().max(*longest_prefix);
        } else {
            tag.attributes += 1;
            tag.prefixed += u64::from(!prefix.is_empty());
            tag.longest_name = name.len().max(tag.longest_name);
        }
    }
    tag.length = at + 1;
    Some(tag)
}

/// Returns the end of the name at a byte offset: a superset of the names that the parser accepts.
fn name_end(bytes: &[u8], from: usize) -> usize {
    let is_end =
        |byte: u8| byte.is_ascii_whitespace() || matches!(byte, b'=' | b'/' | b'>' | b'<' | b'"' | b'\'');
    bytes[from..].iter().position(|&byte| is_end(byte)).map_or(bytes.len(), |length| from + length)
}

/// Returns the end of the white space at a byte offset.
fn space_end(bytes: &[u8], from: usize) -> usize {
    let rest = bytes.get(from..).unwrap_or_default();
    from + rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count()
}

/// Returns the position of the next occurrence of a byte, at or after `from`.
fn position(bytes: &[u8], from: usize, wanted: u8) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.iter().position(|&byte| byte == wanted).map(|length| from + length)
}

/// Returns the length up to and including the delimiter `end`, searched from offset `from`.
fn length_through(bytes: &[u8], from: usize, end: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.windows(end.len()).position(|window| window == end).map(|length| from + length + end.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparisons_count_what_the_parser_does() {
        let count = |text: &str| {
            let mut survey = XmlCostEstimate::default();
            survey.scan(text.as_bytes()).unwrap();
            survey
        };
        let survey = count("<r xmlns='u' xmlns:a='w'><b c='1' a:d='2'/><e/></r><!x <f xmlns:g='h'/>");
        assert_eq!((survey.most_attributes, survey.most_namespaces, survey.longest_prefix), (2, 2, 7));
        // The root: 1 · 2 + 2²; b: 2² / 2 + 2 · 2, rounded down for its prefixed attribute; e: 2.
        assert_eq!((survey.comparisons, survey.open.len()), (6 + 6 + 2, 0));
        assert_eq!(count("<r><a><b/></a>").open.len(), 1);
    }
}
