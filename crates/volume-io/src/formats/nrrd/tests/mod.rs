//! Tests of NRRD files, end to end: accepted and refused files.

mod detached;
mod frames;
mod grid;
mod hints;

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::tests::helpers::{assert_refused, gzip, load_path as load_path_as};
use chiaroscuro_volume::{LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

/// Header of a 2 x 2 x 2 volume of bytes, without its data.
const HEADER: &str = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
/// Voxels of the volume that `HEADER` describes.
const VOXELS: [u8; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

fn bzip2(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Encodes bytes in hexadecimal, one a line, with digits of mixed case.
fn hex(bytes: &[u8]) -> String {
    let digits = |byte: &u8| format!("{:x}{:X}\n", byte >> 4, byte & 15);
    bytes.iter().map(digits).collect::<Vec<_>>().concat()
}

fn write(folder: &TempDir, name: &str, header: &str, data: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, [header.as_bytes(), data].concat()).unwrap();
    path
}

fn load_path(path: &Path) -> Result<Volume, LoadError> {
    load_path_as(path, VolumeChoice::default())
}

/// Loads an attached file: `header`, an empty line, `data`.
fn load_attached(header: &str, data: &[u8]) -> Result<Volume, LoadError> {
    let folder = TempDir::new().unwrap();
    load_path(&write(&folder, "v.nrrd", &format!("{header}\n"), data))
}

/// Returns [`HEADER`] with other fields in place of those with the same name.
fn header_with(fields: &[&str]) -> String {
    let name = |line: &str| line.split(':').next().unwrap_or_default().to_owned();
    let replaced: Vec<_> = fields.iter().map(|line| name(line)).collect();
    let kept = HEADER.lines().filter(|line| !replaced.contains(&name(line)));
    kept.chain(fields.iter().copied()).fold(String::new(), |header, line| header + line + "\n")
}

#[test]
fn every_type_is_read_in_both_byte_orders_and_encodings() {
    macro_rules! check {
        ($type:ty, $variant:ident, [$($synonym:literal),*], $values:expr) => {
            let values: [$type; 3] = $values;
            let samples = Samples::$variant(values.to_vec());
            let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            let text = values.map(|value| value.to_string()).join(" \r\n");
            for synonym in [$($synonym),*] {
                let read = |encoding: &str, endian: &str, data: &[u8]| {
                    let fields = [format!("type: {synonym}"), "sizes: 3 1 1".to_owned(), encoding.to_owned(), endian.to_owned()];
                    let fields: Vec<_> = fields.iter().map(String::as_str).filter(|f| !f.is_empty()).collect();
                    load_attached(&header_with(&fields), data).unwrap().samples().clone()
                };
                assert_eq!(read("encoding: raw", "endian: little", &little), samples);
                assert_eq!(read("encoding: raw", "endian: big", &big), samples);
                assert_eq!(read("encoding: gzip", "endian: little", &gzip(&little)), samples);
                assert_eq!(read("encoding: gz", "endian: big", &gzip(&big)), samples);
                assert_eq!(read("encoding: bzip2", "endian: little", &bzip2(&little)), samples);
                assert_eq!(read("encoding: bz2", "endian: big", &bzip2(&big)), samples);
                assert_eq!(read("encoding: hex", "endian: little", hex(&little).as_bytes()), samples);
                assert_eq!(read("encoding: hex", "endian: big", hex(&big).as_bytes()), samples);
                assert_eq!(read("encoding: ASCII", "", text.as_bytes()), samples);
                assert_eq!(read("encoding: txt", "endian: big", text.as_bytes()), samples);
            }
        };
    }
    // 64-bit integers become the smallest type that holds them.
    let wide: [i64; 3] = [-7, 0, 1 << 31];
    let narrow = Samples::F64(wide.iter().map(|&value| value as f64).collect());
    for synonym in ["longlong", "signed long long int", "int64_t"] {
        let fields = [&format!("type: {synonym}"), "sizes: 3 1 1", "endian: big"];
        let bytes: Vec<u8> = wide.iter().flat_map(|value| value.to_be_bytes()).collect();
        assert_eq!(*load_attached(&header_with(&fields), &bytes).unwrap().samples(), narrow);
    }
    let fields = ["type: ulonglong", "sizes: 3 1 1", "encoding: ascii"];
    let read = load_attached(&header_with(&fields), b"1 2 4294967295").unwrap();
    assert_eq!(*read.samples(), Samples::U32(vec![1, 2, u32::MAX]));
    check!(i8, I8, ["signed char", "int8", "int8_t"], [-128, 0, 127]);
    check!(u8, U8, ["uchar", "unsigned char", "uint8", "uint8_t"], [0, 1, 255]);
    check!(i16, I16, ["short", "signed short int", "int16_t"], [-32768, 258, 32767]);
    check!(u16, U16, ["ushort", "unsigned  short int", "UInt16"], [0, 258, 65535]);
    check!(i32, I32, ["int", "signed int", "int32"], [i32::MIN, 66051, i32::MAX]);
    check!(u32, U32, ["uint", "unsigned int", "uint32_t"], [0, 66051, u32::MAX]);
    check!(f32, F32, ["float"], [-1.5, 0.25, 1e30]);
    check!(f64, F64, ["double"], [-1.5, 0.25, 1e300]);
}

#[test]
fn versions_comments_keys_and_line_ends_are_tolerated() {
    for version in 1..=5 {
        let header = format!(
            "NRRD000{version}\r\n# a comment\r\ncontent: a \u{1b}tooth\r\nType: uchar\r\nkey:=a: b\r\n\
             dimension: 3\r\nsizes: 2 2 2\r\nnumber: 8\r\nEncoding: raw\r\n\r\n"
        );
        let folder = TempDir::new().unwrap();
        let volume = load_path(&write(&folder, "no_extension", &header, &VOXELS)).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()));
        assert_eq!(volume.name(), "a ·tooth");
    }
    assert_eq!(load_attached(HEADER, &VOXELS).unwrap().name(), "v");
}

#[test]
fn missing_and_wrong_fields_are_named() {
    for field in ["type", "dimension", "sizes", "encoding"] {
        let header: String = HEADER
            .lines()
            .filter(|line| !line.starts_with(field))
            .fold(String::new(), |header, line| header + line + "\n");
        assert_refused(load_attached(&header, &VOXELS), LoadErrorKind::BadInput, &[field, "v.nrrd"]);
    }
    for (field, words) in [
        ("type: block", &["type", "block"][..]),
        ("type: char", &["type"]),
        ("type: uint16", &["endian"]),
        ("endian: middle", &["endian"]),
        ("encoding: zip", &["encoding", "zip"]),
        ("dimension: 0", &["dimension"]),
        ("dimension: 17", &["dimension"]),
        ("dimension: three", &["dimension"]),
        ("dimension: 4", &["sizes"]),
        ("sizes: 2 2", &["sizes"]),
        ("sizes: 2 -2 2", &["sizes"]),
        ("sizes: 2 0 2", &["sizes", "at least 1"]),
        ("sizes: 2 2 99999999999999999999999", &["sizes"]),
        ("spacings: 1 1", &["spacings"]),
        ("space directions: (1,0,0) (0,1,0)", &["space directions"]),
        ("space directions: (1,0) (0,1) (1,1)", &["space directions"]),
        ("space directions: 1 0 0", &["space directions"]),
        ("space origin: (1,0)", &["space origin"]),
        ("space origin: (inf,0,0)", &["space origin"]),
        ("space dimension: 5", &["space dimension"]),
        ("kinds: domain vector domain", &["components", "permute"]),
        ("kinds: vector list domain", &["axes are spatial"]),
        ("line skip: -1", &["line skip"]),
        ("line skip: 99", &["line skip"]),
        ("byte skip: -2", &["byte skip"]),
        ("byte skip: 18446744073709551615", &["truncated"]),
        ("this is no field", &["line 6"]),
    ] {
        assert_refused(load_attached(&header_with(&[field]), &VOXELS), LoadErrorKind::BadInput, words);
    }
    let twice = format!("{HEADER}sizes: 2 2 1\n");
    assert_refused(load_attached(&twice, &VOXELS), LoadErrorKind::BadInput, &["sizes", "twice"]);
    let future = HEADER.replace("NRRD0004", "NRRD0006");
    assert_refused(load_attached(&future, &VOXELS), LoadErrorKind::BadInput, &["NRRD0005", "NRRD0006"]);
    assert_refused(load_attached("nothing", &VOXELS), LoadErrorKind::BadInput, &["magic"]);
    assert_refused(load_attached("NRRD0004\n", &VOXELS), LoadErrorKind::BadInput, &["no fields"]);
}

#[test]
fn lying_sizes_are_refused_before_allocation() {
    for encoding in ["raw", "gzip", "ascii"] {
        let fields = ["sizes: 1000000 1000000 1000000", &format!("encoding: {encoding}")];
        let result = load_attached(&header_with(&fields), &VOXELS);
        assert_refused(result, LoadErrorKind::Limit, &["888.2 PiB", "1.0 MiB", "sizes"]);
        let fields = ["sizes: 100 100 100", &format!("encoding: {encoding}")];
        assert_refused(load_attached(&header_with(&fields), &VOXELS), LoadErrorKind::BadInput, &["data"]);
    }
    let endless = format!("{HEADER}# {}\n", "x".repeat(2 << 20));
    assert_refused(load_attached(&endless, &VOXELS), LoadErrorKind::Limit, &["1 MiB"]);
}

#[test]
fn data_of_the_wrong_length_are_refused() {
    let result = load_attached(HEADER, &VOXELS[..7]);
    assert_refused(result, LoadErrorKind::BadInput, &["truncated", "8 bytes", "7 found"]);
    let zipped = header_with(&["encoding: gzip"]);
    let data = gzip(&VOXELS);
    let cut = load_attached(&zipped, &data[..data.len() - 9]);
    assert_refused(cut, LoadErrorKind::BadInput, &["truncated"]);
    assert_refused(load_attached(&zipped, &VOXELS), LoadErrorKind::BadInput, &["gzip"]);
    let long = load_attached(&zipped, &gzip(&[1; 9]));
    assert_refused(long, LoadErrorKind::BadInput, &["more data"]);
    let packed = header_with(&["encoding: bzip2"]);
    let data = bzip2(&VOXELS);
    let cut = load_attached(&packed, &data[..data.len() - 9]);
    assert_refused(cut, LoadErrorKind::BadInput, &["bzip2"]);
    assert_refused(load_attached(&packed, &VOXELS), LoadErrorKind::BadInput, &["bzip2"]);
    let long = load_attached(&packed, &bzip2(&[1; 9]));
    assert_refused(long, LoadErrorKind::BadInput, &["more data"]);
    let digits = header_with(&["encoding: hex"]);
    for (data, word) in [
        ("0102030405060708 09", "more data"),
        ("010203040506070", "truncated"),
        ("010203040506070      ", "within a byte"),
        ("010203040506070g", "hexadecimal"),
    ] {
        assert_refused(load_attached(&digits, data.as_bytes()), LoadErrorKind::BadInput, &[word]);
    }
    let text = header_with(&["encoding: ascii"]);
    for (data, word) in [
        ("1 2 3 4 5 6 7        ", "7 found"),
        ("1 2 3 4 5 6 7 8 9", "more data"),
        ("1 2 3 4 5 6 7 256", "256"),
        ("1 2 3 4 5 6 7 eight", "eight"),
    ] {
        assert_refused(load_attached(&text, data.as_bytes()), LoadErrorKind::BadInput, &[word]);
    }
    // No data at all, and no data file named.
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "v.nhdr", HEADER, &[]);
    assert_refused(load_path(&path), LoadErrorKind::BadInput, &["data file"]);
}

#[test]
fn bytes_behind_packed_data_are_passed_over() {
    for (encoding, packed) in [("gzip", gzip(&VOXELS)), ("bzip2", bzip2(&VOXELS))] {
        let header = header_with(&[&format!("encoding: {encoding}")]);
        for behind in [vec![0; 512], b"\r\n-- \r\nscanned by a gateway".to_vec()] {
            let volume = load_attached(&header, &[&packed[..], &behind].concat()).unwrap();
            assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()), "{encoding}");
        }
    }
    let halves = [gzip(&VOXELS[..3]), vec![0; 100], gzip(&VOXELS[3..]), vec![7]].concat();
    let volume = load_attached(&header_with(&["encoding: gzip"]), &halves).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()));
}

#[test]
fn long_text_is_read_across_blocks() {
    let numbers: Vec<u16> = (0..400_000u32).map(|n| (n * 7919 % 65536) as u16).collect();
    let text = numbers.iter().fold(String::new(), |text, n| text + &n.to_string() + "\n");
    let header = header_with(&["type: uint16", "sizes: 1000 400 1", "encoding: text"]);
    assert_eq!(*load_attached(&header, text.as_bytes()).unwrap().samples(), Samples::U16(numbers));
    let endless = vec![b'1'; 3 << 20];
    let result = load_attached(&header_with(&["encoding: text"]), &endless);
    assert_refused(result, LoadErrorKind::BadInput, &["longer than any number"]);
}

#[test]
fn lines_and_bytes_are_skipped() {
    let expected = Samples::U8(VOXELS.to_vec());
    let read =
        |fields: &[&str], data: &[u8]| load_attached(&header_with(fields), data).unwrap().samples().clone();
    let with_lines = [b"one\ntwo\n".as_slice(), &VOXELS, b"rest"].concat();
    assert_eq!(read(&["line skip: 2"], &with_lines), expected);
    assert_eq!(read(&["lineskip: 1", "byteskip: 4"], &with_lines), expected);
    let at_the_end = [b"what ever".as_slice(), &VOXELS].concat();
    assert_eq!(read(&["byte skip: -1"], &at_the_end), expected);
    let zipped = gzip(&at_the_end);
    assert_eq!(read(&["byte skip: 9", "encoding: gzip"], &zipped), expected);
    let after_a_line = [b"line\n".as_slice(), &zipped].concat();
    assert_eq!(read(&["line skip: 1", "byte skip: 9", "encoding: gzip"], &after_a_line), expected);
    let result = load_attached(&header_with(&["byte skip: -1", "encoding: gzip"]), &zipped);
    assert_refused(result, LoadErrorKind::BadInput, &["byte skip", "raw only"]);
    assert_refused(
        load_attached(&header_with(&["byte skip: -1"]), &VOXELS[..5]),
        LoadErrorKind::BadInput,
        &["5 found"],
    );
}
