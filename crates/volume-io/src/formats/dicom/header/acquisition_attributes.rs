//! Acquisition attributes of an image: when and how it was taken, to tell images at one position apart.

use chiaroscuro_files::sanitised;

/// Attribute in which images at one position can differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AcquisitionAttribute {
    /// Temporal Position Identifier (0020,0100), or Index (0020,9128).
    TemporalPosition,
    /// Diffusion b-value, in s/mm².
    BValue,
    /// Echo Time (TE), in milliseconds.
    EchoTime,
    /// Echo Number of a multi-echo sequence.
    EchoNumber,
    /// Inversion Time (TI), in milliseconds.
    InversionTime,
    /// Flip Angle of the excitation, in degrees.
    FlipAngle,
    /// Peak voltage of the X-ray tube (KVP), in kV.
    TubeVoltage,
    /// Image Type (0008,0008) or Frame Type (0008,9007), as an index into a list of distinct texts.
    ImageType,
    /// Nominal Percentage of Cardiac Phase.
    CardiacPhase,
    /// Trigger Time, or Nominal Cardiac Trigger Delay Time, in milliseconds.
    TriggerTime,
    /// Frame Reference Time, in milliseconds.
    ReferenceTime,
    /// Acquisition Number, or Frame Acquisition Number.
    Acquisition,
    /// Acquisition Time, in seconds of the day.
    AcquisitionTime,
    /// Content Time, in seconds of the day.
    ContentTime,
    /// Instance Number of the image in its series.
    Instance,
}

/// Number of variants of [`AcquisitionAttribute`].
const COUNT: usize = 15;

impl AcquisitionAttribute {
    /// All attributes in order of precedence: parameters that a series varies on purpose come before times, which
    /// merely pass during it.
    pub(crate) const ALL: [Self; COUNT] = [
        Self::TemporalPosition,
        Self::BValue,
        Self::EchoTime,
        Self::EchoNumber,
        Self::InversionTime,
        Self::FlipAngle,
        Self::TubeVoltage,
        Self::ImageType,
        Self::CardiacPhase,
        Self::TriggerTime,
        Self::ReferenceTime,
        Self::Acquisition,
        Self::AcquisitionTime,
        Self::ContentTime,
        Self::Instance,
    ];

    /// Returns the attribute's name for the user.
    fn name(self) -> &'static str {
        match self {
            Self::TemporalPosition => "temporal position",
            Self::BValue => "b-value",
            Self::EchoTime => "echo time",
            Self::EchoNumber => "echo",
            Self::InversionTime => "inversion time",
            Self::FlipAngle => "flip angle",
            Self::TubeVoltage => "tube voltage",
            Self::ImageType => "image type",
            Self::CardiacPhase => "cardiac phase",
            Self::TriggerTime => "trigger time",
            Self::ReferenceTime => "reference time",
            Self::Acquisition => "acquisition",
            Self::AcquisitionTime => "acquired at",
            Self::ContentTime => "created at",
            Self::Instance => "instance",
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Self::EchoTime | Self::InversionTime | Self::TriggerTime | Self::ReferenceTime => " ms",
            Self::FlipAngle => "°",
            Self::TubeVoltage => " kV",
            Self::CardiacPhase => " %",
            _ => "",
        }
    }

    /// Formats name and value for the user; `image_types` holds the texts that [`Self::ImageType`] indexes.
    pub(crate) fn format(self, value: f64, image_types: &[String]) -> String {
        let name = self.name();
        match self {
            Self::ImageType => {
                let text = image_types.get(value as usize).map_or("", String::as_str);
                format!("{name} {}", sanitised(text, 60))
            }
            Self::AcquisitionTime | Self::ContentTime => {
                let (minutes, seconds) = ((value / 60.0) as u32, value % 60.0);
                format!("{name} {:02}:{:02}:{seconds:06.3}", minutes / 60, minutes % 60)
            }
            _ => format!("{name} {value}{}", self.unit()),
        }
    }
}

/// Values of all attributes of an image by [`AcquisitionAttribute`]; NaN for those not stated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AcquisitionAttributes([f64; COUNT]);

impl Default for AcquisitionAttributes {
    fn default() -> Self {
        Self([f64::NAN; COUNT])
    }
}

impl AcquisitionAttributes {
    /// Returns the value of an attribute, if stated.
    pub(crate) fn get(&self, attribute: AcquisitionAttribute) -> Option<f64> {
        Some(self.0[attribute as usize]).filter(|value| !value.is_nan())
    }

    /// Sets the value of an attribute; `None` changes nothing.
    pub(crate) fn set(&mut self, attribute: AcquisitionAttribute, value: Option<f64>) {
        if let Some(value) = value {
            self.0[attribute as usize] = value;
        }
    }

    /// Fills in attributes from `all` where this image has none.
    pub(crate) fn with_defaults(&self, all: &Self) -> Self {
        Self(std::array::from_fn(|at| if self.0[at].is_nan() { all.0[at] } else { self.0[at] }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_kept_and_named() {
        for (at, attribute) in AcquisitionAttribute::ALL.into_iter().enumerate() {
            assert_eq!(attribute as usize, at, "each has a place of its own");
        }
        let mut taken = AcquisitionAttributes::default();
        assert_eq!(taken.get(AcquisitionAttribute::BValue), None);
        taken.set(AcquisitionAttribute::BValue, Some(1000.0));
        taken.set(AcquisitionAttribute::BValue, None);
        assert_eq!(
            AcquisitionAttributes::default().with_defaults(&taken).get(AcquisitionAttribute::BValue),
            Some(1000.0)
        );
        let types = ["ORIGINAL M".to_owned(), "ORIGINAL P".to_owned()];
        assert_eq!(AcquisitionAttribute::ImageType.format(1.0, &types), "image type ORIGINAL P");
        assert_eq!(AcquisitionAttribute::TriggerTime.format(80.0, &types), "trigger time 80 ms");
        assert_eq!(AcquisitionAttribute::AcquisitionTime.format(3723.5, &types), "acquired at 01:02:03.500");
    }
}
