//! DICOM objects without pixels (PS3.4 annex B, PS3.6 annex A), with advice for the user.

/// Class of DICOM objects that have no pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ObjectClass {
    /// Name of the class in the standard.
    pub(crate) name: &'static str,
    /// Advice to the user on handling such a file.
    pub(crate) advice: &'static str,
}

const OPEN_IMAGES_ADVICE: &str = "open the images that it refers to";

const CONTOURS_ADVICE: &str = "convert its contours to a mask, and open that: \
                        `dcmrtstruct2nii convert -r IN.dcm -d FOLDER_OF_ITS_IMAGES -o OUT`, \
                        `plastimatch convert --input IN.dcm --output-labelmap OUT.nrrd`, or 3D Slicer";

const PLAN_ADVICE: &str =
    "open the dose (RTDOSE) that was computed from it, or the images that it was planned on";

const REPORT_ADVICE: &str = "read it with `dsrdump IN.dcm` (DCMTK), and open the images that it describes";

const SURFACE_ADVICE: &str = "open it as a surface in 3D Slicer, and save a segmentation of it as NRRD";

const REGISTRATION_ADVICE: &str = "apply it in 3D Slicer, and save the registered volume as NRRD";

/// Suffixes of class identifiers below [`STORAGE_PREFIX`]; one that ends with a dot matches by prefix. Longer ones come
/// first.
const CLASSES: &[(&str, ObjectClass)] = &[
    ("481.3", ObjectClass { name: "RT Structure Set (contours)", advice: CONTOURS_ADVICE }),
    ("481.5", ObjectClass { name: "RT Plan", advice: PLAN_ADVICE }),
    ("481.8", ObjectClass { name: "RT Ion Plan", advice: PLAN_ADVICE }),
    ("481.", ObjectClass { name: "radiotherapy record", advice: PLAN_ADVICE }),
    ("88.59", ObjectClass { name: "Key Object Selection (a list of images)", advice: OPEN_IMAGES_ADVICE }),
    ("88.67", ObjectClass { name: "Radiation Dose Report", advice: REPORT_ADVICE }),
    ("88.", ObjectClass { name: "Structured Report", advice: REPORT_ADVICE }),
    (
        "11.",
        ObjectClass { name: "Presentation State (display settings of images)", advice: OPEN_IMAGES_ADVICE },
    ),
    (
        "104.1",
        ObjectClass {
            name: "Encapsulated PDF",
            advice: "extract the document with `dcm2pdf IN.dcm OUT.pdf` (DCMTK)",
        },
    ),
    (
        "104.2",
        ObjectClass {
            name: "Encapsulated CDA (a document)",
            advice: "extract the document with `dcm2cda IN.dcm OUT.xml` (DCMTK)",
        },
    ),
    (
        "104.",
        ObjectClass {
            name: "Encapsulated STL, OBJ or MTL (a surface)",
            advice: "extract the surface with `dcmdump +W FOLDER IN.dcm` (DCMTK)",
        },
    ),
    (
        "9.",
        ObjectClass {
            name: "Waveform (such as an ECG)",
            advice: "open it in cardiology software: it has curves and no voxels",
        },
    ),
    ("66.1", ObjectClass { name: "Spatial Registration", advice: REGISTRATION_ADVICE }),
    ("66.2", ObjectClass { name: "Spatial Fiducials", advice: OPEN_IMAGES_ADVICE }),
    ("66.3", ObjectClass { name: "Deformable Spatial Registration", advice: REGISTRATION_ADVICE }),
    ("66.5", ObjectClass { name: "Surface Segmentation", advice: SURFACE_ADVICE }),
    ("66.6", ObjectClass { name: "Tractography Results", advice: "open it in 3D Slicer with SlicerDMRI" }),
    (
        "66",
        ObjectClass {
            name: "Raw Data (before reconstruction)",
            advice: "reconstruct it on the scanner, and export the images",
        },
    ),
    ("67", ObjectClass { name: "Real World Value Mapping", advice: OPEN_IMAGES_ADVICE }),
    ("68.1", ObjectClass { name: "Surface Scan Mesh", advice: SURFACE_ADVICE }),
    ("68.2", ObjectClass { name: "Surface Scan Point Cloud", advice: SURFACE_ADVICE }),
    (
        "4.2",
        ObjectClass {
            name: "MR Spectroscopy",
            advice: "convert it with `spec2nii dicom IN.dcm`, and open a map computed from its spectra",
        },
    ),
    ("78.", ObjectClass { name: "ophthalmic measurements", advice: REPORT_ADVICE }),
    ("79.", ObjectClass { name: "ophthalmic measurements", advice: REPORT_ADVICE }),
    ("80.", ObjectClass { name: "ophthalmic measurements", advice: REPORT_ADVICE }),
    ("131", ObjectClass { name: "Basic Structured Display", advice: OPEN_IMAGES_ADVICE }),
];

/// Common prefix of the identifiers of storage classes.
const STORAGE_PREFIX: &str = "1.2.840.10008.5.1.4.1.1.";

impl ObjectClass {
    /// Looks up the class of a SOP class identifier; `None` if it is not listed here.
    pub(crate) fn from_uid(uid: &str) -> Option<Self> {
        let rest = uid.strip_prefix(STORAGE_PREFIX)?;
        let is_of = |part: &str| if part.ends_with('.') { rest.starts_with(part) } else { rest == part };
        CLASSES.iter().find(|(part, _)| is_of(part)).map(|(_, class)| *class)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_named() {
        for (uid, name) in [
            ("1.2.840.10008.5.1.4.1.1.481.3", "RT Structure Set"),
            ("1.2.840.10008.5.1.4.1.1.481.7", "radiotherapy"),
            ("1.2.840.10008.5.1.4.1.1.88.33", "Structured Report"),
            ("1.2.840.10008.5.1.4.1.1.88.59", "Key Object"),
            ("1.2.840.10008.5.1.4.1.1.11.1", "Presentation State"),
            ("1.2.840.10008.5.1.4.1.1.104.1", "PDF"),
            ("1.2.840.10008.5.1.4.1.1.9.1.1", "Waveform"),
            ("1.2.840.10008.5.1.4.1.1.66", "Raw Data"),
            ("1.2.840.10008.5.1.4.1.1.66.1", "Spatial Registration"),
        ] {
            let found = ObjectClass::from_uid(uid);
            assert!(
                found.is_some_and(|class| class.name.contains(name) && !class.advice.is_empty()),
                "{uid}"
            );
        }
        for uid in ["", "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.5.1.4.1.1.66.4", "1.2.3", "é"] {
            assert_eq!(ObjectClass::from_uid(uid), None, "{uid}: pictures, or nothing known");
        }
    }
}
