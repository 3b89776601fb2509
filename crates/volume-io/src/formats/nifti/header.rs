//! Header fields of Analyze 7.5, NIfTI-1 and NIfTI-2, parsed into one common struct.

use super::super::{Endian, LoadError};
use chiaroscuro_volume::LoadContext;

/// Header format: Analyze 7.5, NIfTI-1 or NIfTI-2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NiftiVersion {
    Analyze,
    Nifti1,
    Nifti2,
}

/// Sizes in bytes of the headers of Analyze and NIfTI-1, and of NIfTI-2; the first field of a header (`sizeof_hdr`)
/// repeats it.
const NIFTI1_HEADER_BYTES: usize = 348;
const NIFTI2_HEADER_BYTES: usize = 540;

/// Size of the extender that follows a header in a single file: four bytes that tell if extensions follow.
pub(super) const EXTENDER_BYTES: u64 = 4;

impl NiftiVersion {
    /// Returns the size of a header in bytes.
    pub(super) fn header_bytes(self) -> u64 {
        match self {
            Self::Nifti2 => NIFTI2_HEADER_BYTES as u64,
            Self::Nifti1 | Self::Analyze => NIFTI1_HEADER_BYTES as u64,
        }
    }

    /// Detects the header format from the first bytes of a file; `None` if they are no header.
    pub(super) fn detect(bytes: &[u8]) -> Option<Self> {
        let has = |at: usize, mark: &[u8]| bytes.get(at..).is_some_and(|rest| rest.starts_with(mark));
        if bytes.len() >= NIFTI2_HEADER_BYTES && (has(4, b"n+2\0") || has(4, b"ni2\0")) {
            return Some(Self::Nifti2);
        }
        if bytes.len() < NIFTI1_HEADER_BYTES {
            return None;
        }
        if has(344, b"n+1\0") || has(344, b"ni1\0") {
            return Some(Self::Nifti1);
        }
        is_analyze(bytes).then_some(Self::Analyze)
    }

    /// Detects the byte order: the one in which the number of dimensions is 1 to 7 (NIfTI-2: in which `sizeof_hdr` is
    /// right).
    fn endian(self, bytes: &[u8]) -> Option<Endian> {
        [Endian::Little, Endian::Big].into_iter().find(|&endian| {
            let fields = NiftiFields { bytes, endian };
            match self {
                Self::Nifti2 => fields.i32(0) == NIFTI2_HEADER_BYTES as i32,
                Self::Nifti1 | Self::Analyze => (1..=7).contains(&fields.i16(40)),
            }
        })
    }
}

/// True if an Analyze header begins here. The format has no magic bytes, so several fields are checked for plausible
/// values.
fn is_analyze(bytes: &[u8]) -> bool {
    [Endian::Little, Endian::Big].into_iter().any(|endian| {
        let fields = NiftiFields { bytes, endian };
        let bits = match fields.i16(70) {
            1 => 1,
            2 | 130 | 256 => 8,
            4 | 132 | 512 => 16,
            8 | 16 | 136 | 768 => 32,
            32 | 64 => 64,
            128 => 24,
            _ => return false,
        };
        fields.i32(0) == NIFTI1_HEADER_BYTES as i32
            && (1..=7).contains(&fields.i16(40))
            && fields.i16(42) > 0
            && [bits, 0].contains(&fields.i16(72))
    })
}

/// Parsed header of an Analyze, NIfTI-1 or NIfTI-2 file.
#[derive(Debug, Clone)]
pub(super) struct NiftiHeader {
    pub(super) version: NiftiVersion,
    /// True if the voxels follow in the same file (magic `n+1` or `n+2`).
    pub(super) has_data: bool,
    pub(super) endian: Endian,
    /// Number of dimensions, followed by the lengths of up to seven.
    pub(super) dim: [i64; 8],
    /// Handedness of the third axis (`qfac`), followed by the spacings along all axes.
    pub(super) pixdim: [f64; 8],
    pub(super) datatype: i16,
    /// Byte offset of the first voxel in the file that holds the data.
    pub(super) data_start: u64,
    pub(super) slope: f64,
    pub(super) intercept: f64,
    pub(super) cal_min: f64,
    pub(super) cal_max: f64,
    pub(super) intent_code: i32,
    /// Units: of lengths in the lowest three bits, of times in the next three (`xyzt_units`).
    pub(super) units: i32,
    /// Units as text, in Analyze files alone: of lengths, and of values (`vox_units`, `cal_units`).
    pub(super) analyze_units: [String; 2],
    pub(super) qform_code: i32,
    pub(super) sform_code: i32,
    pub(super) quatern: [f64; 3],
    pub(super) qoffset: [f64; 3],
    pub(super) srow: [[f64; 4]; 3],
    /// Time of the first volume, in the header's unit of time.
    pub(super) toffset: f64,
    pub(super) descrip: String,
}

impl NiftiHeader {
    /// Parses a header whose format is known.
    pub(super) fn parse(
        context: LoadContext<'_>,
        form: NiftiVersion,
        bytes: &[u8],
    ) -> Result<Self, LoadError> {
        let Some(endian) = form.endian(bytes) else {
            return Err(context.bad_input_error(
                "dim[0]",
                "the number of dimensions is invalid in either byte order: 1 to 7 were expected",
                "copy the file again",
            ));
        };
        let fields = NiftiFields { bytes, endian };
        let (header, offset) = match form {
            NiftiVersion::Analyze | NiftiVersion::Nifti1 => {
                (fields.parse_nifti1(form), f64::from(fields.f32(108)))
            }
            NiftiVersion::Nifti2 => (fields.parse_nifti2(), fields.i64(168) as f64),
        };
        if !(0.0..=u64::MAX as f64).contains(&offset) {
            return Err(context.bad_input_error(
                "vox_offset",
                format!("voxels cannot begin at byte {offset}"),
                "correct the header",
            ));
        }
        let size = form.header_bytes();
        // Some programs leave `vox_offset` at 0.
        let least = if header.has_data { size } else { 0 };
        let data_start = if offset < least as f64 { size + EXTENDER_BYTES } else { offset as u64 };
        Ok(Self { data_start, ..header })
    }

    /// Returns slope and intercept of the values; a slope of 0, or a non-finite number, means that the values are not
    /// scaled.
    pub(super) fn scale(&self) -> (f64, f64) {
        let has_scale = self.slope.is_finite() && self.intercept.is_finite() && self.slope != 0.0;
        if has_scale { (self.slope, self.intercept) } else { (1.0, 0.0) }
    }
}

/// Reader of numbers and text at byte offsets of a header; reads zeros beyond its end.
struct NiftiFields<'a> {
    bytes: &'a [u8],
    endian: Endian,
}

macro_rules! field {
    ($($name:ident: $type:ty),*) => { $(
        fn $name(&self, at: usize) -> $type {
            let bytes = self.array(at);
            match self.endian {
                Endian::Little => <$type>::from_le_bytes(bytes),
                Endian::Big => <$type>::from_be_bytes(bytes),
            }
        }
    )* };
}

impl NiftiFields<'_> {
    field!(i16: i16, i32: i32, i64: i64, f32: f32, f64: f64);

    fn array<const N: usize>(&self, at: usize) -> [u8; N] {
        let found = self.bytes.get(at..at + N).and_then(|bytes| bytes.try_into().ok());
        found.unwrap_or([0; N])
    }

    /// Reads text of at most `most` bytes, up to the first zero byte.
    fn text(&self, at: usize, most: usize) -> String {
        let bytes = self.bytes.get(at..at + most).unwrap_or_default();
        let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        String::from_utf8_lossy(text).into_owned()
    }

    fn f32s<const N: usize>(&self, at: usize) -> [f64; N] {
        std::array::from_fn(|index| f64::from(self.f32(at + 4 * index)))
    }

    fn f64s<const N: usize>(&self, at: usize) -> [f64; N] {
        std::array::from_fn(|index| self.f64(at + 8 * index))
    }

    /// Parses a header of 348 bytes. Analyze uses the fields that NIfTI-1 added for other purposes; the slope is read
    /// in both, as SPM writes it there.
    fn parse_nifti1(&self, form: NiftiVersion) -> NiftiHeader {
        let is_nifti = form == NiftiVersion::Nifti1;
        let nifti_only = |value: i32| if is_nifti { value } else { 0 };
        NiftiHeader {
            version: form,
            has_data: is_nifti && self.bytes.get(344..347) == Some(b"n+1"),
            endian: self.endian,
            dim: std::array::from_fn(|index| i64::from(self.i16(40 + 2 * index))),
            pixdim: self.f32s(76),
            datatype: self.i16(70),
            data_start: 0,
            slope: f64::from(self.f32(112)),
            intercept: if is_nifti { f64::from(self.f32(116)) } else { 0.0 },
            cal_max: f64::from(self.f32(124)),
            cal_min: f64::from(self.f32(128)),
            intent_code: nifti_only(i32::from(self.i16(68))),
            units: nifti_only(self.array::<1>(123).map(i32::from)[0]),
            analyze_units: if is_nifti {
                [String::new(), String::new()]
            } else {
                [self.text(56, 4), self.text(60, 8)]
            },
            qform_code: nifti_only(i32::from(self.i16(252))),
            sform_code: nifti_only(i32::from(self.i16(254))),
            quatern: self.f32s(256),
            qoffset: self.f32s(268),
            srow: [280, 296, 312].map(|at| self.f32s(at)),
            toffset: if is_nifti { f64::from(self.f32(136)) } else { 0.0 },
            descrip: self.text(148, 80),
        }
    }

    /// Parses a NIfTI-2 header of 540 bytes.
    fn parse_nifti2(&self) -> NiftiHeader {
        NiftiHeader {
            version: NiftiVersion::Nifti2,
            has_data: self.bytes.get(4..7) == Some(b"n+2"),
            endian: self.endian,
            dim: std::array::from_fn(|index| self.i64(16 + 8 * index)),
            pixdim: self.f64s(104),
            datatype: self.i16(12),
            data_start: 0,
            slope: self.f64(176),
            intercept: self.f64(184),
            cal_max: self.f64(192),
            cal_min: self.f64(200),
            intent_code: self.i32(504),
            units: self.i32(500),
            analyze_units: [String::new(), String::new()],
            qform_code: self.i32(344),
            sform_code: self.i32(348),
            quatern: self.f64s(352),
            qoffset: self.f64s(376),
            srow: [400, 432, 464].map(|at| self.f64s(at)),
            toffset: self.f64(216),
            descrip: self.text(240, 80),
        }
    }
}
