//! Tests that choosing a volume that a file does not contain is an error in every format.

use tempfile::TempDir;

use super::helpers::assert_refused;
use super::*;

/// Choices that a file of a single volume does not offer, and the option that the error names.
fn unanswerable() -> [(VolumeChoice, &'static str); 5] {
    let choice = VolumeChoice::default;
    [
        (VolumeChoice { channel: Some(5), ..choice() }, "--channel"),
        (VolumeChoice { frame: Some(3), ..choice() }, "--frame"),
        (VolumeChoice { series: Some("4".to_owned()), ..choice() }, "--series"),
        (VolumeChoice { array: Some("xyz".to_owned()), ..choice() }, "--array"),
        (VolumeChoice { component: Some(2), ..choice() }, "--component"),
    ]
}

fn load_choice(path: &Path, choice: VolumeChoice) -> Result<Volume, LoadError> {
    let options = LoadOptions { choice, memory_budget_bytes: 1 << 20, ..LoadOptions::default() };
    open(path, &options, &LoadControl::new())
}

#[test]
fn missing_volumes_cannot_be_chosen_in_any_format() {
    let folder = TempDir::new().unwrap();
    let voxels: Vec<u8> = (0..8).collect();
    let numbers = "0 1 2 3 4 5 6 7";
    let nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n";
    let meta = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    let vti = format!(
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\"><Piece Extent=\"0 1 0 1 0 1\"><PointData>\
         <DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">{numbers}</DataArray></PointData></Piece></ImageData></VTKFile>"
    );
    let vtk = format!(
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nPOINT_DATA 8\n\
         SCALARS a unsigned_char\nLOOKUP_TABLE default\n{numbers}\n"
    );
    let cube = format!("t\nt\n0 0 0 0\n2 1 0 0\n2 0 1 0\n2 0 0 1\n{numbers}\n");
    let npy = b"{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 2), }\n";
    let npy = [b"\x93NUMPY\x01\x00", &(npy.len() as u16).to_le_bytes()[..], npy, &voxels].concat();
    let files = [
        ("v.nrrd", [nrrd.as_bytes(), &voxels].concat()),
        ("v.mha", [meta.as_bytes(), &voxels].concat()),
        ("v.vti", vti.into_bytes()),
        ("v.vtk", vtk.into_bytes()),
        ("v.cube", cube.into_bytes()),
        ("v.npy", npy),
        ("v_2x2x2_uint8.raw", voxels),
    ];
    let mut paths: Vec<PathBuf> = files.iter().map(|(name, bytes)| write(&folder, name, bytes)).collect();
    let slices = TempDir::new().unwrap();
    for name in ["1.png", "2.png"] {
        image::GrayImage::from_raw(2, 1, vec![1, 2]).unwrap().save(slices.path().join(name)).unwrap();
    }
    paths.extend([slices.path().to_owned(), slices.path().join("1.png"), PathBuf::from("builtin:box:16")]);
    for path in paths {
        load_choice(&path, VolumeChoice::default()).unwrap();
        for (choice, option) in unanswerable() {
            assert_refused(load_choice(&path, choice.clone()), LoadErrorKind::BadInput, &[option]);
            // With a fallback allowed, the first volume is read.
            load_choice(&path, choice.with_first_as_fallback()).unwrap();
        }
        let first = VolumeChoice { channel: Some(0), frame: Some(0), ..VolumeChoice::default() };
        load_choice(&path, first).unwrap_or_else(|error| panic!("every file has a first: {error}"));
    }
}

#[test]
fn the_format_of_a_file_is_known() {
    let folder = TempDir::new().unwrap();
    let nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n";
    let nrrd = write(&folder, "v.bin", &[nrrd.as_bytes(), &[1; 8]].concat());
    let pictures = TempDir::new().unwrap();
    for name in ["1.png", "2.png"] {
        image::GrayImage::from_raw(2, 1, vec![1, 2]).unwrap().save(pictures.path().join(name)).unwrap();
    }
    for (path, format) in [
        (nrrd, Some("NRRD")),
        (pictures.path().join("1.png"), Some("PNG")),
        (pictures.path().to_owned(), Some("folder of PNG pictures")),
        (PathBuf::from("builtin:box:16"), None),
    ] {
        assert_eq!(load_choice(&path, VolumeChoice::default()).unwrap().contents().format, format);
    }
}

#[test]
fn errors_list_the_available_choices() {
    let folder = TempDir::new().unwrap();
    let nrrd = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 3\nencoding: raw\n\n";
    let path = write(&folder, "v.nrrd", &[nrrd.as_bytes(), &[1; 24]].concat());
    let choice = VolumeChoice { channel: Some(1), frame: Some(2), ..VolumeChoice::default() };
    let words = ["\"1\" was selected, but it has no channels", "time steps (--frame 0 to 2)"];
    assert_refused(load_choice(&path, choice), LoadErrorKind::BadInput, &words);
    let plain = nrrd.replace("dimension: 4", "dimension: 3").replace("2 2 2 3", "2 2 2");
    let path = write(&folder, "p.nrrd", &[plain.as_bytes(), &[1; 8]].concat());
    let choice = VolumeChoice { channel: Some(1), ..VolumeChoice::default() };
    assert_refused(load_choice(&path, choice), LoadErrorKind::BadInput, &["one volume: leave --channel out"]);
}
