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

/// Images of VTK in its two forms, with their values in the ways that they are written.
fn vtk(voxels: &[u8]) -> [(&'static str, Vec<u8>); 4] {
    let image = |root: &str, array: &str, end: &[u8]| {
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" header_type=\"UInt32\" {root}>\n<ImageData \
             WholeExtent=\"0 5 0 4 0 3\" Origin=\"0 0 0\" Spacing=\"1 1 1.5\">\n<Piece Extent=\"0 5 0 4 0 3\">\n\
             <PointData Scalars=\"a\">\n<DataArray type=\"UInt8\" Name=\"a\" {array}</DataArray>\n</PointData>\n\
             </Piece>\n</ImageData>\n"
        );
        [head.as_bytes(), end, b"</VTKFile>\n"].concat()
    };
    let compressed = {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(voxels).expect("it is in memory");
        encoder.finish().expect("it is in memory")
    };
    let words = [1, voxels.len() as u32, 0, compressed.len() as u32].map(u32::to_le_bytes).concat();
    let appended =
        [b"<AppendedData encoding=\"raw\">\n_".as_slice(), &words, &compressed, b"</AppendedData>\n"]
            .concat();
    // A length of 120 and as many bytes: 1 2, 39 times 1 2 3, and 1.
    let coded = format!("format=\"binary\">eAAAAAEC{}AQ==", "AQID".repeat(39));
    let head = |coding: &str| {
        format!(
            "# vtk DataFile Version 3.0\na title\n{coding}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\nSPACING 1 1 1.5\n\
             ORIGIN 0 0 0\nPOINT_DATA 120\n"
        )
    };
    let bytes = head("BINARY") + "SCALARS a unsigned_char 1\nLOOKUP_TABLE default\n";
    let numbers = voxels.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    let text = head("ASCII") + "FIELD FieldData 1\na 1 120 float\n" + &numbers + "\n";
    [
        (
            "appended.vti",
            image("compressor=\"vtkZLibDataCompressor\"", "format=\"appended\" offset=\"0\">", &appended),
        ),
        ("coded.vti", image("byte_order=\"LittleEndian\"", &coded, b"")),
        ("bytes.vtk", [bytes.as_bytes(), voxels, b"\n"].concat()),
        ("text.vtk", text.into_bytes()),
    ]
}

/// One of each kind.
pub(crate) fn samples(folder: &Path) -> Vec<Sample> {
    let mut found = Vec::new();
    let mut add =
        |name: &str, bytes: Vec<u8>, read| found.push(Sample { name: name.to_owned(), bytes, read });
    let voxels: Vec<u8> = (0..6 * 5 * 4).map(|at| (at * 2) as u8).collect();
    let zipped = {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&voxels).expect("it is in memory");
        encoder.finish().expect("it is in memory")
    };
    let header = |encoding: &str| {
        format!(
            "NRRD0004\n# a comment\ntype: uint8\ndimension: 3\nsizes: 6 5 4\nspacings: 1 1 1.5\nencoding: {encoding}\n\n"
        )
    };
    add("plain.nrrd", [header("raw").into_bytes(), voxels.clone()].concat(), volume as fn(&Path) -> bool);
    add("zipped.nrrd", [header("gzip").into_bytes(), zipped.clone()].concat(), volume);
    let packed = {
        let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
        encoder.write_all(&voxels).expect("it is in memory");
        encoder.finish().expect("it is in memory")
    };
    add("packed.nrrd", [header("bzip2").into_bytes(), packed].concat(), volume);
    // A picture in colours, in hexadecimal digits.
    let digits: Vec<_> = voxels.iter().map(|voxel| format!("{voxel:02x}\n")).collect();
    let digits = header("hex").replace("encoding", "space: RAS\nkinds: RGB-color domain domain\nencoding")
        + &digits.concat();
    add("digits.nrrd", digits.replace("sizes: 6", "sizes: 3").replace("5 4", "5 8").into_bytes(), volume);
    for (name, bytes) in vtk(&voxels) {
        add(name, bytes, volume);
    }
    add("bare_6x5x4_uint8.raw", voxels, volume);
    add("bare_6x5x4_uint8.raw.gz", zipped, volume);

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
