//! PNG files: display colours in 8 or 16 bits, with a record as text.

use std::io::{BufReader, BufWriter, Write as _};
use std::path::Path;

use super::rows::{RECORD_KEY, quantize_u16};
use super::{ExportError, PicturePixels, PixelRows, ReadPictureError};
use chiaroscuro_files::{
    MAX_LOOK_BYTES, check_extension, open_regular, provenance_mark, rename_into_place, temporary_file_for,
    write_atomically,
};
use chiaroscuro_scene::{ImageSpec, MAX_IMAGE_EDGE, PixelFormat};

/// Maximum number of bytes read before a picture's pixels, including texts and colour profiles of other programs, as
/// stored: ten times what cameras write.
const MAX_METADATA_BYTES: usize = 16 << 20;

/// Writes a picture of sRGB bytes, RGBA row by row, as PNG: RGB, or RGBA with straight alpha if it is transparent. It
/// embeds a record ([`chiaroscuro_scene::LookRecord`]) as text.
///
/// # Errors
/// Under the conditions of [`write_atomically`].
pub fn export_png(
    size: [u32; 2],
    shown: &[u8],
    transparent: bool,
    record: Option<&str>,
    path: &Path,
) -> Result<(), ExportError> {
    check_extension(path, &["png"], "pictures of this kind are written as .png")?;
    Ok(write_atomically(path, &encode_shown(size, shown, transparent, record)?)?)
}

/// Encodes a picture like [`export_png`], and returns the bytes of the file.
///
/// # Errors
/// When the number of bytes does not match the pixels.
pub fn encode_shown(
    size: [u32; 2],
    shown: &[u8],
    transparent: bool,
    record: Option<&str>,
) -> Result<Vec<u8>, ExportError> {
    Ok(if transparent {
        encode_png(size, png::ColorType::Rgba, shown, record)?
    } else {
        encode_png(size, png::ColorType::Rgb, &rgb(shown), record)?
    })
}

/// Encodes bytes of colours as PNG, with a record if there is one.
///
/// # Errors
/// When the number of bytes does not match the pixels.
pub fn encode_png(
    [width, height]: [u32; 2],
    color: png::ColorType,
    bytes: &[u8],
    record: Option<&str>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_color(color);
    add_software_text(&mut encoder)?;
    if let Some(record) = record {
        encoder.add_itxt_chunk(RECORD_KEY.to_owned(), record.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(png)
}

/// Adds the name of this program to the file's metadata.
pub(super) fn add_software_text<W: std::io::Write>(
    encoder: &mut png::Encoder<'_, W>,
) -> Result<(), png::EncodingError> {
    encoder.add_text_chunk("Software".to_owned(), provenance_mark())
}

/// Writes a picture from bands of rows.
pub(super) fn write<E: From<ExportError>>(
    path: &Path,
    image_spec: &ImageSpec,
    record: Option<&str>,
    rows: &mut dyn FnMut() -> Result<Option<PixelRows>, E>,
) -> Result<(), E> {
    let failed = ExportError::io_error_for(path);
    let not_encoded = |err| ExportError::with_path(path)(ExportError::Encode(err));
    let file = temporary_file_for(path).map_err(ExportError::from)?;
    let mut out = BufWriter::new(file.reopen().map_err(&failed)?);
    let mut encoder = png::Encoder::new(&mut out, image_spec.size[0], image_spec.size[1]);
    encoder.set_depth(if image_spec.depth == PixelFormat::Eight {
        png::BitDepth::Eight
    } else {
        png::BitDepth::Sixteen
    });
    encoder.set_color(if image_spec.transparent { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_compression(png::Compression::Fast);
    add_software_text(&mut encoder).map_err(not_encoded)?;
    if let Some(record) = record {
        encoder.add_itxt_chunk(RECORD_KEY.to_owned(), record.to_owned()).map_err(not_encoded)?;
    }
    let mut writer = encoder.write_header().map_err(not_encoded)?;
    let mut stream = writer.stream_writer_with_size(1 << 20).map_err(not_encoded)?;
    while let Some(rows) = rows()? {
        let bytes = match rows {
            PixelRows::Bytes(shown) if image_spec.transparent => shown,
            PixelRows::Bytes(shown) => rgb(&shown),
            PixelRows::Floats(shown) => to_u16_be(&shown, image_spec.transparent),
        };
        stream.write_all(&bytes).map_err(&failed)?;
    }
    stream.finish().map_err(not_encoded)?;
    writer.finish().map_err(not_encoded)?;
    out.flush().map_err(&failed)?;
    Ok(rename_into_place(file, path).map_err(ExportError::from)?)
}

/// Returns the colours of a picture without alpha.
pub(super) fn rgb(shown: &[u8]) -> Vec<u8> {
    shown.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect()
}

/// Encodes values from 0 to 1 as 16-bit numbers, big-endian, with or without alpha.
fn to_u16_be(shown: &[f32], alpha: bool) -> Vec<u8> {
    let kept = if alpha { 4 } else { 3 };
    let texels = shown.chunks_exact(4);
    texels
        .flat_map(|texel| texel[..kept].iter().flat_map(|&value| quantize_u16(value).to_be_bytes()))
        .collect()
}

/// Opens a PNG file for decoding.
fn reader(path: &Path) -> Result<image::ImageReader<BufReader<std::fs::File>>, ReadPictureError> {
    Ok(image::ImageReader::with_format(BufReader::new(open_regular(path)?), image::ImageFormat::Png))
}

/// Reads the columns and rows of a PNG file.
pub(super) fn size(path: &Path) -> Result<[u32; 2], ReadPictureError> {
    let size = reader(path)?.into_dimensions().map_err(|err| ReadPictureError::new(path, &err))?;
    check_size(path, size.into())
}

/// Rejects sizes beyond those of any picture that this program writes.
pub(super) fn check_size(path: &Path, size: [u32; 2]) -> Result<[u32; 2], ReadPictureError> {
    let [width, height] = size;
    if size.iter().all(|edge| (1..=MAX_IMAGE_EDGE).contains(edge)) {
        return Ok(size);
    }
    let why = format!("it has {width} × {height} pixels, a size that this program does not write");
    Err(ReadPictureError::new(path, &why))
}

/// Reads the pixels of a PNG file.
pub(super) fn read(path: &Path) -> Result<PicturePixels, ReadPictureError> {
    let failed = |why: &dyn std::fmt::Display| ReadPictureError::new(path, why);
    let size = size(path)?;
    let [width, height] = size;
    let mut reader = reader(path)?;
    // Twice the memory of the decoded pixels: limits the memory for texts and colour profiles in the file.
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(16 * u64::from(width) * u64::from(height) + (1 << 20));
    reader.limits(limits);
    let image = reader.decode().map_err(|err| failed(&err))?;
    let is_deep = matches!(image.color(), image::ColorType::Rgb16 | image::ColorType::Rgba16);
    let rows = if is_deep {
        let words = image.to_rgba16().into_raw();
        PixelRows::Floats(words.into_iter().map(|word| f32::from(word) / 65535.0).collect())
    } else {
        PixelRows::Bytes(image.to_rgba8().into_raw())
    };
    Ok(PicturePixels { size, rows })
}

/// Reads the record in a PNG file, if there is one.
pub(super) fn read_record(path: &Path) -> Result<Option<String>, ReadPictureError> {
    let failed = |why: &dyn std::fmt::Display| ReadPictureError::new(path, why);
    let file = open_regular(path)?;
    let limits = png::Limits { bytes: MAX_METADATA_BYTES };
    let decoder = png::Decoder::new_with_limits(BufReader::new(file), limits);
    let reader = decoder.read_info().map_err(|err| failed(&err))?;
    let found = reader.info().utf8_text.iter().find(|text| text.keyword == RECORD_KEY);
    let Some(mut text) = found.cloned() else { return Ok(None) };
    // Decompression stops at this length.
    text.decompress_text_with_limit(MAX_LOOK_BYTES)
        .map_err(|err| failed(&format!("its embedded settings cannot be read: {err}")))?;
    text.get_text().map(Some).map_err(|err| failed(&err))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_picture;

    #[test]
    fn a_png_keeps_every_byte() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let shown = (0..4 * 6).map(|i| (i * 10) as u8).collect::<Vec<_>>();
        export_png([3, 2], &shown, true, None, &path).unwrap();
        assert_eq!(read_record(&path).unwrap(), None);
        assert_eq!(image::open(&path).unwrap().to_rgba8().into_raw(), shown);
        let record = "{\"name\": \"Größe, 体積\"}";
        export_png([3, 2], &shown, true, Some(record), &path).unwrap();
        assert_eq!(image::open(&path).unwrap().to_rgba8().into_raw(), shown);
        assert_eq!(read_record(&path).unwrap().as_deref(), Some(record));
        std::fs::write(&path, b"no picture").unwrap();
        assert!(read_record(&path).is_err() && read_record(Path::new("/no/such.png")).is_err());
    }

    #[test]
    fn texts_that_swell_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut info = png::Info::with_size(1, 1);
        let mut text = png::text_metadata::ITXtChunk::new(RECORD_KEY, "x".repeat(MAX_LOOK_BYTES + 1));
        text.compressed = true;
        text.compress_text().unwrap();
        info.utf8_text.push(text);
        let file = std::fs::File::create(&path).unwrap();
        let mut writer = png::Encoder::with_info(file, info).unwrap().write_header().unwrap();
        writer.write_image_data(&[0]).unwrap();
        writer.finish().unwrap();
        assert!(std::fs::metadata(&path).unwrap().len() < 1 << 20, "a small file");
        let refused = read_record(&path).unwrap_err().to_string();
        assert!(refused.contains("decompression space"), "{refused}");
        assert!(read_record(folder.path()).is_err(), "a folder");
    }

    #[test]
    fn sixteen_bits_keep_what_eight_lose() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let value = |i: usize| i as f32 / 65535.0;
        for transparent in [false, true] {
            let image_spec = ImageSpec { depth: PixelFormat::Sixteen, transparent, ..ImageSpec::new([5, 4]) };
            let shown: Vec<f32> = (0..80).map(|i| value(i * 3)).collect();
            // Bands of three rows and of one row.
            let mut bands = vec![shown[60..].to_vec(), shown[..60].to_vec()];
            let mut next = || Ok::<_, ExportError>(bands.pop().map(PixelRows::Floats));
            super::super::write_picture(&path, &image_spec, None, &mut next).unwrap();
            let expected = |i: usize| if i % 4 == 3 && !transparent { 65535 } else { i as u16 * 3 };
            let read = image::open(&path).unwrap().to_rgba16().into_raw();
            assert_eq!(read, (0..80).map(expected).collect::<Vec<_>>());
            assert_eq!(
                read_picture(&path).unwrap(),
                PicturePixels { size: [5, 4], rows: PixelRows::Floats(shown).after_round_trip(&image_spec) }
            );
        }
    }
}
