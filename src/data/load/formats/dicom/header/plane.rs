//! What a header says of one picture: where it lies, when it was taken, what its values mean.

use glam::DVec3;

/// Where a picture lies, in left-posterior-superior millimetres, and what its values mean: as far as it is said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::data::load::formats::dicom) struct Plane {
    /// The middle of its first pixel.
    pub(in crate::data::load::formats::dicom) position: Option<DVec3>,
    /// The position is that of this picture, and not of a whole file of several.
    pub(in crate::data::load::formats::dicom) has_own_position: bool,
    /// Along rows, that is from column to column; and along columns.
    pub(in crate::data::load::formats::dicom) orientation: Option<[DVec3; 2]>,
    /// Between rows, and between columns.
    pub(in crate::data::load::formats::dicom) spacing: Option<[f64; 2]>,
    pub(in crate::data::load::formats::dicom) thickness: Option<f64>,
    /// Between the middles of slices.
    pub(in crate::data::load::formats::dicom) between: Option<f64>,
    pub(in crate::data::load::formats::dicom) slope: Option<f64>,
    pub(in crate::data::load::formats::dicom) intercept: Option<f64>,
    /// Centre and width.
    pub(in crate::data::load::formats::dicom) window: [Option<f64>; 2],
    pub(in crate::data::load::formats::dicom) taken: Taken,
}

/// When and how a picture was taken: by what those of one place are put in order, the first difference deciding.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::data::load::formats::dicom) struct Taken {
    pub(in crate::data::load::formats::dicom) temporal_position: Option<f64>,
    pub(in crate::data::load::formats::dicom) b_value: Option<f64>,
    pub(in crate::data::load::formats::dicom) echo_time_ms: Option<f64>,
    pub(in crate::data::load::formats::dicom) trigger_time_ms: Option<f64>,
    pub(in crate::data::load::formats::dicom) acquisition: Option<f64>,
    /// Of the day.
    pub(in crate::data::load::formats::dicom) time_s: Option<f64>,
    pub(in crate::data::load::formats::dicom) instance: Option<f64>,
}

impl Plane {
    /// What is said of one picture, or else of all.
    pub(in crate::data::load::formats::dicom) fn or(&self, all: &Self) -> Self {
        Self {
            position: self.position.or(all.position),
            has_own_position: self.has_own_position,
            orientation: self.orientation.or(all.orientation),
            spacing: self.spacing.or(all.spacing),
            thickness: self.thickness.or(all.thickness),
            between: self.between.or(all.between),
            slope: self.slope.or(all.slope),
            intercept: self.intercept.or(all.intercept),
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

impl Taken {
    fn or(&self, all: &Self) -> Self {
        Self {
            temporal_position: self.temporal_position.or(all.temporal_position),
            b_value: self.b_value.or(all.b_value),
            echo_time_ms: self.echo_time_ms.or(all.echo_time_ms),
            trigger_time_ms: self.trigger_time_ms.or(all.trigger_time_ms),
            acquisition: self.acquisition.or(all.acquisition),
            time_s: self.time_s.or(all.time_s),
            instance: self.instance.or(all.instance),
        }
    }

    /// What decides about the order, the most important first.
    pub(in crate::data::load::formats::dicom) fn order(&self) -> [f64; 7] {
        [
            self.temporal_position,
            self.b_value,
            self.echo_time_ms,
            self.trigger_time_ms,
            self.acquisition,
            self.time_s,
            self.instance,
        ]
        .map(|value| value.unwrap_or(0.0))
    }

    /// What sets it apart from another, in words.
    pub(in crate::data::load::formats::dicom) fn apart_from(&self, other: &Self) -> String {
        let named = [
            (self.temporal_position, other.temporal_position, "temporal position", ""),
            (self.b_value, other.b_value, "b value", ""),
            (self.echo_time_ms, other.echo_time_ms, "echo time", " ms"),
            (self.trigger_time_ms, other.trigger_time_ms, "trigger time", " ms"),
            (self.acquisition, other.acquisition, "acquisition", ""),
        ];
        let first = named.into_iter().find(|(mine, others, ..)| mine != others);
        first.and_then(|(mine, _, name, unit)| Some(format!("{name} {}{unit}", mine?))).unwrap_or_default()
    }
}
