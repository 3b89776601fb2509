//! Parser of the Python dictionary in an array's header, restricted to what NumPy writes.

/// Value of a dictionary entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum PythonValue {
    Text(String),
    Bool(bool),
    /// Tuple of non-negative integers.
    Numbers(Vec<u64>),
    /// List, whose content is discarded: the fields of a record type.
    List,
}

/// Maximum number of axes of a NumPy array.
const MAX_AXES: usize = 64;

/// Parses a dictionary; the error tells what was expected instead.
pub(super) fn parse(text: &str) -> Result<Vec<(String, PythonValue)>, &'static str> {
    let mut text = DictionaryParser(text.trim_ascii());
    text.require('{', "a dictionary in braces")?;
    let mut entries = Vec::new();
    while !text.skip_char('}') {
        let key = text.quoted().ok_or("a key in quotes")?;
        text.require(':', "a colon after a key")?;
        entries.push((key, text.value()?));
        if !text.skip_char(',') {
            text.require('}', "a comma or the closing brace")?;
            break;
        }
    }
    if text.rest().is_empty() { Ok(entries) } else { Err("nothing after the closing brace") }
}

/// Remaining text to be parsed.
struct DictionaryParser<'a>(&'a str);

impl<'a> DictionaryParser<'a> {
    fn rest(&mut self) -> &'a str {
        self.0 = self.0.trim_ascii_start();
        self.0
    }

    /// Skips a character if it comes next, and returns true then.
    fn skip_char(&mut self, sign: char) -> bool {
        let after = self.0.trim_ascii_start().strip_prefix(sign);
        self.0 = after.unwrap_or(self.0);
        after.is_some()
    }

    fn require(&mut self, sign: char, what: &'static str) -> Result<(), &'static str> {
        if self.skip_char(sign) { Ok(()) } else { Err(what) }
    }

    /// Parses text in single or double quotes, without escapes: type names contain none.
    fn quoted(&mut self) -> Option<String> {
        let quote = self.rest().chars().next().filter(|c| matches!(c, '\'' | '"'))?;
        let (inside, after) = self.0[1..].split_once(quote)?;
        self.0 = after;
        (!inside.contains('\\')).then(|| inside.to_owned())
    }

    fn value(&mut self) -> Result<PythonValue, &'static str> {
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(after) = self.rest().strip_prefix(word) {
                self.0 = after;
                return Ok(PythonValue::Bool(value));
            }
        }
        if self.skip_char('(') {
            return self.numbers().map(PythonValue::Numbers);
        }
        if self.rest().starts_with('[') {
            return self.list();
        }
        self.quoted().map(PythonValue::Text).ok_or("a string, True, False, a tuple or a list")
    }

    /// Parses the rest of a tuple, after its parenthesis.
    fn numbers(&mut self) -> Result<Vec<u64>, &'static str> {
        let mut numbers = Vec::new();
        while !self.skip_char(')') {
            let rest = self.rest();
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            // Numbers over 64 bits saturate, and are refused later.
            let number = rest.get(..end).filter(|digits| !digits.is_empty()).ok_or("a whole number")?;
            let number = number.parse().unwrap_or(u64::MAX);
            self.0 = &self.0[end..];
            // Python 2 appends L to long integers.
            self.skip_char('L');
            if numbers.len() == MAX_AXES {
                return Err("at most 64 axes");
            }
            numbers.push(number);
            if !self.skip_char(',') {
                self.require(')', "a comma or the closing parenthesis")?;
                break;
            }
        }
        Ok(numbers)
    }

    /// Skips a list with any content.
    fn list(&mut self) -> Result<PythonValue, &'static str> {
        let mut depth = 0usize;
        let mut quote = None;
        for (at, c) in self.0.char_indices() {
            match (quote, c) {
                (Some(open), c) if c == open => quote = None,
                (None, '\'' | '"') => quote = Some(c),
                (None, '[') => depth += 1,
                (None, ']') => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                self.0 = &self.0[at + 1..];
                return Ok(PythonValue::List);
            }
        }
        Err("the end of a list")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_numpy_writes_is_read() {
        let text = "{'descr': '<f4', \"fortran_order\": False, 'shape': (3, 40L, 5), }   \n";
        let entries = parse(text).unwrap();
        assert_eq!(entries[0], ("descr".to_owned(), PythonValue::Text("<f4".to_owned())));
        assert_eq!(entries[1].1, PythonValue::Bool(false));
        assert_eq!(entries[2].1, PythonValue::Numbers(vec![3, 40, 5]));
        assert_eq!(parse("{}").unwrap(), []);
        assert_eq!(parse("{'a':()}").unwrap()[0].1, PythonValue::Numbers(Vec::new()));
        assert_eq!(parse("{'a':(7,)}").unwrap()[0].1, PythonValue::Numbers(vec![7]));
        let records = "{'descr': [('x]', '<f4', (2,)), ('y', [('z', '|u1')])], 'b': True}";
        assert_eq!(parse(records).unwrap()[0].1, PythonValue::List);
        assert_eq!(
            parse("{'a':(99999999999999999999999,)}").unwrap()[0].1,
            PythonValue::Numbers(vec![u64::MAX])
        );
    }

    #[test]
    fn anything_else_is_not() {
        for text in [
            "",
            "{",
            "[]",
            "{'a'}",
            "{'a': }",
            "{'a': 1}",
            "{'a': (1 2)}",
            "{'a': (-1,)}",
            "{'a': (1,",
            "{'a': [",
            "{'a': ']'",
            "{'a': '\\'}",
            "{a: True}",
            "{'a': True 'b': True}",
            "{'a': True} x",
            "{'a': __import__('os')}",
            "{'é: True}",
        ] {
            assert!(parse(text).is_err(), "{text}");
        }
        assert!(parse(&format!("{{'a': ({})}}", "1,".repeat(65))).is_err());
        assert!(parse(&format!("{{'a': {}", "[".repeat(10_000))).is_err());
    }
}
