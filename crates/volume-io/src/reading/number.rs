//! Conversion of the number types of files to those of volumes, including types that volumes lack (64-bit integers,
//! half floats) and voxels of several components.

use std::io::Read;

use super::samples::{
    BLOCK_BYTES, DecodeSample as _, ReadFault, VoxelLayout, alloc_with_capacity, read_binary, read_until_full,
};
use super::voxel_filter::{SkipFn, VoxelFilter};
use super::voxels::{AveragingError, ReadVoxels, ValueMapping, average_blocks};
use super::{Endian, LoadControl, LoadError};
use chiaroscuro_volume::{GridExtent, LoadContext, Samples, VoxelType};

/// Number type of voxels in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileNumberType {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F16,
    F32,
    F64,
}

impl FileNumberType {
    /// Returns the number type that equals a voxel type.
    pub(crate) const fn from_voxel_type(voxel_type: VoxelType) -> Self {
        match voxel_type {
            VoxelType::U8 => Self::U8,
            VoxelType::I8 => Self::I8,
            VoxelType::U16 => Self::U16,
            VoxelType::I16 => Self::I16,
            VoxelType::U32 => Self::U32,
            VoxelType::I32 => Self::I32,
            VoxelType::F32 => Self::F32,
            VoxelType::F64 => Self::F64,
        }
    }

    /// Size of a number, in bytes.
    pub(crate) const fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 | Self::F16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// Type of the resulting voxels at most: 64-bit integers whose values fit into 32 bits take only 32.
    pub(crate) const fn voxel_type(self) -> VoxelType {
        match self {
            Self::U8 => VoxelType::U8,
            Self::I8 => VoxelType::I8,
            Self::U16 => VoxelType::U16,
            Self::I16 => VoxelType::I16,
            Self::U32 => VoxelType::U32,
            Self::I32 => VoxelType::I32,
            Self::F16 | Self::F32 => VoxelType::F32,
            Self::U64 | Self::I64 | Self::F64 => VoxelType::F64,
        }
    }

    /// Returns true if volumes have this number type, so that no conversion is needed.
    const fn is_voxel_type(self) -> bool {
        !matches!(self, Self::U64 | Self::I64 | Self::F16)
    }

    fn is_wide_integer(self) -> bool {
        matches!(self, Self::U64 | Self::I64)
    }

    /// Decodes a number from its bytes; `bytes` has the length of the type.
    pub(crate) fn value(self, bytes: &[u8], endian: Endian) -> f64 {
        match self {
            Self::U8 => f64::from(u8::from_bytes(bytes, endian)),
            Self::I8 => f64::from(i8::from_bytes(bytes, endian)),
            Self::U16 => f64::from(u16::from_bytes(bytes, endian)),
            Self::I16 => f64::from(i16::from_bytes(bytes, endian)),
            Self::U32 => f64::from(u32::from_bytes(bytes, endian)),
            Self::I32 => f64::from(i32::from_bytes(bytes, endian)),
            Self::U64 => u64::from_bytes(bytes, endian) as f64,
            Self::I64 => i64::from_bytes(bytes, endian) as f64,
            Self::F16 => half::f16::from_bits(u16::from_bytes(bytes, endian)).to_f64(),
            Self::F32 => f64::from(f32::from_bytes(bytes, endian)),
            Self::F64 => f64::from_bytes(bytes, endian),
        }
    }
}

/// Scalar that is derived from a voxel of several components.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ScalarReduction {
    /// Index of a component, from 0.
    Component(usize),
    /// Euclidean length of a vector.
    Magnitude,
    /// Luminance of a colour: weights of red, green and blue after ITU-R BT.709. Further components, such as opacity,
    /// do not count.
    Luminance,
}

/// Storage of a file's voxels: contiguous, x fastest, components interleaved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct VoxelEncoding {
    pub(crate) number: FileNumberType,
    pub(crate) endian: Endian,
    /// Number of components per voxel.
    pub(crate) components: usize,
    pub(crate) reduction: ScalarReduction,
}

impl VoxelEncoding {
    /// Storage of scalar voxels, one number each.
    pub(crate) fn scalar(number: FileNumberType, endian: Endian) -> Self {
        Self { number, endian, components: 1, reduction: ScalarReduction::Component(0) }
    }

    /// Type of the voxels after reading, at most.
    pub(crate) fn voxel_type(&self) -> VoxelType {
        match (self.reduction, self.number) {
            (ScalarReduction::Component(_), number) => number.voxel_type(),
            (ScalarReduction::Luminance, FileNumberType::U8 | FileNumberType::U16) => {
                self.number.voxel_type()
            }
            (ScalarReduction::Magnitude | ScalarReduction::Luminance, _) => VoxelType::F32,
        }
    }

    /// Bytes per voxel in the file, all components together.
    pub(crate) fn voxel_bytes(&self) -> u64 {
        self.number.bytes() as u64 * self.components as u64
    }

    /// Reads the selected voxels of a grid, whose values are the stored numbers; bytes after the grid are not
    /// touched.
    pub(crate) fn read(
        &self,
        reader: &mut impl Read,
        extent: GridExtent,
        control: &LoadControl,
    ) -> Result<ReadVoxels, ReadFault> {
        self.read_values(reader, None, extent, &ValueMapping::identity(None), control)
    }

    /// Reads the selected voxels of a grid and converts them to values; bytes after the grid are not touched. Skipped
    /// voxels are skipped by seeking where the reader can seek.
    pub(crate) fn read_values<R: Read>(
        &self,
        reader: &mut R,
        skip: Option<SkipFn<R>>,
        extent: GridExtent,
        mapping: &ValueMapping<'_>,
        control: &LoadControl,
    ) -> Result<ReadVoxels, ReadFault> {
        let GridExtent { read: selection, .. } = extent;
        let voxel_type = self.voxel_type();
        if selection.is_whole_grid() {
            control.start(extent.bytes);
            return Ok((mapping.map)(self.read_all(reader, extent, control)?)?.into());
        }
        let mut sieve =
            VoxelFilter::new(reader, skip, selection.voxels_to_read(), self.voxel_bytes() as usize, control);
        let read = if selection.is_averaged {
            control.start(GridExtent::unchecked(selection.box_dims(), voxel_type).bytes);
            let [width, height, _] = selection.box_dims();
            let read = average_blocks(&selection, voxel_type.bytes(), mapping, control, |slices| {
                let slab = GridExtent::unchecked([width, height, slices.len()], voxel_type);
                self.read_all(&mut sieve, slab, control)
            });
            read.map_err(|why| match why {
                AveragingError::Read(fault) => fault,
                AveragingError::NoMemory => ReadFault::NoMemory,
            })
        } else {
            let part = GridExtent::unchecked(selection.dims(), voxel_type);
            control.start(part.bytes);
            self.read_all(&mut sieve, part, control).and_then(|samples| Ok((mapping.map)(samples)?.into()))
        };
        // To the end of the grid: truncated data are an error even where the missing voxels are not selected.
        let ended =
            read.and_then(|voxels| read_until_full(&mut sieve, &mut [0], control).map(|_none| voxels));
        ended.map_err(|fault| match sieve.fault.take().unwrap_or(fault) {
            ReadFault::Short { .. } => {
                ReadFault::Short { got: sieve.voxels_consumed() * voxel_type.bytes() as u64 }
            }
            fault => fault,
        })
    }

    /// Returns true if the voxels lie in the file as in memory, up to byte order.
    pub(super) fn matches_memory_layout(&self) -> bool {
        self.components == 1 && self.number.is_voxel_type()
    }

    /// Reads all voxels of a grid.
    fn read_all(
        &self,
        reader: &mut dyn Read,
        extent: GridExtent,
        control: &LoadControl,
    ) -> Result<Samples, ReadFault> {
        let layout = VoxelLayout { extent, voxel_type: self.voxel_type(), endian: self.endian };
        if self.matches_memory_layout() {
            return read_binary(reader, &layout, control);
        }
        let size = self.number.bytes();
        let endian = self.endian;
        macro_rules! of_component {
            ($variant:ident, $type:ty, $at:expr) => {
                self.read_voxels(reader, &layout, control, |voxel| {
                    <$type>::from_bytes(&voxel[$at * size..($at + 1) * size], endian)
                })
                .map(Samples::$variant)
            };
        }
        let part_of = |voxel: &[u8]| {
            self.reduction
                .evaluate(|at| self.number.value(&voxel[at * size..][..size], endian), self.components)
        };
        let read = match (self.reduction, self.number) {
            (ScalarReduction::Component(at), FileNumberType::U8) => of_component!(U8, u8, at),
            (ScalarReduction::Component(at), FileNumberType::I8) => of_component!(I8, i8, at),
            (ScalarReduction::Component(at), FileNumberType::U16) => of_component!(U16, u16, at),
            (ScalarReduction::Component(at), FileNumberType::I16) => of_component!(I16, i16, at),
            (ScalarReduction::Component(at), FileNumberType::U32) => of_component!(U32, u32, at),
            (ScalarReduction::Component(at), FileNumberType::I32) => of_component!(I32, i32, at),
            (ScalarReduction::Component(at), FileNumberType::F32) => of_component!(F32, f32, at),
            (
                ScalarReduction::Component(_),
                FileNumberType::F64 | FileNumberType::U64 | FileNumberType::I64,
            ) => self.read_voxels(reader, &layout, control, part_of).map(Samples::F64),
            (ScalarReduction::Luminance, FileNumberType::U8) => self
                .read_voxels(reader, &layout, control, |voxel| part_of(voxel).round() as u8)
                .map(Samples::U8),
            (ScalarReduction::Luminance, FileNumberType::U16) => self
                .read_voxels(reader, &layout, control, |voxel| part_of(voxel).round() as u16)
                .map(Samples::U16),
            _ => self.read_voxels(reader, &layout, control, |voxel| part_of(voxel) as f32).map(Samples::F32),
        };
        read.map(|samples| if self.number.is_wide_integer() { narrow_integers(samples) } else { samples })
    }

    fn read_voxels<T>(
        &self,
        reader: &mut dyn Read,
        layout: &VoxelLayout,
        control: &LoadControl,
        voxel_of: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, ReadFault> {
        let (count, bytes) = (layout.extent.voxels, self.number.bytes() * self.components);
        let mut values = alloc_with_capacity(count)?;
        let at_once = (BLOCK_BYTES / bytes).max(1);
        let mut block = vec![0; at_once.min(count) * bytes];
        while values.len() < count {
            let want = block.len().min((count - values.len()) * bytes);
            let got = read_until_full(reader, &mut block[..want], control)?;
            values.extend(block[..got].chunks_exact(bytes).map(&voxel_of));
            control.advance((got / bytes * layout.voxel_type.bytes()) as u64);
            if got < want {
                return Err(ReadFault::Short { got: (values.len() * layout.voxel_type.bytes()) as u64 });
            }
        }
        Ok(values)
    }
}

impl ScalarReduction {
    /// Scalar to derive from vectors or colours of `components` components: the component that the user has chosen,
    /// or else the magnitude or luminance. `None` if there is no such component.
    pub(crate) fn from_choice(component: Option<usize>, components: usize, is_color: bool) -> Option<Self> {
        match component {
            Some(at) => (at < components).then_some(Self::Component(at)),
            None if components == 1 => Some(Self::Component(0)),
            None if is_color && components >= 3 => Some(Self::Luminance),
            // Grey with opacity: the opacity is ignored.
            None if is_color => Some(Self::Component(0)),
            None => Some(Self::Magnitude),
        }
    }

    /// Calls [`Self::from_choice`] and turns a missing component into an error.
    pub(crate) fn require(
        context: LoadContext<'_>,
        component: Option<usize>,
        components: usize,
        is_color: bool,
    ) -> Result<Self, LoadError> {
        Self::from_choice(component, components, is_color).ok_or_else(|| {
            context.bad_input_error(
                "--component",
                format!(
                    "component {} is not among its {components} components, which are numbered from 0",
                    component.unwrap_or_default()
                ),
                format!("give a number from 0 to {}", components.saturating_sub(1)),
            )
        })
    }

    /// Remark for the user that voxels are reduced to a scalar; `None` for a single component.
    pub(crate) fn remark(self) -> Option<&'static str> {
        match self {
            Self::Component(_) => None,
            Self::Magnitude => Some("vectors are shown as their magnitude"),
            Self::Luminance => Some("colours are shown as their luminance"),
        }
    }

    /// Derives the scalar from a voxel, given its components.
    pub(crate) fn evaluate(self, component: impl Fn(usize) -> f64, components: usize) -> f64 {
        match self {
            Self::Component(at) => component(at),
            Self::Magnitude => (0..components).map(|at| component(at).powi(2)).sum::<f64>().sqrt(),
            Self::Luminance => 0.2126 * component(0) + 0.7152 * component(1) + 0.0722 * component(2),
        }
    }
}

/// Narrows integers to 32 bits where all values fit.
fn narrow_integers(samples: Samples) -> Samples {
    let Samples::F64(values) = &samples else { return samples };
    let within = |low: f64, high: f64| values.iter().all(|&value| (low..=high).contains(&value));
    if within(f64::from(i32::MIN), f64::from(i32::MAX)) {
        Samples::I32(values.iter().map(|&value| value as i32).collect())
    } else if within(0.0, f64::from(u32::MAX)) {
        Samples::U32(values.iter().map(|&value| value as u32).collect())
    } else {
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(stored: VoxelEncoding, bytes: &[u8], voxels: usize) -> Samples {
        let extent = GridExtent::unchecked([voxels, 1, 1], stored.voxel_type());
        stored.read(&mut &bytes[..], extent, &LoadControl::new()).unwrap().samples
    }

    #[test]
    fn numbers_of_other_types_become_voxels() {
        let wide = [-5i64, 7, 1 << 20].map(i64::to_be_bytes).concat();
        assert_eq!(
            read(VoxelEncoding::scalar(FileNumberType::I64, Endian::Big), &wide, 3),
            Samples::I32(vec![-5, 7, 1 << 20])
        );
        let wider = [3u64, 1 << 31].map(u64::to_le_bytes).concat();
        let stored = VoxelEncoding::scalar(FileNumberType::U64, Endian::Little);
        assert_eq!(read(stored, &wider, 2), Samples::U32(vec![3, 1 << 31]));
        let widest = [3u64, 1 << 40].map(u64::to_le_bytes).concat();
        assert_eq!(read(stored, &widest, 2), Samples::F64(vec![3.0, (1u64 << 40) as f64]));
        let halves = [0.5f32, -2.0].map(|value| half::f16::from_f32(value).to_le_bytes()).concat();
        assert_eq!(
            read(VoxelEncoding::scalar(FileNumberType::F16, Endian::Little), &halves, 2),
            Samples::F32(vec![0.5, -2.0])
        );
    }

    #[test]
    fn components_reduce_to_a_scalar() {
        let colors = [255u8, 255, 255, 0, 0, 0, 0, 255, 0];
        let stored = |part| VoxelEncoding {
            number: FileNumberType::U8,
            endian: Endian::Little,
            components: 3,
            reduction: part,
        };
        assert_eq!(read(stored(ScalarReduction::Luminance), &colors, 3), Samples::U8(vec![255, 0, 182]));
        assert_eq!(read(stored(ScalarReduction::Component(1)), &colors, 3), Samples::U8(vec![255, 0, 255]));
        let vectors = [3.0f32, 4.0].map(f32::to_be_bytes).concat();
        let vector = VoxelEncoding {
            number: FileNumberType::F32,
            endian: Endian::Big,
            components: 2,
            reduction: ScalarReduction::Magnitude,
        };
        assert_eq!(read(vector, &vectors, 1), Samples::F32(vec![5.0]));
        assert_eq!(ScalarReduction::from_choice(Some(3), 3, true), None);
        assert_eq!(
            ScalarReduction::from_choice(None, 2, true),
            Some(ScalarReduction::Component(0)),
            "grey and its opacity"
        );
    }
}
