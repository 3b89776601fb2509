//! EXR: linear, premultiplied light in 16-bit floats, for programs that grade and composite.

use std::io::{BufReader, BufWriter};
use std::path::Path;

use exr::block::writer::ChunksWriter as _;
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::Compression;

use super::rows::RECORD;
use super::whole_file::{open_regular, place, temporary_beside};
use super::{ExportError, ReadPictureError, Rows};
use crate::model::ImageSpec;

/// Channels in the order of the file, which is that of their names, and where they are in a pixel.
const CHANNELS: [(&str, usize); 4] = [("A", 3), ("B", 2), ("G", 1), ("R", 0)];

/// Bytes of a piece of the record: ffmpeg 5 and what is made with it cannot open files with longer texts.
const LONGEST: usize = 255;

/// Writes a picture in blocks of sixteen rows, as the format's lossless compression has them.
pub(super) fn write<E: From<ExportError>>(
    path: &Path,
    shot: &ImageSpec,
    record: Option<&str>,
    rows: &mut dyn FnMut() -> Result<Option<Rows>, E>,
) -> Result<(), E> {
    let file = temporary_beside(path)?;
    let out = BufWriter::new(file.reopen().map_err(ExportError::writing(path))?);
    let [width, height] = shot.size.map(|n| n as usize);
    let channels = CHANNELS.map(|(name, _)| ChannelDescription::named(name, SampleType::F16));
    let mut header = Header::new(Text::from(RECORD), (width, height), channels.into_iter().collect())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing);
    let text = ascii(record.unwrap_or_default());
    let pieces = text.as_bytes().chunks(LONGEST).enumerate();
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
                    Ok(Some(Rows::Floats(more))) => waiting.extend(more),
                    Ok(_) => {
                        return Err(exr::error::Error::Invalid("rows are missing or have no light".into()));
                    }
                    Err(err) => {
                        refused = Some(err);
                        return Err(exr::error::Error::Aborted);
                    }
                }
            }
            let pixels: Vec<f32> = waiting.drain(..wanted).collect();
            compressor.compress_block(at, UncompressedBlock { index, data: planes(&pixels, width) })?;
        }
        Ok(())
    });
    match (refused, written) {
        (Some(err), _) => return Err(err),
        (None, written) => written.map_err(ExportError::Exr)?,
    }
    Ok(place(file, path)?)
}

/// The name of a piece of the record.
fn piece_name(at: usize) -> Text {
    Text::from(format!("{RECORD}.{at:03}").as_str())
}

/// RGBA pixels row by row as the format has them: in each row, channel after channel.
fn planes(pixels: &[f32], width: usize) -> Vec<u8> {
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

/// JSON in ASCII, which is all that the format's texts hold: other characters stand only in strings, where
/// they may be written as escapes.
fn ascii(json: &str) -> String {
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

/// The record in an EXR file, if there is one.
pub(super) fn read_record(path: &Path) -> Result<Option<String>, ReadPictureError> {
    let meta = MetaData::read_from_buffered(BufReader::new(open_regular(path)?), false)
        .map_err(|err| ReadPictureError::new(path, &err))?;
    let Some(header) = meta.headers.first() else { return Ok(None) };
    let piece = |at| header.own_attributes.other.get(&piece_name(at))?.to_text().ok();
    let text: String = (0..).map_while(piece).map(ToString::to_string).collect();
    Ok(Some(text).filter(|text| !text.is_empty()))
}

/// A picture in memory while it is read.
struct Pixels {
    width: usize,
    values: Vec<f32>,
}

/// All of an EXR file.
pub(super) fn read(path: &Path) -> Result<([u32; 2], Rows), ReadPictureError> {
    let image = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |size, _| Pixels { width: size.width(), values: vec![0.0; 4 * size.area()] },
        |Pixels { width, values }, at, (r, g, b, a): (f32, f32, f32, f32)| {
            let first = 4 * (at.y() * *width + at.x());
            values[first..first + 4].copy_from_slice(&[r, g, b, a]);
        },
    );
    let layer = image.map_err(|err| ReadPictureError::new(path, &err))?.layer_data;
    let size = [layer.size.width() as u32, layer.size.height() as u32];
    Ok((size, Rows::Floats(layer.channel_data.pixels.values)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Depth;

    #[test]
    fn light_and_record_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        // Bands that are no blocks, and brighter than white.
        let (width, height) = (3, 37);
        let value = |i: usize| (i % 64) as f32 / 16.0;
        let pixels: Vec<f32> = (0..4 * width * height).map(value).collect();
        let mut bands: Vec<_> = pixels.chunks(4 * width * 10).map(<[f32]>::to_vec).rev().collect();
        let shot = ImageSpec { depth: Depth::Linear, ..ImageSpec::new([width as u32, height as u32]) };
        let record = format!("{{\"name\": \"Größe, 体積 🫁\", \"long\": \"{}\"}}", "x".repeat(700));
        let record = record.as_str();
        let mut next = || Ok::<_, ExportError>(bands.pop().map(Rows::Floats));
        super::super::write_picture(&path, &shot, Some(record), &mut next).unwrap();
        let text = read_record(&path).unwrap().unwrap();
        assert!(text.is_ascii());
        let [found, written] =
            [text.as_str(), record].map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap());
        assert_eq!(found, written);
        assert_eq!(read(&path).unwrap(), ([3, 37], Rows::Floats(pixels)));
        std::fs::write(&path, b"no picture").unwrap();
        assert!(read_record(&path).is_err() && read(&path).is_err());
    }
}
