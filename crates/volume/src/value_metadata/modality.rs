//! Modality of a volume: the kind of device or computation it comes from.

/// Modality, distinguished where volumes are best shown differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Modality {
    /// The file does not state the modality.
    #[default]
    Unknown,
    /// Computed tomography, of patients or of objects.
    Ct,
    /// Magnetic resonance imaging (MRI).
    Mr,
    /// Positron emission tomography (PET).
    Pet,
    /// Single-photon emission tomography and other nuclear imaging.
    Nuclear,
    /// Ultrasound, including intravascular ultrasound.
    Ultrasound,
    /// Rotational angiography and other X-ray imaging.
    XRay,
    /// Optical coherence tomography.
    OpticalCoherence,
    /// Light microscopy, mostly of fluorescence.
    LightMicroscopy,
    /// Electron microscopy, crystallography and quantities computed from them, such as densities of molecules.
    ElectronMicroscopy,
    /// Segmentation: voxels hold numbers of segments.
    Segmentation,
}

impl Modality {
    /// Returns the identifier for machine-readable output; `None` if unknown.
    pub fn key(self) -> Option<&'static str> {
        Some(match self {
            Self::Unknown => return None,
            Self::Ct => "ct",
            Self::Mr => "mr",
            Self::Pet => "pet",
            Self::Nuclear => "nuclear",
            Self::Ultrasound => "ultrasound",
            Self::XRay => "x_ray",
            Self::OpticalCoherence => "optical_coherence",
            Self::LightMicroscopy => "light_microscopy",
            Self::ElectronMicroscopy => "electron_microscopy",
            Self::Segmentation => "segmentation",
        })
    }

    /// Returns the code of DICOM (0008,0060); `None` if unknown.
    pub fn code(self) -> Option<&'static str> {
        Some(match self {
            Self::Unknown => return None,
            Self::Ct => "CT",
            Self::Mr => "MR",
            Self::Pet => "PT",
            Self::Nuclear => "NM",
            Self::Ultrasound => "US",
            Self::XRay => "XA",
            Self::OpticalCoherence => "OCT",
            Self::LightMicroscopy => "SM",
            // Not a code of DICOM, which has none for it.
            Self::ElectronMicroscopy => "EM",
            Self::Segmentation => "SEG",
        })
    }

    /// Parses a code of DICOM (0008,0060), or a common word for the modality.
    pub fn from_code(code: &str) -> Self {
        match code.trim().to_lowercase().as_str() {
            "ct" | "computed tomography" | "microct" | "micro-ct" | "µct" | "cbct" => Self::Ct,
            "mr" | "mri" | "magnetic resonance" | "magnetic resonance imaging" => Self::Mr,
            "pt" | "pet" => Self::Pet,
            "nm" | "spect" => Self::Nuclear,
            "us" | "ivus" | "ultrasound" => Self::Ultrasound,
            "xa" | "rf" | "dx" | "cr" | "x-ray" => Self::XRay,
            "oct" | "opt" => Self::OpticalCoherence,
            "sm" | "gm" | "light microscopy" | "fluorescence microscopy" | "fluorescence" => {
                Self::LightMicroscopy
            }
            "em" | "cryo-em" | "electron microscopy" => Self::ElectronMicroscopy,
            "seg" | "rtstruct" | "segmentation" => Self::Segmentation,
            _ => Self::Unknown,
        }
    }

    /// Finds the modality in a free description, by abbreviations that mean nothing else.
    pub fn from_description(text: &str) -> Self {
        let mut words = text.split(|c: char| !c.is_alphanumeric()).map(|word| match word {
            // Only in capitals: "mr" and "us" are words.
            "CT" | "CBCT" | "MR" | "MRI" | "PET" | "SPECT" => Self::from_code(word),
            _ => Self::Unknown,
        });
        words.find(|&found| found != Self::Unknown).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_understood_and_words_are_not_mistaken() {
        assert_eq!(Modality::from_code(" CT "), Modality::Ct);
        assert_eq!(Modality::from_code("PT"), Modality::Pet);
        assert_eq!(Modality::from_code("ZZ"), Modality::Unknown);
        assert_eq!(Modality::from_description("T1-weighted MRI of a head"), Modality::Mr);
        assert_eq!(Modality::from_description("chest,CT"), Modality::Ct);
        for text in ["", "Mr Smith", "give us a pet", "ACTUAL DOCTOR", "us"] {
            assert_eq!(Modality::from_description(text), Modality::Unknown, "{text}");
        }
    }

    #[test]
    fn keys_are_codes() {
        for code in ["ct", "mr", "pet", "segmentation", "ultrasound"] {
            assert_eq!(Modality::from_code(code).key(), Some(code));
        }
        assert_eq!(Modality::Unknown.key(), None);
        let all = [
            Modality::Unknown,
            Modality::Ct,
            Modality::Mr,
            Modality::Pet,
            Modality::Nuclear,
            Modality::Ultrasound,
            Modality::XRay,
            Modality::OpticalCoherence,
            Modality::LightMicroscopy,
            Modality::ElectronMicroscopy,
            Modality::Segmentation,
        ];
        assert!(
            all.into_iter().all(|modality| Modality::from_code(modality.code().unwrap_or("")) == modality)
        );
    }
}
