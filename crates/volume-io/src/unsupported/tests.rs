//! Tests that every known but unsupported format is recognised by its bytes, whatever its name, and refused with a
//! helpful command.

use std::path::Path;

use super::super::tests::helpers::{assert_refused, gzip, load_bytes, load_path};
use super::super::{LoadOptions, RawFormat, load};
use chiaroscuro_volume::{LoadControl, LoadErrorKind, VolumeChoice, VoxelType};

/// Pads the beginning of a file with bytes.
fn file(start: &[u8]) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.resize(start.len().max(2048), 7);
    bytes
}

/// Builds a file with these first bytes, and others at an offset.
fn with(start: &[u8], at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut made = file(start);
    made[at..at + bytes.len()].copy_from_slice(bytes);
    made
}

/// Builds an OLE 2 compound file whose directory, in the second sector, has these names.
fn compound(names: &[&str]) -> Vec<u8> {
    let mut bytes = with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", 30, &9u16.to_le_bytes());
    bytes[48..52].copy_from_slice(&1u32.to_le_bytes());
    bytes.truncate(1024);
    for name in names {
        let mut entry: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        entry.resize(128, 0);
        bytes.extend(entry);
    }
    bytes
}

/// Sample file of a format, and words of the error message.
struct UnsupportedSample {
    name: &'static str,
    bytes: Vec<u8>,
    words: &'static [&'static str],
}

fn example(name: &'static str, bytes: Vec<u8>, words: &'static [&'static str]) -> UnsupportedSample {
    UnsupportedSample { name, bytes, words }
}

/// One sample of each format that is recognised by content.
fn files() -> Vec<UnsupportedSample> {
    const ZIP: &[u8] = b"PK\x03\x04";
    let stl = [&[b'x'; 80][..], &2u32.to_le_bytes(), &[1; 100]].concat();
    vec![
        example("MATLAB 5", file(b"MATLAB 5.0 MAT-file, Platform"), &["MATLAB", "scipy.io"]),
        example("NetCDF", file(b"CDF\x01\0\0"), &["NetCDF", "xarray"]),
        example("MINC 1", with(b"CDF\x01", 300, b"MINC standard variable"), &["MINC 1", "mnc2nii"]),
        example("HDF4", file(b"\x0e\x03\x13\x01"), &["HDF4", "h4toh5"]),
        example("CZI", file(b"ZISRAWFILE"), &["CZI", "bfconvert"]),
        example("LIF", with(b"\x70\0\0\0\x40\0\0\0\x2a\x20\0\0\0<\0L\0", 40, b"M\0"), &["LIF", "bfconvert"]),
        example("ND2", file(b"\xda\xce\xbe\x0a"), &["ND2", "bfconvert"]),
        example("TXM", compound(&["Root Entry", "ImageInfo", "ImageData1"]), &["Xradia", "dxchange"]),
        example("OIB", compound(&["Root Entry", "OibInfo.txt"]), &["OIB", "bfconvert"]),
        example("ZVI", compound(&["Root Entry", "Image", "Item(0)"]), &["ZVI", "bfconvert"]),
        example("Word", compound(&["Root Entry", "WordDocument"]), &["document"]),
        example("OLE", compound(&["Root Entry"]), &["OLE 2", "bfconvert"]),
        example("OpenVDB", file(b" BDV\0\0\0\0"), &["OpenVDB", "copyToArray"]),
        example("NanoVDB", file(b"NanoVDB0"), &["NanoVDB", "nanovdb_convert"]),
        example("Amira", file(b"# AmiraMesh BINARY-LITTLE-ENDIAN 2.1"), &["Amira", "Fiji"]),
        example(
            "OpenDX",
            file(b"# a map\nobject 1 class gridpositions counts 9 9 9\n"),
            &["OpenDX", "gridData"],
        ),
        example("SEG-Y", file(b"\xc3\x40\xf1\x40"), &["SEG-Y", "segyio"]),
        example("GRIB", file(b"GRIB"), &["GRIB", "cfgrib"]),
        example("ENVI", file(b"ENVI\ndescription = {"), &["ENVI", "gdal_translate"]),
        example("AVW", file(b"AVW_ImageFile   1.00"), &["AVW", "NIfTI"]),
        example("MRtrix", file(b"mrtrix image\n"), &["MRtrix", "mrconvert"]),
        example("AFNI", file(b"\ntype = string-attribute\nname = HISTORY"), &["AFNI", "3dAFNItoNIFTI"]),
        example("PAR", file(b"# === DATA DESCRIPTION FILE ====="), &["Philips", "dcm2niix"]),
        example("Bruker", file(b"##TITLE=Parameter List, ParaVision"), &["Bruker", "brkraw"]),
        example("Interfile", file(b"!INTERFILE :="), &["Interfile", "medcon"]),
        example("ECAT", file(b"MATRIX72v"), &["ECAT", "medcon"]),
        example("Scanco", file(b"CTDATA-HEADER_V1"), &["Scanco", "itk"]),
        example("STL", file(b"solid part\n facet normal 0 0 1"), &["surface (STL)", "trimesh"]),
        example("PLY", file(b"ply\nformat ascii 1.0"), &["surface (PLY)", "trimesh"]),
        example(
            "OBJ",
            file(b"# of a program\nmtllib a.mtl\nv 1.0 2.0 -3\nv 1 1 1\n"),
            &["surface (OBJ)", "trimesh"],
        ),
        example("glTF", file(b"glTF\x02\0\0\0"), &["glTF", "trimesh"]),
        example(
            "FreeSurfer",
            with(b"\xff\xff\xfe", 3, b"created by somebody"),
            &["surface of FreeSurfer", "mgz"],
        ),
        example("GIFTI", file(b"<?xml version=\"1.0\"?>\n<!DOCTYPE GIFTI><GIFTI>"), &["GIFTI"]),
        example(
            "Git LFS",
            file(b"version https://git-lfs.github.com/spec/v1\n"),
            &["Git LFS", "git lfs pull"],
        ),
        example("git-annex", file(b"/annex/objects/MD5E-s1--2.nii.gz"), &["git-annex", "datalad get"]),
        example("a page", file(b"\n <!DOCTYPE html><html>"), &["web page", "download"]),
        example("PDF", file(b"%PDF-1.7"), &["PDF", "pdfimages"]),
        example("DOCX", with(ZIP, 30, b"[Content_Types].xml"), &["Office document"]),
        example("GIF", file(b"GIF89a"), &["GIF", "ffmpeg"]),
        example("MPEG-4", file(b"\0\0\0\x20ftypisom"), &["video", "ffmpeg"]),
        example("WebP", file(b"RIFF\0\0\0\0WEBP"), &["WebP", "dwebp"]),
        example("AVI", file(b"RIFF\0\0\0\0AVI "), &["AVI", "ffmpeg"]),
        example("JPEG 2000", file(b"\0\0\0\x0cjP  \r\n\x87\n"), &["JPEG 2000", "opj_decompress"]),
        example("Zarr in ZIP", with(ZIP, 300, b"a.zarr/.zattrs"), &["OME-Zarr", ".zarr.zip"]),
        example("ZIP", with(ZIP, 30, b"slice1.dcm"), &["ZIP archive", "unzip"]),
        example("tar", with(b"slice1.dcm", 257, b"ustar\x0000"), &["tar archive", "tar -xf"]),
        example("7-Zip", file(b"7z\xbc\xaf\x27\x1c"), &["7-Zip", "7z x"]),
        example("RAR", file(b"Rar!\x1a\x07\0"), &["RAR", "unrar"]),
        example("xz", file(b"\xfd7zXZ\0"), &["xz -d"]),
        example("Zstandard", file(b"\x28\xb5\x2f\xfd"), &["zstd -d"]),
        example("bzip2", file(b"BZh9\x31\x41\x59\x26\x53\x59"), &["bunzip2"]),
        example("LZ4", file(b"\x04\x22\x4d\x18"), &["lz4 -d"]),
        example("gzip twice", gzip(&gzip(&[7; 100])), &["twice", "gunzip"]),
        // Recognised by name, with length or content.
        example("part.stl", stl, &["surface (STL)", "trimesh"]),
        example("scan.vsi", b"II*\0\x08\0\0\0\0\0\0\0\0\0".to_vec(), &["VSI", "bfconvert"]),
        example("scan.Z", file(b"\x1f\x9d\x90"), &["compress", "uncompress"]),
    ]
}

#[test]
fn formats_are_named_by_their_bytes_with_a_command_that_helps() {
    for UnsupportedSample { name, bytes, words } in files() {
        let names = match name {
            named if named.contains('.') && !named.contains(' ') => vec![named],
            // Whatever the extension: none, an unknown one, or that of a supported format.
            _ => vec!["it", "it.xyz", "it.raw", "it.nrrd"],
        };
        for called in names {
            let error = load_bytes(called, &bytes, VolumeChoice::default()).unwrap_err();
            let said = error.to_string();
            assert_eq!(error.kind(), LoadErrorKind::BadInput, "{name}: {said}");
            assert!(error.is_about("format") && !said.contains("describe its voxels"), "{name}: {said}");
            assert!(words.iter().all(|word| said.contains(word)), "{name} as {called}: {words:?} in {said}");
            assert!(!said.contains('\n') && said.len() < 700, "{name}: {said}");
        }
    }
}

#[test]
fn inside_gzip_they_are_told_as_well() {
    let tar = with(b"slice1.dcm", 257, b"ustar\x0000");
    assert_refused(
        load_bytes("x.tgz", &gzip(&tar), VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["tar archive"],
    );
}

#[test]
fn names_tell_where_bytes_say_nothing() {
    for (name, words) in [
        ("scan.vol", ["VGStudio", "--dims"]),
        ("scan.vgi", ["VGI", "--dims"]),
        ("scan.VGL", ["VGL", "TIFF"]),
        ("scan.czi", ["CZI", "bfconvert"]),
        ("scan.oif", ["OIF", "bfconvert"]),
        ("scan.dm4", ["Gatan", "dm2mrc"]),
        ("scan+orig.BRIK", ["AFNI", "3dAFNItoNIFTI"]),
        ("2dseq", ["Bruker", "brkraw"]),
        ("brain.vmr", ["BrainVoyager", "NIfTI"]),
    ] {
        let refused = load_bytes(name, &[3; 700], VolumeChoice::default());
        assert_refused(refused, LoadErrorKind::BadInput, &words);
    }
    assert_refused(
        load_bytes("notes.xyz", &[3; 700], VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["its format is not supported"],
    );
}

#[test]
fn folders_are_named_too() {
    let folder = tempfile::tempdir().unwrap();
    for (name, marks, words) in
        [("x.n5", ["attributes.json", "s0"], ["N5", "Fiji"]), ("7", ["acqp", "method"], ["Bruker", "brkraw"])]
    {
        let path = folder.path().join(name);
        std::fs::create_dir(&path).unwrap();
        for mark in marks {
            std::fs::write(path.join(mark), "{}").unwrap();
        }
        assert_refused(load_path(&path, VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    }
}

#[test]
fn bare_voxels_that_begin_like_another_format_are_read_where_they_are_described() {
    let folder = tempfile::tempdir().unwrap();
    for UnsupportedSample { name, bytes, .. } in files() {
        // Except those that RAW would not read as stored: gzip is inflated.
        if name == "gzip twice" || name == "scan.vsi" {
            continue;
        }
        let path = folder.path().join("odd.bin");
        std::fs::write(&path, &bytes).unwrap();
        let raw = RawFormat {
            dims: Some([bytes.len(), 1, 1]),
            voxel_type: Some(VoxelType::U8),
            ..RawFormat::default()
        };
        let options = LoadOptions { raw, ..LoadOptions::default() };
        let volume = load(&path, &options, &LoadControl::new());
        assert!(volume.is_ok_and(|volume| volume.dims() == [bytes.len(), 1, 1]), "{name} by options");
        let named = folder.path().join(format!("odd_{}x1x1_uint8.raw", bytes.len()));
        std::fs::write(&named, &bytes).unwrap();
        assert!(load_path(&named, VolumeChoice::default()).is_ok(), "{name} by its name");
    }
    assert!(super::unsupported_folder(Path::new("nowhere")).is_none());
}

/// Returns the row of a format in the table of docs/FORMATS.md.
fn documented_row(format: &super::UnsupportedFormat) -> String {
    let name = format.description.trim_start_matches("an ").trim_start_matches("a ");
    let mut letters = name.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let endings: Vec<String> = format.extensions.iter().map(|ending| format!("`{ending}`")).collect();
    let endings = if endings.is_empty() { "by content".to_owned() } else { endings.join(" ") };
    let advice = format.advice.replace('|', "\\|");
    format!("| {first}{} | {} | {advice} |", letters.as_str(), endings)
}

#[test]
fn the_documentation_names_every_refused_format_with_its_extensions_and_what_helps() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/FORMATS.md");
    let text = std::fs::read_to_string(path).unwrap();
    let folders = super::folders::FOLDERS.iter().map(|(_, format)| format).chain([&super::hdf5::MINC_2]);
    let missing: Vec<String> =
        super::all().chain(folders).map(documented_row).filter(|row| !text.contains(row)).collect();
    assert!(missing.is_empty(), "docs/FORMATS.md lacks these rows:\n{}", missing.join("\n"));
}
