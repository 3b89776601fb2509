//! A valid file of every kind that is read, and its reader.

use std::io::Write as _;
use std::path::Path;

use chiaroscuro::data::load::{LoadControl, LoadOptions};
use chiaroscuro::data::{ValueRange, ValueRanges, open};
use chiaroscuro::export::{ExportError, Rows};
use chiaroscuro::export::{export_png, picture_size, read_picture, read_record, write_picture};
use chiaroscuro::model::{
    Depth, EXPORTED, ImageSpec, PRESETS, Record, Settings, VolumeRecord, export, import,
};

/// A kind of file.
pub(crate) struct Sample {
    /// Its name, with the ending that says the kind.
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    /// Reads such a file as the program does; whether it was accepted.
    pub(crate) read: fn(&Path) -> bool,
}

/// Values of computed tomography, for which the preset is.
fn range() -> ValueRange {
    ValueRange::new(-1000.0, 3000.0)
}

fn volume(path: &Path) -> bool {
    open(path, &LoadOptions::default(), &LoadControl::new()).is_ok()
}

/// As a look of a session, of a preset or in a picture.
fn look(text: Option<String>) -> bool {
    let record = text.and_then(|text| Record::read(&text).ok());
    record.is_some_and(|record| {
        record.unknown();
        record.apply(&Settings::default(), &ValueRanges::UNIT).is_ok()
    })
}

fn session(path: &Path) -> bool {
    look(std::fs::read(path).ok().and_then(|bytes| String::from_utf8(bytes).ok()))
}

fn picture(path: &Path) -> bool {
    let has_look = look(read_record(path).ok().flatten());
    picture_size(path).is_ok() && read_picture(path).is_ok() && has_look
}

fn transfer(path: &Path) -> bool {
    let bytes = std::fs::read(path).expect("it was just written");
    import(path, &bytes, range()).is_ok()
}

/// A `MetaImage` header of 6 x 5 x 4 bytes without the field that ends it.
const METAIMAGE: &str = "ObjectType = Image\nNDims = 3\nBinaryData = True\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n\
     Offset = 0 0 0\nElementSpacing = 1 1 1.5\nDimSize = 6 5 4\nElementType = MET_UCHAR\n";

/// As a volume whose voxels are in a second file.
fn listed(path: &Path) -> bool {
    let data = path.with_file_name("bare_6x5x4_uint8.raw");
    std::fs::write(data, [7; 6 * 5 * 4]).expect("room");
    volume(path)
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("it is in memory");
    encoder.finish().expect("it is in memory")
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("it is in memory");
    encoder.finish().expect("it is in memory")
}

/// Puts bytes at places of a header of so many.
fn header(size: usize, fields: &[(usize, &[u8])]) -> Vec<u8> {
    let mut bytes = vec![0; size];
    for (at, field) in fields {
        bytes[*at..at + field.len()].copy_from_slice(field);
    }
    bytes
}

fn f32s(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// NIfTI-1 with a quaternion.
fn nifti(voxels: &[u8]) -> Vec<u8> {
    let fields: [(usize, &[u8]); 9] = [
        (0, &348i32.to_le_bytes()),
        (40, &[3, 0, 6, 0, 5, 0, 4, 0]),
        (70, &[2, 0, 8, 0]),
        (76, &f32s(&[1.0, 1.0, 1.0, 1.5])),
        (108, &f32s(&[352.0, 2.0, 1.0])),
        (148, b"a description"),
        (252, &[1, 0]),
        (256, &f32s(&[0.0, 0.0, 0.5, 1.0, 2.0, 3.0])),
        (344, b"n+1\0"),
    ];
    [header(352, &fields), voxels.to_vec()].concat()
}

/// NIfTI-2 with a matrix, and vectors of two components.
fn nifti_2(voxels: &[u8]) -> Vec<u8> {
    let i64s = |values: &[i64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let f64s = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let fields: [(usize, &[u8]); 8] = [
        (0, &540i32.to_le_bytes()),
        (4, b"n+2\0\r\n\x1a\n"),
        (12, &[2, 0, 8, 0]),
        (16, &i64s(&[5, 6, 5, 2, 1, 2])),
        (168, &i64s(&[544])),
        (348, &[1]),
        (400, &f64s(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0])),
        (504, &1007i32.to_le_bytes()),
    ];
    [header(544, &fields), voxels.to_vec()].concat()
}

/// One of each kind.
pub(crate) fn samples(folder: &Path) -> Vec<Sample> {
    let mut found = Vec::new();
    let mut add =
        |name: &str, bytes: Vec<u8>, read| found.push(Sample { name: name.to_owned(), bytes, read });
    let voxels: Vec<u8> = (0..6 * 5 * 4).map(|at| (at * 2) as u8).collect();
    let zipped = gzip(&voxels);
    let nrrd = |encoding: &str| {
        format!(
            "NRRD0004\n# a comment\ntype: uint8\ndimension: 3\nsizes: 6 5 4\nspacings: 1 1 1.5\nencoding: {encoding}\n\n"
        )
    };
    add("plain.nrrd", [nrrd("raw").into_bytes(), voxels.clone()].concat(), volume as fn(&Path) -> bool);
    add("zipped.nrrd", [nrrd("gzip").into_bytes(), zipped.clone()].concat(), volume);
    add("bare_6x5x4_uint8.raw", voxels.clone(), volume);
    add("bare_6x5x4_uint8.raw.gz", zipped, volume);
    add("plain.nii", nifti(&voxels), volume);
    add("second.nii.gz", gzip(&nifti_2(&voxels)), volume);
    let local = [METAIMAGE, "ElementDataFile = LOCAL\n"].concat();
    add("plain.mha", [local.as_bytes(), &voxels].concat(), volume);
    let compressed = [METAIMAGE, "CompressedData = True\nElementDataFile = LOCAL\n"].concat();
    add("zipped.mha", [compressed.as_bytes(), &zlib(&voxels)].concat(), volume);
    let list = [METAIMAGE, "ElementDataFile = LIST 3\nbare_6x5x4_uint8.raw\n"].concat();
    add("list.mhd", list.into_bytes(), listed);

    let of = VolumeRecord::new(Path::new("builtin:chair"), 7, None);
    let record = Record::text(&Settings::default(), Some(&of), None);
    add("session.json", record.clone().into_bytes(), session);
    add("preset.json", PRESETS[0].text().as_bytes().to_vec(), session);
    let png = folder.join("sample.png");
    export_png([3, 2], &[120; 24], true, Some(&record), &png).expect("a picture");
    add("picture.png", std::fs::read(&png).expect("it was just written"), picture);
    let exr = folder.join("sample.exr");
    let mut rows = Some(Rows::Floats(vec![0.5; 24]));
    let shot = ImageSpec { depth: Depth::Linear, ..ImageSpec::new([3, 2]) };
    write_picture(&exr, &shot, Some(&record), &mut || Ok::<_, ExportError>(rows.take())).expect("a picture");
    add("picture.exr", std::fs::read(&exr).expect("it was just written"), picture);

    let with_preset =
        PRESETS[0].apply(&Settings::default(), &ValueRanges::same(range())).expect("a preset of ours");
    for ending in EXPORTED {
        let name = format!("function.{ending}");
        let bytes = export(Path::new(&name), &with_preset.transfer, range());
        add(&name, bytes.expect("it is one of ours"), transfer);
    }
    found
}

#[test]
fn samples_are_valid() {
    let folder = tempfile::tempdir().expect("a folder");
    for Sample { name, bytes, read } in samples(folder.path()) {
        let path = folder.path().join(&name);
        std::fs::write(&path, bytes).expect("room");
        assert!(read(&path), "{name}");
    }
}
