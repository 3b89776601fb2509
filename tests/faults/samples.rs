//! Sample files: a valid file of every readable kind, with its reader.

use std::io::Write as _;
use std::path::Path;

use chiaroscuro_media::{
    Animation, AnimationSpec, ExportError, PixelRows, export_png, picture_size, read_picture, read_record,
    write_picture,
};
use chiaroscuro_scene::{
    EXPORT_EXTENSIONS, ImageSpec, LookRecord, PRESETS, PixelFormat, Settings, VolumeRecord, export_transfer,
    import_transfer,
};
use chiaroscuro_volume::{LoadControl, ValueRange, ValueRanges};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Valid file of one kind.
pub(crate) struct SampleFile {
    /// File name, whose extension states the kind.
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    /// Reads such a file like the program; returns true if it was accepted.
    pub(crate) read: fn(&Path) -> bool,
}

/// Value range of computed tomography, which the preset is for.
fn ct_range() -> ValueRange {
    ValueRange::new(-1000.0, 3000.0)
}

fn reads_volume(path: &Path) -> bool {
    // The first of several volumes is read, as in the window.
    let options = LoadOptions::default();
    let options = LoadOptions { choice: options.choice.clone().with_first_as_fallback(), ..options };
    open(path, &options, &LoadControl::new()).is_ok()
}

/// Reads a look from a session, a preset or a picture; returns true if it was accepted.
fn is_valid_look(text: Option<String>) -> bool {
    let record = text.and_then(|text| LookRecord::parse(&text).ok());
    record.is_some_and(|record| {
        record.unknown_content();
        record.apply(&Settings::default(), &ValueRanges::UNIT).is_ok()
    })
}

fn reads_session(path: &Path) -> bool {
    is_valid_look(std::fs::read(path).ok().and_then(|bytes| String::from_utf8(bytes).ok()))
}

fn reads_picture(path: &Path) -> bool {
    let has_look = is_valid_look(read_record(path).ok().flatten());
    picture_size(path).is_ok() && read_picture(path).is_ok() && has_look
}

/// Reads a GIF or a video, of which only the look is read.
fn reads_embedded_look(path: &Path) -> bool {
    is_valid_look(read_record(path).ok().flatten())
}

/// Video with a record after the boxes that players read.
fn video_with_record(record: &str) -> Vec<u8> {
    let part = |kind: &[u8; 4], parts: &[&[u8]]| {
        let length = 8 + parts.iter().map(|part| part.len()).sum::<usize>();
        [&(length as u32).to_be_bytes()[..], kind, &parts.concat()].concat()
    };
    let record = part(b"uuid", &[b"chiaroscuro.look", record.as_bytes()]);
    [part(b"ftyp", &[b"isom\0\0\0\0"]), part(b"mdat", &[&[7; 40]]), part(b"moov", &[&[0; 12]]), record]
        .concat()
}

fn reads_transfer_function(path: &Path) -> bool {
    let bytes = std::fs::read(path).expect("it was just written");
    import_transfer(path, &bytes, ct_range()).is_ok()
}

/// File names, with the contents of `found/NAME/far`.
macro_rules! kept {
    ($($name:literal),+ $(,)?) => {
        // Embedded, because the fuzz target, which uses these samples as well, is in another package.
        [$(($name, include_bytes!(concat!("found/", $name, "/far")).as_slice())),+]
    };
}

/// Valid files of other programs, which cannot be generated here in a few lines.
const STORED_SAMPLES: [(&str, &[u8]); 50] = kept![
    "packed.nrrd",
    "digits.nrrd",
    "appended.vti",
    "coded.vti",
    "bytes.vtk",
    "text.vtk",
    "plain.nii",
    "second.nii.gz",
    "plain.mha",
    "zipped.mha",
    "frames.dcm",
    "implicit.dcm",
    "deflated.dcm",
    "runs.dcm",
    "lossless.dcm",
    "jpeg.dcm",
    "extended.dcm",
    "jpeg_ls.dcm",
    "jpeg_ls_colour.dcm",
    "jpeg_2000.dcm",
    "tiles.tif",
    "lzw.tif",
    "zstd.tif",
    "colors.tif",
    "jpeg.tif",
    "imagej.tif",
    "ome.tif",
    "grey.jpg",
    "grey.bmp",
    "slice.png",
    "density.mrc",
    "array.npy",
    "arrays.npz",
    "density.cube",
    "packed.pvm",
    "described.dat",
    "described.ini",
    "described.ivf",
    "list.mhd",
    "brain.mgh",
    "labels.mgz",
    "cube.fits",
    "units.fits.gz",
    "levels.zarr.zip",
    "shards.zarr.zip",
    "chunks.h5",
    "trees.h5",
    "growing.h5",
    "held.mat",
    "signal.nxs",
];

/// Files of other programs, by their names.
pub(crate) fn stored_samples() -> Vec<(&'static str, Vec<u8>)> {
    STORED_SAMPLES.map(|(name, bytes)| (name, bytes.to_vec())).to_vec()
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("it is in memory");
    encoder.finish().expect("it is in memory")
}

/// Generates one sample of each kind.
pub(crate) fn samples(folder: &Path) -> Vec<SampleFile> {
    let mut found = Vec::new();
    let mut add =
        |name: &str, bytes: Vec<u8>, read| found.push(SampleFile { name: name.to_owned(), bytes, read });
    let voxels: Vec<u8> = (0..6 * 5 * 4).map(|at| (at * 2) as u8).collect();
    let zipped = gzip(&voxels);
    let nrrd = |encoding: &str| {
        format!(
            "NRRD0004\n# a comment\ntype: uint8\ndimension: 3\nsizes: 6 5 4\nspacings: 1 1 1.5\nencoding: {encoding}\n\n"
        )
    };
    add("plain.nrrd", [nrrd("raw").into_bytes(), voxels.clone()].concat(), reads_volume as fn(&Path) -> bool);
    add("zipped.nrrd", [nrrd("gzip").into_bytes(), zipped.clone()].concat(), reads_volume);
    add("bare_6x5x4_uint8.raw", voxels.clone(), reads_volume);
    add("bare_6x5x4_uint8.raw.gz", zipped, reads_volume);
    for (name, bytes) in stored_samples() {
        add(name, bytes, reads_volume);
    }
    // Data files of headers and descriptions.
    std::fs::write(folder.join("described.raw"), [7; 24]).expect("room");
    std::fs::write(folder.join("listed.raw"), [7; 6 * 5 * 4]).expect("room");

    let of = VolumeRecord::new(Path::new("builtin:chair"), 7, None);
    let record = LookRecord::to_json(&Settings::default(), Some(&of), None);
    add("session.json", record.clone().into_bytes(), reads_session);
    add("preset.json", PRESETS[0].json().as_bytes().to_vec(), reads_session);
    let png = folder.join("sample.png");
    export_png([3, 2], &[120; 24], true, Some(&record), &png).expect("a picture");
    add("picture.png", std::fs::read(&png).expect("it was just written"), reads_picture);
    let exr = folder.join("sample.exr");
    let mut rows = Some(PixelRows::Floats(vec![0.5; 24]));
    let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new([3, 2]) };
    write_picture(&exr, &image_spec, Some(&record), &mut || Ok::<_, ExportError>(rows.take()))
        .expect("a picture");
    add("picture.exr", std::fs::read(&exr).expect("it was just written"), reads_picture);
    let gif = folder.join("sample.gif");
    let animation_spec = AnimationSpec { size: [3, 2], frames: 1, rate: 10, transparent: false };
    let mut moving = Animation::create(&gif, &animation_spec).expect("a file");
    moving.add(&[120; 24], &record).expect("a picture");
    moving.finish().expect("a file");
    add("moving.gif", std::fs::read(&gif).expect("it was just written"), reads_embedded_look);
    add("moving.mp4", video_with_record(&record), reads_embedded_look);

    let with_preset = PRESETS[0]
        .apply(&Settings::default(), &ValueRanges::without_outliers(ct_range()))
        .expect("a preset of ours");
    for ending in EXPORT_EXTENSIONS {
        let name = format!("function.{ending}");
        let bytes = export_transfer(Path::new(&name), &with_preset.layer().transfer, ct_range());
        add(&name, bytes.expect("it is one of ours"), reads_transfer_function);
    }
    found
}

#[test]
fn samples_are_valid() {
    let folder = tempfile::tempdir().expect("a folder");
    for SampleFile { name, bytes, read } in samples(folder.path()) {
        let path = folder.path().join(&name);
        std::fs::write(&path, bytes).expect("room");
        assert!(read(&path), "{name}");
    }
}
