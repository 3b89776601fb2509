//! Tests of several acquisitions at equal or nearly equal positions: each is a volume.

use super::*;

/// A slice of 4 x 3 pixels v = x + 10 y + `base` at a height.
fn slice(z_mm: f64, base: u16, set: impl FnOnce(DataSetBuilder) -> DataSetBuilder) -> DicomFileBuilder {
    ramp_file(base).with(|all| set(all.decimal(tags::POSITION, &format!("0\\0\\{z_mm}"))))
}

/// Loads the volume of one phase of the files.
fn phase(files: &[DicomFileBuilder], frame: usize) -> Volume {
    load_path(folder(files).path(), VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }).unwrap()
}

fn acquisition(number: u16) -> impl Fn(DataSetBuilder) -> DataSetBuilder {
    move |set| set.text(tags::ACQUISITION_NUMBER, *b"IS", &number.to_string())
}

/// Acquisition 1 at heights 0, 1 and 3 times 2 mm; acquisition 2 at all four, with values higher by 1000.
fn acquisitions(shift_mm: f64) -> Vec<DicomFileBuilder> {
    let first = [0u16, 1, 3].map(|z| slice(f64::from(z) * 2.0, 100 * z, acquisition(1)));
    let second =
        [0u16, 1, 2, 3].map(|z| slice(f64::from(z) * 2.0 + shift_mm, 1000 + 100 * z, acquisition(2)));
    first.into_iter().chain(second).collect()
}

#[test]
fn a_phase_that_lacks_a_slice_borrows_none() {
    // At equal positions, with jitter, and after a breath.
    for shift_mm in [0.0, 0.001, 0.3, 0.8] {
        let files = acquisitions(shift_mm);
        let offered = load_path(folder(&files).path(), VolumeChoice::default());
        assert_refused(
            offered,
            LoadErrorKind::BadInput,
            &["2 time steps", "0 \"acquisition 1\" (4 x 3 x 4)", "1 \"acquisition 2\" (4 x 3 x 4)"],
        );
        let second = phase(&files, 1);
        assert_eq!(second.samples(), &Samples::U16(ramp_values(&[1000, 1100, 1200, 1300])), "{shift_mm}");
        assert_eq!(affine_columns(&second)[8..], [2.0, 0.0, 0.0, shift_mm], "each lies at its own place");
        assert!(second.remarks().is_empty(), "{:?}", second.remarks());
        let first = phase(&files, 0);
        assert_eq!(first.samples(), &Samples::U16(ramp_values(&[0, 100, 200, 300])), "{shift_mm}");
        assert_remark(&first, "1 slice is missing of 4, 2.0000 mm apart: interpolated");
    }
}

#[test]
fn phases_that_were_taken_in_turns_are_one_volume() {
    let volume = load_path(
        folder(&acquisitions(1.0)).path(),
        VolumeChoice { frame: Some(0), ..VolumeChoice::default() },
    );
    let volume = volume.unwrap();
    assert_eq!(volume.dims(), [4, 3, 8], "{:?}", volume.remarks());
    assert_eq!(affine_columns(&volume)[8], 1.0);
}

#[test]
fn every_attribute_that_varies_is_offered() {
    type Attribute = fn(DataSetBuilder, f64) -> DataSetBuilder;
    let cases: [(Attribute, &str); 10] = [
        (|set, n| set.text(tags::TEMPORAL_POSITION, *b"IS", &n.to_string()), "temporal position 2"),
        (|set, n| set.text(tags::ECHO_NUMBER, *b"IS", &n.to_string()), "echo 2"),
        (|set, n| set.decimal(tags::TRIGGER_TIME, &(n * 40.0).to_string()), "trigger time 80 ms"),
        (|set, n| set.value(tags::B_VALUE, *b"FD", &(n * 500.0).to_le_bytes()), "b-value 1000"),
        (
            |set, n| {
                let b = if n == 1.0 { "0\\8\\0\\0" } else { "1000001000\\8\\0\\0" };
                set.text(0x0043_0010, *b"LO", "GEMS_PARM_01").text(0x0043_1039, *b"IS", b)
            },
            "b-value 1000",
        ),
        (
            |set, n| {
                let b = (n * 500.0) as f32;
                let set = set.text(0x2001_0011, *b"LO", "Philips Imaging DD 001");
                set.value(0x2001_1103, *b"FL", &b.to_le_bytes())
            },
            "b-value 1000",
        ),
        (|set, n| set.text(tags::CONTENT_TIME, *b"TM", &format!("12000{n}.5")), "created at 12:00:02.500"),
        (|set, n| set.text(tags::ACQUISITION_TIME, *b"TM", &format!("12000{n}")), "acquired at 12:00:02.000"),
        (|set, n| set.decimal(tags::REFERENCE_TIME, &n.to_string()), "reference time 2 ms"),
        (
            |set, n| set.text(tags::IMAGE_TYPE, *b"CS", if n == 1.0 { "ORIGINAL\\M" } else { "ORIGINAL\\P" }),
            "image type ORIGINAL\\P",
        ),
    ];
    for (set, words) in cases {
        // The second phase lacks one of three slices, whichever it is.
        for missing in [0, 1, 2] {
            let heights = [0u16, 1, 2];
            let first = heights.map(|z| slice(f64::from(z), 100 * z, |all| set(all, 1.0)));
            let second = heights.into_iter().filter(|&z| z != missing);
            let second = second.map(|z| slice(f64::from(z), 1000 + 100 * z, |all| set(all, 2.0)));
            let files: Vec<DicomFileBuilder> = first.into_iter().chain(second).collect();
            let offered = load_path(folder(&files).path(), VolumeChoice::default());
            assert_refused(offered, LoadErrorKind::BadInput, &["2 time steps", words]);
            assert_eq!(phase(&files, 0).samples(), &Samples::U16(ramp_values(&[0, 100, 200])), "{words}");
            let expected: &[u16] = match missing {
                0 => &[1100, 1200],
                1 => &[1000, 1100, 1200],
                _ => &[1000, 1100],
            };
            // Two slices 2 mm apart are an even volume.
            let expected = if missing == 1 { &[1000, 1200][..] } else { expected };
            assert_eq!(phase(&files, 1).samples(), &Samples::U16(ramp_values(expected)), "{words}");
        }
    }
}

#[test]
fn attributes_are_combined() {
    let slices = [0u16, 1, 2].into_iter().flat_map(|z| {
        [(1u16, 5u16), (1, 10), (2, 5), (2, 10)].map(|(position, echo)| {
            slice(f64::from(z), 100 * z + 1000 * position + echo, |set| {
                set.text(tags::TEMPORAL_POSITION, *b"IS", &position.to_string())
                    .decimal(tags::ECHO_TIME, &echo.to_string())
            })
        })
    });
    let files: Vec<DicomFileBuilder> = slices.collect();
    let offered = load_path(folder(&files).path(), VolumeChoice::default());
    let words = ["4 time steps", "2 \"temporal position 2, echo time 5 ms\""];
    assert_refused(offered, LoadErrorKind::BadInput, &words);
    assert_eq!(phase(&files, 2).samples(), &Samples::U16(ramp_values(&[2005, 2105, 2205])));
}

#[test]
fn times_that_differ_from_slice_to_slice_are_those_of_the_nearest_phase() {
    // Three phases, in which each slice has its own times; the first time of the second slice is missing.
    let times = [[0.0, 40.0, 80.0], [1.0, 41.5, 81.0], [0.5, 39.0, 79.5]];
    let mut files = Vec::new();
    for (z, times) in times.into_iter().enumerate() {
        for (phase, time) in times.into_iter().enumerate().filter(|&(phase, _)| (z, phase) != (1, 0)) {
            let base = (1000 * phase + 100 * z) as u16;
            files.push(slice(z as f64, base, |set| set.decimal(tags::TRIGGER_TIME, &time.to_string())));
        }
    }
    for (number, expected) in [(0, &[0, 200][..]), (1, &[1000, 1100, 1200]), (2, &[2000, 2100, 2200])] {
        assert_eq!(phase(&files, number).samples(), &Samples::U16(ramp_values(expected)), "{number}");
    }
}

#[test]
fn instance_numbers_tell_passes_apart() {
    let file = |z: u16, base: u16, number: u16| {
        slice(f64::from(z), base + 100 * z, |set| {
            set.text(tags::INSTANCE_NUMBER, *b"IS", &number.to_string())
        })
    };
    // One pass after the other, the second without a slice.
    let files = [file(0, 0, 1), file(1, 0, 2), file(2, 0, 3), file(0, 1000, 4), file(2, 1000, 5)];
    assert_eq!(phase(&files, 0).samples(), &Samples::U16(ramp_values(&[0, 100, 200])));
    assert_eq!(phase(&files, 1).samples(), &Samples::U16(ramp_values(&[1000, 1200])));
    // Slice by slice, with both passes at each position.
    let files = [file(0, 0, 1), file(0, 1000, 2), file(1, 0, 3), file(1, 1000, 4)];
    assert_eq!(phase(&files, 1).samples(), &Samples::U16(ramp_values(&[1000, 1100])));
}

#[test]
fn acquisitions_that_follow_each_other_are_one_volume() {
    let files: Vec<DicomFileBuilder> = (0..8u16)
        .map(|z| slice(f64::from(z), 100 * z, acquisition(1 + z / 4)))
        .chain([slice(4.0, 2000, acquisition(1))])
        .collect();
    let volume = load_path(folder(&files).path(), VolumeChoice::default()).unwrap();
    let expected: Vec<u16> = (0..8).map(|z| 100 * z).collect();
    assert_eq!(volume.dims()[2], 8);
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&expected)));
    assert_remark(&volume, "1 of 9 images share their position with others");
}

#[test]
fn a_file_says_which_phase_is_meant() {
    let at = folder(&acquisitions(0.0));
    let volume = load_path(&at.path().join("5"), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[1000, 1100, 1200, 1300])));
    let choice = VolumeChoice { frame: Some(0), ..VolumeChoice::default() };
    let volume = load_path(&at.path().join("5"), choice).unwrap();
    assert_eq!(volume.samples().value(0), 0.0, "unless another is asked for");
}

#[test]
fn private_b_values_are_those_of_their_creators_only() {
    let other = |z: u16, b: u16| {
        slice(f64::from(z), 100 * z + b, |set| {
            set.text(0x0043_0010, *b"LO", "SOMEBODY ELSE").text(0x0043_1039, *b"IS", &b.to_string())
        })
    };
    let files = [other(0, 0), other(1, 1), other(0, 2), other(1, 3)];
    let message = load_path(folder(&files).path(), VolumeChoice::default());
    let message = message.map(|volume| volume.remarks().join("; ")).unwrap_or_else(|error| error.to_string());
    assert!(!message.contains("b-value"), "{message}");
    // The standard's element counts where both are there.
    let both = |z: u16, b: u16| {
        slice(f64::from(z), 100 * z + b, |set| {
            set.value(tags::B_VALUE, *b"FD", &f64::from(b).to_le_bytes())
                .text(0x0043_0010, *b"LO", "GEMS_PARM_01")
                .text(0x0043_1039, *b"IS", "7\\0")
        })
    };
    let files = [both(0, 0), both(1, 0), both(0, 900), both(1, 900)];
    let words = ["2 time steps", "1 \"b-value 900\""];
    assert_refused(
        load_path(folder(&files).path(), VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &words,
    );
}
