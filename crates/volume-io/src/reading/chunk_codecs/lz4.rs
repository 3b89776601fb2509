//! LZ4 blocks, without the frame format.

/// Decompresses a block to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken block, or one of more bytes.
pub(crate) fn decode_lz4_block(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    lz4_flex::block::decompress(bytes, max_bytes).map_err(|error| format!("the LZ4 data are broken: {error}"))
}

/// Decompresses a block that begins with its length in four bytes, as numcodecs writes it.
///
/// # Errors
/// Fails for a broken block, or one of more than `max_bytes`.
pub(crate) fn decode_lz4_with_length(bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    let Some((length, block)) = bytes.split_first_chunk::<4>() else {
        return Err("the LZ4 data end within their length".to_owned());
    };
    let length = u32::from_le_bytes(*length) as usize;
    if length > max_bytes {
        return Err(format!("the LZ4 data announce {length} bytes, {max_bytes} were expected"));
    }
    decode_lz4_block(block, length)
}
