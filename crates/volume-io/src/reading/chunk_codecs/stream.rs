//! Compressed streams that are chunks: gzip, zlib, bzip2 and Zstandard.

use std::io::Read;

use super::{PIECE_BYTES, STOPPED};
use chiaroscuro_volume::CancelToken;

/// Decompresses a gzip stream to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken stream, or one of more bytes.
pub(crate) fn decode_gzip(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    read_at_most(flate2::bufread::MultiGzDecoder::new(bytes), "gzip", max_bytes)
}

/// Decompresses a zlib stream to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken stream, or one of more bytes.
pub(crate) fn decode_zlib(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    read_at_most(flate2::bufread::ZlibDecoder::new(bytes), "zlib", max_bytes)
}

/// Decompresses a bzip2 stream to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken stream, or one of more bytes.
pub(crate) fn decode_bzip2(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    read_at_most(bzip2::bufread::BzDecoder::new(bytes), "bzip2", max_bytes)
}

/// Decompresses a Zstandard frame to at most `max_bytes`, whether or not it states its size.
///
/// # Errors
/// Fails for a broken frame, or one of more bytes.
pub(crate) fn decode_zstd(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    let mut source = bytes;
    let decoder = ruzstd::decoding::StreamingDecoder::new(&mut source)
        .map_err(|error| format!("the Zstandard data are broken: {error}"))?;
    read_at_most(decoder, "Zstandard", max_bytes)
}

/// Reads a stream to its end, in pieces between which the work on this thread can be cancelled.
fn read_at_most(mut decoder: impl Read, name: &str, max_bytes: usize) -> Result<Vec<u8>, String> {
    let token = CancelToken::current();
    // Streams state no size that could be trusted: memory grows as it is filled.
    let mut out = Vec::with_capacity(max_bytes.min(PIECE_BYTES));
    loop {
        if token.is_cancelled() {
            return Err(STOPPED.to_owned());
        }
        let piece = decoder.by_ref().take(PIECE_BYTES as u64).read_to_end(&mut out);
        match piece {
            Err(error) => return Err(format!("the {name} data are broken: {error}")),
            Ok(_) if out.len() > max_bytes => {
                return Err(format!("the {name} data make more than {max_bytes} bytes"));
            }
            Ok(PIECE_BYTES) => {}
            Ok(_) => return Ok(out),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn streams_make_no_more_than_is_expected() {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(&[7; 1000]).unwrap();
        let packed = encoder.finish().unwrap();
        assert_eq!(decode_zlib(&packed, 1000).unwrap(), [7; 1000]);
        assert!(decode_zlib(&packed, 999).unwrap_err().contains("more than 999 bytes"));
        assert!(decode_zlib(&packed[..packed.len() / 2], 1000).unwrap_err().contains("broken"));
        let packed =
            ruzstd::encoding::compress_to_vec(&[7u8; 1000][..], ruzstd::encoding::CompressionLevel::Fastest);
        assert_eq!(decode_zstd(&packed, 1000).unwrap(), [7; 1000]);
        assert!(decode_zstd(&packed, 999).is_err() && decode_zstd(&packed[..5], 1000).is_err());
    }
}
