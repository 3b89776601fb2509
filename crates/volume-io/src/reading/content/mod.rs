//! Forward-only reader of a file's content: as stored, or inflated where the whole file is compressed.

pub(crate) mod members;

use std::fs::File;
use std::io::{self, BufReader, Read};

use super::input::{InputFile, max_inflated_bytes};
use super::number::VoxelEncoding;
use super::samples::{ReadFault, read_until_full, skip_bytes};
use super::voxel_filter::{SkipFn, skip_in_file};
use super::voxels::{ReadVoxels, ValueMapping};
use super::{LoadControl, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext};
use members::GzipMembers;

/// Content of a file, read forwards.
pub(crate) struct FileContent {
    form: ContentReader,
    /// Position in the content, in bytes.
    position: u64,
    /// Length of the content in bytes, or an upper bound of it for compressed files.
    max_bytes: u64,
}

enum ContentReader {
    Stored(InputFile),
    Inflated(Box<GzipMembers<BufReader<File>>>),
}

impl FileContent {
    /// Starts at the beginning of a file's content.
    pub(crate) fn new(input: InputFile, is_gzip: bool) -> Self {
        let most_bytes = if is_gzip { max_inflated_bytes(input.len) } else { input.len };
        let form = if is_gzip {
            ContentReader::Inflated(Box::new(GzipMembers::new(input.reader)))
        } else {
            ContentReader::Stored(input)
        };
        Self { form, position: 0, max_bytes: most_bytes }
    }

    /// Checks that the content can have `bytes` bytes from `start` on, without inflating it.
    pub(crate) fn check_length(
        &self,
        context: LoadContext<'_>,
        field: &str,
        start: u64,
        bytes: u128,
    ) -> Result<(), LoadError> {
        let found = self.max_bytes.saturating_sub(start);
        if u128::from(found) >= bytes {
            return Ok(());
        }
        Err(context.bad_input_error(
            field,
            match self.form {
                ContentReader::Stored(_) => {
                    format!("the data are truncated: {bytes} bytes expected from byte {start} on, {found} found")
                }
                ContentReader::Inflated(_) => format!(
                    "the data are truncated: {bytes} bytes expected from byte {start} on, at most {found} found"
                ),
            },
            "check the header, or copy the file again",
        ))
    }

    /// Moves forward to byte `position`.
    pub(crate) fn seek_forward(&mut self, position: u64, control: &LoadControl) -> Result<(), ReadFault> {
        if let ContentReader::Stored(input) = &mut self.form {
            self.position = position;
            return input.seek(position).map_err(ReadFault::Io);
        }
        let skip = position.saturating_sub(self.position);
        if skip_bytes(self, skip, control).map_err(ReadFault::into_decoder_fault)? < skip {
            return Err(ReadFault::Short { got: 0 });
        }
        Ok(())
    }

    /// Skips `count` bytes by seeking; only in uncompressed files.
    fn skip_forward(&mut self, count: u64) -> io::Result<()> {
        self.position += count;
        match &mut self.form {
            ContentReader::Stored(input) => skip_in_file(&mut input.reader, count),
            ContentReader::Inflated(_) => Err(io::Error::from(io::ErrorKind::Unsupported)),
        }
    }

    /// Reads the selected voxels of the grid that comes next.
    pub(crate) fn voxels(
        &mut self,
        stored: &VoxelEncoding,
        extent: GridExtent,
        meant: &ValueMapping<'_>,
        control: &LoadControl,
    ) -> Result<ReadVoxels, ReadFault> {
        if let ContentReader::Stored(input) = &mut self.form
            && extent.read.is_whole_grid()
        {
            let bytes = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
            let voxels = stored.read_from_file(input, self.position, extent, meant, control);
            let voxels = voxels.map_err(ReadFault::into_decoder_fault)?;
            self.position = self.position.saturating_add(bytes);
            input.seek(self.position).map_err(ReadFault::Io)?;
            return Ok(voxels);
        }
        let skip_fn: Option<SkipFn<Self>> = match self.form {
            ContentReader::Stored(_) => Some(Self::skip_forward),
            ContentReader::Inflated(_) => None,
        };
        stored.read_values(self, skip_fn, extent, meant, control).map_err(ReadFault::into_decoder_fault)
    }

    /// Makes a decoder verify the checksum, which follows the last byte. Bytes after the voxels are ignored.
    pub(crate) fn finish(&mut self, control: &LoadControl) -> Result<(), ReadFault> {
        match &mut self.form {
            ContentReader::Stored(_) => Ok(()),
            ContentReader::Inflated(_) => {
                read_until_full(self, &mut [0], control).map_err(ReadFault::into_decoder_fault).map(drop)
            }
        }
    }
}

impl Read for FileContent {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = match &mut self.form {
            ContentReader::Stored(input) => input.reader.read(buffer),
            ContentReader::Inflated(decoder) => decoder.read(buffer),
        }?;
        self.position += count as u64;
        Ok(count)
    }
}
