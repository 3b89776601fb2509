//! Own compression of Blosc, `BloscLZ`: a variant of `FastLZ`.
//!
//! After the decoder of c-blosc 1.21 (`blosc/blosclz.c`): control bytes are followed by literals, or are copies of
//! earlier bytes.

/// Largest distance that two bytes state; farther copies add two more bytes to it.
const MAX_NEAR_DISTANCE: usize = 8191;

/// Decompresses a block to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken block, or one of more bytes.
pub(super) fn decode_blosclz(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    decode(bytes, max_bytes).ok_or_else(|| "the BloscLZ data are broken".to_owned())
}

/// Decodes a block; `None` where it is broken.
fn decode(bytes: &[u8], max_bytes: usize) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(max_bytes);
    let mut rest = bytes.iter();
    let mut control = usize::from(*rest.next()?) & 31;
    loop {
        if control < 32 {
            let count = control + 1;
            let literals = rest.as_slice().get(..count)?;
            if out.len() + count > max_bytes {
                return None;
            }
            out.extend_from_slice(literals);
            rest.nth(count - 1);
        } else {
            let mut length = (control >> 5) - 1;
            let mut distance = (control & 31) << 8;
            if length == 6 {
                loop {
                    let more = usize::from(*rest.next()?);
                    length += more;
                    if more != 255 {
                        break;
                    }
                }
            }
            let low = usize::from(*rest.next()?);
            distance = if low == 255 && distance == 31 << 8 {
                let far = [usize::from(*rest.next()?), usize::from(*rest.next()?)];
                (far[0] << 8) + far[1] + MAX_NEAR_DISTANCE
            } else {
                distance + low
            } + 1;
            length += 3;
            // A block ends with literals: a copy without a successor is not carried out.
            if rest.as_slice().is_empty() {
                return Some(out);
            }
            if distance > out.len() || out.len() + length > max_bytes {
                return None;
            }
            let from = out.len() - distance;
            // A copy may reach into itself.
            for at in from..from + length {
                out.push(out[at]);
            }
        }
        match rest.next() {
            Some(next) => control = usize::from(*next),
            None => return Some(out),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_copies() {
        // Three literals; a copy of 4 + 3 bytes from a distance of 3; one literal.
        let packed = [2, b'a', b'b', b'c', 5 << 5, 2, 0, b'!'];
        assert_eq!(decode_blosclz(&packed, 11).unwrap(), b"abcabcabca!"[..].to_vec());
        assert!(decode_blosclz(&packed, 10).is_err(), "one byte more than expected");
        assert!(decode_blosclz(&[0, b'a', 5 << 5, 2, 0, b'!'], 11).is_err(), "before the beginning");
        assert!(decode_blosclz(&[9, b'a'], 11).is_err() && decode_blosclz(&[], 1).is_err());
    }
}
