//! Tests that load legacy VTK files through the public interface: supported and refused ones.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;

use crate::tests::helpers::{self, assert_refused};
use chiaroscuro_volume::{FileDimension, LoadError, LoadErrorKind, Modality, Samples, Volume, VolumeChoice};

const HEAD: &str = "# vtk DataFile Version 3.0\na head, CT\nASCII\n  \nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n\
                    ORIGIN 1 2 3\nSPACING 0.5 1 2\n";
const TEXT: &str = "POINT_DATA 8\nSCALARS a unsigned_char 1\nLOOKUP_TABLE default\n1 2 3 4\n5 6 7 8\n";

fn load_bytes_as(bytes: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    helpers::load_bytes("v.vtk", bytes, choice)
}

fn load_bytes(bytes: &[u8]) -> Result<Volume, LoadError> {
    load_bytes_as(bytes, VolumeChoice::default())
}

/// Builds a binary file: the header, followed by the given parts.
fn binary(parts: &[&[u8]]) -> Vec<u8> {
    [HEAD.replace("ASCII", "BINARY").as_bytes(), &parts.concat()].concat()
}

#[test]
fn every_type_is_read_in_text_and_in_bytes() {
    macro_rules! check {
        ($name:literal, $type:ty, $variant:ident, $values:expr, $samples:expr) => {
            let values: [$type; 8] = $values;
            let samples = Samples::$variant($samples(values));
            let text = values.map(|value| value.to_string()).join(" ");
            let start = format!("POINT_DATA 8\nSCALARS a {}\nLOOKUP_TABLE default\n", $name);
            let file = format!("{HEAD}{start}{text}\n");
            assert_eq!(*load_bytes(file.as_bytes()).unwrap().samples(), samples, $name);
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            let file = binary(&[start.as_bytes(), &bytes, b"\n"]);
            assert_eq!(*load_bytes(&file).unwrap().samples(), samples, $name);
            let mut zipped = GzEncoder::new(Vec::new(), Compression::default());
            zipped.write_all(&file).unwrap();
            assert_eq!(*load_bytes(&zipped.finish().unwrap()).unwrap().samples(), samples, $name);
        };
        ($name:literal, $type:ty, $variant:ident, $values:expr) => {
            check!($name, $type, $variant, $values, |values: [$type; 8]| values.to_vec());
        };
    }
    check!("unsigned_char", u8, U8, [10, 1, 2, 3, 13, 5, 6, 255]);
    check!("char", i8, I8, [-128, -1, 0, 1, 2, 3, 4, 127]);
    check!("unsigned_short", u16, U16, [0, 1, 2, 3, 4, 5, 6, 65535]);
    check!("short", i16, I16, [-32768, -1, 0, 1, 2, 3, 4, 32767]);
    check!("unsigned_int", u32, U32, [0, 1, 2, 3, 4, 5, 6, u32::MAX]);
    check!("int", i32, I32, [i32::MIN, -1, 0, 1, 2, 3, 4, i32::MAX]);
    check!("vtkIdType", i32, I32, [-1, 0, 1, 2, 3, 4, 5, 6]);
    check!("float", f32, F32, [-1.5, 0.1, 1e-30, 1e30, 0.0, 1.0, 2.0, 3.0]);
    check!("double", f64, F64, [-1.5, 0.1, 1e-300, 1e300, 0.0, 1.0, 2.0, 3.0]);
    let narrow = |values: [i64; 8]| values.map(|value| value as i32).to_vec();
    check!("long", i64, I32, [-7, 0, 1, 2, 3, 4, 5, 6], narrow);
    check!("vtktypeint64", i64, I32, [-7, 0, 1, 2, 3, 4, 5, 6], narrow);
    let wide = |values: [u64; 8]| values.map(|value| value as f64).to_vec();
    check!("unsigned_long", u64, F64, [0, 1, 2, 3, 4, 5, 6, 1 << 40], wide);
}

#[test]
fn the_grid_lies_where_the_file_says() {
    let volume = load_bytes(format!("{HEAD}{TEXT}").as_bytes()).unwrap();
    assert_eq!((volume.dims(), volume.name()), ([2; 3], "v"));
    assert_eq!(volume.spacing_mm(), DVec3::new(0.5, 1.0, 2.0));
    assert_eq!(volume.world_from_index().translation, DVec3::new(1.0, 2.0, 3.0));
    assert!(!volume.is_anatomical() && !volume.has_unknown_scale());
    assert_eq!(volume.metadata().modality, Modality::Ct);
    let old =
        format!("{HEAD}{TEXT}").replace("SPACING", "ASPECT_RATIO").replace("LOOKUP_TABLE default\n", "");
    assert_eq!(load_bytes(old.as_bytes()).unwrap().spacing_mm(), DVec3::new(0.5, 1.0, 2.0));
    let mirrored = format!("{HEAD}{TEXT}").replace("SPACING 0.5 1 2", "SPACING 0.5 -1 2");
    let mirrored = load_bytes(mirrored.as_bytes()).unwrap();
    assert_eq!(mirrored.world_from_index().matrix3.y_axis.y, -1.0);
    assert!(mirrored.remarks()[0].contains("run backwards"), "{:?}", mirrored.remarks());
    let none = format!("{HEAD}{TEXT}").replace("SPACING 0.5 1 2\n", "");
    assert!(load_bytes(none.as_bytes()).unwrap().has_unknown_scale());
    let shifted = format!("{HEAD}{TEXT}").replace("DIMENSIONS 2 2 2", "EXTENT 2 3 0 1 -1 0");
    assert_eq!(
        load_bytes(shifted.as_bytes()).unwrap().world_from_index().translation,
        DVec3::new(2.0, 2.0, 1.0)
    );
    let cells = format!("{HEAD}{TEXT}").replace("2 2 2\n", "3 3 3\n").replace("POINT_DATA", "CELL_DATA");
    let cells = load_bytes(cells.as_bytes()).unwrap();
    assert_eq!((cells.dims(), cells.world_from_index().translation), ([2; 3], DVec3::new(1.25, 2.5, 4.0)));
}

#[test]
fn all_arrays_are_found() {
    let vectors: Vec<u8> =
        [3.0f32, 4.0, 0.0].repeat(8).iter().flat_map(|value| value.to_be_bytes()).collect();
    let cell = 7i16.to_be_bytes();
    let in_bytes = binary(&[
        b"FIELD FieldData 1\nTIME 1 1 double\n\0\0\0\0\0\0\0\0\n",
        b"CELL_DATA 1\nSCALARS c short 1\nLOOKUP_TABLE default\n",
        &cell,
        b"\nMETADATA\nINFORMATION 1\nNAME N LOCATION L\nDATA 1 0\n\n",
        b"POINT_DATA 8\nCOLOR_SCALARS rgb 3\n",
        &[11; 24],
        b"\nVECTORS v%20w float\n",
        &vectors,
        b"\nLOOKUP_TABLE own 2\n12345678\nFIELD more 3\nbits 1 8 bit\n\xff\nNULL_ARRAY\nt 1 8 unsigned_char\n",
        b"\x01\x02\x03\x04\x05\x06\x07\x08\nSTRANGE thing\nMETADATA",
    ]);
    let (colors, vectors) = ("0.2 0.2 0.2 ".repeat(8), "3 4 0\n".repeat(8));
    let in_text = format!(
        "{HEAD}FIELD FieldData 1\nTIME 1 1 double\n0.5\nCELL_DATA 1\nSCALARS c short\nLOOKUP_TABLE default\n7\n\
         METADATA\nx\n\nPOINT_DATA 8\nCOLOR_SCALARS rgb 3\n{colors}\nVECTORS v%20w float\n{vectors}\n\
         LOOKUP_TABLE own 2\n1 2 3 4 5 6 7 8\nFIELD more 3\nbits 1 8 bit\n1 1 1 1 1 1 1 1\nNULL_ARRAY\n\
         t 1 8 unsigned_char\n1 2 3 4 5 6 7 8\nSTRANGE thing\n"
    );
    for (bytes, is_text) in [(in_bytes, false), (in_text.into_bytes(), true)] {
        let listed = ["4 arrays", "0 \"c\" (1 x 1 x 1)", "2 \"v w\" (2 x 2 x 2)", "3 \"t\""];
        assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &listed);
        let choose = |key: &str| {
            load_bytes_as(&bytes, VolumeChoice::default().with_selected(FileDimension::Array, key)).unwrap()
        };
        assert_eq!(*choose("c").samples(), Samples::I16(vec![7]));
        assert_eq!(*choose("v w").samples(), Samples::F32(vec![5.0; 8]));
        assert_eq!(*choose("t").samples(), Samples::U8(vec![1, 2, 3, 4, 5, 6, 7, 8]));
        let color = choose("rgb");
        assert!(color.remarks()[0].contains("luminance"));
        let first = if is_text { 51.0 } else { 11.0 };
        assert_eq!(color.value(0, 0, 0), first);
    }
}

#[test]
fn what_cannot_be_read_is_named() {
    for (from, to, words) in [
        ("ASCII", "TEXT", &["line 3", "TEXT"][..]),
        ("STRUCTURED_POINTS", "UNSTRUCTURED_GRID", &["UNSTRUCTURED_GRID", "Resample"]),
        ("STRUCTURED_POINTS", "RECTILINEAR_GRID", &["RECTILINEAR_GRID", "Resample"]),
        ("DATASET STRUCTURED_POINTS", "FIELD data 0", &["DATASET"]),
        ("DIMENSIONS 2 2 2", "DIMENSIONS 2 2", &["DIMENSIONS", "3 numbers"]),
        ("DIMENSIONS 2 2 2", "DIMENSIONS 2 0 2", &["DIMENSIONS", "at least 1"]),
        ("DIMENSIONS 2 2 2\n", "", &["POINT_DATA", "missing"]),
        ("SPACING 0.5 1 2", "SPACING 0.5 1 x", &["SPACING"]),
        ("POINT_DATA 8", "POINT_DATA 9", &["POINT_DATA", "8 values", "9 are announced"]),
        ("POINT_DATA 8\n", "", &["SCALARS", "not understood"]),
        ("unsigned_char 1", "string 1", &["not understood"]),
        ("unsigned_char 1", "bit 1", &["no array"]),
        ("unsigned_char 1", "unsigned_char 0", &["not understood"]),
        ("unsigned_char 1", "unsigned_char 18446744073709551615", &["not understood"]),
        ("SCALARS a unsigned_char 1", "NONSENSE", &["NONSENSE"]),
        ("5 6 7 8", "5 6 7 x", &["\"x\"", "uint8"]),
        ("5 6 7 8", "5 6 7      ", &["truncated"]),
        ("5 6 7 8", "", &["truncated"]),
    ] {
        let text = format!("{HEAD}{TEXT}");
        assert!(text.contains(from), "{from}");
        assert_refused(load_bytes(text.replace(from, to).as_bytes()), LoadErrorKind::BadInput, words);
    }
    let cut = binary(&[b"POINT_DATA 8\nSCALARS a short\nLOOKUP_TABLE default\n", &[0; 15]]);
    assert_refused(load_bytes(&cut), LoadErrorKind::BadInput, &["truncated", "16 bytes"]);
    assert_refused(load_bytes(HEAD.as_bytes()), LoadErrorKind::BadInput, &["no array"]);
    let endless = format!("{HEAD}{}", "x".repeat(10_000));
    assert_refused(load_bytes(endless.as_bytes()), LoadErrorKind::BadInput, &["4096 bytes"]);
    let huge = HEAD.replace("2 2 2", "100000 100000 100000");
    let huge = format!("{huge}POINT_DATA 1000000000000000\nSCALARS a float\nLOOKUP_TABLE default\n1");
    assert_refused(load_bytes(huge.as_bytes()), LoadErrorKind::Limit, &["100000"]);
    let most = HEAD.replace("2 2 2", "9223372036854775807 9223372036854775807 9");
    let most = format!("{most}POINT_DATA 18446744073709551615\nSCALARS a float\nLOOKUP_TABLE default\n1");
    assert!(load_bytes(most.as_bytes()).is_err());
}
