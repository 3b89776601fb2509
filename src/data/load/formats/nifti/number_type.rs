//! Number types of voxels by `datatype` code.

use super::super::LoadError;
use super::super::number::{Number, Part};
use super::header::Header;
use crate::data::attempt::Attempt;

/// Number type of a voxel: stored type, number of components, and colour flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NumberType {
    pub(super) number: Number,
    /// Number of interleaved components of each voxel.
    pub(super) components: usize,
    pub(super) is_color: bool,
}

impl NumberType {
    /// Looks up the type of a header's `datatype` code (`nifti1.h`, `DT_`… and `NIFTI_TYPE_`…). Codes 130 to 136 are
    /// those that SPM added to Analyze.
    pub(super) fn of(attempt: Attempt<'_>, header: &Header) -> Result<Self, LoadError> {
        let scalar = |number| Ok(Self { number, components: 1, is_color: false });
        let colors = |components| Ok(Self { number: Number::U8, components, is_color: true });
        let complex = |number| Ok(Self { number, components: 2, is_color: false });
        match header.datatype {
            2 => scalar(Number::U8),
            4 => scalar(Number::I16),
            8 => scalar(Number::I32),
            16 => scalar(Number::F32),
            32 => complex(Number::F32),
            64 => scalar(Number::F64),
            128 => colors(3),
            256 | 130 => scalar(Number::I8),
            512 | 132 => scalar(Number::U16),
            768 | 136 => scalar(Number::U32),
            1024 => scalar(Number::I64),
            1280 => scalar(Number::U64),
            1792 => complex(Number::F64),
            2304 => colors(4),
            code => {
                let why = match code {
                    1 => "voxels of one bit".to_owned(),
                    1536 | 2048 => "numbers of 128 bits".to_owned(),
                    _ => format!("voxels of the unknown type {code}"),
                };
                Err(attempt.bad_input(
                    "datatype",
                    format!("{why} are not read"),
                    "write it with a type of 8 to 64 bits",
                ))
            }
        }
    }

    /// Returns a remark for the user if only part of a voxel's data is shown.
    pub(super) fn remark(&self, part: Part) -> Option<&'static str> {
        if self.components == 2 && part == Part::Magnitude {
            return Some("complex numbers are shown as their magnitude");
        }
        part.remark()
    }
}
