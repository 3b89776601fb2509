//! LZF, the filter 32000 of h5py: literals, and copies of up to 264 bytes from the 8192 before.

/// Decompresses to at most `limit` bytes.
pub(super) fn decode(bytes: &[u8], limit: usize) -> Result<Vec<u8>, String> {
    let mut found = Vec::new();
    let mut rest = bytes;
    let mut next = |count: usize| -> Result<&[u8], String> {
        let (taken, after) = rest.split_at_checked(count).ok_or("it ends too early")?;
        rest = after;
        Ok(taken)
    };
    loop {
        let Ok(&[control]) = next(1) else { return Ok(found) };
        let control = usize::from(control);
        if control < 32 {
            found.extend_from_slice(next(control + 1)?);
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(next(1)?[0]);
            }
            let distance = (control & 31) << 8 | usize::from(next(1)?[0]);
            let Some(from) = found.len().checked_sub(distance + 1) else {
                return Err("it refers to bytes before its beginning".to_owned());
            };
            let (length, period) = (length + 2, distance + 1);
            if length <= period {
                found.extend_from_within(from..from + length);
            } else {
                // The copy overlaps itself: the bytes repeat.
                (0..length).for_each(|at| found.push(found[from + at % period]));
            }
        }
        if found.len() > limit {
            return Err(format!("it has more than the {limit} bytes that a chunk can have"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_copies_are_expanded() {
        assert_eq!(decode(&[2, b'a', b'b', b'c', 1 << 5, 2], 9).unwrap(), b"abcabc");
        assert_eq!(decode(&[0, 9, 7 << 5, 1, 0], 20).unwrap(), [9; 11], "a run of one byte");
        assert!(decode(&[], 1).unwrap().is_empty());
        assert!(decode(&[0, 9, 7 << 5, 255, 0], 20).unwrap_err().contains("more than"));
        assert!(decode(&[1 << 5, 0], 20).unwrap_err().contains("before"));
        assert!(decode(&[3, 1], 20).unwrap_err().contains("early"));
        assert!(decode(&[0, 1, 7 << 5], 20).is_err());
    }
}
