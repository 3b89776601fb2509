//! `NIfTI` dimensions (`dim`): three of space, then time and up to three more.

use super::super::LoadError;
use super::header::NiftiHeader;
use chiaroscuro_volume::{LoadContext, VolumeOffer};

/// Maximum number of selectable volumes in a file: longer than any scanner's series.
const MAX_FRAMES: u64 = 1 << 16;

/// Maximum number of components of a vector: real files have three, or the coefficients of a model.
const MAX_COMPONENTS: u64 = 1 << 10;

/// Intents that make the fifth dimension the components of vectors (`NIFTI_INTENT_DISPVECT`, `NIFTI_INTENT_VECTOR`).
const VECTOR_INTENTS: [i32; 2] = [1006, 1007];

/// Meaning of the dimensions: grid size, number of volumes, and number of vector components.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NiftiGrid {
    /// Voxels along x, y, z.
    pub(super) dims: [u64; 3],
    /// Number of volumes that the user can choose from.
    pub(super) frames: usize,
    /// Components of a vector, each stored as a volume of its own; 1 if the file has no vectors.
    pub(super) components: usize,
    /// Lengths of the fourth to seventh dimension, without the vector components (replaced by 1).
    extra_lengths: [u64; 4],
}

impl NiftiGrid {
    pub(super) fn parse(context: LoadContext<'_>, header: &NiftiHeader) -> Result<Self, LoadError> {
        let wrong = |field: &str, found: i64, expected: &str| {
            context.bad_input_error(
                field,
                format!("{expected} was expected, {found} was found"),
                "correct the header",
            )
        };
        let count = header.dim[0];
        if !(1..=7).contains(&count) {
            return Err(wrong("dim[0]", count, "a number of dimensions from 1 to 7"));
        }
        let mut lengths = [1u64; 7];
        for (axis, (length, &stated)) in lengths.iter_mut().zip(&header.dim[1..]).enumerate() {
            if axis as i64 >= count {
                break;
            }
            *length = match u64::try_from(stated) {
                // Some programs write 0 for the length of an unused axis.
                Ok(0) if axis > 0 => 1,
                Ok(said) => said,
                Err(_negative) => {
                    return Err(wrong(&format!("dim[{}]", axis + 1), stated, "a number of voxels"));
                }
            };
        }
        let [x, y, z, mut others @ ..] = lengths;
        let mut components = 1;
        if VECTOR_INTENTS.contains(&header.intent_code) {
            components = std::mem::replace(&mut others[1], 1).max(1);
        }
        let frames = others.iter().fold(1u64, |product, &n| product.saturating_mul(n));
        if frames > MAX_FRAMES || components > MAX_COMPONENTS {
            return Err(context.limit_error(
                "dim",
                format!(
                    "{frames} volumes of {components} components are too many: at most {MAX_FRAMES} of \
                     {MAX_COMPONENTS} are supported"
                ),
                "split the file",
            ));
        }
        Ok(Self {
            dims: [x, y, z],
            frames: frames as usize,
            components: components as usize,
            extra_lengths: others,
        })
    }

    /// Returns the volumes that the user can choose from, with their names.
    pub(super) fn offers(&self, header: &NiftiHeader) -> Vec<VolumeOffer> {
        let name = |frame| self.name(frame, header).unwrap_or_default();
        (0..self.frames).map(|frame| VolumeOffer::with_number(frame, &name(frame), self.dims)).collect()
    }

    /// Returns a name for a volume: its time if the header gives a time unit, or its indices along several extra
    /// dimensions.
    fn name(&self, frame: usize, header: &NiftiHeader) -> Option<String> {
        let [steps, others @ ..] = self.extra_lengths;
        if others != [1; 3] {
            let mut remaining = frame as u64;
            let mut indices = Vec::new();
            for length in self.extra_lengths {
                indices.extend((length > 1).then(|| (remaining % length).to_string()));
                remaining /= length;
            }
            return Some(indices.join(", "));
        }
        // Time units: `NIFTI_UNITS_SEC`, `_MSEC` and `_USEC`.
        let unit = match header.units & 0x38 {
            8 => "s",
            16 => "ms",
            24 => "µs",
            _ => return None,
        };
        let (step, first) = (header.pixdim[4], header.toffset);
        let time = (frame as f64).mul_add(step, if first.is_finite() { first } else { 0.0 });
        // NIfTI-1 stores 32-bit floats: rounding to 1e-3 hides their representation error.
        let time = (time * 1e3).round() / 1e3;
        (steps > 1 && step > 0.0 && time.is_finite()).then(|| format!("{time} {unit}"))
    }
}
