//! Decoders of two codecs of medical images that other crates lack: lossy JPEG of 12 bits (and of 8), and JPEG-LS.
//! Safe Rust without dependencies.
//!
//! Both modules have a function `header`, which parses no further than the frame header, and a function `decode`.
//! Images are not trusted: callers compare the size in the header with the one that they expect before they decode.
//!
//! Begin with `decode` in `jpeg_ls/mod.rs`: it follows the markers of an image, and `jpeg_ls/scan_decoder.rs` decodes
//! the bits between them; `lossy_jpeg/mod.rs` and `lossy_jpeg/bits.rs` are divided in the same way. The
//! memory that a hostile image can take is bounded at the beginning of `jpeg_ls/mod.rs`, and by
//! `LossyJpegDecoder::allocate` for lossy JPEG.

pub mod jpeg_ls;
pub mod lossy_jpeg;
