//! Tests with files of every writer of this program, and files of other programs that only mention it.

use std::path::Path;

use chiaroscuro_files::{MAX_LOOK_BYTES, PROVENANCE_MARK, is_written_by_us};
use chiaroscuro_files::{provenance_mark, with_provenance_mark};
use chiaroscuro_media::{
    Animation, AnimationSpec, ExportError, PixelRows, encode_png, export_png, write_picture,
};
use chiaroscuro_scene::{ImageSpec, LookRecord, PixelFormat, Settings};
use chiaroscuro_volume::{Samples, Volume};
use chiaroscuro_volume_io::write::{ExportVolume, VolumeFormat, write_volume};

/// Returns true if a file with these contents is recognised as this program's.
fn is_ours_with(contents: impl AsRef<[u8]>) -> bool {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("file");
    std::fs::write(&path, contents).expect("the file can be written");
    is_written_by_us(&path)
}

/// Checks that contents are recognised, and are not after truncation before the mark or a change of it: nothing but
/// the mark decides.
fn check_ours(contents: &[u8]) {
    assert!(is_ours_with(contents));
    let mark = PROVENANCE_MARK.as_bytes();
    let at = contents.windows(mark.len()).position(|window| window == mark).expect("the mark");
    for end in 1..at {
        assert!(!is_ours_with(&contents[..end]), "{end} of {}", contents.len());
    }
    let mut others = contents.to_vec();
    others[at] ^= 1;
    assert!(!is_ours_with(&others));
}

#[test]
fn pictures_of_ours_are_known() {
    let folder = tempfile::tempdir().unwrap();
    check_ours(&encode_png([2, 1], png::ColorType::Rgb, &[0; 6], None).unwrap());
    for (name, depth) in [("a.png", PixelFormat::Sixteen), ("a.exr", PixelFormat::Linear)] {
        let path = folder.path().join(name);
        let image_spec = ImageSpec { depth, ..ImageSpec::new([2, 1]) };
        let mut rows = [PixelRows::Floats(vec![0.5; 8])].into_iter();
        let written: Result<(), ExportError> =
            write_picture(&path, &image_spec, None, &mut || Ok(rows.next()));
        written.unwrap();
        check_ours(&std::fs::read(&path).unwrap());
    }
}

#[test]
fn volumes_of_ours_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let volume = Volume::with_spacing("t", [2, 1, 1], glam::DVec3::ONE, Samples::U8(vec![1, 2])).unwrap();
    // Includes an axis too long for NIfTI-1.
    let long = Samples::U8((0..40_000).map(|at| at as u8).collect());
    let long = Volume::with_spacing("t", [40_000, 1, 1], glam::DVec3::ONE, long).unwrap();
    for (name, volume) in
        [("a.nrrd", &volume), ("a.mha", &volume), ("a.nii", &volume), ("b.nii", &long)].into_iter().chain([
            ("a.tif", &volume),
            ("a.vti", &volume),
            ("a.nii.gz", &volume),
            ("a.npy", &volume),
            ("a.ozx", &volume),
        ])
    {
        let path = folder.path().join(name);
        let format = VolumeFormat::from_path(&path).unwrap();
        write_volume(&path, format, &ExportVolume::new(volume), false).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        match name {
            // The format has no metadata for a mark.
            "a.npy" => assert!(!is_written_by_us(&path)),
            "a.nii.gz" => {
                assert!(is_written_by_us(&path));
                assert!((1..bytes.len() / 2).all(|end| !is_ours_with(&bytes[..end])));
            }
            _ => check_ours(&bytes),
        }
    }
}

#[test]
fn volumes_of_others_that_speak_of_it_are_not_ours() {
    let mark = PROVENANCE_MARK;
    for text in [
        format!("ObjectType = Image\nComment = {mark}\n0018|1020 = another, {mark}\n"),
        format!("ObjectType = Image\nElementDataFile = LOCAL\n\n0018|1020 = {mark}\n"),
        format!("<?xml version=\"1.0\"?>\n<!-- not by {mark} -->\n<VTKFile>"),
        format!("<?xml version=\"1.0\"?>\n<VTKFile><!-- {mark} -->\n"),
    ] {
        assert!(!is_ours_with(&text), "{text}");
    }
    // NIfTI header with the mark as its description, without an extension.
    let mut header = vec![0; 400];
    header[..4].copy_from_slice(&348i32.to_le_bytes());
    header[344..348].copy_from_slice(b"n+1\0");
    header[148..148 + mark.len()].copy_from_slice(mark.as_bytes());
    header[360..360 + mark.len()].copy_from_slice(mark.as_bytes());
    assert!(!is_ours_with(&header));
    // Offsets beyond the end of a TIFF file.
    for bytes in [
        &b"II*\0\xff\xff\xff\xff"[..],
        b"II+\0\x08\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff",
        b"II*\0\x08\0\0\0\xff\xff",
    ] {
        assert!(!is_ours_with(bytes));
    }
}

#[test]
fn films_of_ours_are_known() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.gif"] {
        let path = folder.path().join(name);
        let animation_spec = AnimationSpec { size: [2, 1], frames: 1, rate: 25, transparent: false };
        let mut film = Animation::create(&path, &animation_spec).unwrap();
        // An empty record, since a record would be recognised as well.
        film.add(&[9; 8], "").unwrap();
        film.finish().unwrap();
        check_ours(&std::fs::read(&path).unwrap());
    }
}

#[test]
fn texts_of_ours_are_known() {
    // A session or preset without a mark is from an earlier version.
    assert!(is_ours_with(LookRecord::to_json(&Settings::default(), None, None)));
    check_ours(with_provenance_mark(serde_json::json!({"shadows": {"gain": 2.0}})).to_string().as_bytes());
    check_ours(with_provenance_mark(serde_json::json!({"image_size": [1, 2]})).to_string().as_bytes());
    check_ours(format!("NRRD0005\n# {}\ntype: float\n\n", provenance_mark()).as_bytes());
    assert!(is_ours_with(b""), "an empty file holds nothing");
}

/// Returns an MP4 box with the given type and contents.
fn boxed(kind: [u8; 4], contents: &[u8]) -> Vec<u8> {
    [&(contents.len() as u32 + 8).to_be_bytes(), &kind[..], contents].concat()
}

/// Returns an MP4 box with a 64-bit length.
fn long_box(kind: [u8; 4], contents: &[u8]) -> Vec<u8> {
    [&1_u32.to_be_bytes(), &kind[..], &(contents.len() as u64 + 16).to_be_bytes(), contents].concat()
}

/// Returns the `moov` box of a video with one metadata item.
fn head(item: [u8; 4], text: &str) -> Vec<u8> {
    let data = boxed(*b"data", &[&[0, 0, 0, 1, 0, 0, 0, 0], text.as_bytes()].concat());
    let items = [boxed(*b"\xa9too", &boxed(*b"data", &[0; 12])), boxed(item, &data)].concat();
    let meta = [vec![0; 4], boxed(*b"hdlr", &[0; 25]), boxed(*b"ilst", &items)].concat();
    boxed(*b"moov", &[boxed(*b"mvhd", &[0; 100]), boxed(*b"udta", &boxed(*b"meta", &meta))].concat())
}

#[test]
fn films_in_mp4_are_known_by_their_comment() {
    let kind = boxed(*b"ftyp", b"isom\0\0\x02\0isomiso2");
    let (ours, pixels) = (head(*b"\xa9cmt", &provenance_mark()), boxed(*b"mdat", &[7; 1000]));
    check_ours(&[&kind[..], &ours, &pixels].concat());
    assert!(
        is_ours_with([&kind[..], &long_box(*b"mdat", &vec![7; 500_000]), &ours].concat()),
        "texts at the end"
    );
    for theirs in [
        head(*b"\xa9nam", &provenance_mark()),
        head(*b"\xa9cmt", &format!("made with {}", provenance_mark())),
        boxed(*b"mdat", &ours),
        boxed(*b"free", provenance_mark().as_bytes()),
        // Boxes longer than the file, or with invalid lengths.
        [&[0xff; 4], &b"moov"[..], &ours].concat(),
        [&1_u32.to_be_bytes(), &b"moov"[..], &[0xff; 8], &ours].concat(),
        [&[0, 0, 0, 3], &b"moov"[..], &ours].concat(),
    ] {
        assert!(!is_ours_with([&kind[..], &theirs].concat()));
    }
}

#[test]
fn who_writes_of_the_program_is_not_the_program() {
    let name = provenance_mark();
    for text in [
        name.clone(),
        format!("# {name}\n\nA page about it.\n"),
        format!("From: a@b.c\nSubject: {name}\n"),
        format!("NRRD0004\ntype: float\n# {name}\n\n"),
        format!("NRRD0004\n# unlike {name}\n\n"),
        format!("NRRD0004\n\n# {name}\n"),
        format!(r#"{{"notes": "{name}"}}"#),
        format!(r#"{{"notes": {{"_made_by": "{name}"}}}}"#),
        format!(r#"{{"_made_by": "not {name}"}}"#),
        format!(r#"{{"_made_by": "{PROVENANCE_MARK}s"}}"#),
        format!(r#"{{"_made_by": ["{name}"]}}"#),
        format!(r#"{{"_made_by": "{name}""#),
        format!(r#"["_made_by", "{name}"]"#),
        format!(r#"{{"schema": 1, "notes": {{"camera": {{}}, "shadows": {{}}, "of": "{name}"}}}}"#),
    ] {
        assert!(!is_ours_with(&text), "{text}");
    }
}

/// Returns a copy of a file in which `from` has been replaced by `to`, of equal length.
fn swapped(contents: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let at = contents.windows(from.len()).position(|window| window == from).expect("the bytes are there");
    [&contents[..at], to, &contents[at + from.len()..]].concat()
}

#[test]
fn pictures_that_hold_the_mark_elsewhere_are_of_others() {
    let plain = encode_png([2, 1], png::ColorType::Rgb, &[0; 6], None).unwrap();
    // In another text, in a private chunk, and after the pixels.
    for (from, to) in [(&b"tEXtSoftware"[..], &b"tEXtComments"[..]), (b"tEXtSoftware", b"prVtSoftware")] {
        assert!(!is_ours_with(swapped(&plain, from, to)));
    }
    assert!(is_ours_with(swapped(&plain, b"IDAT", b"prVt")), "no chunk but pixels ends the search");
    let at = plain.windows(4).position(|window| window == b"tEXt").unwrap() - 4;
    let length = u32::from_be_bytes(plain[at..at + 4].try_into().unwrap()) as usize + 12;
    let (mark, rest) = (&plain[at..at + length], [&plain[..at], &plain[at + length..]].concat());
    assert!(!is_ours_with([&rest[..], mark].concat()));
    // As pixels, which are stored uncompressed.
    let line = [PROVENANCE_MARK.as_bytes(), &[0; 2]].concat();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, line.len() as u32, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_deflate_compression(png::DeflateCompression::NoCompression);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&line).unwrap();
    writer.finish().unwrap();
    assert!(
        png.windows(PROVENANCE_MARK.len()).any(|window| window == PROVENANCE_MARK.as_bytes())
            && !is_ours_with(&png)
    );
    // An application extension of a GIF; another attribute of an EXR.
    let gif = |kind: u8| {
        let text = provenance_mark();
        [&b"GIF89a\x01\0\x01\0\0\0\0\x21"[..], &[kind, text.len() as u8], text.as_bytes(), b"\0\x3b"].concat()
    };
    assert!(is_ours_with(gif(0xfe)) && !is_ours_with(gif(0xff)));
    let exr = |name: &str, kind: &str| {
        let length = (provenance_mark().len() as u32).to_le_bytes();
        let words = [name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat();
        [&b"\x76\x2f\x31\x01\x02\0\0\0"[..], &words, &length, provenance_mark().as_bytes(), b"\0"].concat()
    };
    assert!(is_ours_with(exr("software", "string")));
    assert!(!is_ours_with(exr("comments", "string")) && !is_ours_with(exr("software", "opaque")));
}

#[test]
fn files_of_earlier_versions_are_known() {
    // Without the mark, but with a record.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    export_png([1, 1], &[0; 4], false, Some("{}"), &path).unwrap();
    let earlier = |path: &Path| {
        let contents = std::fs::read(path).unwrap();
        let unmarked = swapped(&contents, b"Chiaroscuro, the", b"Another one, the");
        (unmarked.clone(), swapped(&unmarked, b"chiaroscuro", b"nameofother"))
    };
    let (ours, theirs) = earlier(&path);
    assert!(is_ours_with(ours) && !is_ours_with(theirs));
    assert!(is_ours_with(b"\x76\x2f\x31\x01\x02\0\0\0chiaroscuro.000\0string\0\x02\0\0\0{}\0"));
    assert!(is_ours_with(br#"{"schema": 1, "camera": {}, "shadows": {}}"#));
    for (contents, what) in [
        (&br#"{"camera": {}, "shadows": {}}"#[..], "a part of a look"),
        (br#"{"schema": 1, "camera": {}, "shadows": null}"#, "nothing"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\x0eiTXtTitle\0chiaros", "a title"),
    ] {
        assert!(!is_ours_with(contents), "{what}");
    }
}

#[test]
fn what_is_no_file_or_much_too_long_is_of_others() {
    let folder = tempfile::tempdir().unwrap();
    // Nothing is lost with an empty folder.
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    assert!(!is_written_by_us(folder.path()) && !is_written_by_us(&folder.path().join("none")));
    let long =
        format!(r#"{{"_made_by": "{}", "notes": "{}"}}"#, provenance_mark(), "x".repeat(2 * MAX_LOOK_BYTES));
    assert!(!is_ours_with(long));
}
