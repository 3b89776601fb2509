//! Interface of a format's reader: how its files are recognised, and the source that it reads from.

use std::io::{self, BufReader, Read, Seek as _};
use std::path::Path;

use super::content::members::GzipMembers;
use super::input::{Input, is_gzip, most_inflated};
use super::number::{Part, Stored};
use super::samples::{Fault, Layout, fill, is_corruption, skip_bytes};
use super::voxels::{Meant, Voxels};
use super::{Dimension, LoadControl, LoadError, LoadOptions, Offer};
use crate::data::Volume;
use crate::data::attempt::{Attempt, Extent};

/// Bytes of a file's beginning that are inspected to recognise it: a NIfTI-2 header has 540, the DICOM magic ends at
/// 132.
const START_BYTES: usize = 1024;

/// Maximum number of volumes that a file may offer by index: more than can be chosen from a list.
const MOST_OFFERS: u64 = 1 << 16;

/// Content that may follow the voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load) enum After {
    /// Anything may follow the voxels.
    More,
    /// The content must end with the voxels.
    End,
}

/// Reader of a file format.
pub(in crate::data::load) struct Reader {
    /// Name of the format in messages and menus.
    pub(in crate::data::load) name: &'static str,
    /// Extensions of its files, in lower case and with their dots.
    pub(in crate::data::load) endings: &'static [&'static str],
    /// Returns true if a file with this beginning has the format, whatever its name.
    pub(in crate::data::load) recognises: fn(&Start) -> bool,
    /// Reads a file of the format.
    pub(in crate::data::load) load: fn(Source<'_>) -> Result<Volume, LoadError>,
}

/// File to be read, with its options.
pub(in crate::data::load) struct Source<'a> {
    pub(in crate::data::load) path: &'a Path,
    /// Handle, positioned at the file's beginning.
    pub(in crate::data::load) input: Input,
    pub(in crate::data::load) start: Start,
    pub(in crate::data::load) options: &'a LoadOptions,
    pub(in crate::data::load) control: &'a LoadControl,
}

impl Source<'_> {
    /// Content of the file from its beginning, inflated where the whole file is compressed.
    ///
    /// Callers must limit how much they read: a compressed file may expand to any size.
    pub(in crate::data::load) fn content(&mut self) -> Box<dyn Read + '_> {
        if self.start.is_gzip() {
            Box::new(BufReader::new(GzipMembers::new(&mut self.input.reader)))
        } else {
            Box::new(&mut self.input.reader)
        }
    }

    /// Reads the selected voxels of a grid that begins at byte `at` of the content. The length is checked before
    /// anything is allocated; for compressed files against the largest possible inflated size.
    ///
    /// # Errors
    /// `BadInput` for data that are too short, too long or corrupt, with `help`; `Limit` where memory is exhausted.
    pub(in crate::data::load) fn voxels(
        &mut self,
        attempt: Attempt<'_>,
        at: u64,
        (stored, extent): (&Stored, Extent),
        after: After,
        help: &str,
    ) -> Result<Voxels, LoadError> {
        let layout = Layout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
        let needed = (extent.voxels as u64).saturating_mul(stored.bytes_of_voxel());
        let control = self.control;
        let [x, y, z] = extent.dims;
        let grid = format!("for {x} x {y} x {z} voxels of {}", layout.voxel_type.name());
        if self.start.is_gzip() {
            let most = most_inflated(self.input.len).saturating_sub(at);
            if most < needed {
                let why =
                    format!("the data are truncated: {needed} bytes expected {grid}, room for {most} found");
                return Err(attempt.bad_input("data", why, help));
            }
        } else {
            let found = self.input.len.saturating_sub(at);
            if found < needed {
                let why = format!("the data are truncated: {needed} bytes expected {grid}, {found} found");
                return Err(attempt.bad_input("data", why, help));
            }
            if found > needed && after == After::End {
                let why = format!("there are {found} bytes where {needed} were expected {grid}");
                return Err(attempt.bad_input("data", why, help));
            }
            let read = stored.read_of_file(&mut self.input, at, extent, &Meant::as_stored(None), control);
            return read.map_err(|fault| fault.into_error(attempt, &layout, "bytes", help));
        }
        let skip = at;
        // One byte more than needed distinguishes "too much" from "enough", and limits decompression bombs.
        let mut content = self.content().take(skip.saturating_add(needed).saturating_add(1));
        let mut read = || {
            if skip_bytes(&mut content, skip, control)? < skip {
                return Err(Fault::Short { got: 0 });
            }
            let voxels = stored.read(&mut content, extent, control)?;
            // Also makes the decoder verify the checksum, where nothing else follows.
            if fill(&mut content, &mut [0], control)? > 0 && after == After::End {
                return Err(Fault::Long);
            }
            Ok(voxels)
        };
        read().map_err(|fault| {
            let fault = match fault {
                Fault::Io(error) if is_corruption(&error) => Fault::Corrupt(error),
                fault => fault,
            };
            fault.into_error(attempt, &layout, "bytes", help)
        })
    }

    /// Index of the chosen one of `count` volumes along a dimension; their names may be empty.
    ///
    /// # Errors
    /// As [`Attempt::chosen`]; `Limit` for more than [`MOST_OFFERS`].
    pub(in crate::data::load) fn numbered(
        &self,
        attempt: Attempt<'_>,
        dimension: Dimension,
        count: u64,
        dims: [u64; 3],
        name: impl Fn(usize) -> String,
    ) -> Result<usize, LoadError> {
        if count > MOST_OFFERS {
            return Err(attempt.limit(
                dimension.option(),
                format!("it holds {count} {}, {MOST_OFFERS} are allowed", dimension.plural()),
                "check the header, or write fewer into one file",
            ));
        }
        let offers = (0..count as usize).map(|at| Offer::numbered(at, &name(at), dims)).collect();
        attempt.chosen(&self.options.choice, dimension, offers)
    }

    /// Scalar to derive from voxels of several components, by the user's choice.
    ///
    /// # Errors
    /// `BadInput` where the user has chosen a component that does not exist.
    pub(in crate::data::load) fn part(
        &self,
        attempt: Attempt<'_>,
        components: usize,
        is_color: bool,
    ) -> Result<Part, LoadError> {
        let component = self.options.choice.component_among(components, is_color);
        Part::asked(attempt, component, components, is_color)
    }
}

/// First bytes of a file, as stored and inflated.
pub(in crate::data::load) struct Start {
    stored: Vec<u8>,
    /// First bytes of the content, where the whole file is compressed.
    inflated: Option<Vec<u8>>,
}

impl Start {
    /// Reads the first bytes of an input, and seeks back to its beginning.
    pub(in crate::data::load) fn of(input: &mut Input) -> io::Result<Self> {
        let mut stored = Vec::with_capacity(START_BYTES);
        input.reader.by_ref().take(START_BYTES as u64).read_to_end(&mut stored)?;
        input.reader.rewind()?;
        let inflated = is_gzip(&stored).then(|| {
            let mut found = Vec::new();
            // A stream that is corrupt, or that the limit cuts off, still yields the bytes before that.
            let mut decoder = GzipMembers::new(&mut input.reader).take(START_BYTES as u64);
            let _how_far = decoder.read_to_end(&mut found);
            found
        });
        input.reader.rewind()?;
        Ok(Self { stored, inflated })
    }

    /// First bytes of the content, inflated where the file is compressed.
    pub(in crate::data::load) fn bytes(&self) -> &[u8] {
        self.inflated.as_ref().unwrap_or(&self.stored)
    }

    /// First bytes of the file as stored.
    pub(in crate::data::load) fn stored(&self) -> &[u8] {
        &self.stored
    }

    /// Returns true if the whole file is compressed.
    pub(in crate::data::load) fn is_gzip(&self) -> bool {
        self.inflated.is_some()
    }

    /// True if the content of a compressed file is compressed once more.
    pub(crate) fn is_packed_twice(&self) -> bool {
        self.inflated.as_deref().is_some_and(is_gzip)
    }

    /// Returns true if the content has `bytes` at offset `at`.
    pub(in crate::data::load) fn has(&self, bytes: &[u8], at: usize) -> bool {
        self.bytes().get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }
}
