//! Where a file's voxels lie in the world, and a volume of all that was read.

use std::time::Instant;

use glam::{DAffine3, DMat3, DVec3};

use super::LoadError;
use super::voxels::Voxels;
use crate::data::attempt::{Attempt, Extent, is_usable_affine, is_usable_spacing, unlike_spacings};
use crate::data::{Hints, Samples, ValueRange, Volume};

/// Where voxels lie: as the file says it, mended where it says what cannot be.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::data::load) struct Placement {
    /// Voxel indices (centres at whole numbers) to millimetres; right-anterior-superior where it
    /// [is anatomical](Self::is_anatomical).
    pub(in crate::data::load) world_from_index: DAffine3,
    /// Whether the file says which way a body lies.
    pub(in crate::data::load) is_anatomical: bool,
    /// Whether the file says how large voxels are; else they are 1, and nobody knows of what.
    pub(in crate::data::load) is_scale_known: bool,
    /// Millimetres of the unit in which the file says lengths.
    pub(in crate::data::load) length_unit_mm: f64,
    /// What was mended, for the user.
    pub(in crate::data::load) remarks: Vec<String>,
}

impl Placement {
    /// Voxels of which nothing is known.
    pub(in crate::data::load) fn unknown() -> Self {
        Self {
            world_from_index: DAffine3::IDENTITY,
            is_anatomical: false,
            is_scale_known: false,
            length_unit_mm: 1.0,
            remarks: Vec::new(),
        }
    }

    /// Voxels so far apart, along the axes of the world.
    pub(in crate::data::load) fn spaced(spacing_mm: [f64; 3]) -> Self {
        let mut remarks = Vec::new();
        let spacing_mm = mended(spacing_mm, &mut remarks);
        let world_from_index = DAffine3::from_mat3(DMat3::from_diagonal(spacing_mm));
        Self { world_from_index, remarks, is_scale_known: true, ..Self::unknown() }
    }

    /// Voxels that lie as a file's affine says, in right-anterior-superior millimetres. Where it has no three usable axes,
    /// as far apart as its columns are long.
    pub(in crate::data::load) fn ras(world_from_index: DAffine3) -> Self {
        let axes = world_from_index.matrix3;
        let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length);
        if is_usable_affine(&world_from_index) && unlike_spacings(lengths).is_none() {
            return Self { world_from_index, is_anatomical: true, is_scale_known: true, ..Self::unknown() };
        }
        let mut placement = Self::spaced(lengths);
        placement
            .remarks
            .push("the file's axes are unusable: they are taken for those of the grid".to_owned());
        placement
    }

    /// As [`Self::ras`], in left-posterior-superior millimetres.
    pub(in crate::data::load) fn lps(world_from_index: DAffine3) -> Self {
        let ras_from_lps = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
        Self::ras(DAffine3::from_mat3(ras_from_lps) * world_from_index)
    }

    /// The same where the file does not say which way a body lies.
    #[must_use]
    pub(in crate::data::load) fn of_no_body(self) -> Self {
        Self { is_anatomical: false, ..self }
    }

    /// The same where the file says how distances compare, and not how long they are.
    #[must_use]
    pub(in crate::data::load) fn of_unknown_scale(self) -> Self {
        Self { is_scale_known: false, ..self }
    }

    /// The same where the file says lengths in a unit of so many millimetres.
    #[must_use]
    pub(in crate::data::load) fn said_in(self, length_unit_mm: f64) -> Self {
        Self { length_unit_mm, ..self }
    }

    /// The same with something that the user is told.
    #[must_use]
    pub(in crate::data::load) fn remarked(mut self, remark: Option<impl Into<String>>) -> Self {
        self.remarks.extend(remark.map(Into::into));
        self
    }
}

/// Distances that can be used, in place of those that cannot: 1 where they say nothing, all 1 where they cannot be meant
/// together.
fn mended(spacing_mm: [f64; 3], remarks: &mut Vec<String>) -> DVec3 {
    let mend = |length: f64| if is_usable_spacing(length.abs()) { length.abs() } else { 1.0 };
    let mut usable = spacing_mm.map(mend);
    if unlike_spacings(usable).is_some() {
        usable = [1.0; 3];
    }
    if usable != spacing_mm {
        let [x, y, z] = spacing_mm;
        let [a, b, c] = usable;
        remarks.push(format!(
            "distances of {x} x {y} x {z} mm between voxels cannot be: {a} x {b} x {c} are taken"
        ));
    }
    DVec3::from(usable)
}

/// All that was read of a volume.
#[derive(Debug)]
pub(in crate::data::load) struct Parts {
    pub(in crate::data::load) name: String,
    /// The grid, what was read of it and what is wanted.
    pub(in crate::data::load) extent: Extent,
    /// Where the grid lies.
    pub(in crate::data::load) placement: Placement,
    pub(in crate::data::load) voxels: Voxels,
    pub(in crate::data::load) hints: Hints,
}

impl Parts {
    /// The volume: what is wanted of what was read.
    ///
    /// # Errors
    /// `BadInput` where the parts make none: no value is finite, or values span more than a number can say.
    pub(in crate::data::load) fn volume(self, attempt: Attempt<'_>) -> Result<Volume, LoadError> {
        self.volume_or(attempt, "check the header against the data")
    }

    /// The same with other help.
    pub(in crate::data::load) fn volume_or(
        self,
        attempt: Attempt<'_>,
        help: &str,
    ) -> Result<Volume, LoadError> {
        let Self { name, extent, placement, voxels, hints } = self;
        let Extent { read, wanted, .. } = extent;
        for remark in &placement.remarks {
            attempt.warn(remark);
        }
        let start = Instant::now();
        let of = |samples: Samples| {
            let affine = read.placed(placement.world_from_index);
            let made = Volume::new(name.clone(), read.dims(), affine, samples).map(|volume| {
                let volume = if read.is_all() { volume } else { volume.kept_of_file(&read) };
                let volume = volume.with_anatomy(placement.is_anatomical).with_hints(hints.clone());
                let volume = volume.with_remarks(placement.remarks.clone());
                let volume = volume.said_in_units_of(placement.length_unit_mm);
                if placement.is_scale_known { volume } else { volume.with_unknown_scale() }
            });
            made.and_then(|volume| match volume.hints().padding {
                // A volume of padding alone is shown as it is.
                Some(padding) if volume.value_range() != ValueRange::new(padding, padding) => {
                    volume.with_padding(padding)
                }
                _ => Ok(volume),
            })
        };
        let Voxels { samples, picked } = voxels;
        // Means of labels say nothing: whoever sees that these are labels reads them again.
        let labels = picked.and_then(|picked| of(picked).ok()).filter(Volume::is_of_labels);
        let volume = labels.map_or_else(|| of(samples), Ok).and_then(|volume| volume.portion(&read, &wanted));
        let volume = volume.map(|volume| volume.with_looking_took(start.elapsed()));
        volume.map_err(|error| attempt.bad_input("data", error.to_string(), help))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_is_mended_and_said() {
        for (said, taken) in [
            ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
            ([0.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
            ([-1.5, 2.0, f64::NAN], [1.5, 2.0, 1.0]),
            ([1e-8, 1.0, 1e8], [1.0; 3]),
        ] {
            let placement = Placement::spaced(said);
            let axes = placement.world_from_index.matrix3;
            assert_eq!([axes.x_axis.x, axes.y_axis.y, axes.z_axis.z], taken);
            assert_eq!(placement.remarks.is_empty(), said == taken, "{said:?}");
        }
    }

    #[test]
    fn left_posterior_is_turned_to_right_anterior() {
        let placed = Placement::lps(DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(placed.world_from_index.translation, DVec3::new(-1.0, -2.0, 3.0));
        assert_eq!(placed.world_from_index.matrix3.x_axis, -DVec3::X);
        assert!(placed.is_anatomical && placed.remarks.is_empty());
        let flat = Placement::ras(DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::X * 2.0, DVec3::Z)));
        assert_eq!(flat.world_from_index.matrix3, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)));
        assert!(!flat.is_anatomical && flat.remarks.len() == 1);
    }
}
