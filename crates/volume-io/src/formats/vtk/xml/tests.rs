//! Tests that load VTK XML images through the public interface: supported and refused ones.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;

use crate::Endian;
use crate::tests::helpers::{self, assert_refused, zlib};
use chiaroscuro_files::xml::slow_texts::{many_attributes, nested_namespaces, slow_texts};
use chiaroscuro_volume::{FileDimension, LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

const VOXELS: [u8; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

fn load_bytes_as(bytes: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    helpers::load_bytes("v.vti", bytes, choice)
}

fn load_bytes(bytes: &[u8]) -> Result<Volume, LoadError> {
    load_bytes_as(bytes, VolumeChoice::default())
}

/// Builds a file of 2 x 2 x 2 points from attributes of the root, arrays, and content after the image.
fn file(root: &str, arrays: &str, end: &[u8]) -> Vec<u8> {
    let head = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" {root}>\n<ImageData WholeExtent=\"0 1 0 1 0 1\" \
         Origin=\"1 2 3\" Spacing=\"0.5 1 2\">\n<Piece Extent=\"0 1 0 1 0 1\">\n{arrays}\n</Piece>\n</ImageData>\n"
    );
    [head.as_bytes(), end, b"\n</VTKFile>\n"].concat()
}

fn points(attributes: &str, text: &str) -> String {
    format!("<PointData><DataArray Name=\"a\" {attributes}>{text}</DataArray></PointData>")
}

/// Builds a file with one array of bytes as text.
fn plain_file() -> String {
    let arrays = points("type=\"UInt8\" format=\"ascii\"", "1 2 3 4\n5 6 7 8");
    String::from_utf8(file("", &arrays, b"")).unwrap()
}

fn base64(bytes: &[u8]) -> String {
    const CHARACTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, at| bits << 8 | u32::from(group.get(at).copied().unwrap_or(0)));
        for at in 0..4 {
            let character = CHARACTERS[(bits >> (18 - 6 * at) & 63) as usize];
            text.push(if at <= group.len() { char::from(character) } else { '=' });
        }
    }
    text
}

/// Encodes at most 14 bytes as an LZ4 block of literals.
fn lz4(bytes: &[u8]) -> Vec<u8> {
    [&[(bytes.len() as u8) << 4], bytes].concat()
}

/// Encodes numbers of a header, of 32 or 64 bits.
fn words(are_long: bool, endian: Endian, words: &[u64]) -> Vec<u8> {
    let bytes = |&word: &u64| match (are_long, endian) {
        (true, Endian::Big) => word.to_be_bytes().to_vec(),
        (true, Endian::Little) => word.to_le_bytes().to_vec(),
        (false, Endian::Big) => (word as u32).to_be_bytes().to_vec(),
        (false, Endian::Little) => (word as u32).to_le_bytes().to_vec(),
    };
    words.iter().flat_map(bytes).collect()
}

/// Packs bytes in blocks of `size` bytes; returns the header and the data.
fn blocks(
    are_long: bool,
    endian: Endian,
    bytes: &[u8],
    size: usize,
    pack: fn(&[u8]) -> Vec<u8>,
) -> (Vec<u8>, Vec<u8>) {
    let packed: Vec<_> = bytes.chunks(size).map(pack).collect();
    let mut header = vec![packed.len() as u64, size as u64, (bytes.len() % size) as u64];
    header.extend(packed.iter().map(|block| block.len() as u64));
    (words(are_long, endian, &header), packed.concat())
}

#[test]
fn every_form_of_the_values_is_read() {
    let values: [i16; 8] = [-2, 0, 1, 258, 32767, -32768, 5, 6];
    let expected = Samples::I16(values.to_vec());
    for (are_long, is_big) in [(false, false), (false, true), (true, false), (true, true)] {
        let endian = if is_big { Endian::Big } else { Endian::Little };
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| if is_big { value.to_be_bytes() } else { value.to_le_bytes() })
            .collect();
        let order = if is_big { "BigEndian" } else { "LittleEndian" };
        let width = if are_long { "UInt64" } else { "UInt32" };
        let plain = (words(are_long, endian, &[16]), bytes.clone());
        for (compressor, (header, data), is_plain) in [
            ("", plain, true),
            ("vtkZLibDataCompressor", blocks(are_long, endian, &bytes, 6, zlib), false),
            ("vtkZLibDataCompressor", blocks(are_long, endian, &bytes, 8, zlib), false),
            ("vtkLZ4DataCompressor", blocks(are_long, endian, &bytes, 10, lz4), false),
        ] {
            let root = format!("byte_order=\"{order}\" header_type=\"{width}\" compressor=\"{compressor}\"");
            let both = [header.as_slice(), &data].concat();
            let text = if is_plain { base64(&both) } else { base64(&header) + &base64(&data) };
            let inline = points("type=\"Int16\" format=\"binary\"", &format!("\n  {text}\n  "));
            let appended = points("type=\"Int16\" format=\"appended\" offset=\"5\"", "");
            let raw = [b"<AppendedData encoding=\"raw\">\n _<<<<<".as_slice(), &both, b"</AppendedData>"];
            let coded = format!("<AppendedData encoding=\"base64\">\n _AAAA={text}</AppendedData>");
            for bytes in [
                file(&root, &inline, b""),
                file(&root, &appended, &raw.concat()),
                file(&root, &appended, coded.as_bytes()),
            ] {
                let volume = load_bytes(&bytes).unwrap();
                assert_eq!(*volume.samples(), expected, "{root}");
                let mut zipped = GzEncoder::new(Vec::new(), Compression::default());
                zipped.write_all(&bytes).unwrap();
                let volume = load_bytes(&zipped.finish().unwrap()).unwrap();
                assert_eq!(*volume.samples(), expected, "zipped, {root}");
            }
        }
    }
}

#[test]
fn every_type_is_read_as_text() {
    macro_rules! check {
        ($name:literal, $variant:ident, $values:expr) => {
            let values = $values;
            let text = values.map(|value| value.to_string()).join(" ");
            let bytes = file("", &points(concat!("type=\"", $name, "\" format=\"ascii\""), &text), b"");
            assert_eq!(*load_bytes(&bytes).unwrap().samples(), Samples::$variant(values.to_vec()));
        };
    }
    check!("Int8", I8, [-128i8, -1, 0, 1, 2, 3, 4, 127]);
    check!("UInt8", U8, [0u8, 1, 2, 3, 4, 5, 6, 255]);
    check!("Int16", I16, [-32768i16, -1, 0, 1, 2, 3, 4, 32767]);
    check!("UInt16", U16, [0u16, 1, 2, 3, 4, 5, 6, 65535]);
    check!("Int32", I32, [i32::MIN, -1, 0, 1, 2, 3, 4, i32::MAX]);
    check!("UInt32", U32, [0u32, 1, 2, 3, 4, 5, 6, u32::MAX]);
    check!("Int64", I32, [i32::MIN, -1, 0, 1, 2, 3, 4, i32::MAX]);
    check!("UInt64", F64, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 1099511627776.0]);
    check!("Float32", F32, [-1.5f32, 0.1, 1e-30, 1e30, 0.0, 1.0, 2.0, 3.0]);
    check!("Float64", F64, [-1.5f64, 0.1, 1e-300, 1e300, 0.0, 1.0, 2.0, 3.0]);
}

#[test]
fn the_grid_lies_where_the_file_says() {
    let volume = load_bytes(plain_file().as_bytes()).unwrap();
    assert_eq!((volume.dims(), volume.name()), ([2; 3], "v"));
    assert!(!volume.is_anatomical() && !volume.has_unknown_scale());
    assert_eq!(volume.spacing_mm(), DVec3::new(0.5, 1.0, 2.0));
    let place = |from: &str, to: &str| {
        let text = plain_file().replace(from, to);
        load_bytes(text.as_bytes()).unwrap().world_from_index()
    };
    assert_eq!(place("", "").translation, DVec3::new(1.0, 2.0, 3.0));
    // The point with index 0 is at the origin.
    let shifted = place("0 1 0 1 0 1", "4 5 -2 -1 0 1");
    assert_eq!(shifted.translation, DVec3::new(3.0, 0.0, 3.0));
    // The matrix is written row by row.
    let turned = place("Origin=", "Direction=\"0 -1 0 1 0 0 0 0 1\" Origin=");
    assert_eq!(turned.matrix3.x_axis, DVec3::new(0.0, 0.5, 0.0));
    assert_eq!(turned.matrix3.y_axis, DVec3::new(-1.0, 0.0, 0.0));
    let mirrored = place("Spacing=\"0.5", "Spacing=\"-0.5");
    assert_eq!(mirrored.matrix3.x_axis, DVec3::new(-0.5, 0.0, 0.0));
    let unknown = plain_file().replace("Spacing=", "Other=");
    assert!(load_bytes(unknown.as_bytes()).unwrap().has_unknown_scale());
    let flat = plain_file().replace("Spacing=\"0.5 1 2\"", "Spacing=\"0.5 1 0\"");
    let flat = load_bytes(flat.as_bytes()).unwrap();
    assert_eq!(flat.spacing_mm(), DVec3::new(0.5, 1.0, 1.0));
    assert!(!flat.remarks().is_empty());
}

#[test]
fn values_of_cells_lie_in_their_middle() {
    let text = plain_file().replace("PointData", "CellData").replace("0 1 0 1 0 1", "0 2 0 2 0 2");
    let volume = load_bytes(text.as_bytes()).unwrap();
    assert_eq!((volume.dims(), volume.samples()), ([2; 3], &Samples::U8(VOXELS.to_vec())));
    assert_eq!(volume.world_from_index().translation, DVec3::new(1.25, 2.5, 4.0));
    let flat = text.replace("0 2 0 2 0 2", "0 2 0 4 7 7");
    let volume = load_bytes(flat.as_bytes()).unwrap();
    assert_eq!((volume.dims(), volume.world_from_index().translation.z), ([2, 4, 1], 17.0));
}

#[test]
fn one_of_several_arrays_is_chosen() {
    let array = |name: &str, text: &str| {
        format!("<DataArray type=\"UInt8\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
    };
    let arrays = format!(
        "<PointData Scalars=\"b\">{}{}{}<DataArray type=\"String\" Name=\"s\"/></PointData><CellData>{}</CellData>",
        array("vtkGhostType", "0 0 0 0 0 0 0 0"),
        array("wind & rain", "1 2 3 4 5 6 7 8"),
        array("b", "1 1 1 1 1 1 1 2"),
        array("c", "9"),
    );
    let bytes = file("", &arrays, b"");
    assert_refused(
        load_bytes(&bytes),
        LoadErrorKind::BadInput,
        &["3 arrays", "--array", "0 \"wind & rain\" (2 x 2 x 2)", "2 \"c\" (1 x 1 x 1)"],
    );
    let choose = |key: &str| VolumeChoice::default().with_selected(FileDimension::Array, key);
    let first = load_bytes_as(&bytes, choose("0")).unwrap();
    assert_eq!((first.samples(), first.name()), (&Samples::U8(VOXELS.to_vec()), "v wind & rain"));
    let second = load_bytes_as(&bytes, choose("b")).unwrap();
    assert_eq!(*second.samples(), Samples::U8(vec![1, 1, 1, 1, 1, 1, 1, 2]));
}

#[test]
fn the_only_array_of_single_numbers_is_opened() {
    let array = |name: &str, components: usize, first: usize| {
        let numbers: Vec<_> = (0..8 * components).map(|at| (first + at).to_string()).collect();
        format!(
            "<DataArray Name=\"{name}\" type=\"UInt8\" NumberOfComponents=\"{components}\" format=\"ascii\">{}\
             </DataArray>",
            numbers.join(" ")
        )
    };
    let of = |arrays: &[String]| file("", &format!("<PointData>{}</PointData>", arrays.concat()), b"");
    let (velocity, pressure, rgb) = (array("velocity", 3, 0), array("pressure", 1, 100), array("rgb", 3, 50));
    let one = of(&[velocity.clone(), pressure.clone(), rgb.clone()]);
    let found = load_bytes(&one).unwrap();
    assert_eq!((found.value(0, 0, 0), found.name()), (100.0, "v pressure"));
    let chosen = VolumeChoice::default().with_selected(FileDimension::Array, "velocity");
    assert_eq!(load_bytes_as(&one, chosen).unwrap().name(), "v velocity");
    // The user chooses among two arrays of single numbers, and among vectors if there is none.
    for several in [of(&[velocity.clone(), pressure, array("t", 1, 0)]), of(&[velocity, rgb])] {
        assert_refused(load_bytes(&several), LoadErrorKind::BadInput, &["--array"]);
    }
}

#[test]
fn several_components_make_one_value() {
    let with = |kind: &str, components: usize, component: Option<usize>| {
        let numbers: Vec<_> = (0..8 * components).map(|at| (3 + at % components).to_string()).collect();
        let text = numbers.join(" ");
        let attributes = format!("type=\"{kind}\" NumberOfComponents=\"{components}\" format=\"ascii\"");
        let choice = VolumeChoice { component, ..VolumeChoice::default() };
        load_bytes_as(&file("", &points(&attributes, &text), b""), choice)
    };
    assert_eq!(*with("Float32", 2, None).unwrap().samples(), Samples::F32(vec![5.0; 8]));
    assert_eq!(*with("Int16", 3, Some(2)).unwrap().samples(), Samples::I16(vec![5; 8]));
    let color = with("UInt8", 4, None).unwrap();
    assert_eq!(*color.samples(), Samples::U8(vec![4; 8]));
    assert!(color.remarks()[0].contains("luminance"));
    assert_refused(with("Int16", 3, Some(3)), LoadErrorKind::BadInput, &["3 components", "0 to 2"]);
}

#[test]
fn unsupported_compressor_is_refused_where_used() {
    let root = "compressor=\"vtkLZMADataCompressor\"";
    let text = points("type=\"UInt8\" format=\"ascii\"", "1 2 3 4\n5 6 7 8");
    assert_eq!(*load_bytes(&file(root, &text, b"")).unwrap().samples(), Samples::U8(VOXELS.to_vec()));
    let packed = points("type=\"UInt8\" format=\"binary\"", "AQAAAAgAAAAAAAAADAAAAA==");
    assert_refused(load_bytes(&file(root, &packed, b"")), LoadErrorKind::BadInput, &["LZMA", "uncompressed"]);
}

#[test]
fn what_cannot_be_read_is_named() {
    for (from, to, words) in [
        ("type=\"ImageData\"", "type=\"UnstructuredGrid\"", &["UnstructuredGrid", "Resample"][..]),
        ("type=\"ImageData\"", "type=\"PImageData\"", &["pieces", "ParaView"]),
        ("Extent=\"0 1 0 1 0 1\"", "Extent=\"0 1 0 1\"", &["Extent"]),
        ("Extent=\"0 1 0 1 0 1\"", "Extent=\"0 -1 0 1 0 1\"", &["Extent"]),
        ("Origin=\"1 2 3\"", "Origin=\"1 2 x\"", &["Origin"]),
        ("type=\"ImageData\"", "type=\"ImageData\" byte_order=\"Middle\"", &["byte_order", "Middle"]),
        ("type=\"ImageData\"", "type=\"ImageData\" header_type=\"UInt16\"", &["header_type"]),
        ("UInt8", "Bit", &["no array"]),
        ("Name=\"a\"", "NumberOfComponents=\"0\"", &["NumberOfComponents"]),
        ("Name=\"a\"", "NumberOfTuples=\"7\"", &["no array"]),
        ("ascii", "hex", &["format"]),
        ("ascii", "appended", &["offset"]),
        ("format=\"ascii\"", "format=\"appended\" offset=\"0\"", &["AppendedData", "missing"]),
        ("1 2 3 4", "1 2 3 x", &["\"x\"", "uint8"]),
        ("1 2 3 4", "1 2 3 256", &["256"]),
        ("1 2 3 4", "1 2", &["truncated"]),
        ("1 2 3 4\n5 6 7 8", "", &["truncated"]),
        ("</Piece>", "</Piece><Piece/>", &["2 pieces"]),
        ("</Piece>", "", &["not well-formed XML"]),
    ] {
        let text = plain_file();
        assert!(text.contains(from), "{from}");
        assert_refused(load_bytes(text.replace(from, to).as_bytes()), LoadErrorKind::BadInput, words);
    }
    let cut = &plain_file()[..200];
    assert_refused(load_bytes(cut.as_bytes()), LoadErrorKind::BadInput, &["not well-formed XML"]);
    let huge = plain_file().replace("0 1 0 1 0 1", "0 99999 0 99999 0 99999");
    assert_refused(load_bytes(huge.as_bytes()), LoadErrorKind::Limit, &["100000 x 100000"]);
    let large = plain_file().replace("0 1 0 1 0 1", "0 99 0 99 0 9");
    assert_refused(load_bytes(large.as_bytes()), LoadErrorKind::BadInput, &["truncated", "100000 numbers"]);
    let most = format!("{} {} 0 0 0 0", i64::MIN, i64::MAX);
    let most = plain_file().replace("0 1 0 1 0 1", &most);
    assert_refused(load_bytes(most.as_bytes()), LoadErrorKind::BadInput, &["Extent"]);
}

#[test]
fn inconsistent_headers_are_refused() {
    let appended = points("type=\"UInt8\" format=\"appended\" offset=\"0\"", "");
    let read = |root: &str, bytes: &[u8]| {
        let data = [b"<AppendedData encoding=\"raw\">_", bytes].concat();
        // The file ends with its data.
        let whole = file(root, &appended, &data);
        load_bytes(&whole[..whole.len() - "\n</VTKFile>\n".len()])
    };
    let with = |header: &[u64], data: &[u8]| [words(false, Endian::Little, header).as_slice(), data].concat();
    let bad = LoadErrorKind::BadInput;
    assert_eq!(*read("", &with(&[8], &VOXELS)).unwrap().samples(), Samples::U8(VOXELS.to_vec()));
    assert_refused(read("", &with(&[9], &[0; 9])), bad, &["8 bytes", "announces 9"]);
    assert_refused(read("", &with(&[8], &VOXELS[..5])), bad, &["truncated", "5 found"]);
    assert_refused(read("", &[8, 0]), bad, &["header"]);
    let zlib_root = "compressor=\"vtkZLibDataCompressor\"";
    let packed = zlib(&VOXELS);
    let length = packed.len() as u64;
    for (header, data, words) in [
        (&[1u64, 8, 0, length][..], &packed[..], &[][..]),
        (&[1, 8, 8, length], &packed[..], &[]),
        (&[2, 8, 0, length, length], &packed[..], &["2 blocks"]),
        (&[0, 8, 0], &[], &["0 blocks"]),
        (&[u64::from(u32::MAX), u64::from(u32::MAX), 0], &[], &["announces"]),
        (&[1, 4, 8, length], &packed[..], &["announces"]),
        (&[1, 8, 0, length + 1], &packed[..], &["truncated"]),
        (&[1, 8, 0, 1 << 30], &packed[..], &["cannot take"]),
        (&[1, 8, 0, length - 3], &packed[..], &["block"]),
        (&[1, 8, 0], &[], &["header"]),
    ] {
        let result = read(zlib_root, &with(header, data));
        match words {
            [] => assert_eq!(*result.unwrap().samples(), Samples::U8(VOXELS.to_vec()), "{header:?}"),
            words => assert_refused(result, bad, words),
        }
    }
    for (bytes, words) in [(&VOXELS[..7], "expands to 7"), (&[1; 9], "expands to 9")] {
        let packed = zlib(bytes);
        let result = read(zlib_root, &with(&[1, 8, 0, packed.len() as u64], &packed));
        assert_refused(result, bad, &[words]);
    }
    let lz4_root = "compressor=\"vtkLZ4DataCompressor\"";
    for bytes in [&[0x50, 1, 2][..], &[0x90, 1, 2, 3, 4, 5, 6, 7, 8, 9], &[0xff; 8], &[]] {
        let result = read(lz4_root, &with(&[1, 8, 0, bytes.len() as u64], bytes));
        assert_refused(result, bad, &["block"]);
    }
    let inline = points("type=\"UInt8\" format=\"binary\"", "CAAAAAECAwQ?");
    assert_refused(load_bytes(&file("", &inline, b"")), bad, &["'?'"]);
}

#[test]
fn blocks_are_counted_with_the_volume() {
    let appended = points("type=\"UInt8\" format=\"appended\" offset=\"0\"", "");
    let read = |size: usize| {
        let (header, data) = blocks(false, Endian::Little, &vec![7; 600_000], size, zlib);
        let data = [b"<AppendedData encoding=\"raw\">_", header.as_slice(), &data].concat();
        let whole = file("compressor=\"vtkZLibDataCompressor\"", &appended, &data);
        // On bytes, since the blocks are not UTF-8.
        let at = |from: &[u8]| whole.windows(from.len()).position(|part| part == from).unwrap();
        let (extent, end) = (at(b"WholeExtent"), at(b"Origin"));
        let piece = at(b"<Piece Extent");
        let image = [
            &whole[..extent],
            b"WholeExtent=\"0 99 0 99 0 59\" ",
            &whole[end..piece],
            b"<Piece>",
            &whole[piece + b"<Piece Extent=\"0 1 0 1 0 1\">".len()..],
        ];
        load_bytes(&image.concat())
    };
    assert_eq!(*read(32 << 10).unwrap().samples(), Samples::U8(vec![7; 600_000]));
    // Of the budget of 1 MiB, the volume takes 586 KiB.
    assert_refused(read(600_000), LoadErrorKind::Limit, &["compressed block", "1.1 MiB", "smaller blocks"]);
}

#[test]
fn xml_that_would_take_long_is_refused() {
    // As the whole file, and inside an otherwise valid image.
    let both = |text: &str| {
        let arrays = points("type=\"UInt8\" format=\"ascii\"", "1 2 3 4 5 6 7 8") + text;
        [text.as_bytes().to_vec(), file("", &arrays, b"")]
    };
    for (_, text) in slow_texts("VTKFile") {
        for bytes in both(&text) {
            // Deep nesting and long markup are refused while the file is scanned.
            let said = load_bytes(&bytes).unwrap_err().to_string();
            assert!(
                ["1 MiB", "deep", "attributes and namespaces"].iter().any(|why| said.contains(why)),
                "{said}"
            );
        }
    }
    let texts = [nested_namespaces("VTKFile", 4000), many_attributes("VTKFile", 40_000)];
    for (text, words) in texts.iter().zip(["4001 namespaces", "40000 attributes"]) {
        for bytes in both(text) {
            assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &["markup", words]);
        }
    }
}
