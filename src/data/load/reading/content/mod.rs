//! Forward-only reader of a file's content: as stored, or inflated where the whole file is compressed.

pub(crate) mod members;

use std::fs::File;
use std::io::{self, BufReader, Read};

use members::GzipMembers;

use super::input::{Input, most_inflated};
use super::number::Stored;
use super::samples::{Fault, fill, skip_bytes};
use super::sieve::{Leap, leap_in_file};
use super::voxels::{Meant, Voxels};
use super::{LoadControl, LoadError};
use crate::data::attempt::{Attempt, Extent};

/// Content of a file, read forwards.
pub(in crate::data::load) struct Content {
    form: Form,
    /// Position in the content, in bytes.
    at: u64,
    /// Length of the content in bytes, or an upper bound of it for compressed files.
    most_bytes: u64,
}

enum Form {
    Stored(Input),
    Inflated(Box<GzipMembers<BufReader<File>>>),
}

impl Content {
    /// Starts at the beginning of a file's content.
    pub(in crate::data::load) fn of(input: Input, is_gzip: bool) -> Self {
        let most_bytes = if is_gzip { most_inflated(input.len) } else { input.len };
        let form = if is_gzip {
            Form::Inflated(Box::new(GzipMembers::new(input.reader)))
        } else {
            Form::Stored(input)
        };
        Self { form, at: 0, most_bytes }
    }

    /// Checks that the content can have `bytes` bytes from `start` on, without inflating it.
    pub(in crate::data::load) fn check_room(
        &self,
        attempt: Attempt<'_>,
        field: &str,
        start: u64,
        bytes: u128,
    ) -> Result<(), LoadError> {
        let found = self.most_bytes.saturating_sub(start);
        if u128::from(found) >= bytes {
            return Ok(());
        }
        Err(attempt.bad_input(
            field,
            match self.form {
                Form::Stored(_) => {
                    format!("the data are truncated: {bytes} bytes expected from byte {start} on, {found} found")
                }
                Form::Inflated(_) => format!(
                    "the data are truncated: {bytes} bytes expected from byte {start} on, room for {found} found"
                ),
            },
            "check the header, or copy the file again",
        ))
    }

    /// Moves forward to byte `position`.
    pub(in crate::data::load) fn go_to(&mut self, position: u64, control: &LoadControl) -> Result<(), Fault> {
        if let Form::Stored(input) = &mut self.form {
            self.at = position;
            return input.seek(position).map_err(Fault::Io);
        }
        let skip = position.saturating_sub(self.at);
        if skip_bytes(self, skip, control).map_err(Fault::of_stream)? < skip {
            return Err(Fault::Short { got: 0 });
        }
        Ok(())
    }

    /// Skips `count` bytes by seeking; only in uncompressed files.
    fn leap(&mut self, count: u64) -> io::Result<()> {
        self.at += count;
        match &mut self.form {
            Form::Stored(input) => leap_in_file(&mut input.reader, count),
            Form::Inflated(_) => Err(io::Error::from(io::ErrorKind::Unsupported)),
        }
    }

    /// Reads the selected voxels of the grid that comes next.
    pub(in crate::data::load) fn voxels(
        &mut self,
        stored: &Stored,
        extent: Extent,
        meant: &Meant<'_>,
        control: &LoadControl,
    ) -> Result<Voxels, Fault> {
        if let Form::Stored(input) = &mut self.form
            && extent.read.is_all()
        {
            let bytes = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel());
            let voxels = stored.read_of_file(input, self.at, extent, meant, control);
            let voxels = voxels.map_err(Fault::of_stream)?;
            self.at = self.at.saturating_add(bytes);
            input.seek(self.at).map_err(Fault::Io)?;
            return Ok(voxels);
        }
        let leap: Option<Leap<Self>> = match self.form {
            Form::Stored(_) => Some(Self::leap),
            Form::Inflated(_) => None,
        };
        stored.read_meant(self, leap, extent, meant, control).map_err(Fault::of_stream)
    }

    /// Makes a decoder verify the checksum, which follows the last byte. Bytes after the voxels are ignored.
    pub(in crate::data::load) fn finish(&mut self, control: &LoadControl) -> Result<(), Fault> {
        match &mut self.form {
            Form::Stored(_) => Ok(()),
            Form::Inflated(_) => fill(self, &mut [0], control).map_err(Fault::of_stream).map(drop),
        }
    }
}

impl Read for Content {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = match &mut self.form {
            Form::Stored(input) => input.reader.read(buffer),
            Form::Inflated(decoder) => decoder.read(buffer),
        }?;
        self.at += count as u64;
        Ok(count)
    }
}
