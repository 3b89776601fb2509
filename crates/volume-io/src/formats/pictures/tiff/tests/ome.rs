//! Tests of OME-TIFF: the order of pages, and the size of voxels.

use super::writer::{LITTLE, TiffLeaf};
use super::{assert_refused, load_bytes, load_chosen, load_with};
use crate::formats::pictures::tiff::file::page::tag;
use chiaroscuro_files::xml::slow_texts::slow_texts;
use chiaroscuro_volume::{FileDimension, LoadErrorKind, Modality, Volume, VolumeChoice};

fn page(value: u8) -> TiffLeaf {
    LITTLE.leaf([2, 1], 8, &[value, value])
}

fn file(xml: &str, count: u8) -> Vec<u8> {
    let pages: Vec<TiffLeaf> = (0..count)
        .map(|at| if at == 0 { page(0).with_text(tag::DESCRIPTION, xml) } else { page(at) })
        .collect();
    LITTLE.file(&pages)
}

fn image(name: &str, pixels: &str, inside: &str) -> String {
    format!(
        "<Image ID=\"i\" Name=\"{name}\"><Pixels SizeX=\"2\" SizeY=\"1\" Type=\"uint8\" {pixels}>{inside}</Pixels></Image>"
    )
}

fn document(images: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\" \
         UUID=\"urn:uuid:own\">{images}</OME>"
    )
}

fn firsts(volume: &Volume) -> Vec<f64> {
    (0..volume.dims()[2]).map(|z| volume.value(0, 0, z)).collect()
}

#[test]
fn pages_are_in_the_order_that_is_said() {
    for (order, expected) in [
        ("XYZCT", [9.0, 10.0, 11.0]),
        ("XYZTC", [9.0, 10.0, 11.0]),
        ("XYCZT", [7.0, 9.0, 11.0]),
        ("XYCTZ", [3.0, 7.0, 11.0]),
        ("XYTZC", [7.0, 9.0, 11.0]),
        ("XYTCZ", [3.0, 7.0, 11.0]),
    ] {
        let pixels = format!("DimensionOrder=\"{order}\" SizeZ=\"3\" SizeC=\"2\" SizeT=\"2\"");
        for data in ["", "<TiffData/>", "<TiffData IFD=\"0\" PlaneCount=\"12\"/>"] {
            let bytes = file(&document(&image("a", &pixels, data)), 12);
            let choice = VolumeChoice { channel: Some(1), frame: Some(1), ..VolumeChoice::default() };
            assert_eq!(firsts(&load_chosen(&bytes, choice).unwrap()), expected, "{order} {data}");
        }
    }
    let pixels = "DimensionOrder=\"XYZZT\" SizeZ=\"1\" SizeC=\"1\" SizeT=\"1\"";
    let refused = load_bytes(&file(&document(&image("a", pixels, "")), 1));
    assert_refused(refused, LoadErrorKind::BadInput, &["XYZZT", "DimensionOrder"]);
}

#[test]
fn sizes_channels_and_light_are_understood() {
    let pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"2\" SizeC=\"2\" SizeT=\"1\" PhysicalSizeX=\"0.5\" \
                  PhysicalSizeY=\"500\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"µm\"";
    let channels = "<Channel ID=\"c0\" Name=\"DAPI\" EmissionWavelength=\"460\" Color=\"65535\"/>\
                    <Channel ID=\"c1\" Name=\"GFP\" Color=\"-16711681\"/>";
    let bytes = file(&document(&image("cells", pixels, channels)), 4);
    assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &["0 \"DAPI\" (2 x 1 x 2)", "1 \"GFP\""]);
    let volume = load_chosen(&bytes, VolumeChoice { channel: Some(1), ..VolumeChoice::default() }).unwrap();
    assert_eq!((firsts(&volume), volume.name()), (vec![2.0, 3.0], "cells"));
    assert!((volume.spacing_mm() - glam::DVec3::new(0.5e-3, 0.5e-3, 2e-3)).length() < 1e-12);
    assert_eq!(volume.metadata().modality, Modality::LightMicroscopy);
    assert_eq!(volume.metadata().acquisition(), Some("GFP"));
    let channels = volume.contents().alternatives_in(FileDimension::Channel).unwrap();
    let colors: Vec<_> = channels.offers.iter().map(|channel| channel.color).collect();
    assert_eq!(colors, [Some([0, 0, 255]), Some([255, 0, 255])]);
    let flat = "DimensionOrder=\"XYZCT\" SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"1\" PhysicalSizeY=\"1\"";
    let volume = load_bytes(&file(&document(&image("", flat, "")), 2)).unwrap();
    assert!(volume.has_unknown_scale() && volume.metadata().is_empty() && volume.name() == "stack");
    assert!(volume.remarks().is_empty());
    let wrong = format!("{flat} PhysicalSizeZ=\"-2\"");
    let volume = load_bytes(&file(&document(&image("", &wrong, "")), 2)).unwrap();
    assert!(volume.has_unknown_scale() && volume.remarks()[0].contains("PhysicalSize"));
}

#[test]
fn several_images_are_series() {
    let pixels = |z: u8| format!("DimensionOrder=\"XYZCT\" SizeZ=\"{z}\" SizeC=\"1\" SizeT=\"1\"");
    let first = image("one", &pixels(2), "<TiffData IFD=\"0\" PlaneCount=\"2\"/>");
    let second = image("two", &pixels(3), "<TiffData IFD=\"2\" PlaneCount=\"3\"/>");
    let bytes = file(&document(&(first + &second)), 5);
    assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &["2 series", "\"two\" (2 x 1 x 3)"]);
    for key in ["1", "two"] {
        let choice = VolumeChoice { series: Some(key.to_owned()), ..VolumeChoice::default() };
        assert_eq!(firsts(&load_chosen(&bytes, choice).unwrap()), [2.0, 3.0, 4.0]);
    }
}

#[test]
fn pages_may_lie_in_files_beside() {
    let folder = tempfile::tempdir().unwrap();
    let pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\"";
    let data = |z: u8, file: &str, mark: &str| {
        format!(
            "<TiffData FirstZ=\"{z}\" IFD=\"{z}\"><UUID FileName=\"{file}\">urn:uuid:{mark}</UUID></TiffData>"
        )
    };
    let set = |last: &str| {
        let all = data(0, "old_name.ome.tif", "own") + &data(1, "b.tif", "b") + &data(2, last, "c");
        document(&image("set", pixels, &all))
    };
    let path = folder.path().join("a.ome.tif");
    let write = |xml: &str| std::fs::write(&path, file(xml, 1)).unwrap();
    for name in ["b.tif", "c.tif"] {
        std::fs::write(folder.path().join(name), LITTLE.file(&[page(30), page(31), page(32)])).unwrap();
    }
    write(&set("c.tif"));
    assert_eq!(firsts(&load_with(&path, VolumeChoice::default()).unwrap()), [0.0, 31.0, 32.0]);
    // Opening the folder gives the same volume.
    assert_eq!(firsts(&load_with(folder.path(), VolumeChoice::default()).unwrap()), [0.0, 31.0, 32.0]);
    write(&set("missing.tif"));
    let volume = load_with(&path, VolumeChoice::default()).unwrap();
    assert_eq!(firsts(&volume), [0.0, 31.0], "what is there is shown");
    let remarks = volume.remarks().join("; ");
    assert!(remarks.contains("3 slices are announced, and there are pages for the first 2"), "{remarks}");
    assert!(remarks.contains("\"missing.tif\" is missing"), "{remarks}");
    write(&set("../c.tif"));
    assert_refused(
        load_with(&path, VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["../c.tif", "FileName"],
    );
    // XML in a companion file.
    std::fs::write(folder.path().join("set.companion.ome"), set("c.tif")).unwrap();
    write(
        "<?xml version=\"1.0\"?><OME UUID=\"urn:uuid:own\"><BinaryOnly MetadataFile=\"set.companion.ome\"/></OME>",
    );
    let of_tiff = load_with(&path, VolumeChoice::default()).unwrap();
    assert_eq!(firsts(&of_tiff), [0.0, 31.0, 32.0]);
    // The companion file itself is opened.
    let companion = folder.path().join("set.companion.ome");
    let of_xml = load_with(&companion, VolumeChoice::default()).unwrap();
    assert_eq!(firsts(&of_xml), [31.0, 32.0], "the file that was renamed is not known");
}

#[test]
fn xml_beside_its_files_is_opened_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" \
                  PhysicalSizeZ=\"2\"";
    let data = |z: usize| {
        format!(
            "<TiffData FirstZ=\"{z}\" IFD=\"0\" PlaneCount=\"1\"><UUID FileName=\"p{z}.ome.tif\">urn:uuid:{z}</UUID></TiffData>"
        )
    };
    let xml = document(&image("", pixels, &(0..3).map(data).collect::<String>()));
    let companion = folder.path().join("set.companion.ome");
    std::fs::write(&companion, &xml).unwrap();
    let tiff = |z: usize| folder.path().join(format!("p{z}.ome.tif"));
    for z in 0..3 {
        let xml =
            format!("<OME UUID=\"urn:uuid:{z}\"><BinaryOnly MetadataFile=\"set.companion.ome\"/></OME>");
        std::fs::write(tiff(z), LITTLE.file(&[page(10 * z as u8).with_text(tag::DESCRIPTION, &xml)]))
            .unwrap();
    }
    let of_tiff = load_with(&tiff(1), VolumeChoice::default()).unwrap();
    for path in [companion.as_path(), folder.path()] {
        let volume = load_with(path, VolumeChoice::default()).unwrap();
        assert_eq!(firsts(&volume), [0.0, 10.0, 20.0]);
        assert_eq!(volume.spacing_mm(), of_tiff.spacing_mm());
    }
    // Without the first file, and without any.
    std::fs::remove_file(tiff(0)).unwrap();
    let volume = load_with(&companion, VolumeChoice::default()).unwrap();
    assert_eq!(firsts(&volume), [10.0, 20.0]);
    assert!(volume.remarks().join("; ").contains("pages for 1 to 2 of them"), "{:?}", volume.remarks());
    for z in 1..3 {
        std::fs::remove_file(tiff(z)).unwrap();
    }
    assert_refused(
        load_with(&companion, VolumeChoice::default()),
        LoadErrorKind::Io,
        &["no such file", "p0.ome.tif"],
    );
    for (xml, kind, words) in [
        (document(&image("", pixels, "<TiffData/>")), LoadErrorKind::BadInput, "no TIFF files"),
        (xml.replace("p0.ome.tif", "../p0.ome.tif"), LoadErrorKind::BadInput, "out of the header's folder"),
        (xml.replace("p0.ome.tif", "/etc/hostname"), LoadErrorKind::BadInput, "absolute"),
        (xml[..xml.len() / 2].to_owned(), LoadErrorKind::BadInput, "not well-formed XML"),
    ] {
        std::fs::write(&companion, xml).unwrap();
        assert_refused(load_with(&companion, VolumeChoice::default()), kind, &[words]);
    }
}

#[test]
fn recordings_that_stopped_show_what_is_there() {
    let pixels =
        |z: u8, c: u8, t: u8| format!("DimensionOrder=\"XYZCT\" SizeZ=\"{z}\" SizeC=\"{c}\" SizeT=\"{t}\"");
    for data in ["", "<TiffData/>", "<TiffData IFD=\"0\" PlaneCount=\"10\"/>"] {
        let volume = load_bytes(&file(&document(&image("a", &pixels(10, 1, 1), data)), 6)).unwrap();
        assert_eq!(firsts(&volume), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "{data}");
        assert!(volume.remarks()[0].contains("10 slices are announced, and there are pages for the first 6"));
    }
    // Stopped in the second of four time steps: two are offered, and the second is short.
    let stopped = file(&document(&image("a", &pixels(3, 1, 4), "")), 5);
    assert_refused(load_bytes(&stopped), LoadErrorKind::BadInput, &["2 time steps"]);
    let second = load_chosen(&stopped, VolumeChoice { frame: Some(1), ..VolumeChoice::default() }).unwrap();
    assert_eq!(firsts(&second), [3.0, 4.0]);
    let remarks = second.remarks().join("; ");
    assert!(remarks.contains("4 time steps are announced, and there are pages for the first 2"), "{remarks}");
    assert_refused(
        load_chosen(&stopped, VolumeChoice { frame: Some(3), ..VolumeChoice::default() }),
        LoadErrorKind::BadInput,
        &["\"3\" is not one of its 2 time steps"],
    );
    // For one slice over time, the recorded steps are its depth.
    let times = load_bytes(&file(&document(&image("a", &pixels(1, 1, 9), "")), 4)).unwrap();
    assert_eq!(firsts(&times), [0.0, 1.0, 2.0, 3.0]);
    // A gap in between keeps its place.
    let data: String = [0, 1, 3].map(|z| format!("<TiffData FirstZ=\"{z}\" IFD=\"{z}\"/>")).concat();
    let gap = load_bytes(&file(&document(&image("a", &pixels(5, 1, 1), &data)), 4)).unwrap();
    assert_eq!(firsts(&gap), [0.0, 1.0, 0.0, 3.0]);
    let remarks = gap.remarks().join("; ");
    assert!(
        remarks.contains("slices 2: they are left empty") && remarks.contains("the first 4"),
        "{remarks}"
    );
    // No page at all for the chosen channel; the error lists the others.
    let data: String =
        [0, 1].map(|z| format!("<TiffData FirstC=\"1\" FirstZ=\"{z}\" IFD=\"{z}\"/>")).concat();
    let other = file(&document(&image("a", &pixels(2, 2, 1), &data)), 2);
    let refused = load_chosen(&other, VolumeChoice { channel: Some(0), ..VolumeChoice::default() });
    assert_refused(
        refused,
        LoadErrorKind::BadInput,
        &["no page for channel 0 at time step 0", "with pages: 1 at 0"],
    );
}

#[test]
fn channels_are_called_by_their_dye_or_light_where_they_have_no_name() {
    let pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"1\" SizeC=\"3\" SizeT=\"1\"";
    let channels = "<Channel Name=\"nuclei\" Fluor=\"DAPI\"/><Channel Name=\" \" Fluor=\"GFP\"/><Channel EmissionWavelength=\"610\"/>";
    let refused = load_bytes(&file(&document(&image("a", pixels, channels)), 3));
    assert_refused(refused, LoadErrorKind::BadInput, &["0 \"nuclei\"", "1 \"GFP\"", "2 \"610 nm\""]);
}

#[test]
fn inconsistent_metadata_are_refused() {
    let pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\"";
    for (xml, words) in [
        (document(""), "no image"),
        ("<OME><Image></OME>".to_owned(), "not well-formed XML"),
        (document(&image("a", "SizeZ=\"0\" SizeC=\"1\" SizeT=\"1\"", "")), "not a valid size"),
        (document(&image("a", "SizeZ=\"9999999\" SizeC=\"1\" SizeT=\"1\"", "")), "9999999 slices"),
        (document(&image("a", "SizeZ=\"1\" SizeC=\"9999\" SizeT=\"9999\"", "")), "implausible"),
        (document(&image("a", pixels, "<TiffData FirstZ=\"3\"/>")), "beyond"),
        (document(&image("a", pixels, "<TiffData IFD=\"7\" PlaneCount=\"3\"/>")), "the file has 2 pages"),
        (
            document(
                &image("a", "SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\"", "").replace("SizeX=\"2\"", "SizeX=\"3\""),
            ),
            "pages of 3 x 1",
        ),
        ("<!DOCTYPE OME [<!ENTITY a \"b\">]><OME>&a;</OME>".to_owned(), "document type"),
    ] {
        assert_refused(load_bytes(&file(&xml, 2)), LoadErrorKind::BadInput, &[words]);
    }
}

#[test]
fn xml_that_would_take_long_is_refused() {
    for (words, xml) in slow_texts("OME") {
        assert_refused(load_bytes(&file(&xml, 2)), LoadErrorKind::BadInput, &["OME-XML", words]);
    }
}

#[test]
fn a_recording_of_many_planes_is_read() {
    // Each plane with all attributes of the schema.
    let planes = (0..20_000)
        .map(|at| {
            format!(
                "<TiffData FirstC=\"0\" FirstT=\"{at}\" FirstZ=\"0\" IFD=\"{}\" PlaneCount=\"1\"/><Plane TheC=\"0\" TheT=\"{at}\" \
                 TheZ=\"0\" DeltaT=\"{at}\" DeltaTUnit=\"s\" ExposureTime=\"1\" ExposureTimeUnit=\"s\" PositionX=\"1\" \
                 PositionXUnit=\"µm\" PositionY=\"1\" PositionYUnit=\"µm\" PositionZ=\"1\" PositionZUnit=\"µm\"/>",
                at % 2
            )
        })
        .collect::<Vec<String>>().concat();
    let sizes = "DimensionOrder=\"XYZCT\" SizeZ=\"1\" SizeC=\"1\" SizeT=\"20000\"";
    let bytes = file(&document(&image("a", sizes, &planes)), 2);
    for (frame, value) in [(0, 0.0), (1, 1.0), (19_998, 0.0), (19_999, 1.0)] {
        let choice = VolumeChoice { frame: Some(frame), ..VolumeChoice::default() };
        assert_eq!(firsts(&load_chosen(&bytes, choice).unwrap()), [value], "{frame}");
    }
}

#[test]
fn too_many_images_are_refused() {
    let sizes = "DimensionOrder=\"XYZCT\" SizeZ=\"1\" SizeC=\"1\" SizeT=\"1\"";
    let bytes = file(&document(&image("a", sizes, "").repeat(20_000)), 1);
    assert_refused(load_bytes(&bytes), LoadErrorKind::Limit, &["20000 images", "split"]);
}
