//! Number types of voxels by `datatype` code.

use super::super::LoadError;
use super::super::number::{FileNumberType, ScalarReduction};
use super::header::NiftiHeader;
use chiaroscuro_volume::LoadContext;

/// Number type of a voxel: stored type, number of components, and colour flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NiftiNumberType {
    pub(super) number: FileNumberType,
    /// Number of interleaved components of each voxel.
    pub(super) components: usize,
    pub(super) is_color: bool,
}

impl NiftiNumberType {
    /// Looks up the type of a header's `datatype` code (`nifti1.h`, `DT_`… and `NIFTI_TYPE_`…). Codes 130 to 136 are
    /// those that SPM added to Analyze.
    pub(super) fn from_header(context: LoadContext<'_>, header: &NiftiHeader) -> Result<Self, LoadError> {
        let scalar = |number| Ok(Self { number, components: 1, is_color: false });
        let colors = |components| Ok(Self { number: FileNumberType::U8, components, is_color: true });
        let complex = |number| Ok(Self { number, components: 2, is_color: false });
        match header.datatype {
            2 => scalar(FileNumberType::U8),
            4 => scalar(FileNumberType::I16),
            8 => scalar(FileNumberType::I32),
            16 => scalar(FileNumberType::F32),
            32 => complex(FileNumberType::F32),
            64 => scalar(FileNumberType::F64),
            128 => colors(3),
            256 | 130 => scalar(FileNumberType::I8),
            512 | 132 => scalar(FileNumberType::U16),
            768 | 136 => scalar(FileNumberType::U32),
            1024 => scalar(FileNumberType::I64),
            1280 => scalar(FileNumberType::U64),
            1792 => complex(FileNumberType::F64),
            2304 => colors(4),
            code => {
                let why = match code {
                    1 => "voxels of one bit".to_owned(),
                    1536 | 2048 => "numbers of 128 bits".to_owned(),
                    _ => format!("voxels of the unknown type {code}"),
                };
                Err(context.bad_input_error(
                    "datatype",
                    format!("{why} are not supported"),
                    "write it with a type of 8 to 64 bits",
                ))
            }
        }
    }

    /// Returns a remark for the user if only part of a voxel's data is shown.
    pub(super) fn remark(&self, part: ScalarReduction) -> Option<&'static str> {
        if self.components == 2 && part == ScalarReduction::Magnitude {
            return Some("complex numbers are shown as their magnitude");
        }
        part.remark()
    }
}
