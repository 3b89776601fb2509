//! Records in GIF and MP4 files: the settings of their first picture.

use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::ReadPictureError;
use chiaroscuro_files::{MAX_LOOK_BYTES, open_regular};

/// Marker before the record in a GIF comment, which distinguishes it from comments of other programs.
const GIF_RECORD_MARKER: &[u8] = b"chiaroscuro\n";

/// UUID of the record's box in an MP4: players skip unknown boxes (ISO/IEC 14496-12, 4.2).
const RECORD_BOX_UUID: [u8; 16] = *b"chiaroscuro.look";

/// Maximum number of boxes that are examined: a video has a handful.
const MAX_BOXES: usize = 64;

/// Returns the content of a GIF comment with a record.
pub(super) fn gif_comment(record: &str) -> Vec<u8> {
    [GIF_RECORD_MARKER, record.as_bytes()].concat()
}

/// Appends a record to the end of an MP4.
pub(super) fn append_to_mp4(file: &mut impl Write, record: &str) -> std::io::Result<()> {
    let length = 8 + RECORD_BOX_UUID.len() + record.len();
    let Ok(length) = u32::try_from(length) else { return Ok(()) };
    file.write_all(&length.to_be_bytes())?;
    file.write_all(b"uuid")?;
    file.write_all(&RECORD_BOX_UUID)?;
    file.write_all(record.as_bytes())
}

/// Reads the record of a GIF or an MP4, by the file's extension; `None` for other files.
pub(crate) fn read_record(path: &Path) -> Option<Result<Option<String>, ReadPictureError>> {
    let is = |ending: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    let read: fn(BufReader<std::fs::File>) -> std::io::Result<Option<Vec<u8>>> = match () {
        () if is("gif") => find_in_gif,
        () if is("mp4") => find_in_mp4,
        () => return None,
    };
    Some(open_regular(path).map_err(Into::into).and_then(|file| {
        let failed = |why: &dyn std::fmt::Display| ReadPictureError::new(path, why);
        let found = read(BufReader::new(file)).map_err(|err| failed(&err))?;
        found.map(|bytes| String::from_utf8(bytes).map_err(|err| failed(&err))).transpose()
    }))
}

/// Finds the comment with the marker before the first picture.
fn find_in_gif(file: impl Read) -> std::io::Result<Option<Vec<u8>>> {
    // Records are at the beginning, and files may be of any length.
    let mut file = file.take(4 * MAX_LOOK_BYTES as u64);
    let mut head = [0; 13];
    file.read_exact(&mut head)?;
    if !head.starts_with(b"GIF8") {
        return Err(std::io::Error::other("it is not a GIF"));
    }
    // Global colour table: 3 bytes for each of 2^(n + 1) colours.
    if head[10] & 0x80 != 0 {
        skip(&mut file, 3 << ((head[10] & 7) + 1))?;
    }
    let byte = |file: &mut dyn Read| {
        let mut one = [0];
        file.read_exact(&mut one).map(|()| one[0])
    };
    // Extensions begin with 0x21, pictures with 0x2c, and 0x3b is the trailer.
    while byte(&mut file)? == 0x21 {
        let is_comment = byte(&mut file)? == 0xfe;
        let mut text = Vec::new();
        loop {
            let length = byte(&mut file)?;
            if length == 0 {
                break;
            }
            let mut part = vec![0; length.into()];
            file.read_exact(&mut part)?;
            if is_comment && text.len() < MAX_LOOK_BYTES + GIF_RECORD_MARKER.len() {
                text.extend(part);
            }
        }
        if let Some(record) = text.strip_prefix(GIF_RECORD_MARKER) {
            return Ok(Some(record.to_vec()));
        }
    }
    Ok(None)
}

fn skip(file: &mut impl Read, bytes: u64) -> std::io::Result<()> {
    std::io::copy(&mut file.take(bytes), &mut std::io::sink()).map(drop)
}

/// Finds the record's box among the top-level boxes of an MP4.
fn find_in_mp4(mut file: impl Read + Seek) -> std::io::Result<Option<Vec<u8>>> {
    for _ in 0..MAX_BOXES {
        let mut head = [0; 8];
        if file.read_exact(&mut head).is_err() {
            return Ok(None);
        }
        let [a, b, c, d, kind @ ..] = head;
        let mut length = u64::from(u32::from_be_bytes([a, b, c, d]));
        let mut passed = 8;
        if length == 1 {
            // The length does not fit in 32 bits.
            let mut long = [0; 8];
            file.read_exact(&mut long)?;
            (length, passed) = (u64::from_be_bytes(long), 16);
        }
        // A length of 0 extends to the end of the file.
        let Some(left) = length.checked_sub(passed) else { return Ok(None) };
        if kind == *b"uuid" && left >= RECORD_BOX_UUID.len() as u64 {
            let mut name = [0; RECORD_BOX_UUID.len()];
            file.read_exact(&mut name)?;
            let left = left - RECORD_BOX_UUID.len() as u64;
            if name == RECORD_BOX_UUID {
                let mut record = Vec::new();
                file.take(left.min(MAX_LOOK_BYTES as u64)).read_to_end(&mut record)?;
                return Ok(Some(record));
            }
            file.seek(SeekFrom::Current(i64::try_from(left).unwrap_or(i64::MAX)))?;
        } else {
            file.seek(SeekFrom::Current(i64::try_from(left).unwrap_or(i64::MAX)))?;
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn films_carry_a_record_among_other_boxes() {
        let mut film = Vec::new();
        for (kind, length) in [(b"ftyp", 12_u32), (b"mdat", 300), (b"uuid", 40)] {
            film.extend((8 + length).to_be_bytes());
            film.extend(kind);
            film.extend(vec![7; length as usize]);
        }
        let read = |film: &[u8]| find_in_mp4(std::io::Cursor::new(film.to_vec())).unwrap();
        assert_eq!(read(&film), None);
        append_to_mp4(&mut film, "{\"schema\": 2}").unwrap();
        assert_eq!(read(&film).as_deref(), Some(&b"{\"schema\": 2}"[..]));
        for cut in 0..film.len() {
            // A file that is cut off anywhere must not cause a failure.
            drop(find_in_mp4(std::io::Cursor::new(film[..cut].to_vec())));
        }
        let endless = [0, 0, 0, 8, b'f', b'r', b'e', b'e'].repeat(10_000);
        assert_eq!(read(&endless), None);
        assert_eq!(read(&[0, 0, 0, 0, b'm', b'd', b'a', b't', 1, 2]), None);
    }

    #[test]
    fn gifs_carry_one_in_a_comment() {
        let record = "x".repeat(1000);
        let mut bytes = Vec::new();
        {
            let mut encoder = gif::Encoder::new(&mut bytes, 1, 1, &[0; 12]).unwrap();
            encoder.set_repeat(gif::Repeat::Infinite).unwrap();
            encoder.write_raw_extension(gif::Extension::Comment.into(), &[b"by somebody"]).unwrap();
            encoder.write_raw_extension(gif::Extension::Comment.into(), &[&gif_comment(&record)]).unwrap();
            encoder.write_frame(&gif::Frame::from_rgb(1, 1, &[1, 2, 3])).unwrap();
        }
        assert_eq!(find_in_gif(&bytes[..]).unwrap(), Some(record.into_bytes()));
        assert!((0..bytes.len()).all(|cut| find_in_gif(&bytes[..cut]).is_ok_and(|found| found.is_none())
            || find_in_gif(&bytes[..cut]).is_err()
            || cut > 1000));
        assert!(find_in_gif(&b"PNG, which is something else"[..]).is_err());
    }
}
