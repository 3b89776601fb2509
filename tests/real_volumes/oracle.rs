//! Comparison with independent readers: values that other libraries read from files, in the tables of
//! `tests/oracle/`.

use std::path::{Path, PathBuf};

use chiaroscuro_volume::{LoadControl, LoadError, LoadErrorKind, Volume, VolumeChoice};
use chiaroscuro_volume_io::{LoadOptions, load};
use flate2::Crc;
use glam::DVec3;

/// Tolerance of an affine, as a share of its largest step: headers of `NIfTI` and MRC have 24 bits.
const AFFINE_TOLERANCE: f64 = 1e-6;

/// Tolerance of a mean, as a share of the largest value: millions are summed in another order.
const MEAN_TOLERANCE: f64 = 1e-9;

/// Share of voxels that decoders may round differently after lossy compression: up to 6 % were found for JPEG and
/// JPEG 2000.
const LOSSY_SHARE: f64 = 0.1;

/// Size of the largest file in the repository, in bytes; HDF5 keeps metadata in blocks of about 2 KiB.
const MAX_FILE_BYTES: u64 = 4096;
const MAX_HDF5_BYTES: u64 = 11 << 10;

/// Voxel type in the table of a file without a volume.
const REFUSED_TYPE: &str = "refused";

/// Row of a table: facts about a file, by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct OracleRow {
    pub(crate) file: String,
    /// Choice of the volume, as options of the command line; or the reason for a refusal, in words of the message.
    pub(crate) choice: String,
    pub(crate) dims: String,
    pub(crate) voxel_type: String,
    /// Space of the affine: `body`, `world` (millimetres, not anatomical) or `voxels` (unknown size).
    pub(crate) space: String,
    /// Three rows of four numbers: index to right-anterior-superior millimetres.
    pub(crate) affine: Vec<f64>,
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) mean: f64,
    /// Checksum of the voxels in their type, little-endian, x fastest.
    pub(crate) crc32: String,
    /// Tolerance of values after lossy compression.
    pub(crate) tolerance: f64,
}

/// Folder of the tables.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracle")
}

/// Reads the rows of a table.
pub(crate) fn read_table(name: &str) -> Vec<OracleRow> {
    let path = folder().join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|err| panic!("{}: {err}", path.display()));
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().expect("the names of the columns").split('\t').collect();
    let wanted = "file choice dims type space affine min max mean crc32 tolerance";
    assert_eq!(names.join(" "), wanted, "{name}");
    lines.map(row).collect()
}

fn row(line: &str) -> OracleRow {
    let columns: Vec<&str> = line.split('\t').collect();
    let text = |at: usize| columns[at].to_owned();
    let number = |at: usize| columns[at].parse().unwrap_or(f64::NAN);
    OracleRow {
        file: text(0),
        choice: text(1),
        dims: text(2),
        voxel_type: text(3),
        space: text(4),
        affine: columns[5].split(' ').filter_map(|number| number.parse().ok()).collect(),
        min: number(6),
        max: number(7),
        mean: number(8),
        crc32: text(9),
        tolerance: number(10),
    }
}

/// Parses the choice of a volume.
fn parse_choice(said: &str) -> VolumeChoice {
    let mut choice = VolumeChoice::default();
    let words: Vec<&str> = said.split(' ').collect();
    for pair in words.chunks_exact(2) {
        let number = || Some(pair[1].parse().expect("a number"));
        match pair[0] {
            "--frame" => choice.frame = number(),
            "--channel" => choice.channel = number(),
            "--component" => choice.component = number(),
            "--series" => choice.series = Some(pair[1].to_owned()),
            "--array" => choice.array = Some(pair[1].to_owned()),
            "--level" => choice.level = Some(pair[1].to_owned()),
            other => panic!("{other} is no option"),
        }
    }
    choice
}

pub(crate) fn open(folder: &Path, row: &OracleRow) -> Result<Volume, LoadError> {
    let said = if row.voxel_type == REFUSED_TYPE { "-" } else { &row.choice };
    let options = LoadOptions { choice: parse_choice(said), ..LoadOptions::default() };
    load(&folder.join(&row.file), &options, &LoadControl::new())
}

/// Row of a loaded volume, with the file, choice and tolerance of another row.
fn row_of(volume: &Volume, said: &OracleRow) -> OracleRow {
    let samples = volume.samples();
    let voxel_type = samples.voxel_type();
    let space = match (volume.is_anatomical(), volume.has_unknown_scale()) {
        (true, _) => "body",
        (false, false) => "world",
        (false, true) => "voxels",
    };
    let place = volume.world_from_index();
    let axes = place.matrix3;
    let [x, y, z, t] = [axes.x_axis, axes.y_axis, axes.z_axis, place.translation].map(|v| v.to_array());
    let values = || (0..samples.len()).map(|voxel| samples.value(voxel)).filter(|value| value.is_finite());
    let mut crc = Crc::new();
    for voxel in 0..samples.len() {
        let value = samples.value(voxel);
        match voxel_type.name() {
            "uint8" => crc.update(&[value as u8]),
            "int8" => crc.update(&(value as i8).to_le_bytes()),
            "uint16" => crc.update(&(value as u16).to_le_bytes()),
            "int16" => crc.update(&(value as i16).to_le_bytes()),
            "uint32" => crc.update(&(value as u32).to_le_bytes()),
            "int32" => crc.update(&(value as i32).to_le_bytes()),
            "float32" => crc.update(&(value as f32).to_le_bytes()),
            _ => crc.update(&value.to_le_bytes()),
        }
    }
    OracleRow {
        dims: volume.dims().map(|n| n.to_string()).join(" "),
        voxel_type: voxel_type.name().to_owned(),
        space: space.to_owned(),
        affine: (0..3).flat_map(|row| [x[row], y[row], z[row], t[row]]).collect(),
        min: values().fold(f64::INFINITY, f64::min),
        max: values().fold(f64::NEG_INFINITY, f64::max),
        mean: values().sum::<f64>() / values().count() as f64,
        crc32: if said.crc32 == "-" { "-".to_owned() } else { format!("{:08x}", crc.sum()) },
        ..said.clone()
    }
}

/// Returns true if two affines agree up to rounding.
fn affines_agree(found: &[f64], said: &[f64]) -> bool {
    let column = |of: &[f64], at: usize| DVec3::new(of[at], of[at + 4], of[at + 8]);
    let step = |of: &[f64]| (0..3).map(|at| column(of, at).length()).fold(0.0, f64::max);
    found.len() == 12
        && said.len() == 12
        && (0..4).all(|at| {
            let (found, expected_column) = (column(found, at), column(said, at));
            let scale =
                if at < 3 { expected_column.length() } else { expected_column.length().max(step(said)) };
            found.distance(expected_column) <= AFFINE_TOLERANCE * scale
        })
}

/// Columns in which two rows differ, with both values.
fn differing_columns(found: &OracleRow, said: &OracleRow) -> Vec<String> {
    let largest = said.min.abs().max(said.max.abs());
    let near = |a: f64, b: f64, by: f64| (a - b).abs() <= by;
    let numbers = [
        ("min", found.min, said.min, said.tolerance),
        ("max", found.max, said.max, said.tolerance),
        ("mean", found.mean, said.mean, MEAN_TOLERANCE * largest + LOSSY_SHARE * said.tolerance),
    ];
    let words = [
        ("dims", &found.dims, &said.dims),
        ("type", &found.voxel_type, &said.voxel_type),
        ("space", &found.space, &said.space),
        ("crc32", &found.crc32, &said.crc32),
    ];
    let words = words.into_iter().filter(|(_, found, said)| found != said);
    let numbers = numbers.into_iter().filter(|(_, found, said, by)| !near(*found, *said, *by));
    let place = (!affines_agree(&found.affine, &said.affine))
        .then(|| format!("affine {:?}, {:?} expected", found.affine, said.affine));
    words
        .map(|(name, found, said)| format!("{name} {found}, {said} expected"))
        .chain(numbers.map(|(name, found, said, _)| format!("{name} {found}, {said} expected")))
        .chain(place)
        .collect()
}

/// All differences between a file and its row.
pub(crate) fn differences(folder: &Path, row: &OracleRow) -> Vec<String> {
    let found = match (open(folder, row), row.voxel_type == REFUSED_TYPE) {
        (Ok(volume), false) => differing_columns(&row_of(&volume, row), row),
        (Ok(_), true) => vec!["it is opened, and holds no volume".to_owned()],
        (Err(error), false) => vec![error.to_string()],
        (Err(error), true) => {
            let is_kind = matches!(error.kind(), LoadErrorKind::BadInput | LoadErrorKind::Io);
            let is_right = is_kind && error.to_string().contains(&row.choice);
            if is_right { Vec::new() } else { vec![format!("refused, but not as {:?}: {error}", row.choice)] }
        }
    };
    found.into_iter().map(|difference| format!("{}: {difference}", row.file)).collect()
}

/// Checks the files in the repository, which other libraries have written.
pub(crate) fn written_files_are_read_as_other_libraries_read_them() {
    let rows = read_table("written.tsv");
    let wrong: Vec<String> =
        rows.iter().flat_map(|row| differences(&folder().join("written"), row)).collect();
    println!("{} files, {} differences", rows.len(), wrong.len());
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(rows.len() >= 80, "{} files", rows.len());
    for entry in std::fs::read_dir(folder().join("written")).expect("it is there") {
        let entry = entry.expect("it can be listed");
        let bytes = entry.metadata().expect("it is there").len();
        let is_hdf5 = entry.file_name().to_string_lossy().starts_with("hdf5_");
        let most = if is_hdf5 { MAX_HDF5_BYTES } else { MAX_FILE_BYTES };
        assert!(bytes <= most, "{} has {bytes} bytes", entry.path().display());
    }
}

/// Checks the test data outside the repository, if available.
pub(crate) fn test_data_are_read_as_other_libraries_read_them(data: &Path) {
    let rows = read_table("data.tsv");
    let wrong: Vec<String> = rows.iter().flat_map(|row| differences(data, row)).collect();
    println!("{} files, {} differences", rows.len(), wrong.len());
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    // Every file has a row.
    let mut folders = ["formats", "raw", "first"].map(|name| data.join(name)).to_vec();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("it is there") {
            let path = entry.expect("it can be listed").path();
            let name = path.strip_prefix(data).expect("it is below").to_string_lossy().replace('\\', "/");
            if path.is_dir() {
                folders.push(path);
            } else {
                assert!(rows.iter().any(|row| row.file == name), "{name} has no row");
            }
        }
    }
}

/// Guards the comparison itself: a change of any column is detected.
pub(crate) fn a_wrong_row_is_noticed() {
    let rows = read_table("written.tsv");
    let folder = folder().join("written");
    let row = rows.iter().find(|row| row.space == "body").expect("a file of a body");
    assert_eq!(differences(&folder, row), Vec::<String>::new());
    let moved = |at: usize, by: f64| {
        let mut affine = row.affine.clone();
        affine[at] += by;
        affine
    };
    let changes = [
        ("dims", OracleRow { dims: row.dims.split(' ').rev().collect::<Vec<_>>().join(" "), ..row.clone() }),
        ("type", OracleRow { voxel_type: "uint64".to_owned(), ..row.clone() }),
        ("space", OracleRow { space: "world".to_owned(), ..row.clone() }),
        ("affine", OracleRow { affine: moved(3, 1e-3), ..row.clone() }),
        ("affine", OracleRow { affine: moved(4, 1e-3), ..row.clone() }),
        ("affine", OracleRow { affine: Vec::new(), ..row.clone() }),
        ("min", OracleRow { min: row.min + 1.0, ..row.clone() }),
        ("max", OracleRow { max: row.max - 1.0, ..row.clone() }),
        ("mean", OracleRow { mean: row.mean + 1e-3, ..row.clone() }),
        ("crc32", OracleRow { crc32: "00000000".to_owned(), ..row.clone() }),
    ];
    for (column, changed) in changes {
        let found = differences(&folder, &changed);
        assert!(matches!(&found[..], [only] if only.contains(column)), "{column}: {found:?}");
    }
    let missing = OracleRow { file: "none.nrrd".to_owned(), ..row.clone() };
    let refused = OracleRow { voxel_type: REFUSED_TYPE.to_owned(), ..row.clone() };
    let otherwise = OracleRow { choice: "no such word".to_owned(), ..missing.clone() };
    for wrong in [missing, refused, OracleRow { voxel_type: REFUSED_TYPE.to_owned(), ..otherwise }] {
        assert_eq!(differences(&folder, &wrong).len(), 1, "{wrong:?}");
    }
    // After lossy compression: values within the tolerance pass, and no others.
    let lossy = OracleRow { tolerance: 1.0, ..row.clone() };
    let off = |by: f64| differing_columns(&OracleRow { min: row.min + by, ..row.clone() }, &lossy).len();
    assert_eq!([off(1.0), off(1.5)], [0, 1]);
    let pairs = rows.iter().filter(|row| row.choice != "-").count();
    assert!(pairs > 5, "files of several volumes, of which another is chosen");
}
