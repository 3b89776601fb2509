//! Tests of labels in header extensions.

use tempfile::TempDir;

use super::{NiftiBuilder, gzip, header_348, load_path, nifti1_header, read, write};
use crate::Endian;
use chiaroscuro_volume::{FileLabel, Samples, ValueMeaning, Volume, VolumeChoice};

/// Text of an extension as `TotalSegmentator` writes it.
fn caret_xml(labels: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?> <CaretExtension>  <VolumeInformation Index=\"0\">   \
         <LabelTable>\n{labels}\n  </LabelTable>  </VolumeInformation></CaretExtension>\n              "
    )
}

/// An extension of this content, padded with zeros.
fn extension(endian: Endian, code: u32, content: &str) -> Vec<u8> {
    let size = (content.len() + 8).next_multiple_of(16);
    let fields = [size as u32, code].map(|number| match endian {
        Endian::Little => number.to_le_bytes(),
        Endian::Big => number.to_be_bytes(),
    });
    let mut bytes = [&fields.concat(), content.as_bytes()].concat();
    bytes.resize(size, 0);
    bytes
}

/// A file of the voxels 1 and 2 with extensions before them.
fn file_with(extensions: &[u8]) -> Vec<u8> {
    let header = nifti1_header(&[2, 1, 1], 2).text(348, &[1]).f32(108, &[352.0 + extensions.len() as f32]);
    header.with_data(&[extensions, &[1, 2]].concat())
}

fn label(name: &str, color: Option<[f32; 3]>) -> FileLabel {
    FileLabel { name: name.to_owned(), color }
}

#[track_caller]
fn assert_spleen(volume: &Volume) {
    assert_eq!(volume.metadata().meaning, ValueMeaning::Labels);
    assert_eq!(volume.metadata().labels.get(1), Some(&label("spleen", Some([0.25, 0.5, 1.0]))));
}

const SPLEEN: &str =
    "<Label Key=\"1\" Red=\"0.25\" Green=\"0.5\" Blue=\"1\" Alpha=\"1\"><![CDATA[spleen]]></Label>";

#[test]
fn labels_of_an_extension_have_names_and_colours() {
    let others = "<Label Key='2'> left\nkidney </Label><Label Key='3' Red='7' Green='0' Blue='0'/>\
                  <Label>no key</Label><Label Key='x'>no number</Label><Other Key='4'/>";
    let xml = caret_xml(&format!("{SPLEEN}{others}"));
    let comment = extension(Endian::Little, 6, "a comment");
    let file = file_with(&[comment, extension(Endian::Little, 0, &xml)].concat());
    for file in [file.clone(), gzip(&file)] {
        let volume = read(&file);
        assert_eq!(*volume.samples(), Samples::U8(vec![1, 2]));
        assert_spleen(&volume);
        let labels = &volume.metadata().labels;
        assert_eq!(labels.len(), 3);
        assert!(labels.get(2).is_some_and(|label| label.name.contains("kidney") && label.color.is_none()));
        assert_eq!(labels.get(3), Some(&label("", None)), "a colour out of range is none");
        assert!(!volume.remarks().iter().any(|remark| remark.contains("ignored")));
    }
}

#[test]
fn extensions_of_both_forms_and_byte_orders_are_read() {
    for endian in [Endian::Little, Endian::Big] {
        let bytes = extension(endian, 30, &caret_xml(SPLEEN));
        let one = header_348(endian, &[1, 1, 1], 2, b"n+1\0")
            .text(348, &[1])
            .f32(108, &[352.0 + bytes.len() as f32])
            .with_data(&[&bytes[..], &[1]].concat());
        assert_spleen(&read(&one));
        let two = NiftiBuilder { endian, bytes: vec![0; 544] }
            .i32(0, &[540])
            .text(4, b"n+2\0")
            .i16(12, &[2])
            .i64(16, &[3, 1, 1, 1])
            .i64(168, &[544 + bytes.len() as i64])
            .text(540, &[1])
            .with_data(&[&bytes[..], &[1]].concat());
        assert_spleen(&read(&two));
    }
}

#[test]
fn files_beside_the_volume_precede_extensions_and_fractions_are_no_labels() {
    let bytes = extension(Endian::Little, 0, &caret_xml(SPLEEN));
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "seg.nii", &file_with(&bytes));
    write(&folder, "seg.txt", b"1 Bone 255 0 0 0\n");
    let volume = load_path(&path, VolumeChoice::default()).unwrap();
    assert_eq!(volume.metadata().labels.get(1).map(|label| label.name.as_str()), Some("Bone"));
    let header = nifti1_header(&[1, 1, 1], 16).text(348, &[1]).f32(108, &[352.0 + bytes.len() as f32]);
    let field = read(&header.with_data(&[&bytes[..], &1.5f32.to_le_bytes()].concat()));
    assert!(field.metadata().is_empty(), "an image with a table of labels");
}

#[test]
fn broken_extensions_are_ignored_and_said() {
    let xml = |text: &str| extension(Endian::Little, 0, text);
    let nested = format!("<LabelTable>{}", "<Label>".repeat(1000));
    let entities = "<!DOCTYPE a [<!ENTITY b \"bbb\">]><LabelTable><Label Key='1'>&b;</Label></LabelTable>";
    for extensions in [
        xml("<LabelTable><Label Key='1'>spleen</LabelTable>"),
        xml("<LabelTable"),
        xml(&caret_xml(SPLEEN)[..150]),
        xml(&nested),
        xml(entities),
        [&[7, 0, 0, 0, 0, 0, 0, 0], &[1; 8][..]].concat(),
        [&[0xff; 8], &[1; 8][..]].concat(),
        [&[32, 0, 0, 0, 0, 0, 0, 0], &[1; 8][..]].concat(),
    ] {
        let file = file_with(&extensions);
        for file in [file.clone(), gzip(&file)] {
            let volume = read(&file);
            assert_eq!(*volume.samples(), Samples::U8(vec![1, 2]));
            assert!(volume.metadata().labels.is_empty());
            let said = volume.remarks().iter().any(|remark| remark.contains("is ignored: "));
            assert!(said, "{:?} {:?}", volume.remarks(), &extensions[..16]);
        }
    }
}

#[test]
fn extensions_without_labels_are_silent() {
    let xml = |text: &str| extension(Endian::Little, 0, text);
    let unmarked = {
        let bytes = xml(&caret_xml(SPLEEN));
        let header = nifti1_header(&[2, 1, 1], 2).f32(108, &[352.0 + bytes.len() as f32]);
        header.with_data(&[&bytes[..], &[1, 2]].concat())
    };
    for file in [
        file_with(&[0; 32]),
        file_with(&[1, 2, 3]),
        file_with(&xml("<LabelTable/>")),
        file_with(&xml("\u{feff}no markup & \u{1}")),
        unmarked,
    ] {
        let volume = read(&file);
        assert!(volume.metadata().is_empty());
        assert!(!volume.remarks().iter().any(|remark| remark.contains("ignored")), "{:?}", volume.remarks());
    }
}

#[test]
fn huge_extensions_are_not_read() {
    // Behind a gap of many bytes, and itself beyond the limit.
    let long = format!("{}{}", " ".repeat(2 << 20), caret_xml(SPLEEN));
    let volume = read(&gzip(&file_with(&extension(Endian::Little, 0, &long))));
    assert_eq!(*volume.samples(), Samples::U8(vec![1, 2]));
    assert!(volume.metadata().labels.is_empty());
    assert!(volume.remarks().iter().any(|remark| remark.contains("too long")));
}
