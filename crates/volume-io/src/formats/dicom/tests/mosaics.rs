//! Tests of Siemens mosaics: slices as tiles of one image.

use super::*;
use crate::formats::dicom::header::csa::tests::header as siemens_header;

/// Private elements of Siemens: their creator, and the number of slices.
const SIEMENS_CREATOR: DicomTag = 0x0019_0010;
const MOSAIC_COUNT: DicomTag = 0x0019_100a;

/// A mosaic of 2 x 2 tiles of 2 x 3 pixels, three of them used: v = x + 10 y + 100 z.
fn mosaic(set: impl FnOnce(DataSetBuilder) -> DataSetBuilder) -> DicomFileBuilder {
    let pixel = |column: u16, row: u16| {
        let z = column / 2 + row / 3 * 2;
        if z < 3 { column % 2 + row % 3 * 10 + 100 * z } else { 0 }
    };
    let words: Vec<u16> = (0..24).map(|at| pixel(at % 4, at / 4)).collect();
    DicomFileBuilder::new(EXPLICIT).size(4, 6).words(&words).with(|all| {
        set(all
            .text(tags::IMAGE_TYPE, *b"CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC")
            .decimal(tags::SPACING_BETWEEN_SLICES, "3"))
    })
}

fn expected() -> Samples {
    let pixel = |at: u16| at % 2 + at / 2 % 3 * 10 + at / 6 * 100;
    Samples::U16((0..18).map(pixel).collect())
}

/// Adds the number of slices in a private element.
fn counted(set: DataSetBuilder) -> DataSetBuilder {
    set.text(SIEMENS_CREATOR, *b"LO", "SIEMENS MR HEADER").value(MOSAIC_COUNT, *b"US", &3u16.to_le_bytes())
}

#[test]
fn slices_side_by_side_are_a_volume() {
    let csa = siemens_header(&[("NumberOfImagesInMosaic", &["3"]), ("SliceNormalVector", &["0", "0", "1"])]);
    let cases: [Box<dyn Fn(DataSetBuilder) -> DataSetBuilder>; 2] =
        [Box::new(counted), Box::new(move |set| set.value(tags::SIEMENS_HEADER, *b"OB", &csa))];
    for set in cases {
        let volume = mosaic(&set).load().unwrap();
        assert_eq!((volume.dims(), volume.samples()), ([2, 3, 3], &expected()));
        // The image begins at 1, 2, 3; columns are 0.25 mm apart and rows 0.5, and a slice is half as wide and high.
        let origin = [-(1.0 + 0.25 * 1.0), -(2.0 + 0.5 * 1.5), 3.0];
        assert_eq!(affine_columns(&volume)[6..], [&[0.0, 0.0, 3.0][..], &origin].concat());
        assert!(volume.remarks().is_empty(), "{:?}", volume.remarks());
    }
}

#[test]
fn slices_go_the_way_that_the_header_says() {
    let csa = siemens_header(&[("NumberOfImagesInMosaic", &["3"]), ("SliceNormalVector", &["0", "0", "-1"])]);
    let volume = mosaic(|set| set.value(tags::SIEMENS_HEADER, *b"OB", &csa)).load().unwrap();
    // Begins with the third slice, which lies lowest.
    assert_eq!(volume.samples().value(0), 200.0);
    assert_eq!(affine_columns(&volume)[8..], [3.0, -1.25, -2.75, -3.0]);
}

#[test]
fn mosaics_of_a_series_are_phases() {
    let files = [1u16, 2].map(|number| {
        mosaic(|set| counted(set).text(tags::ACQUISITION_NUMBER, *b"IS", &number.to_string()))
            .with(|set| set.decimal(tags::INTERCEPT, "0"))
    });
    let at = folder(&files);
    let words = ["2 time steps", "1 \"acquisition 2\" (2 x 3 x 3)"];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    assert_eq!(load_path(at.path(), choice).unwrap().samples(), &expected());
}

#[test]
fn a_mosaic_that_does_not_say_how_many_slices_it_has_stays_a_picture() {
    let volume = mosaic(|set| set).load().unwrap();
    assert_eq!(volume.dims(), [4, 6, 1]);
    assert_remark(&volume, "their number is not stated");
    for count in [0u16, 5000, 65535, 17] {
        let file = mosaic(|set| counted(set).value(MOSAIC_COUNT, *b"US", &count.to_le_bytes()));
        assert_eq!(file.load().unwrap().dims(), [4, 6, 1], "{count}");
    }
    // The private element of another manufacturer.
    let other = mosaic(|set| counted(set).text(SIEMENS_CREATOR, *b"LO", "GEMS_ACQU_01"));
    assert_eq!(other.load().unwrap().dims(), [4, 6, 1]);
}
