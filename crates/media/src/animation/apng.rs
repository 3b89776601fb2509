//! Animated PNG (APNG): full colour and transparency. Programs that do not support it show the first picture.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use png::text_metadata::ITXtChunk;

use super::{AnimationEncoder, AnimationSpec};
use crate::ExportError;
use crate::png_file::{add_software_text, rgb};
use crate::rows::RECORD_KEY;
use chiaroscuro_files::{TemporaryFile, rename_into_place, temporary_file_for};

/// Writer of an APNG file.
pub(super) struct ApngWriter {
    writer: png::Writer<BufWriter<File>>,
    file: TemporaryFile,
    path: PathBuf,
    transparent: bool,
    /// True once the file has the record of its first picture.
    has_record: bool,
}

impl ApngWriter {
    pub(super) fn create(path: &Path, animation_spec: &AnimationSpec) -> Result<Self, ExportError> {
        let AnimationSpec { size: [width, height], frames, rate, transparent } = *animation_spec;
        let file = temporary_file_for(path)?;
        let out = BufWriter::new(file.reopen().map_err(ExportError::io_error_for(path))?);
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_color(if transparent { png::ColorType::Rgba } else { png::ColorType::Rgb });
        add_software_text(&mut encoder)?;
        encoder.set_animated(frames, 0)?;
        encoder.set_frame_delay(1, rate)?;
        encoder.validate_sequence(true);
        Ok(Self {
            writer: encoder.write_header()?,
            file,
            path: path.to_owned(),
            transparent,
            has_record: false,
        })
    }
}

impl AnimationEncoder for ApngWriter {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        if !self.has_record && !record.is_empty() {
            let chunk = ITXtChunk::new(RECORD_KEY, record);
            self.writer.write_text_chunk(&chunk)?;
            self.has_record = true;
        }
        if self.transparent {
            self.writer.write_image_data(shown)?;
        } else {
            self.writer.write_image_data(&rgb(shown))?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        let Self { writer, file, path, .. } = *self;
        writer.finish()?;
        Ok(rename_into_place(file, &path)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_record;

    #[test]
    fn the_file_says_how_many_pictures_it_has() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let animation_spec = AnimationSpec { size: [3, 2], frames: 3, rate: 10, transparent: true };
        let mut file = Box::new(ApngWriter::create(&path, &animation_spec).unwrap());
        for at in 1..=3 {
            file.add(&[at; 4 * 6], &format!("{{\"picture\": {at}}}")).unwrap();
        }
        file.finish().unwrap();
        let decoder = png::Decoder::new(std::io::BufReader::new(File::open(&path).unwrap()));
        let info = decoder.read_info().unwrap();
        assert_eq!(info.info().animation_control().unwrap().num_frames, 3);
        assert_eq!(read_record(&path).unwrap().as_deref(), Some(r#"{"picture": 1}"#));
    }
}
