//! Compressed streams that are chunks: gzip, zlib, bzip2 and Zstandard.

use std::io::{Read, Result as IoResult};

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

fn read_at_most(decoder: impl Read, name: &str, max_bytes: usize) -> Result<Vec<u8>, String> {
    // Streams state no size that could be trusted: memory grows as it is filled.
    let mut out = Vec::with_capacity(max_bytes.min(1 << 20));
    let read: IoResult<usize> = decoder.take(max_bytes as u64 + 1).read_to_end(&mut out);
    match read {
        Err(error) => Err(format!("the {name} data are broken: {error}")),
        Ok(count) if count > max_bytes => Err(format!("the {name} data make more than {max_bytes} bytes")),
        Ok(_) => Ok(out),
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
