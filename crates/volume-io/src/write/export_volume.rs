//! Volume in the orientation and number type of an export, without a copy of its voxels.

use std::io::{Result, Write};
use std::ops::Range;

use glam::DAffine3;
use rayon::prelude::*;

use super::number_conversion::{ConvertError, NumberConversion, NumberRequest, append_number};
use super::reorientation::GridReorientation;
use chiaroscuro_volume::{
    AnatomicalAxes, Samples, SpacingUnit, ValueMeaning, ValueMetadata, Volume, VoxelType,
};

/// Volume to be exported. Its voxels are reoriented and converted while they are written.
#[derive(Debug, Clone)]
pub struct ExportVolume<'a> {
    volume: &'a Volume,
    dims: [usize; 3],
    /// Transform from voxel indices (centres at integers) to millimetres.
    world_from_index: DAffine3,
    /// Index of the first exported voxel in the volume, and the signed strides along each exported axis.
    first_index: isize,
    strides: [isize; 3],
    numbers: NumberConversion,
    hints: ValueMetadata,
}

impl<'a> ExportVolume<'a> {
    /// Creates an export of a volume as it is.
    pub fn new(volume: &'a Volume) -> Self {
        let dims = volume.dims();
        let mut hints = volume.metadata().clone();
        hints.padding = volume.padding_value().or(hints.padding);
        Self {
            volume,
            dims,
            world_from_index: volume.world_from_index(),
            first_index: 0,
            strides: [1, dims[0] as isize, (dims[0] * dims[1]) as isize],
            numbers: NumberConversion::identity(volume.samples()),
            hints,
        }
    }

    /// Permutes and flips the axes so that they point to the given sides of the body. Every voxel keeps its position
    /// in the world.
    ///
    /// # Errors
    /// When the volume has no anatomical orientation.
    pub fn reoriented(self, headings: AnatomicalAxes) -> std::result::Result<Self, ConvertError> {
        if !self.volume.is_anatomical() {
            return Err(ConvertError::NoOrientation);
        }
        let turn = GridReorientation::towards_sides(headings, self.world_from_index);
        let (mut first, mut steps) = (self.first_index, [0; 3]);
        for (axis, source) in turn.sources.into_iter().enumerate() {
            let step = self.strides[source];
            let is_reversed = turn.is_reversed[axis];
            steps[axis] = if is_reversed { -step } else { step };
            if is_reversed {
                first += step * (self.dims[source] as isize - 1);
            }
        }
        let world_from_index = self.world_from_index * turn.index_from_reoriented(self.dims);
        Ok(Self {
            dims: turn.sources.map(|source| self.dims[source]),
            world_from_index,
            first_index: first,
            strides: steps,
            ..self
        })
    }

    /// Changes the number type of the export.
    ///
    /// # Errors
    /// When a value cannot be represented.
    pub fn with_number_type(self, wish: &NumberRequest) -> std::result::Result<Self, ConvertError> {
        let numbers = NumberConversion::requested(self.volume.samples(), self.hints.padding, wish)?;
        let mut hints = self.hints;
        hints.padding = numbers.padding();
        if numbers.is_rescaled() {
            // Metadata of the original values do not apply to rescaled numbers.
            let mut rescaled = ValueMetadata::default();
            rescaled.modality = hints.modality;
            rescaled.is_rescaled = true;
            rescaled.padding = hints.padding;
            rescaled.window = hints.window.map(|window| window.map(|value| numbers.convert(value)));
            rescaled.set_acquisition(hints.acquisition().unwrap_or_default());
            hints = rescaled;
        }
        Ok(Self { numbers, hints, ..self })
    }

    /// Name of the volume.
    pub(super) fn name(&self) -> &str {
        self.volume.name()
    }

    /// Number of voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Transform from voxel indices (centres at integers) to millimetres.
    pub fn world_from_index(&self) -> DAffine3 {
        self.world_from_index
    }

    /// Distances between voxels along each axis, in mm.
    pub(super) fn spacing_mm(&self) -> [f64; 3] {
        let axes = self.world_from_index.matrix3;
        [axes.x_axis, axes.y_axis, axes.z_axis].map(glam::DVec3::length)
    }

    /// Returns true if +x, +y and +z of the world are known to be a body's right, front and head.
    pub(super) fn is_anatomical(&self) -> bool {
        self.volume.is_anatomical()
    }

    /// Returns true if lengths are in voxels.
    pub(super) fn has_unknown_scale(&self) -> bool {
        self.volume.has_unknown_scale()
    }

    /// Returns true if position, scale and orientation of the volume are all unknown.
    pub(super) fn has_unknown_geometry(&self) -> bool {
        self.has_unknown_scale() && self.world_from_index == DAffine3::IDENTITY
    }

    /// Returns true if the spacing is all that is known of the volume's geometry.
    pub(super) fn has_spacing_only(&self) -> bool {
        let straight = glam::DMat3::from_diagonal(self.spacing_mm().into());
        !self.is_anatomical() && self.world_from_index == DAffine3::from_mat3(straight)
    }

    /// Returns true if the axes of the grid have the directions of those of the world.
    pub(super) fn is_axis_aligned(&self) -> bool {
        self.world_from_index.matrix3 == glam::DMat3::from_diagonal(self.spacing_mm().into())
    }

    /// Unit in which lengths are stated.
    pub(super) fn length_unit(&self) -> SpacingUnit {
        self.volume.length_unit()
    }

    /// Returns true if the numbers that are written are labels.
    pub(super) fn is_label_map(&self) -> bool {
        self.volume.is_label_map() && !self.numbers.is_rescaled()
    }

    /// Number type that is written.
    pub fn voxel_type(&self) -> VoxelType {
        self.numbers.voxel_type
    }

    /// Metadata of the values, as they are written.
    pub(super) fn hints(&self) -> &ValueMetadata {
        &self.hints
    }

    /// Unit of the values, stated or implied by their meaning.
    pub(super) fn unit(&self) -> Option<&str> {
        self.hints.unit().or((self.hints.meaning == ValueMeaning::HounsfieldUnits).then_some("HU"))
    }

    /// Size of all voxels, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.dims.iter().fold(self.voxel_type().bytes() as u64, |bytes, &n| bytes * n as u64)
    }

    /// Writes all voxels row by row, x fastest, in little-endian order.
    pub(super) fn write_voxels(&self, out: &mut dyn Write) -> Result<()> {
        let mut bytes = Vec::new();
        for z in 0..self.dims[2] as isize {
            for y in 0..self.dims[1] as isize {
                bytes.clear();
                self.append_row(self.first_index + y * self.strides[1] + z * self.strides[2], &mut bytes);
                out.write_all(&bytes)?;
            }
        }
        Ok(())
    }

    /// Encodes slices as [`Self::write_voxels`] does, several at a time.
    pub(super) fn slices(&self, range: Range<usize>) -> Vec<Vec<u8>> {
        let slice = |z: usize| {
            let mut bytes = Vec::with_capacity(self.dims[0] * self.dims[1] * self.voxel_type().bytes());
            for y in 0..self.dims[1] as isize {
                self.append_row(
                    self.first_index + y * self.strides[1] + z as isize * self.strides[2],
                    &mut bytes,
                );
            }
            bytes
        };
        range.into_par_iter().map(slice).collect()
    }

    /// Appends the row that begins at a voxel of the volume.
    fn append_row(&self, first: isize, bytes: &mut Vec<u8>) {
        let samples = self.volume.samples();
        let step = self.strides[0];
        let places = (0..self.dims[0] as isize).map(|x| (first + x * step) as usize);
        if !self.numbers.is_identity(samples) {
            for place in places {
                append_number(bytes, self.numbers.voxel_type, self.numbers.convert(samples.value(place)));
            }
            return;
        }
        macro_rules! put_all {
            ($($variant:ident),+) => {
                match samples {
                    $(Samples::$variant(values) => {
                        bytes.extend(places.flat_map(|place| values[place].to_le_bytes()));
                    })+
                }
            };
        }
        put_all!(U8, I8, U16, I16, U32, I32, F32, F64);
    }
}
