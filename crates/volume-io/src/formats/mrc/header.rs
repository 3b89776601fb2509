//! Header of an MRC file: 256 words of 4 bytes, which its definition counts from 1.

use super::super::{Endian, LoadError};
use chiaroscuro_volume::LoadContext;

pub(super) const HEADER_BYTES: usize = 1024;

/// Maximum plausible number of voxels along an axis; a larger number shows a wrong byte order.
const MAX_AXIS_LENGTH: i32 = 1 << 24;

/// Highest mode that any program writes: 101, packed 4 bits.
const MAX_MODE: i32 = 101;

/// IMOD's stamp: "IMOD" as a little-endian integer.
const IMOD_STAMP: i32 = 1_146_047_817;

/// Bit of IMOD's flags: bytes are signed.
const IMOD_SIGNED_BYTES: i32 = 1;

/// Bit of IMOD's flags: the origin has the opposite sign.
const IMOD_ORIGIN_INVERTED: i32 = 4;

/// Space group numbers that stand for stacks of volumes.
const VOLUME_STACKS: std::ops::RangeInclusive<i32> = 401..=630;

pub(super) struct MrcHeader {
    bytes: [u8; HEADER_BYTES],
    pub(super) endian: Endian,
}

impl MrcHeader {
    /// Parses the header at the beginning of a file, and detects its byte order.
    pub(super) fn parse(context: LoadContext<'_>, start: &[u8]) -> Result<Self, LoadError> {
        let Some(&bytes) = start.first_chunk() else {
            return Err(context.bad_input_error(
                "header",
                format!("the header is truncated: {HEADER_BYTES} bytes expected, {} found", start.len()),
                "copy or download the file again",
            ));
        };
        let with_endian = |endian| Self { bytes, endian };
        // The machine stamp is wrong in files that were converted only in part, so plausibility decides.
        let stamped = match bytes[212] {
            0x44 => Some(Endian::Little),
            0x11 => Some(Endian::Big),
            _ => None,
        };
        let first = stamped.unwrap_or(Endian::Little);
        let other = if first == Endian::Little { Endian::Big } else { Endian::Little };
        let [as_stamped, swapped] = [first, other].map(with_endian);
        if as_stamped.is_plausible() || (stamped.is_some() && !swapped.is_plausible()) {
            Ok(as_stamped)
        } else if swapped.is_plausible() {
            Ok(swapped)
        } else {
            Err(context.bad_input_error(
                "header",
                "the header is not that of an MRC file: its dimensions or mode are invalid in either byte order",
                "check the file's name and format",
            ))
        }
    }

    fn word(&self, word: usize) -> [u8; 4] {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(&self.bytes[4 * (word - 1)..4 * word]);
        bytes
    }

    /// Returns a word as an integer.
    pub(super) fn int(&self, word: usize) -> i32 {
        match self.endian {
            Endian::Little => i32::from_le_bytes(self.word(word)),
            Endian::Big => i32::from_be_bytes(self.word(word)),
        }
    }

    /// Returns a word as a real number.
    pub(super) fn float(&self, word: usize) -> f64 {
        f64::from(f32::from_bits(self.int(word).cast_unsigned()))
    }

    /// Returns three consecutive words as integers.
    pub(super) fn ints(&self, first: usize) -> [i32; 3] {
        [first, first + 1, first + 2].map(|word| self.int(word))
    }

    /// Returns three consecutive words as real numbers.
    pub(super) fn floats(&self, first: usize) -> [f64; 3] {
        [first, first + 1, first + 2].map(|word| self.float(word))
    }

    fn is_plausible(&self) -> bool {
        self.ints(1).iter().all(|n| (1..=MAX_AXIS_LENGTH).contains(n))
            && (0..=MAX_MODE).contains(&self.mode())
    }

    /// Returns the numbers of columns, rows and sections (`NX`, `NY`, `NZ`).
    pub(super) fn dims(&self, context: LoadContext<'_>) -> Result<[u64; 3], LoadError> {
        let [x, y, z] = self.ints(1);
        let along = |n: i32| u64::try_from(n).ok().filter(|&n| n > 0);
        match (along(x), along(y), along(z)) {
            (Some(x), Some(y), Some(z)) => Ok([x, y, z]),
            _ => Err(context.bad_input_error(
                "NX, NY, NZ",
                format!("{x} x {y} x {z} are not valid dimensions"),
                "every dimension must be at least 1",
            )),
        }
    }

    pub(super) fn mode(&self) -> i32 {
        self.int(4)
    }

    fn space_group(&self) -> i32 {
        self.int(23)
    }

    /// True for a stack of images rather than a volume (`ISPG` 0 and `MZ` 1), for example a tilt series.
    pub(super) fn is_image_stack(&self) -> bool {
        self.space_group() == 0 && self.int(10) == 1
    }

    /// Returns the number of sections of each volume of a stack; otherwise `all`.
    pub(super) fn sections_per_volume(&self, all: u64) -> u64 {
        let sampled = u64::try_from(self.int(10)).unwrap_or(0);
        let is_stack = VOLUME_STACKS.contains(&self.space_group()) && sampled > 0;
        if is_stack && all.is_multiple_of(sampled) { sampled } else { all }
    }

    /// Returns the size of the extended header in bytes (`NSYMBT`), which lies between header and voxels.
    pub(super) fn extension_bytes(&self, context: LoadContext<'_>) -> Result<u64, LoadError> {
        let said = self.int(24);
        u64::try_from(said).map_err(|_negative| {
            context.bad_input_error(
                "NSYMBT",
                format!("{said} bytes cannot be the length of an extended header"),
                "copy or download the file again",
            )
        })
    }

    fn imod_flags(&self) -> Option<i32> {
        (self.int(39) == IMOD_STAMP).then(|| self.int(40))
    }

    /// True if bytes are signed: as IMOD's flags state, as the definition of 2014 demands, or as the value range
    /// suggests in older files.
    pub(super) fn bytes_are_signed(&self) -> bool {
        let is_of_2014 = matches!(self.int(28), 20140..=20149);
        match self.imod_flags() {
            Some(flags) => flags & IMOD_SIGNED_BYTES != 0,
            None => is_of_2014 || self.float(21) <= f64::from(i8::MAX),
        }
    }

    /// Returns the position of the first voxel in Å; `None` if it is all zero.
    pub(super) fn origin(&self) -> Option<[f64; 3]> {
        let origin = self.floats(50);
        let sign =
            if self.imod_flags().is_some_and(|flags| flags & IMOD_ORIGIN_INVERTED != 0) { -1.0 } else { 1.0 };
        let is_said = origin.iter().all(|x| x.is_finite()) && origin != [0.0; 3];
        is_said.then(|| origin.map(|x| sign * x))
    }

    /// Returns the first non-empty one of ten labels, in which programs note what they have done.
    pub(super) fn label(&self) -> String {
        let labels = self.bytes[224..].chunks(80).map(|label| {
            let end = label.iter().position(|&byte| byte == 0).unwrap_or(label.len());
            String::from_utf8_lossy(&label[..end]).trim().to_owned()
        });
        labels.into_iter().find(|label| !label.is_empty()).unwrap_or_default()
    }
}
