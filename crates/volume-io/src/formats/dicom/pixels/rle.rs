//! DICOM's RLE codec (PS3.5 annex G): one byte plane per byte of a pixel, highest first, each packed with `PackBits`.

/// Size of the header in bytes: the number of planes, and the offsets of up to 15.
const HEADER_BYTES: usize = 64;

/// Decodes an image of `pixels` pixels: little-endian numbers, colours interleaved.
///
/// # Errors
/// A message that tells what is wrong with the image.
pub(super) fn decode(
    packed: &[u8],
    pixels: usize,
    samples: usize,
    bytes_of_number: usize,
) -> Result<Vec<u8>, String> {
    let planes = samples * bytes_of_number;
    let word = |at: usize| {
        let bytes = packed.get(4 * at..)?.first_chunk()?;
        usize::try_from(u32::from_le_bytes(*bytes)).ok()
    };
    let plane_count = word(0).unwrap_or(0);
    if plane_count != planes || packed.len() < HEADER_BYTES {
        return Err(format!("an image has {plane_count} byte planes, {planes} are expected"));
    }
    // Two bytes encode at most 128: data that cannot be complete get no memory.
    if packed.len().saturating_mul(64) < pixels.saturating_mul(planes) {
        return Err(format!("an image is truncated: {} bytes cannot hold {pixels} pixels", packed.len()));
    }
    let mut unpacked = vec![0; pixels * planes];
    for plane in 0..planes {
        let start = word(plane + 1).filter(|&start| start >= HEADER_BYTES);
        let end = if plane + 1 < planes { word(plane + 2) } else { Some(packed.len()) };
        let (Some(start), Some(end)) = (start, end) else {
            return Err("the offset of a byte plane is missing or invalid".to_owned());
        };
        let Some(packed) = packed.get(start..end) else {
            return Err(format!("a byte plane lies at bytes {start} to {end} of {}", packed.len()));
        };
        let (sample, byte) = (plane / bytes_of_number, plane % bytes_of_number);
        let first = sample * bytes_of_number + (bytes_of_number - 1 - byte);
        let into = unpacked.iter_mut().skip(first).step_by(planes);
        let decoded = decode_plane(packed, into);
        if decoded < pixels {
            return Err(format!("a byte plane is truncated: it has {decoded} of {pixels} bytes"));
        }
    }
    Ok(unpacked)
}

/// Decodes a plane's bytes in order; returns their number, at most as many as `into` takes.
fn decode_plane<'a>(packed: &[u8], mut into: impl Iterator<Item = &'a mut u8>) -> usize {
    let mut done = 0;
    let mut rest = packed;
    let mut put = |byte: u8| into.next().map(|place| *place = byte).is_some();
    while let [control, after @ ..] = rest {
        let length = usize::from(*control);
        match length {
            0..128 => {
                let (literal, after) = after.split_at(after.len().min(length + 1));
                for &byte in literal {
                    done += usize::from(put(byte));
                }
                rest = after;
            }
            128 => rest = after,
            _ => {
                let [byte, after @ ..] = after else { break };
                for _ in 0..257 - length {
                    done += usize::from(put(*byte));
                }
                rest = after;
            }
        }
    }
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encode_planes(planes: &[&[u8]]) -> Vec<u8> {
        let mut header = vec![planes.len() as u32];
        let mut at = HEADER_BYTES as u32;
        for plane in planes {
            header.push(at);
            at += plane.len() as u32;
        }
        header.resize(HEADER_BYTES / 4, 0);
        [header.into_iter().flat_map(u32::to_le_bytes).collect(), planes.concat()].concat()
    }

    #[test]
    fn runs_and_literals_are_unpacked_plane_by_plane() {
        // High bytes 1 1 1 2, low bytes 3 4 5 6, and a padding byte.
        let bytes = encode_planes(&[&[254, 1, 128, 0, 2], &[3, 3, 4, 5, 6, 0]]);
        assert_eq!(decode(&bytes, 4, 1, 2).unwrap(), [3, 1, 4, 1, 5, 1, 6, 2]);
        let colors = encode_planes(&[&[1, 1, 2], &[1, 3, 4], &[1, 5, 6]]);
        assert_eq!(decode(&colors, 2, 3, 1).unwrap(), [1, 3, 5, 2, 4, 6]);
    }

    #[test]
    fn what_is_broken_is_refused() {
        let good = encode_planes(&[&[3, 1, 2, 3, 4]]);
        assert!(decode(&good, 4, 1, 1).is_ok());
        assert!(decode(&good, 4, 1, 2).unwrap_err().contains("1 byte planes, 2"));
        assert!(decode(&good, 5, 1, 1).unwrap_err().contains("4 of 5"));
        assert!(decode(&good, usize::MAX, 1, 1).unwrap_err().contains("cannot hold"));
        let mut outside = good.clone();
        outside[4] = 255;
        assert!(decode(&outside, 4, 1, 1).unwrap_err().contains("bytes 255 to"));
        for length in 0..good.len() {
            assert!(decode(&good[..length], 4, 1, 1).is_err(), "{length}");
        }
    }
}
