//! GIF animation: a palette of 256 colours per frame, and binary transparency.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::embedded_record::gif_comment;
use super::{AnimationEncoder, AnimationSpec};
use crate::ExportError;
use chiaroscuro_files::{TemporaryFile, provenance_mark, rename_into_place, temporary_file_for};

/// Sampling of pixels for the palette: every third, which is indistinguishable from all of them.
const PALETTE_SAMPLING: i32 = 3;

/// Shortest duration of a frame, in hundredths of a second: viewers slow down faster ones.
const MIN_DELAY: u64 = 2;

/// Writer of a GIF file.
pub(super) struct GifWriter {
    encoder: gif::Encoder<BufWriter<File>>,
    file: TemporaryFile,
    path: PathBuf,
    animation_spec: AnimationSpec,
    size: [u16; 2],
    written: u32,
}

impl GifWriter {
    pub(super) fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        let unfit = ExportError::UnsupportedByFormat {
            what: "GIF pictures have at most 65535 pixels along an edge",
            path: path.to_owned(),
        };
        let [Ok(width), Ok(height)] = animation_spec.size.map(u16::try_from) else { return Err(unfit) };
        let file = temporary_file_for(path)?;
        let out = BufWriter::new(file.reopen().map_err(ExportError::io_error_for(path))?);
        let mut encoder = gif::Encoder::new(out, width, height, &[])?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        encoder.write_raw_extension(gif::Extension::Comment.into(), &[provenance_mark().as_bytes()])?;
        Ok(Self {
            encoder,
            file,
            path: path.to_owned(),
            animation_spec: *animation_spec,
            size: [width, height],
            written: 0,
        })
    }

    /// Returns the duration of the next frame in hundredths of a second, rounded so that the sum matches the rate.
    fn delay(&self) -> u16 {
        let begins =
            |frame: u32| (200 * u64::from(frame) / u64::from(self.animation_spec.rate.max(1))).div_ceil(2);
        (begins(self.written + 1) - begins(self.written)).max(MIN_DELAY) as u16
    }
}

impl AnimationEncoder for GifWriter {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        if self.written == 0 && !record.is_empty() {
            self.encoder.write_raw_extension(gif::Extension::Comment.into(), &[&gif_comment(record)])?;
        }
        let mut pixels = shown.to_vec();
        for pixel in pixels.chunks_exact_mut(4) {
            pixel[3] = if self.animation_spec.transparent && pixel[3] < 128 { 0 } else { 255 };
        }
        let mut frame =
            gif::Frame::from_rgba_speed(self.size[0], self.size[1], &mut pixels, PALETTE_SAMPLING);
        frame.delay = self.delay();
        frame.dispose = gif::DisposalMethod::Background;
        self.encoder.write_frame(&frame)?;
        self.written += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        let Self { encoder, file, path, animation_spec, written, .. } = *self;
        if written != animation_spec.frames {
            return Err(ExportError::UnsupportedByFormat { what: "frames are missing", path });
        }
        encoder.into_inner()?.flush().map_err(ExportError::io_error_for(&path))?;
        Ok(rename_into_place(file, &path)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_come_back_and_take_their_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        let animation_spec = AnimationSpec { size: [2, 1], frames: 24, rate: 24, transparent: true };
        let mut file = Box::new(GifWriter::create(&path, &animation_spec).unwrap());
        for _ in 0..24 {
            file.add(&[200, 100, 50, 255, 9, 9, 9, 0], "").unwrap();
        }
        file.finish().unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(File::open(&path).unwrap()).unwrap();
        let (mut frames, mut hundredths) = (0, 0);
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!(frame.buffer[..4], [200, 100, 50, 255]);
            assert_eq!(frame.buffer[7], 0, "transparent");
            frames += 1;
            hundredths += u32::from(frame.delay);
        }
        assert_eq!((frames, hundredths), (24, 100), "a second");
        assert!(GifWriter::create(&path, &AnimationSpec { size: [70000, 1], ..animation_spec }).is_err());
    }
}
