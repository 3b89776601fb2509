//! Conversion of voxels to another number type: exactly, or by mapping a range of values to the full range of the
//! type.

use chiaroscuro_volume::{Samples, ValueRange, VoxelType};

/// Requested number type of a volume that is exported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberRequest {
    /// Number type; `None` keeps that of the volume.
    pub voxel_type: Option<VoxelType>,
    /// Values that are mapped to the lowest and the highest number of the type; values outside are clamped.
    pub rescaled: Option<ValueRange>,
    /// Value for missing voxels.
    pub padding: Option<f64>,
}

/// Reason why voxels cannot be converted as requested.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ConvertError {
    #[error(
        "its values range from {} to {}, {voxel_type} from {} to {}; choose a wider --type, or --rescale {}:{}",
        found.low, found.high, allowed.low, allowed.high, found.low, found.high
    )]
    OutOfRange { voxel_type: &'static str, found: ValueRange, allowed: ValueRange },
    #[error(
        "values such as {value} have fractions, which {voxel_type} cannot store; choose --type float32, or \
         --rescale {}:{}",
        found.low, found.high
    )]
    Fractions { voxel_type: &'static str, value: f64, found: ValueRange },
    #[error("float32 cannot store {value}: beyond 16777216 it skips whole numbers; choose --type float64")]
    Inexact { value: f64 },
    #[error(
        "{count} voxels are not finite, and {voxel_type} has only whole numbers; --padding VALUE replaces them"
    )]
    NotFinite { voxel_type: &'static str, count: usize },
    #[error(
        "--rescale maps values to whole numbers, and {voxel_type} has fractions; choose --type uint8 or uint16"
    )]
    RescaledToFloats { voxel_type: &'static str },
    #[error("--padding {padding} is not a number that {voxel_type} can store; choose one that it can")]
    BadPadding { voxel_type: &'static str, padding: f64 },
    #[error(
        "the file does not state the orientation of a body, so left and right are unknown; --orient is for files that \
         do"
    )]
    NoOrientation,
}

/// Conversion of voxel values to the numbers in a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NumberConversion {
    pub(super) voxel_type: VoxelType,
    /// Linear mapping of values to whole numbers, followed by rounding.
    scale: Option<LinearMapping>,
    /// Padding value of the volume, which marks missing voxels in addition to values that are not finite.
    source_padding: Option<f64>,
    /// Number that is written for missing voxels.
    padding: Option<f64>,
}

/// Linear mapping from a range of values to a range of whole numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LinearMapping {
    from: ValueRange,
    to: ValueRange,
}

impl LinearMapping {
    fn number(self, value: f64) -> f64 {
        let Self { from, to } = self;
        let share = ((value - from.low) / from.span()).clamp(0.0, 1.0);
        share.mul_add(to.span(), to.low).round()
    }
}

/// Returns the range of an integer type; `None` for floating-point types.
fn integer_range(voxel_type: VoxelType) -> Option<ValueRange> {
    let (low, high) = match voxel_type {
        VoxelType::U8 => (0.0, f64::from(u8::MAX)),
        VoxelType::I8 => (f64::from(i8::MIN), f64::from(i8::MAX)),
        VoxelType::U16 => (0.0, f64::from(u16::MAX)),
        VoxelType::I16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
        VoxelType::U32 => (0.0, f64::from(u32::MAX)),
        VoxelType::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
        VoxelType::F32 | VoxelType::F64 => return None,
    };
    Some(ValueRange::new(low, high))
}

/// Returns true if a number type can represent a value.
fn can_represent(voxel_type: VoxelType, value: f64) -> bool {
    match integer_range(voxel_type) {
        Some(all) => (all.low..=all.high).contains(&value) && value.fract() == 0.0,
        None => voxel_type == VoxelType::F64 || (value as f32).is_finite(),
    }
}

impl NumberConversion {
    /// Creates a conversion that keeps the voxels' numbers.
    pub(super) fn identity(samples: &Samples) -> Self {
        Self { voxel_type: samples.voxel_type(), scale: None, source_padding: None, padding: None }
    }

    /// Creates the requested conversion for voxels with a given padding value.
    ///
    /// # Errors
    /// When a value cannot be represented.
    pub(super) fn requested(
        samples: &Samples,
        found_padding: Option<f64>,
        wish: &NumberRequest,
    ) -> Result<Self, ConvertError> {
        let voxel_type = wish.voxel_type.unwrap_or(samples.voxel_type());
        let name = voxel_type.name();
        if let Some(padding) = wish.padding.filter(|&padding| !can_represent(voxel_type, padding)) {
            return Err(ConvertError::BadPadding { voxel_type: name, padding });
        }
        let exact = Self { voxel_type, scale: None, source_padding: found_padding, padding: wish.padding };
        let Some(from) = wish.rescaled else {
            exact.check(samples)?;
            return Ok(exact);
        };
        let Some(all) = integer_range(voxel_type) else {
            return Err(ConvertError::RescaledToFloats { voxel_type: name });
        };
        let holds_nothing = (0..samples.len()).any(|voxel| exact.is_missing(samples.value(voxel)));
        let padding = wish.padding.or(holds_nothing.then_some(all.low));
        // The number that marks missing voxels is excluded from the mapping's range.
        let inner = |edge: f64, step: f64| if padding == Some(edge) { edge + step } else { edge };
        let to = ValueRange::new(inner(all.low, 1.0), inner(all.high, -1.0));
        Ok(Self { scale: Some(LinearMapping { from, to }), padding, ..exact })
    }

    /// Returns true if the conversion leaves voxels unchanged.
    pub(super) fn is_identity(&self, samples: &Samples) -> bool {
        self.voxel_type == samples.voxel_type() && self.scale.is_none() && self.padding.is_none()
    }

    pub(super) fn is_rescaled(&self) -> bool {
        self.scale.is_some()
    }

    /// Converts a voxel value to the number in the file.
    pub(super) fn convert(&self, value: f64) -> f64 {
        match (self.padding, self.scale) {
            (Some(padding), _) if self.is_missing(value) => padding,
            (_, Some(scale)) => scale.number(value),
            (_, None) => value,
        }
    }

    /// Returns the number that marks missing voxels in the file, if there is one.
    pub(super) fn padding(&self) -> Option<f64> {
        // A padding value that no voxel has and the type cannot represent is dropped.
        self.padding.or(self.source_padding.filter(|&value| can_represent(self.voxel_type, value)))
    }

    fn is_missing(&self, value: f64) -> bool {
        !value.is_finite() || self.source_padding == Some(value)
    }

    /// Checks that the number type can represent all values.
    fn check(&self, samples: &Samples) -> Result<(), ConvertError> {
        let (voxel_type, name) = (self.voxel_type, self.voxel_type.name());
        if voxel_type == samples.voxel_type() || voxel_type == VoxelType::F64 {
            return Ok(());
        }
        let is_whole = integer_range(samples.voxel_type()).is_some();
        let mut found: Option<ValueRange> = None;
        let (mut fraction, mut inexact, mut not_finite) = (None, None, 0);
        for voxel in 0..samples.len() {
            let value = self.convert(samples.value(voxel));
            if !value.is_finite() {
                not_finite += 1;
                continue;
            }
            found = found
                .map(|found| ValueRange::new(found.low.min(value), found.high.max(value)))
                .or(Some(ValueRange::new(value, value)));
            if value.fract() != 0.0 {
                fraction = fraction.or(Some(value));
            }
            if is_whole && f64::from(value as f32).to_bits() != value.to_bits() {
                inexact = inexact.or(Some(value));
            }
        }
        // The padding value was validated before.
        let Some(found) = found else { return Ok(()) };
        let Some(allowed) = integer_range(voxel_type) else {
            let reach = f64::from(f32::MAX);
            return match inexact {
                Some(value) => Err(ConvertError::Inexact { value }),
                None if [found.low, found.high].iter().all(|&value| can_represent(voxel_type, value)) => {
                    Ok(())
                }
                None => Err(ConvertError::OutOfRange {
                    voxel_type: name,
                    found,
                    allowed: ValueRange::new(-reach, reach),
                }),
            };
        };
        if found.low < allowed.low || found.high > allowed.high {
            return Err(ConvertError::OutOfRange { voxel_type: name, found, allowed });
        }
        if let Some(value) = fraction {
            return Err(ConvertError::Fractions { voxel_type: name, value, found });
        }
        if not_finite > 0 {
            return Err(ConvertError::NotFinite { voxel_type: name, count: not_finite });
        }
        Ok(())
    }
}

/// Appends a number in little-endian order. Values that the type cannot represent were rejected before.
pub(super) fn append_number(bytes: &mut Vec<u8>, voxel_type: VoxelType, number: f64) {
    match voxel_type {
        VoxelType::U8 => bytes.extend((number as u8).to_le_bytes()),
        VoxelType::I8 => bytes.extend((number as i8).to_le_bytes()),
        VoxelType::U16 => bytes.extend((number as u16).to_le_bytes()),
        VoxelType::I16 => bytes.extend((number as i16).to_le_bytes()),
        VoxelType::U32 => bytes.extend((number as u32).to_le_bytes()),
        VoxelType::I32 => bytes.extend((number as i32).to_le_bytes()),
        VoxelType::F32 => bytes.extend((number as f32).to_le_bytes()),
        VoxelType::F64 => bytes.extend(number.to_le_bytes()),
    }
}
