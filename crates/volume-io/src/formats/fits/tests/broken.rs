//! Tests of FITS files that are truncated, contradict themselves, or hold no image.

use super::super::*;
use super::writer::TestUnit;
use super::{assert_refused, gzip, load_bytes, picture};
use chiaroscuro_volume::{LoadErrorKind, VolumeChoice};

fn opened(bytes: &[u8]) -> Result<Volume, LoadError> {
    load_bytes("a.fits", bytes, VolumeChoice::default())
}

#[test]
fn every_cut_is_refused() {
    let whole = picture().bytes();
    // Behind the last pixel only the fill of the block is missing.
    for cut in (0..whole.len()).step_by(7).filter(|&cut| cut < 2880 + 12) {
        let error = opened(&whole[..cut]).unwrap_err();
        assert_eq!(error.kind(), LoadErrorKind::BadInput, "{cut}: {error}");
        assert!(error.to_string().contains("a.fits"), "{error}");
    }
    assert!(opened(&whole[..2880 + 12]).is_ok());
    let packed = gzip(&whole);
    for cut in 11..packed.len() {
        assert_eq!(opened(&packed[..cut]).unwrap_err().kind(), LoadErrorKind::BadInput, "{cut}");
    }
    // A truncated extension ends the list of units.
    let second = TestUnit::extension("IMAGE", 8, &[3, 2], (0..6).collect()).bytes();
    for cut in [0, 1, 79, 80, 2000, 2879] {
        assert!(opened(&[whole.as_slice(), &second[..cut]].concat()).is_ok(), "{cut}");
    }
}

#[test]
fn headers_that_lie_are_refused() {
    const FAR: u64 = 1 << 62;
    for (unit, kind, words) in [
        (picture().with("NAXIS", 999), LoadErrorKind::BadInput, "NAXIS3"),
        (picture().with("NAXIS", 1000), LoadErrorKind::BadInput, "1000 axes"),
        (picture().with("NAXIS", -1), LoadErrorKind::BadInput, "-1 axes"),
        (picture().with("NAXIS", "many"), LoadErrorKind::BadInput, "whole number"),
        (picture().without("NAXIS"), LoadErrorKind::BadInput, "NAXIS"),
        (picture().with("NAXIS1", FAR), LoadErrorKind::Limit, "are allowed"),
        (picture().with("NAXIS1", FAR).with("NAXIS2", FAR), LoadErrorKind::Limit, "are allowed"),
        (picture().with("NAXIS1", "99999999999999999999"), LoadErrorKind::BadInput, "NAXIS1"),
        (picture().with("NAXIS1", -3), LoadErrorKind::BadInput, "NAXIS1"),
        (picture().with("NAXIS1", 0), LoadErrorKind::BadInput, "no image"),
        (picture().with("NAXIS1", 2000), LoadErrorKind::BadInput, "truncated"),
        (picture().with("NAXIS", 1), LoadErrorKind::BadInput, "two axes or more"),
        (picture().with("BITPIX", 12), LoadErrorKind::BadInput, "12 bits"),
        (picture().with("BITPIX", i64::MIN), LoadErrorKind::BadInput, "BITPIX"),
        (picture().without("BITPIX"), LoadErrorKind::BadInput, "BITPIX"),
        (TestUnit::primary(8, &[2, 2, 2, 2, 2], vec![1; 32]), LoadErrorKind::BadInput, "5 axes"),
        (TestUnit::primary(8, &[2, 2, 2, FAR], vec![1; 32]), LoadErrorKind::Limit, "time steps"),
        (
            TestUnit::primary(-32, &[1, 2], [f32::NAN; 2].map(f32::to_be_bytes).concat()),
            LoadErrorKind::BadInput,
            "finite",
        ),
    ] {
        for bytes in [unit.bytes(), gzip(&unit.bytes())] {
            // Gzipped content may be longer than the file suggests: missing data show only while they are read.
            let error = opened(&bytes).unwrap_err();
            assert!(error.kind() == kind || error.to_string().contains("truncated"), "{words}: {error}");
            if error.kind() == kind && !error.to_string().contains("truncated") {
                assert!(error.to_string().contains(words), "{words} is not in: {error}");
            }
        }
    }
}

#[test]
fn a_header_without_an_end_is_read_no_further_than_headers_are_long() {
    let card = format!("{:<80}", "HISTORY that goes on");
    let endless = [picture().header_without_end(), card.repeat(36 * 2100).into_bytes()].concat();
    assert_refused(opened(&endless), LoadErrorKind::Limit, &["no END"]);
    assert_refused(opened(&gzip(&endless)), LoadErrorKind::Limit, &["no END"]);
    assert_refused(opened(&picture().header_without_end()), LoadErrorKind::BadInput, &["without END"]);
    // Control characters and invalid UTF-8 in comments and values.
    let mut odd = picture().with("OBJECT", "'\u{1b}[2J x'").with("BSCALE", "nan").with("BZERO", "1e999");
    odd = odd.with("CDELT1", "nan").with("BLANK", "none");
    let mut bytes = odd.bytes();
    let blank = bytes.windows(5).position(|word| word == b"BLANK").unwrap();
    bytes[blank + 40..blank + 80].fill(0xff);
    let volume = opened(&bytes).unwrap();
    assert!(!volume.metadata().acquisition().unwrap_or_default().contains('\u{1b}'));
    assert!(opened(&[&b"SIMPLE  ="[..], &[0xfe; 6000]].concat()).is_err());
}

#[test]
fn files_without_a_picture_say_what_they_hold() {
    let empty = TestUnit::primary(8, &[], Vec::new());
    let table = TestUnit::extension("BINTABLE", 8, &[7, 3], vec![9; 21]);
    let packed = table.clone().with("ZIMAGE", "T");
    let groups =
        TestUnit::primary(-32, &[0, 3], vec![0; 24]).with("GROUPS", "T").with("PCOUNT", 3).with("GCOUNT", 1);
    for (units, words) in [
        (vec![empty.clone()], "no image"),
        (vec![empty.clone(), table.clone()], "tables"),
        (vec![empty.clone(), packed.clone()], "funpack"),
        (vec![groups], "interferometer"),
    ] {
        let bytes: Vec<u8> = units.iter().flat_map(TestUnit::bytes).collect();
        assert_refused(opened(&bytes), LoadErrorKind::BadInput, &[words]);
    }
    // An image beside a compressed one is shown, with a remark on the other.
    let both = [picture().bytes(), packed.bytes()].concat();
    assert!(opened(&both).unwrap().remarks()[0].contains("funpack"));
    assert_refused(opened(b"something else"), LoadErrorKind::BadInput, &["SIMPLE"]);
}
