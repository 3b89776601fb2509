//! Image plane: position, acquisition attributes and value scale of one DICOM image, as far as the header gives them.

use glam::DVec3;

use super::acquisition_attributes::AcquisitionAttributes;

/// Image plane, in left-posterior-superior millimetres, with the scale of its values; absent fields are not stated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ImagePlane {
    /// Centre of the first pixel.
    pub(crate) position: Option<DVec3>,
    /// True if the position is that of this image, not of a file with several frames.
    pub(crate) has_own_position: bool,
    /// True if it is one of frames that follow each other in time.
    pub(crate) is_cine: bool,
    /// True if position and orientation refer to an ultrasound volume's own frame of reference, in millimetres.
    pub(crate) is_in_volume_frame: bool,
    /// Slice Location: millimetres along an unspecified line.
    pub(crate) location_mm: Option<f64>,
    /// Unit directions along rows (from column to column) and along columns.
    pub(crate) orientation: Option<[DVec3; 2]>,
    /// Spacing between rows, and between columns, in millimetres.
    pub(crate) spacing: Option<[f64; 2]>,
    /// Element that the spacing is taken from, if it is not Pixel Spacing.
    pub(crate) spacing_source: Option<&'static str>,
    pub(crate) thickness_mm: Option<f64>,
    /// Spacing between the centres of adjacent slices, in millimetres.
    pub(crate) slice_spacing_mm: Option<f64>,
    pub(crate) slope: Option<f64>,
    pub(crate) intercept: Option<f64>,
    /// Number of the segment that the image is a mask of.
    pub(crate) segment: Option<u16>,
    /// Centre and width of the display window.
    pub(crate) window: [Option<f64>; 2],
    pub(crate) attributes: AcquisitionAttributes,
}

impl ImagePlane {
    /// Fills in values that are stated for all images, where this image has none.
    pub(crate) fn with_defaults(&self, all: &Self) -> Self {
        Self {
            position: self.position.or(all.position),
            has_own_position: self.has_own_position,
            is_cine: self.is_cine || all.is_cine,
            is_in_volume_frame: self.is_in_volume_frame || all.is_in_volume_frame,
            location_mm: self.location_mm.or(all.location_mm),
            orientation: self.orientation.or(all.orientation),
            spacing: self.spacing.or(all.spacing),
            spacing_source: if self.spacing.is_some() { self.spacing_source } else { all.spacing_source },
            thickness_mm: self.thickness_mm.or(all.thickness_mm),
            slice_spacing_mm: self.slice_spacing_mm.or(all.slice_spacing_mm),
            slope: self.slope.or(all.slope),
            intercept: self.intercept.or(all.intercept),
            segment: self.segment.or(all.segment),
            window: [self.window[0].or(all.window[0]), self.window[1].or(all.window[1])],
            attributes: self.attributes.with_defaults(&all.attributes),
        }
    }

    /// Returns the unit normal of the image plane, if its orientation is known.
    pub(crate) fn normal(&self) -> Option<DVec3> {
        let [along_row, along_column] = self.orientation?;
        along_row.cross(along_column).try_normalize()
    }

    /// Returns slope and intercept of the values; a slope of 0 counts as absent.
    pub(crate) fn scale(&self) -> [f64; 2] {
        let is_usable = |slope: &f64| slope.is_finite() && *slope != 0.0;
        [self.slope.filter(is_usable).unwrap_or(1.0), self.intercept.filter(|v| v.is_finite()).unwrap_or(0.0)]
    }
}
