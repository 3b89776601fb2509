//! Line reader for files with data between the lines, which it can skip.

use std::io::{self, BufRead, Cursor, Read};

use super::super::super::{LoadControl, LoadError};
use super::super::image::content_error;
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum length of a line, in bytes: VTK itself reads 256.
const MAX_LINE_BYTES: u64 = 4096;

/// Lines of a file, and the data between them.
pub(super) struct LegacyLines<'a> {
    context: LoadContext<'a>,
    control: &'a LoadControl,
    reader: CountingReader<'a>,
}

impl<'a> LegacyLines<'a> {
    pub(super) fn new(
        context: LoadContext<'a>,
        reader: Box<dyn BufRead + 'a>,
        control: &'a LoadControl,
    ) -> Self {
        let reader = CountingReader { ahead: Cursor::default(), reader, position: 0 };
        Self { context, control, reader }
    }

    /// Offset of the next byte in the content.
    pub(super) fn position(&self) -> u64 {
        self.reader.position
    }

    /// Reads the next line, without surrounding white space; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<String>, LoadError> {
        self.control.check()?;
        let mut line = Vec::new();
        let read = self.reader.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut line);
        read.map_err(|error| content_error(self.context, error))?;
        let text = String::from_utf8_lossy(&line);
        if line.len() as u64 == MAX_LINE_BYTES && !line.ends_with(b"\n") {
            let why = format!("a line is longer than {MAX_LINE_BYTES} bytes: {}", quoted(&text));
            return Err(self.context.bad_input_error("lines", why, "check that it is a VTK file"));
        }
        Ok((!line.is_empty()).then(|| text.trim().to_owned()))
    }

    /// Reads the next line that is not blank.
    pub(super) fn next_non_blank(&mut self) -> Result<Option<String>, LoadError> {
        loop {
            match self.next()? {
                Some(line) if line.is_empty() => {}
                line => return Ok(line),
            }
        }
    }

    /// Returns true if a word comes next, ignoring case; it is not consumed.
    pub(super) fn begins_with(&mut self, word: &str) -> Result<bool, LoadError> {
        let mut seen = Vec::new();
        let position = self.reader.position;
        let read = self.reader.by_ref().take(word.len() as u64).read_to_end(&mut seen);
        read.map_err(|error| content_error(self.context, error))?;
        let is_it = seen.eq_ignore_ascii_case(word.as_bytes());
        let rest = std::mem::take(&mut self.reader.ahead);
        let (rest, at) = (rest.get_ref().as_slice(), rest.position() as usize);
        seen.extend(rest.get(at..).unwrap_or_default());
        self.reader.ahead = Cursor::new(seen);
        self.reader.position = position;
        Ok(is_it)
    }

    /// Skips bytes; returns false if the file ends before that.
    pub(super) fn skip_bytes(&mut self, bytes: u64) -> Result<bool, LoadError> {
        let mut left = bytes;
        while left > 0 {
            let block = self.block()?;
            if block.is_empty() {
                return Ok(false);
            }
            let used = usize::try_from(left).map_or(block.len(), |left| left.min(block.len()));
            self.reader.consume(used);
            left -= used as u64;
        }
        Ok(true)
    }

    /// Skips words separated by white space; returns false if the file ends before that.
    pub(super) fn skip_words(&mut self, words: u64) -> Result<bool, LoadError> {
        let mut left = words;
        let mut is_within = false;
        while left > 0 {
            let block = self.block()?;
            if block.is_empty() {
                return Ok(left == u64::from(is_within));
            }
            let mut used = 0;
            for byte in block {
                let is_space = byte.is_ascii_whitespace();
                if is_within && is_space {
                    left -= 1;
                }
                is_within = !is_space;
                if left == 0 {
                    break;
                }
                used += 1;
            }
            self.reader.consume(used);
        }
        Ok(true)
    }

    fn block(&mut self) -> Result<&[u8], LoadError> {
        self.control.check()?;
        self.reader.fill_buf().map_err(|error| content_error(self.context, error))
    }
}

/// Reader that counts its position, with a buffer for bytes that are put back.
struct CountingReader<'a> {
    ahead: Cursor<Vec<u8>>,
    reader: Box<dyn BufRead + 'a>,
    position: u64,
}

impl CountingReader<'_> {
    fn is_ahead(&self) -> bool {
        self.ahead.position() < self.ahead.get_ref().len() as u64
    }
}

impl Read for CountingReader<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = if self.is_ahead() { self.ahead.read(into) } else { self.reader.read(into) }?;
        self.position += read as u64;
        Ok(read)
    }
}

impl BufRead for CountingReader<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.is_ahead() { self.ahead.fill_buf() } else { self.reader.fill_buf() }
    }

    fn consume(&mut self, used: usize) {
        self.position += used as u64;
        if self.is_ahead() {
            self.ahead.consume(used);
        } else {
            self.reader.consume(used);
        }
    }
}
