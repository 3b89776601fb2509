//! EXR files: linear, premultiplied light in 16-bit floats, for grading and compositing programs.

use std::cell::RefCell;
use std::fs::File;
use std::io::{BufRead as _, BufReader, BufWriter, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::Path;

use exr::block::writer::ChunksWriter as _;
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::Compression;

use super::png_file::check_size;
use super::rows::RECORD_KEY;
use super::{ExportError, PicturePixels, PixelRows, ReadPictureError};
use chiaroscuro_files::{
    MAX_LOOK_BYTES, open_regular, provenance_mark, rename_into_place, temporary_file_for,
};
use chiaroscuro_scene::ImageSpec;

/// Channels in the order of the file (alphabetical), with their offset in a pixel.
const CHANNELS: [(&str, usize); 4] = [("A", 3), ("B", 2), ("G", 1), ("R", 0)];

/// Length of a piece of the record, in bytes: ffmpeg 5 and programs that use it cannot open files with longer texts.
const MAX_TEXT_BYTES: usize = 255;

/// Bytes of the magic number and version at the beginning of an EXR file.
const ATTRIBUTES_OFFSET: u64 = 8;

/// Maximum compression ratio of the format's methods: 1032 of deflate, times two of the transforms before it.
const MAX_COMPRESSION_RATIO: u64 = 2064;

/// Maximum number of bytes read before the pixels: a record in pieces, each with a name and lengths, and as much
/// again from other programs.
const MAX_METADATA_BYTES: u64 = 4 * MAX_LOOK_BYTES as u64;

/// Writes a picture in blocks of sixteen rows, which the format's lossless compression uses.
pub(super) fn write<E: From<ExportError>>(
    path: &Path,
    image_spec: &ImageSpec,
    record: Option<&str>,
    rows: &mut dyn FnMut() -> Result<Option<PixelRows>, E>,
) -> Result<(), E> {
    let file = temporary_file_for(path).map_err(ExportError::from)?;
    let out = BufWriter::new(file.reopen().map_err(ExportError::io_error_for(path))?);
    let [width, height] = image_spec.size.map(|n| n as usize);
    let channels = CHANNELS.map(|(name, _)| ChannelDescription::named(name, SampleType::F16));
    let mut header = Header::new(Text::from(RECORD_KEY), (width, height), channels.into_iter().collect())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing);
    header.own_attributes.software_name = Some(Text::from(provenance_mark().as_str()));
    let text = escape_to_ascii(record.unwrap_or_default());
    let pieces = text.as_bytes().chunks(MAX_TEXT_BYTES).enumerate();
    header.own_attributes.other.extend(
        pieces.map(|(at, piece)| (piece_name(at), AttributeValue::Text(Text::from_slice_unchecked(piece)))),
    );
    let mut refused = None;
    let written = exr::block::write(out, std::iter::once(header).collect(), true, |meta, chunks| {
        let blocks: Vec<_> = enumerate_ordered_header_block_indices(&meta.headers).collect();
        let mut compressor = chunks.sequential_blocks_compressor(&meta);
        let mut waiting = std::collections::VecDeque::new();
        for (at, index) in blocks {
            let wanted = index.pixel_size.area() * 4;
            while waiting.len() < wanted {
                match rows() {
                    Ok(Some(PixelRows::Floats(more))) => waiting.extend(more),
                    Ok(_) => {
                        return Err(exr::error::Error::Invalid(
                            "rows are missing or not of linear light".into(),
                        ));
                    }
                    Err(err) => {
                        refused = Some(err);
                        return Err(exr::error::Error::Aborted);
                    }
                }
            }
            let pixels: Vec<f32> = waiting.drain(..wanted).collect();
            compressor.compress_block(at, UncompressedBlock { index, data: channel_rows(&pixels, width) })?;
        }
        Ok(())
    });
    match (refused, written) {
        (Some(err), _) => return Err(err),
        (None, written) => written.map_err(|err| ExportError::with_path(path)(ExportError::Exr(err)))?,
    }
    sort_attributes(file.as_file()).map_err(ExportError::io_error_for(path))?;
    Ok(rename_into_place(file, path).map_err(ExportError::from)?)
}

/// Sorts the attributes of a file's header by name: the library writes custom ones in varying order, and equal
/// pictures should have equal bytes. The total length does not change.
fn sort_attributes(mut file: &File) -> std::io::Result<()> {
    file.seek(SeekFrom::Start(ATTRIBUTES_OFFSET))?;
    let mut header = BufReader::new(file);
    let mut attributes = Vec::new();
    loop {
        // Name, type, length, and the value; an empty name ends the header.
        let mut attribute = Vec::new();
        if header.read_until(0, &mut attribute)? <= 1 {
            break;
        }
        header.read_until(0, &mut attribute)?;
        let mut length = [0; 4];
        header.read_exact(&mut length)?;
        attribute.extend(length);
        let length = u64::from(u32::from_le_bytes(length));
        header.by_ref().take(length).read_to_end(&mut attribute)?;
        attributes.push(attribute);
    }
    attributes.sort_unstable();
    file.seek(SeekFrom::Start(ATTRIBUTES_OFFSET))?;
    file.write_all(&attributes.concat())
}

/// Returns the attribute name of a piece of the record.
fn piece_name(at: usize) -> Text {
    Text::from(format!("{RECORD_KEY}.{at:03}").as_str())
}

/// Converts RGBA pixels to the format's layout: channel after channel within each row.
fn channel_rows(pixels: &[f32], width: usize) -> Vec<u8> {
    let half = |value: f32| half::f16::from_f32(value).to_ne_bytes();
    pixels
        .chunks_exact(4 * width)
        .flat_map(|row| {
            CHANNELS
                .into_iter()
                .flat_map(move |(_, at)| row.iter().skip(at).step_by(4).flat_map(move |&v| half(v)))
        })
        .collect()
}

/// Converts JSON to ASCII, the character set of the format's texts: other characters occur only in strings, where
/// they can be escaped.
fn escape_to_ascii(json: &str) -> String {
    let mut units = [0; 2];
    json.chars().fold(String::with_capacity(json.len()), |mut text, c| {
        if c.is_ascii() {
            text.push(c);
        } else {
            text.extend(c.encode_utf16(&mut units).iter().map(|unit| format!("\\u{unit:04x}")));
        }
        text
    })
}

/// Reads the metadata of an EXR file, at most [`MAX_METADATA_BYTES`] bytes of it.
fn meta_data(path: &Path, file: File) -> Result<MetaData, ReadPictureError> {
    MetaData::read_from_buffered(BufReader::new(file.take(MAX_METADATA_BYTES)), false)
        .map_err(|err| ReadPictureError::new(path, &err))
}

/// Reads the record in an EXR file, if there is one.
pub(super) fn read_record(path: &Path) -> Result<Option<String>, ReadPictureError> {
    let meta = meta_data(path, open_regular(path)?)?;
    let Some(header) = meta.headers.first() else { return Ok(None) };
    let piece = |at| header.own_attributes.other.get(&piece_name(at))?.to_text().ok();
    let mut text = String::new();
    for piece in (0..).map_while(piece) {
        text.extend(piece.chars());
        if text.len() > MAX_LOOK_BYTES {
            return Err(ReadPictureError::new(path, &"its embedded settings are too long"));
        }
    }
    Ok(Some(text).filter(|text| !text.is_empty()))
}

/// Pixel buffer of a picture that is being read.
struct ExrPixels {
    width: usize,
    values: Vec<f32>,
}

/// Reads the columns and rows of an EXR file.
pub(super) fn size(path: &Path) -> Result<[u32; 2], ReadPictureError> {
    let failed = |why: &dyn std::fmt::Display| ReadPictureError::new(path, why);
    let file = open_regular(path)?;
    let bytes = file.metadata().map_err(|err| failed(&err))?.len();
    let meta = meta_data(path, file)?;
    let size = meta.headers.first().map(|header| header.layer_size).ok_or_else(|| failed(&"it is empty"))?;
    let edge = |edge: usize| u32::try_from(edge).unwrap_or(u32::MAX);
    let size = check_size(path, [edge(size.width()), edge(size.height())])?;
    // A pixel has at least two bytes.
    let least = 2 * u64::from(size[0]) * u64::from(size[1]) / MAX_COMPRESSION_RATIO;
    if least > bytes {
        return Err(failed(&format!("{bytes} bytes are too few for {} × {} pixels", size[0], size[1])));
    }
    Ok(size)
}

/// Reads the pixels of an EXR file.
pub(super) fn read(path: &Path) -> Result<PicturePixels, ReadPictureError> {
    let [width, height] = size(path)?.map(|edge| edge as usize);
    let mut room = Vec::new();
    let no_room = |err| ReadPictureError::new(path, &format!("there is not enough memory for it: {err}"));
    room.try_reserve_exact(4 * width * height).map_err(no_room)?;
    room.resize(4 * width * height, 0.0);
    let room = RefCell::new(room);
    let image = exr::prelude::read_first_rgba_layer_from_file(
        path,
        // The size is that of the first layer with colours, which may differ from the first layer.
        move |size, _| ExrPixels {
            width: size.width(),
            values: if size.area() == width * height { room.take() } else { Vec::new() },
        },
        |ExrPixels { width, values }, at, (r, g, b, a): (f32, f32, f32, f32)| {
            let first = 4 * (at.y() * *width + at.x());
            if let Some(pixel) = values.get_mut(first..first + 4) {
                pixel.copy_from_slice(&[r, g, b, a]);
            }
        },
    );
    let layer = image.map_err(|err| ReadPictureError::new(path, &err))?.layer_data;
    if [layer.size.width(), layer.size.height()] != [width, height] {
        return Err(ReadPictureError::new(path, &"its layers differ in size"));
    }
    let rows = PixelRows::Floats(layer.channel_data.pixels.values);
    Ok(PicturePixels { size: [width as u32, height as u32], rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::PixelFormat;

    /// Returns a copy of a file whose header claims another size.
    fn claiming(file: &[u8], size: [i32; 2]) -> Vec<u8> {
        let mut file = file.to_vec();
        for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let at = file.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4 + 8;
            for (axis, edge) in size.into_iter().enumerate() {
                file[at + 4 * axis..][..4].copy_from_slice(&(edge - 1).to_le_bytes());
            }
        }
        file
    }

    #[test]
    fn light_and_record_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        // Band heights that do not match the blocks, and values brighter than white.
        let (width, height) = (3, 37);
        let value = |i: usize| (i % 64) as f32 / 16.0;
        let pixels: Vec<f32> = (0..4 * width * height).map(value).collect();
        let mut bands: Vec<_> = pixels.chunks(4 * width * 10).map(<[f32]>::to_vec).rev().collect();
        let mut again = Some(PixelRows::Floats(pixels.clone()));
        let image_spec =
            ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new([width as u32, height as u32]) };
        let record = format!("{{\"name\": \"Größe, 体積 🫁\", \"long\": \"{}\"}}", "x".repeat(700));
        let record = record.as_str();
        let mut next = || Ok::<_, ExportError>(bands.pop().map(PixelRows::Floats));
        super::super::write_picture(&path, &image_spec, Some(record), &mut next).unwrap();
        let text = read_record(&path).unwrap().unwrap();
        assert!(text.is_ascii());
        let [found, written] =
            [text.as_str(), record].map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap());
        assert_eq!(found, written);
        assert_eq!(read(&path).unwrap(), PicturePixels { size: [3, 37], rows: PixelRows::Floats(pixels) });
        // Writing the same picture again gives the same bytes.
        let before = std::fs::read(&path).unwrap();
        let mut next = || Ok::<_, ExportError>(again.take());
        super::super::write_picture(&path, &image_spec, Some(record), &mut next).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), before);
        // The header claims a thousand times the pixels that its bytes can hold.
        std::fs::write(&path, claiming(&before, [16_384, 16_384])).unwrap();
        let refused = read(&path).unwrap_err().to_string();
        assert!(refused.contains("bytes are too few for"), "{refused}");
        // Records have a maximum length.
        let mut rows = Some(PixelRows::Floats(vec![0.0; 4]));
        let mut next = || Ok::<_, ExportError>(rows.take());
        let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new([1, 1]) };
        let long = "x".repeat(MAX_LOOK_BYTES + 1);
        super::super::write_picture(&path, &image_spec, Some(&long), &mut next).unwrap();
        let refused = read_record(&path).unwrap_err().to_string();
        assert!(refused.contains("embedded settings are too long") && size(&path).is_ok(), "{refused}");
        std::fs::write(&path, b"no picture").unwrap();
        assert!(read_record(&path).is_err() && read(&path).is_err());
    }
}
