//! What a header says of one picture: where it lies, when it was taken, what its values mean.

use glam::DVec3;

use super::taken::Taken;

/// Where a picture lies, in left-posterior-superior millimetres, and what its values mean: as far as it is said.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::data::load::formats::dicom) struct Plane {
    /// The middle of its first pixel.
    pub(in crate::data::load::formats::dicom) position: Option<DVec3>,
    /// The position is that of this picture, and not of a whole file of several.
    pub(in crate::data::load::formats::dicom) has_own_position: bool,
    /// It is one of frames that follow each other in time.
    pub(crate) is_of_film: bool,
    /// Position and orientation are those of a volume of ultrasound, in millimetres of its own.
    pub(crate) is_in_volume_frame: bool,
    /// Slice Location, millimetres along a line that nobody names.
    pub(crate) location_mm: Option<f64>,
    /// Along rows, that is from column to column; and along columns.
    pub(in crate::data::load::formats::dicom) orientation: Option<[DVec3; 2]>,
    /// Between rows, and between columns.
    pub(in crate::data::load::formats::dicom) spacing: Option<[f64; 2]>,
    /// The element that the distances are taken from, where it is not Pixel Spacing.
    pub(crate) spacing_source: Option<&'static str>,
    pub(in crate::data::load::formats::dicom) thickness: Option<f64>,
    /// Between the middles of slices.
    pub(in crate::data::load::formats::dicom) between: Option<f64>,
    pub(in crate::data::load::formats::dicom) slope: Option<f64>,
    pub(in crate::data::load::formats::dicom) intercept: Option<f64>,
    /// The segment of which it is a mask.
    pub(crate) segment: Option<u16>,
    /// Centre and width.
    pub(in crate::data::load::formats::dicom) window: [Option<f64>; 2],
    pub(in crate::data::load::formats::dicom) taken: Taken,
}

impl Plane {
    /// What is said of one picture, or else of all.
    pub(in crate::data::load::formats::dicom) fn or(&self, all: &Self) -> Self {
        Self {
            position: self.position.or(all.position),
            has_own_position: self.has_own_position,
            is_of_film: self.is_of_film || all.is_of_film,
            is_in_volume_frame: self.is_in_volume_frame || all.is_in_volume_frame,
            location_mm: self.location_mm.or(all.location_mm),
            orientation: self.orientation.or(all.orientation),
            spacing: self.spacing.or(all.spacing),
            spacing_source: if self.spacing.is_some() { self.spacing_source } else { all.spacing_source },
            thickness: self.thickness.or(all.thickness),
            between: self.between.or(all.between),
            slope: self.slope.or(all.slope),
            intercept: self.intercept.or(all.intercept),
            segment: self.segment.or(all.segment),
            window: [self.window[0].or(all.window[0]), self.window[1].or(all.window[1])],
            taken: self.taken.or(&all.taken),
        }
    }

    /// Across the picture, if it is said how it lies.
    pub(in crate::data::load::formats::dicom) fn normal(&self) -> Option<DVec3> {
        let [along_row, along_column] = self.orientation?;
        along_row.cross(along_column).try_normalize()
    }

    /// Slope and intercept of its values; one of 0 says nothing.
    pub(in crate::data::load::formats::dicom) fn scale(&self) -> [f64; 2] {
        let is_usable = |slope: &f64| slope.is_finite() && *slope != 0.0;
        [self.slope.filter(is_usable).unwrap_or(1.0), self.intercept.filter(|v| v.is_finite()).unwrap_or(0.0)]
    }
}
