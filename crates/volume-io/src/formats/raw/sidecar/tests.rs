//! Tests of companion files that describe raw voxels: opened themselves, found beside the data, contradicted by
//! options, and with false contents.

use std::path::PathBuf;

use glam::DVec3;
use tempfile::TempDir;

use super::*;
use crate::{LoadOptions, RawFormat, load as load_file};
use chiaroscuro_files::xml::slow_texts::{many_attributes, nested_namespaces};
use chiaroscuro_volume::{LoadControl, LoadErrorKind, Modality, Samples, VolumeChoice, VoxelType};

const DAT: &str = "ObjectFileName:\tfoot.raw\nTaggedFileName:\t---\nResolution:\t2 3 2\nSliceThickness:\t 0.5 0.5 2 \n\
                   Format:\tUCHAR\nObjectModel:\tI\nGridType:\tEQUIDISTANT\nModality:\tCT\nTimeStep:\t0\n";
const INI: &str = "dimx:2\r\ndimy:3\r\ndimz:2\r\nskip:0\r\nformat:uint8\r\n";
const IVF: &str = "<?xml version=\"1.0\" ?>\n<InviwoVolume version=\"2\">\n<RawFile content=\"foot.raw\" />\
                   <Format content=\"UINT8\" /><ByteOffset content=\"0\" /><LittleEndian content=\"1\" />\
                   <Dimension x=\"2\" y=\"3\" z=\"2\" /><BasisAndOffset><col0 x=\"2\" y=\"0\" z=\"0\" w=\"0\" />\
                   <col1 x=\"0\" y=\"3\" z=\"0\" w=\"0\" /><col2 x=\"0\" y=\"0\" z=\"4\" w=\"0\" /></BasisAndOffset>\
                   </InviwoVolume>";

struct DescriptionFolder(TempDir);

impl DescriptionFolder {
    /// Creates a folder with a file of twelve bytes as voxels.
    fn new(data: &str) -> Self {
        let folder = Self(TempDir::new().unwrap());
        folder.write(data, (0..12).collect::<Vec<u8>>());
        folder
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    fn load(&self, name: &str, options: LoadOptions) -> Result<Volume, LoadError> {
        let options = LoadOptions { memory_budget_bytes: 1 << 20, ..options };
        load_file(&self.0.path().join(name), &options, &LoadControl::new())
    }
}

fn plain() -> LoadOptions {
    LoadOptions::default()
}

#[test]
fn descriptions_are_read_from_either_side() {
    for (data, description, text, spacing, is_scale_known) in [
        ("foot.raw", "foot.dat", DAT, DVec3::new(0.5, 0.5, 2.0), true),
        ("foot.raw", "foot.raw.dat", DAT, DVec3::new(0.5, 0.5, 2.0), true),
        ("foot.raw", "foot.raw.ini", INI, DVec3::ONE, false),
        ("foot.raw", "foot.ini", INI, DVec3::ONE, false),
        ("foot.dat", "foot.dat.ini", INI, DVec3::ONE, false),
        ("foot.raw", "foot.ivf", IVF, DVec3::new(1.0, 1.0, 2.0), false),
    ] {
        let folder = DescriptionFolder::new(data);
        folder.write(description, text);
        for opened in [data, description] {
            let volume = folder.load(opened, plain()).unwrap();
            assert_eq!(volume.dims(), [2, 3, 2], "{opened}");
            assert_eq!(*volume.samples(), Samples::U8((0..12).collect()));
            assert_eq!(
                (volume.spacing_mm(), !volume.has_unknown_scale()),
                (spacing, is_scale_known),
                "{opened}"
            );
            assert_eq!(volume.name(), "foot");
            assert_eq!(volume.metadata().modality == Modality::Ct, text == DAT);
            let raw = RawFormat {
                spacing_mm: Some([3.0; 3]),
                voxel_type: Some(VoxelType::I8),
                ..RawFormat::default()
            };
            let said = folder.load(opened, LoadOptions { raw, ..plain() }).unwrap();
            assert!(matches!(said.samples(), Samples::I8(_)), "options count more");
            assert_eq!((said.spacing_mm(), said.has_unknown_scale()), (DVec3::splat(3.0), false));
        }
    }
}

#[test]
fn types_orders_and_models_are_understood() {
    let words = |big: bool, n: usize| -> Vec<u8> {
        (0..n as u16)
            .flat_map(|v| if big { (v * 300).to_be_bytes() } else { (v * 300).to_le_bytes() })
            .collect()
    };
    let expected = Samples::U16((0..12).map(|v| v * 300).collect());
    let halves = (0..12).flat_map(|v| half::f16::from_f32(v as f32).to_le_bytes()).collect::<Vec<u8>>();
    let reals = Samples::F32((0..12).map(|v| v as f32).collect());
    let colors: Vec<u8> = (0..12).flat_map(|v| [v, v, v]).collect();
    let bytes = Samples::U8((0..12).collect());
    for (lines, data, samples) in [
        ("Format: USHORT\n", words(false, 12), &expected),
        ("Format: USHORT_12\nByteOrder: BigEndian\n", words(true, 12), &expected),
        (
            "format: UINT16\nEndianness: little\nByteOffset: 2\n",
            [vec![9, 9], words(false, 12)].concat(),
            &expected,
        ),
        ("Format: FLOAT16\n", halves, &reals),
        ("Format: Vec3UINT8\n", colors.clone(), &bytes),
        ("Format: UCHAR\nObjectModel: RGB\n", colors, &bytes),
    ] {
        let folder = DescriptionFolder::new("x");
        folder.write("v.raw", data);
        folder.write("v.dat", format!("RawFile: v.raw\nResolution: 2 3 2\nSpacing: 1 1 2\n{lines}"));
        let volume = folder.load("v.dat", plain()).unwrap();
        assert_eq!(volume.samples(), samples, "{lines}");
        assert_eq!((volume.spacing_mm().z, volume.has_unknown_scale()), (2.0, true), "1 1 2 compares only");
    }
    let folder = DescriptionFolder::new("v.raw");
    let sequence = "RawFile: v.raw\nResolution: 2 3 1\nFormat: UCHAR\nSequences: 2\n\
                    BasisVector1: 2 0 0\nBasisVector2: 0 3 0\nBasisVector3: 0 0 2";
    folder.write("v.dat", sequence);
    assert!(matches!(folder.load("v.dat", plain()), Err(LoadError::Several { .. })));
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    let second = folder.load("v.raw", LoadOptions { choice, ..plain() }).unwrap();
    assert_eq!(*second.samples(), Samples::U8((6..12).collect()));
    assert_eq!((second.spacing_mm(), second.has_unknown_scale()), (DVec3::new(1.0, 1.0, 2.0), true));
}

#[test]
fn descriptions_of_other_files_do_not_count() {
    let folder = DescriptionFolder::new("foot_12x1x1_uint8.raw");
    folder.write("foot_12x1x1_uint8.dat", DAT);
    assert_eq!(folder.load("foot_12x1x1_uint8.raw", plain()).unwrap().dims(), [12, 1, 1]);
    folder.write("foot_12x1x1_uint8.ini", INI.replace("dimx:2", "dimx:two"));
    assert_eq!(folder.load("foot_12x1x1_uint8.raw", plain()).unwrap().dims(), [12, 1, 1], "its name says it");
    folder.write("foot_12x1x1_uint8.ini", INI);
    assert_eq!(folder.load("foot_12x1x1_uint8.raw", plain()).unwrap().dims(), [2, 3, 2]);
    let raw = RawFormat { dims: Some([3, 2, 2]), voxel_type: Some(VoxelType::U8), ..RawFormat::default() };
    let said = LoadOptions { raw, ..plain() };
    assert_eq!(folder.load("foot_12x1x1_uint8.raw", said).unwrap().dims(), [3, 2, 2]);
    // Raw voxels may have the extension .dat as well.
    let folder = DescriptionFolder::new("sim_2x3x2_uint8.dat");
    assert_eq!(folder.load("sim_2x3x2_uint8.dat", plain()).unwrap().dims(), [2, 3, 2]);
}

#[test]
fn inconsistent_descriptions_are_refused() {
    for (name, text, kind, words) in [
        ("a.dat", DAT.replace("foot.raw", "../foot.raw"), LoadErrorKind::BadInput, "leads out"),
        ("a.dat", DAT.replace("foot.raw", "/etc/passwd"), LoadErrorKind::BadInput, "absolute"),
        ("a.dat", DAT.replace("foot.raw", "none.raw"), LoadErrorKind::Io, "no such file"),
        ("a.dat", DAT.replace("2 3 2", "2 3"), LoadErrorKind::BadInput, "Resolution"),
        ("a.dat", DAT.replace("2 3 2", "-2 3 2"), LoadErrorKind::BadInput, "Resolution"),
        ("a.dat", DAT.replace("2 3 2", "20 3 2"), LoadErrorKind::BadInput, "120 bytes were expected"),
        ("a.dat", DAT.replace("2 3 2", "0 3 2"), LoadErrorKind::BadInput, "empty"),
        ("a.dat", DAT.replace("2 3 2", "99999999 99999999 99"), LoadErrorKind::Limit, "Resolution"),
        ("a.dat", DAT.replace("UCHAR", "UTEXT"), LoadErrorKind::BadInput, "\"UTEXT\""),
        ("a.dat", DAT.replace("Format", "Vormat"), LoadErrorKind::BadInput, "Format"),
        ("a.dat", DAT.to_owned() + "ByteOffset: x", LoadErrorKind::BadInput, "ByteOffset"),
        ("a.dat", DAT.to_owned() + "ByteOrder: x", LoadErrorKind::BadInput, "ByteOrder"),
        ("a.dat", DAT.to_owned() + "Sequences: 0", LoadErrorKind::BadInput, "Sequences"),
        ("a.dat", DAT.to_owned() + "Sequences: 99999999999999", LoadErrorKind::Limit, "time steps"),
        ("a.dat", DAT.to_owned() + &"#\n".repeat(40_000), LoadErrorKind::BadInput, "longer"),
        ("a.ini", INI.to_owned(), LoadErrorKind::BadInput, "is not beside it"),
        ("foot.ini", INI.replace("dimz:2", "dimz:"), LoadErrorKind::BadInput, "dimz"),
        ("foot.ini", INI.replace("uint8", "Vec9uint8"), LoadErrorKind::BadInput, "format"),
        ("foot.ini", INI.replace("uint8", "vecé"), LoadErrorKind::BadInput, "format"),
        ("a.ivf", IVF.replace("</InviwoVolume>", ""), LoadErrorKind::BadInput, "XML"),
        ("a.ivf", IVF.replace("x=\"2\" y=\"3\"", "x=\"2\""), LoadErrorKind::BadInput, "Dimension"),
        ("a.ivf", "<a>".to_owned(), LoadErrorKind::BadInput, "XML"),
    ] {
        let folder = DescriptionFolder::new("foot.raw");
        folder.write(name, &text);
        let error = folder.load(name, plain()).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
    let folder = DescriptionFolder::new("foot.raw");
    folder.write("foot.ini", INI.replace("uint8", "?"));
    let error = folder.load("foot.raw", plain()).unwrap_err();
    assert!(error.to_string().contains("foot.ini"), "nothing else says what it is: {error}");
}

#[test]
fn xml_that_would_take_long_is_refused() {
    let folder = DescriptionFolder::new("foot.raw");
    // As long as a description may be, with a beginning that is recognised as one.
    let namespaces = nested_namespaces("InviwoVolume", 1500);
    let attributes = many_attributes("InviwoVolume", 7000).replacen('<', "<?x <!-- <RawFile ?><", 1);
    folder.write("a.ivf", format!("<!-- <RawFile -->{namespaces}"));
    let error = folder.load("a.ivf", plain()).unwrap_err();
    assert_eq!(error.kind(), LoadErrorKind::BadInput);
    assert!(error.to_string().contains("1501 namespaces"), "{error}");
    // Parsing these takes 0.1 s.
    folder.write("a.ivf", attributes);
    assert!(folder.load("a.ivf", plain()).unwrap_err().to_string().contains("RawFile"));
}
