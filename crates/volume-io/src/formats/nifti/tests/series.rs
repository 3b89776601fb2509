//! Tests of files with several volumes: time steps, extra dimensions, vectors.

use super::{assert_refused, gzip, load_bytes, nifti1_header};
use chiaroscuro_volume::{FileDimension, LoadError, LoadErrorKind, Samples, VolumeChoice};

fn frame(frame: usize) -> VolumeChoice {
    VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }
}

#[test]
fn time_steps_are_chosen() {
    let file =
        nifti1_header(&[2, 1, 1, 3], 2).text(123, &[2 + 8]).f32(136, &[10.0]).with_data(&[1, 2, 3, 4, 5, 6]);
    for file in [file.clone(), gzip(&file)] {
        for (at, values) in [[1, 2], [3, 4], [5, 6]].iter().enumerate() {
            let volume = load_bytes(&file, frame(at)).unwrap();
            assert_eq!(*volume.samples(), Samples::U8(values.to_vec()));
            assert_eq!(volume.dims(), [2, 1, 1]);
        }
        let Err(LoadError::Several { dimension, offers, .. }) = load_bytes(&file, VolumeChoice::default())
        else {
            panic!("nobody has said which");
        };
        assert_eq!(dimension, FileDimension::Frame);
        let names: Vec<&str> = offers.iter().map(|offer| offer.name.as_str()).collect();
        assert_eq!(names, ["10 s", "11.5 s", "13 s"]);
        assert_refused(load_bytes(&file, frame(3)), LoadErrorKind::BadInput, &["3 time steps", "--frame"]);
    }
    // Complete time steps are shown although the file is truncated behind them.
    assert!(load_bytes(&file[..file.len() - 2], frame(1)).is_ok());
    assert_refused(load_bytes(&file[..file.len() - 1], frame(2)), LoadErrorKind::BadInput, &["truncated"]);
    let zipped = gzip(&file[..file.len() - 1]);
    assert_refused(load_bytes(&zipped, frame(2)), LoadErrorKind::BadInput, &["truncated"]);
}

#[test]
fn more_dimensions_are_counted_through() {
    let data: Vec<u8> = (0..12).collect();
    let file = nifti1_header(&[1, 1, 1, 2, 1, 3, 2], 2).with_data(&data);
    let volume = load_bytes(&file, frame(7)).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![7]));
    assert_refused(
        load_bytes(&file, VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["12 time steps", "7 \"1, 0, 1\""],
    );
    // A length of 0 means unused, and extra dimensions of length 1 offer no choice.
    let file = nifti1_header(&[2, 1, 1, 0, 1], 2).with_data(&[1, 2]);
    assert!(load_bytes(&file, VolumeChoice::default()).is_ok());
    let many = nifti1_header(&[1, 1, 1, 32767, 32767, 32767, 32767], 2).with_data(&[1]);
    assert_refused(load_bytes(&many, VolumeChoice::default()), LoadErrorKind::Limit, &["too many", "dim"]);
}

#[test]
fn vectors_lie_behind_each_other() {
    let numbers = [3.0f32, 0.0, 1.0, 1.0, 4.0, 2.0, 1.0, 1.0];
    let data: Vec<u8> = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
    let of = |dims: &[i16]| nifti1_header(dims, 16).i16(68, &[1007]);
    // Two components of two time steps of two voxels each.
    let file = of(&[2, 1, 1, 2, 2]).with_data(&data);
    for file in [file.clone(), gzip(&file)] {
        let volume = load_bytes(&file, frame(0)).unwrap();
        assert_eq!(*volume.samples(), Samples::F32(vec![5.0, 2.0]));
        assert!(volume.remarks().iter().any(|remark| remark.contains("magnitude")));
        let second = VolumeChoice { component: Some(1), ..frame(0) };
        assert_eq!(*load_bytes(&file, second).unwrap().samples(), Samples::F32(vec![4.0, 2.0]));
        assert_eq!(*load_bytes(&file, frame(1)).unwrap().samples(), Samples::F32(vec![2f32.sqrt(); 2]));
    }
    let scaled = of(&[2, 1, 1, 2, 2]).f32(112, &[2.0, -6.0]).with_data(&data);
    assert_eq!(*load_bytes(&scaled, frame(0)).unwrap().samples(), Samples::F32(vec![2.0, 40f32.sqrt()]));
    let third = VolumeChoice { component: Some(2), ..frame(0) };
    assert_refused(load_bytes(&file, third), LoadErrorKind::BadInput, &["--component", "0 to 1"]);
    let cut = &file[..file.len() - 9];
    assert_refused(load_bytes(cut, frame(0)), LoadErrorKind::BadInput, &["truncated"]);
    assert_refused(load_bytes(&gzip(cut), frame(0)), LoadErrorKind::BadInput, &["truncated"]);
    let colors = nifti1_header(&[1, 1, 1, 1, 2], 128).i16(68, &[1007]).with_data(&[0; 6]);
    assert_refused(load_bytes(&colors, VolumeChoice::default()), LoadErrorKind::BadInput, &["datatype"]);
}
