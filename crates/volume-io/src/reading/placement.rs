//! Placement of a file's grid in world space, and assembly of the volume from all that was read.

use std::time::Instant;

use glam::{DAffine3, DMat3, DVec3};

use super::voxels::ReadVoxels;
use super::{LoadControl, LoadError};
use chiaroscuro_volume::{
    GridExtent, LoadContext, MissingVoxels, Samples, ValueMetadata, ValueRange, Volume, VolumeError,
    find_fill_value, is_usable_affine, is_usable_spacing, spacing_ratio_error,
};

/// Affine transform of the grid as the file gives it, with implausible values corrected.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GridPlacement {
    /// Transform from voxel indices (centres at integers) to millimetres; right-anterior-superior where it [is
    /// anatomical](Self::is_anatomical).
    pub(crate) world_from_index: DAffine3,
    /// True if the file gives the anatomical orientation.
    pub(crate) is_anatomical: bool,
    /// True if the file gives the size of voxels; otherwise it is 1 in an unknown unit.
    pub(crate) is_scale_known: bool,
    /// Unit of length in the file, in millimetres.
    pub(crate) length_unit_mm: f64,
    /// Corrections that were made, as remarks for the user.
    pub(crate) remarks: Vec<String>,
}

impl GridPlacement {
    /// Placement for files without any geometry: unit spacing, unknown scale.
    pub(crate) fn unknown() -> Self {
        Self {
            world_from_index: DAffine3::IDENTITY,
            is_anatomical: false,
            is_scale_known: false,
            length_unit_mm: 1.0,
            remarks: Vec::new(),
        }
    }

    /// Placement by spacing alone, along the world axes.
    pub(crate) fn from_spacing(spacing_mm: [f64; 3]) -> Self {
        let mut remarks = Vec::new();
        let spacing_mm = repair_spacing(spacing_mm, &mut remarks);
        let world_from_index = DAffine3::from_mat3(DMat3::from_diagonal(spacing_mm));
        Self { world_from_index, remarks, is_scale_known: true, ..Self::unknown() }
    }

    /// Placement by a file's affine transform, in right-anterior-superior millimetres. If its axes are degenerate,
    /// only the lengths of its columns are used, as spacing.
    pub(crate) fn from_ras_affine(world_from_index: DAffine3) -> Self {
        let axes = world_from_index.matrix3;
        let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length);
        if is_usable_affine(&world_from_index) && spacing_ratio_error(lengths).is_none() {
            return Self { world_from_index, is_anatomical: true, is_scale_known: true, ..Self::unknown() };
        }
        let mut placement = Self::from_spacing(lengths);
        placement
            .remarks
            .push("the file's axis directions are unusable: the axes of the grid are used".to_owned());
        placement
    }

    /// Placement by an affine transform in left-posterior-superior millimetres; see [`Self::from_ras_affine`].
    pub(crate) fn from_lps_affine(world_from_index: DAffine3) -> Self {
        let ras_from_lps = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
        Self::from_ras_affine(DAffine3::from_mat3(ras_from_lps) * world_from_index)
    }

    /// Marks the anatomical orientation as unknown.
    #[must_use]
    pub(crate) fn without_anatomy(self) -> Self {
        Self { is_anatomical: false, ..self }
    }

    /// Marks the scale as unknown, where the file gives relative distances only.
    #[must_use]
    pub(crate) fn with_unknown_scale(self) -> Self {
        Self { is_scale_known: false, ..self }
    }

    /// Sets the unit of length in the file, in millimetres.
    #[must_use]
    pub(crate) fn with_length_unit(self, length_unit_mm: f64) -> Self {
        Self { length_unit_mm, ..self }
    }

    /// Adds a remark for the user.
    #[must_use]
    pub(crate) fn with_remark(mut self, remark: Option<impl Into<String>>) -> Self {
        self.remarks.extend(remark.map(Into::into));
        self
    }
}

/// Largest ratio of an assumed length of a voxel to a stated one. Slices of clinical scans and of microscopes are up
/// to ten times as far apart as pixels are wide; a unit of length that has nothing to do with the voxels would make
/// slices of them, or a line of the volume.
pub(crate) const MAX_ASSUMED_RATIO: f64 = 10.0;

/// Returns true if an assumed length of a voxel suits a stated one.
pub(crate) fn is_plausible_assumption(assumed: f64, stated: f64) -> bool {
    let ratio = assumed / stated;
    (1.0 / MAX_ASSUMED_RATIO..=MAX_ASSUMED_RATIO).contains(&ratio)
}

/// Replaces unusable spacings: a missing or invalid one by 1, or by the smallest of the others where 1 is unlike them;
/// all of them by 1 where their ratios are implausible.
fn repair_spacing(spacing_mm: [f64; 3], remarks: &mut Vec<String>) -> DVec3 {
    let stated = spacing_mm.map(|length| Some(length.abs()).filter(|length| is_usable_spacing(*length)));
    let smallest = stated.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let suits_all = stated.iter().flatten().all(|length| is_plausible_assumption(1.0, *length));
    let assumed = if suits_all { 1.0 } else { smallest };
    let mut usable = stated.map(|length| length.unwrap_or(assumed));
    if spacing_ratio_error(usable).is_some() {
        usable = [1.0; 3];
    }
    if usable != spacing_mm {
        let [x, y, z] = spacing_mm;
        let [a, b, c] = usable;
        remarks.push(format!("a voxel spacing of {x} x {y} x {z} mm is unusable: {a} x {b} x {c} is used"));
    }
    DVec3::from(usable)
}

/// Everything that was read of a volume, before it is assembled.
#[derive(Debug)]
pub(crate) struct VolumeParts {
    pub(crate) name: String,
    /// Grid size, the part that was read and the part that is wanted.
    pub(crate) extent: GridExtent,
    /// Placement of the grid in world space.
    pub(crate) placement: GridPlacement,
    pub(crate) voxels: ReadVoxels,
    pub(crate) hints: ValueMetadata,
}

impl VolumeParts {
    /// Assembles the volume from the wanted part of the voxels that were read; notes in `control` how long that took.
    ///
    /// # Errors
    /// `BadInput` where the parts are no valid volume: no value is finite, or the value range overflows.
    pub(crate) fn into_volume(
        self,
        context: LoadContext<'_>,
        control: &LoadControl,
    ) -> Result<Volume, LoadError> {
        self.into_volume_with_help(context, control, "check the header against the data")
    }

    /// Assembles the volume as [`Self::into_volume`] does, with another help text for errors.
    pub(crate) fn into_volume_with_help(
        self,
        context: LoadContext<'_>,
        control: &LoadControl,
        help: &str,
    ) -> Result<Volume, LoadError> {
        let Self { name, extent, placement, voxels, hints } = self;
        let GridExtent { read, wanted, .. } = extent;
        for remark in &placement.remarks {
            context.warn(remark);
        }
        let start = Instant::now();
        let of = |samples: Samples| {
            let affine = read.world_from_kept(placement.world_from_index);
            let made = Volume::new(name.clone(), read.dims(), affine, samples).map(|volume| {
                let volume = if read.is_whole_grid() { volume } else { volume.with_file_portion(&read) };
                let volume =
                    volume.with_anatomical_axes(placement.is_anatomical).with_metadata(hints.clone());
                let volume = volume.with_remarks(placement.remarks.clone());
                let volume = volume.with_length_unit(placement.length_unit_mm);
                if placement.is_scale_known { volume } else { volume.with_unknown_scale() }
            });
            made.and_then(|volume| match volume.metadata().padding {
                // A volume of nothing but padding is shown as it is.
                Some(padding) if volume.value_range() != ValueRange::new(padding, padding) => {
                    volume.with_padding(padding)
                }
                None => match find_fill_value(volume.samples(), &volume.ranges()) {
                    Some(fill) if !volume.is_label_map() => with_fill_value(context, volume, fill),
                    _ => Ok(volume),
                },
                _ => Ok(volume),
            })
        };
        let ReadVoxels { samples, block_firsts: picked } = voxels;
        // Means of labels are meaningless: where the first voxels of the blocks prove to be labels, they are used
        // instead, and the caller reads the file again.
        let labels = picked.and_then(|picked| of(picked).ok()).filter(Volume::is_label_map);
        let volume =
            labels.map_or_else(|| of(samples), Ok).and_then(|volume| volume.extract_portion(&read, &wanted));
        control.set_analysis_time(start.elapsed());
        volume.map_err(|error| context.bad_input_error("data", error.to_string(), help))
    }
}

/// Marks voxels of a fill value as missing, and says so.
fn with_fill_value(context: LoadContext<'_>, volume: Volume, fill: f64) -> Result<Volume, VolumeError> {
    let mut remarks = volume.remarks().to_vec();
    let volume = volume.with_padding(fill)?;
    let missing = volume.missing().map_or(0, MissingVoxels::count) - volume.non_finite_voxels();
    // The digits of a 32-bit float are those of the number that was written: 1e20, not 1.0000000200408773e20.
    let short = fill as f32;
    let number = match (fill.abs() < 1e7, f64::from(short) == fill) {
        (true, _) => format!("{fill}"),
        (false, true) => format!("{short:e}"),
        (false, false) => format!("{fill:e}"),
    };
    remarks.push(format!(
        "{:.0} % of the voxels hold {number}, far from all other values: they are taken as missing",
        100.0 * missing as f64 / volume.voxel_count() as f64
    ));
    if let Some(remark) = remarks.last() {
        context.warn(remark);
    }
    Ok(volume.with_remarks(remarks))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_spacings_are_repaired_and_reported() {
        for (said, taken) in [
            ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
            ([0.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
            ([-1.5, 2.0, f64::NAN], [1.5, 2.0, 1.0]),
            ([1e-8, 1.0, 1e8], [1.0; 3]),
            // A length of 1 would make a line or a plate of the grid.
            ([0.02, 0.03, 0.0], [0.02, 0.03, 0.02]),
            ([25.0, 0.0, 30.0], [25.0, 25.0, 30.0]),
            ([0.1, 0.1, 0.0], [0.1, 0.1, 1.0]),
            ([0.0; 3], [1.0; 3]),
        ] {
            let placement = GridPlacement::from_spacing(said);
            let axes = placement.world_from_index.matrix3;
            assert_eq!([axes.x_axis.x, axes.y_axis.y, axes.z_axis.z], taken);
            assert_eq!(placement.remarks.is_empty(), said == taken, "{said:?}");
        }
    }

    #[test]
    fn fill_values_are_missing_and_said() {
        let load = |fill: f32| {
            let value = |at: usize| if at % 10 < 4 { fill } else { (at * 7919 % 1000) as f32 };
            let bytes: Vec<u8> = (0..1000).flat_map(|at| value(at).to_le_bytes()).collect();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("grid_10x10x10_float32.raw");
            std::fs::write(&path, bytes).unwrap();
            crate::load(&path, &crate::LoadOptions::default(), &LoadControl::new()).unwrap()
        };
        let filled = load(1e20);
        assert_eq!(
            (filled.padding_value(), filled.missing().map(MissingVoxels::count)),
            (Some(f64::from(1e20f32)), Some(400))
        );
        let remarks = filled.remarks().join("; ");
        assert!(remarks.contains("40 % of the voxels hold 1e20"), "{remarks}");
        assert_eq!(load(0.0).missing(), None);
    }

    #[test]
    fn left_posterior_is_turned_to_right_anterior() {
        let placed = GridPlacement::from_lps_affine(DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(placed.world_from_index.translation, DVec3::new(-1.0, -2.0, 3.0));
        assert_eq!(placed.world_from_index.matrix3.x_axis, -DVec3::X);
        assert!(placed.is_anatomical && placed.remarks.is_empty());
        let flat = GridPlacement::from_ras_affine(DAffine3::from_mat3(DMat3::from_cols(
            DVec3::X,
            DVec3::X * 2.0,
            DVec3::Z,
        )));
        assert_eq!(flat.world_from_index.matrix3, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)));
        assert!(!flat.is_anatomical && flat.remarks.len() == 1);
    }
}
