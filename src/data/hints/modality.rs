//! How data were acquired.

/// The kinds of devices and computations that volumes come from, as far as they differ in how they are best shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Modality {
    /// The file does not say.
    #[default]
    Unknown,
    /// Computed tomography, of patients or of things.
    Ct,
    /// Magnetic resonance.
    Mr,
    /// Positron emission tomography.
    Pet,
    /// Single photon emission and other nuclear imaging.
    Nuclear,
    /// Ultrasound.
    Ultrasound,
    /// Rotational angiography and other X-ray imaging.
    XRay,
    /// Optical coherence tomography.
    OpticalCoherence,
    /// Light microscopy, fluorescence above all.
    LightMicroscopy,
    /// Electron microscopy, crystallography and what is computed from them: densities of molecules.
    ElectronMicroscopy,
    /// Numbers of segments.
    Segmentation,
}

impl Modality {
    /// What machines call it; nothing where it is not known.
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

    /// Its code of DICOM (0008,0060); nothing where it is not known.
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
            // DICOM has none for it.
            Self::ElectronMicroscopy => "EM",
            Self::Segmentation => "SEG",
        })
    }

    /// What a code of DICOM (0008,0060), or a word for it, stands for.
    pub fn of_code(code: &str) -> Self {
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

    /// What a free description says by the words that stand for nothing else.
    pub fn of_description(text: &str) -> Self {
        let mut words = text.split(|c: char| !c.is_alphanumeric()).map(|word| match word {
            // In capitals alone: "mr" and "us" are words.
            "CT" | "CBCT" | "MR" | "MRI" | "PET" | "SPECT" => Self::of_code(word),
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
        assert_eq!(Modality::of_code(" CT "), Modality::Ct);
        assert_eq!(Modality::of_code("PT"), Modality::Pet);
        assert_eq!(Modality::of_code("ZZ"), Modality::Unknown);
        assert_eq!(Modality::of_description("T1-weighted MRI of a head"), Modality::Mr);
        assert_eq!(Modality::of_description("chest,CT"), Modality::Ct);
        for text in ["", "Mr Smith", "give us a pet", "ACTUAL DOCTOR", "us"] {
            assert_eq!(Modality::of_description(text), Modality::Unknown, "{text}");
        }
    }

    #[test]
    fn keys_are_codes() {
        for code in ["ct", "mr", "pet", "segmentation", "ultrasound"] {
            assert_eq!(Modality::of_code(code).key(), Some(code));
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
        assert!(all.into_iter().all(|modality| Modality::of_code(modality.code().unwrap_or("")) == modality));
    }
}
