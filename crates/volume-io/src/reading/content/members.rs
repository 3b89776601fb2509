//! Decoders of gzip and bzip2 streams of one or several members; bytes after the last member are ignored.
//!
//! Tapes and block copies pad files with zeros, and mail gateways append lines. Bytes after a complete member that do
//! not begin another one are no part of the content, as in gzip itself ("trailing garbage ignored", and zeros
//! silently) and zlib's `gzread`. Truncated members, and wrong checksums, are errors.

use std::io::{self, BufRead, Read};

use bzip2::bufread::BzDecoder;
use flate2::bufread::GzDecoder;

/// Maximum length of zero padding that is searched for another member: the largest block of tapes (LTO, 16 MiB).
const MAX_PADDING_BYTES: u64 = 16 << 20;

/// Decoder of a single member.
pub(crate) trait Member: Read {
    /// Reader of the compressed bytes.
    type Packed: BufRead;
    /// Magic bytes at the beginning of every member.
    const MAGIC: &'static [u8];

    /// Starts a decoder at the next member.
    fn new(packed: Self::Packed) -> Self;

    /// Returns the reader, positioned after the member, once all of it has been decoded.
    fn into_packed(self) -> Self::Packed;
}

/// Member of a gzip file (RFC 1952: two bytes of magic, then method 8).
impl<R: BufRead> Member for GzDecoder<Lookahead<R>> {
    type Packed = Lookahead<R>;
    const MAGIC: &'static [u8] = &[0x1f, 0x8b, 8];

    fn new(packed: Lookahead<R>) -> Self {
        Self::new(packed)
    }

    fn into_packed(self) -> Lookahead<R> {
        self.into_inner()
    }
}

/// Member of a bzip2 file, decoded by the `bzip2` crate.
impl<R: BufRead> Member for BzDecoder<Lookahead<R>> {
    type Packed = Lookahead<R>;
    const MAGIC: &'static [u8] = b"BZh";

    fn new(packed: Lookahead<R>) -> Self {
        Self::new(packed)
    }

    fn into_packed(self) -> Lookahead<R> {
        self.into_inner()
    }
}

/// Reader of the concatenated content of all members.
pub(crate) struct Members<M> {
    /// Decoder of the current member; `None` after the last one, and after an error.
    current: Option<M>,
}

/// Reader of the content of a gzip file.
pub(crate) type GzipMembers<R> = Members<GzDecoder<Lookahead<R>>>;

/// Reader of the content of a bzip2 file.
pub(crate) type Bzip2Members<R> = Members<BzDecoder<Lookahead<R>>>;

impl<R: BufRead, M: Member<Packed = Lookahead<R>>> Members<M> {
    /// Starts decoding compressed bytes, which must begin with a member.
    pub(crate) fn new(packed: R) -> Self {
        Self { current: Some(M::new(Lookahead { front: Vec::new(), at: 0, rest: packed })) }
    }
}

impl<R: BufRead, M: Member<Packed = Lookahead<R>>> Read for Members<M> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if into.is_empty() {
            return Ok(0);
        }
        while let Some(mut member) = self.current.take() {
            match member.read(into) {
                Ok(0) => {
                    let mut packed = member.into_packed();
                    if packed.skip_padding()? && packed.begins_with(M::MAGIC)? {
                        self.current = Some(M::new(packed));
                    }
                }
                Err(error) if error.kind() != io::ErrorKind::Interrupted => return Err(error),
                read => {
                    self.current = Some(member);
                    return read;
                }
            }
        }
        Ok(0)
    }
}

/// Reader that can look ahead some bytes without consuming them.
pub(crate) struct Lookahead<R> {
    /// Bytes that were looked at; those before `at` have been consumed since.
    front: Vec<u8>,
    at: usize,
    rest: R,
}

impl<R: BufRead> Lookahead<R> {
    /// Fills the buffer and returns it, empty only at the end of the stream; retries after interruption by a signal.
    fn block(&mut self) -> io::Result<&[u8]> {
        loop {
            match self.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
                Ok(_) => return self.fill_buf(),
            }
        }
    }

    /// Skips zeros, up to the limit; returns true if anything else follows.
    fn skip_padding(&mut self) -> io::Result<bool> {
        let mut skipped = 0;
        while skipped < MAX_PADDING_BYTES {
            let block = self.block()?;
            let zeros = block.iter().take_while(|&&byte| byte == 0).count();
            if zeros < block.len() || block.is_empty() {
                let is_more = !block.is_empty();
                self.consume(zeros);
                return Ok(is_more);
            }
            self.consume(zeros);
            skipped += zeros as u64;
        }
        Ok(false)
    }

    /// True if these bytes come next; they are not consumed.
    fn begins_with(&mut self, bytes: &[u8]) -> io::Result<bool> {
        let mut front = Vec::new();
        while front.len() < bytes.len() {
            let block = self.block()?;
            let count = block.len().min(bytes.len() - front.len());
            if count == 0 {
                break;
            }
            front.extend_from_slice(&block[..count]);
            self.consume(count);
        }
        let is_same = front == bytes;
        // Bytes from an earlier look-ahead that are still unread follow.
        front.extend_from_slice(self.front.get(self.at..).unwrap_or_default());
        (self.front, self.at) = (front, 0);
        Ok(is_same)
    }
}

impl<R: BufRead> BufRead for Lookahead<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at < self.front.len() { Ok(&self.front[self.at..]) } else { self.rest.fill_buf() }
    }

    fn consume(&mut self, count: usize) {
        if self.at < self.front.len() { self.at += count } else { self.rest.consume(count) }
    }
}

impl<R: BufRead> Read for Lookahead<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let block = self.fill_buf()?;
        let count = block.len().min(into.len());
        into[..count].copy_from_slice(&block[..count]);
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Write as _};

    use super::*;
    use crate::tests::helpers::gzip;

    fn bzip2(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    /// Decompresses a stream with a read buffer of `room` bytes.
    fn content(packed: &[u8], room: usize) -> io::Result<Vec<u8>> {
        let mut content = Vec::new();
        let packed_by = BufReader::with_capacity(room, packed);
        if packed.starts_with(b"BZh") {
            Bzip2Members::new(packed_by).read_to_end(&mut content)?;
        } else {
            GzipMembers::new(packed_by).read_to_end(&mut content)?;
        }
        Ok(content)
    }

    #[test]
    fn bytes_behind_a_whole_member_are_passed_over_and_members_joined() {
        for pack in [gzip as fn(&[u8]) -> Vec<u8>, bzip2] {
            let [one, two] = [pack(b"one"), pack(b"two")];
            let magic = one[..3].to_vec();
            let zeros = vec![0; 40_000];
            for (behind, expected) in [
                (vec![], "one"),
                (zeros.clone(), "one"),
                (b"-- sent by a gateway --\r\n".to_vec(), "one"),
                (magic[..2].to_vec(), "one"),
                (vec![magic[0]], "one"),
                (vec![0xFF; 70_000], "one"),
                (two.clone(), "onetwo"),
                ([&zeros[..], &two, &zeros].concat(), "onetwo"),
                ([&two[..], &one, b"junk", &two].concat(), "onetwoone"),
            ] {
                for room in [1, 2, 3, 7, 1 << 16] {
                    let found = content(&[&one[..], &behind].concat(), room).unwrap();
                    assert_eq!(String::from_utf8(found).unwrap(), expected, "{room} {}", behind.len());
                }
            }
        }
    }

    #[test]
    fn members_that_are_cut_off_or_changed_are_errors() {
        for pack in [gzip as fn(&[u8]) -> Vec<u8>, bzip2] {
            let (one, two) = (pack(b"one and more"), pack(b"two"));
            for end in 1..one.len() {
                assert!(content(&one[..end], 64).is_err(), "cut to {end}");
            }
            for end in 4..two.len() {
                let cut = [&one[..], &two[..end]].concat();
                assert!(content(&cut, 64).is_err(), "the second member is cut to {end}");
            }
            let mut changed = one.clone();
            let checksum = changed.len() - 6;
            changed[checksum] ^= 1;
            assert!(content(&changed, 64).is_err());
            assert!(content(&[&changed[..], &[0; 512]].concat(), 64).is_err(), "also where zeros follow");
        }
    }

    #[test]
    fn padding_has_an_end() {
        let one = gzip(b"one");
        let endless = one.chain(io::repeat(0).take(1 << 40));
        let mut content = Vec::new();
        GzipMembers::new(BufReader::with_capacity(1 << 20, endless)).read_to_end(&mut content).unwrap();
        assert_eq!(content, b"one");
    }
}
