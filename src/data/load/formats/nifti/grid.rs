//! The dimensions: three of space, then time and what else there is.

use super::super::LoadError;
use super::header::Header;
use crate::data::attempt::{Attempt, Offer};

/// Most volumes of a file that are told apart: longer series than any scanner makes.
const MOST_FRAMES: u64 = 1 << 16;

/// Most components of a vector: those of real ones are three, or the coefficients of a model.
const MOST_COMPONENTS: u64 = 1 << 10;

/// Intents whose fifth dimension are the components of vectors (`NIFTI_INTENT_DISPVECT`, `NIFTI_INTENT_VECTOR`).
const VECTOR_INTENTS: [i32; 2] = [1006, 1007];

/// What the dimensions mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grid {
    /// Voxels along x, y, z.
    pub(super) dims: [u64; 3],
    /// Volumes that can be chosen.
    pub(super) frames: usize,
    /// Numbers of a vector, each in a volume of its own; 1 where there are no vectors.
    pub(super) components: usize,
    /// The fourth to the seventh dimension, without the components.
    others: [u64; 4],
}

impl Grid {
    pub(super) fn of(attempt: Attempt<'_>, header: &Header) -> Result<Self, LoadError> {
        let wrong = |field: &str, found: i64, expected: &str| {
            attempt.bad_input(
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
        for (axis, (length, &said)) in lengths.iter_mut().zip(&header.dim[1..]).enumerate() {
            if axis as i64 >= count {
                break;
            }
            *length = match u64::try_from(said) {
                // Some programs write no length where there is nothing along an axis.
                Ok(0) if axis > 0 => 1,
                Ok(said) => said,
                Err(_negative) => {
                    return Err(wrong(&format!("dim[{}]", axis + 1), said, "a number of voxels"));
                }
            };
        }
        let [x, y, z, mut others @ ..] = lengths;
        let mut components = 1;
        if VECTOR_INTENTS.contains(&header.intent_code) {
            components = std::mem::replace(&mut others[1], 1).max(1);
        }
        let frames = others.iter().fold(1u64, |product, &n| product.saturating_mul(n));
        if frames > MOST_FRAMES || components > MOST_COMPONENTS {
            return Err(attempt.limit(
                "dim",
                format!(
                    "{frames} volumes of {components} components are too many: at most {MOST_FRAMES} of {MOST_COMPONENTS} are read"
                ),
                "split the file",
            ));
        }
        Ok(Self { dims: [x, y, z], frames: frames as usize, components: components as usize, others })
    }

    /// The volumes that can be chosen.
    pub(super) fn offers(&self, header: &Header) -> Vec<Offer> {
        let name = |frame| self.name(frame, header).unwrap_or_default();
        (0..self.frames).map(|frame| Offer::numbered(frame, &name(frame), self.dims)).collect()
    }

    /// The time of a volume, where the file says it, or else its place along more than one dimension.
    fn name(&self, frame: usize, header: &Header) -> Option<String> {
        let [steps, others @ ..] = self.others;
        if others != [1; 3] {
            let mut rest = frame as u64;
            let mut place = Vec::new();
            for length in self.others {
                place.extend((length > 1).then(|| (rest % length).to_string()));
                rest /= length;
            }
            return Some(place.join(", "));
        }
        // `NIFTI_UNITS_SEC`, `_MSEC` and `_USEC`.
        let unit = match header.units & 0x38 {
            8 => "s",
            16 => "ms",
            24 => "µs",
            _ => return None,
        };
        let (step, first) = (header.pixdim[4], header.toffset);
        let time = (frame as f64).mul_add(step, if first.is_finite() { first } else { 0.0 });
        // The numbers of NIfTI-1 are of 32 bits: what they are rounded by is not shown.
        let time = (time * 1e3).round() / 1e3;
        (steps > 1 && step > 0.0 && time.is_finite()).then(|| format!("{time} {unit}"))
    }
}
