//! Tests of several numbers per voxel: components, colours and time steps.

use tempfile::TempDir;

use super::{assert_refused, header_with, load_path_as, write};
use chiaroscuro_volume::{LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

fn load(fields: &[&str], data: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    let folder = TempDir::new().unwrap();
    load_path_as(&write(&folder, "v.nrrd", &format!("{}\n", header_with(fields)), data), choice)
}

fn frame(frame: usize) -> VolumeChoice {
    VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }
}

fn component(component: usize) -> VolumeChoice {
    VolumeChoice { component: Some(component), ..VolumeChoice::default() }
}

#[test]
fn the_slowest_axis_holds_time_steps() {
    let bytes: Vec<u8> = (0..16).collect();
    let sizes = ["dimension: 4", "sizes: 2 2 2 2"];
    let plain = [sizes[0], sizes[1]];
    for fields in [
        &plain[..],
        &[sizes[0], sizes[1], "kinds: domain domain domain list"],
        &[sizes[0], sizes[1], "spacings: 1 1 1 nan"],
        &[sizes[0], sizes[1], "space: RAS", "space directions: (1,0,0) (0,1,0) (0,0,1) none"],
        &[
            sizes[0],
            sizes[1],
            "space: left-posterior-superior-time",
            "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,2)",
            "space origin: (1,2,3,4)",
        ],
    ] {
        let listed = ["2 time steps", "--frame", "1 (2 x 2 x 2)"];
        assert_refused(load(fields, &bytes, VolumeChoice::default()), LoadErrorKind::BadInput, &listed);
        for step in [0, 1] {
            let volume = load(fields, &bytes, frame(step)).unwrap();
            assert_eq!(*volume.samples(), Samples::U8(bytes[step * 8..][..8].to_vec()), "{fields:?}");
        }
        assert_refused(
            load(fields, &bytes, frame(2)),
            LoadErrorKind::BadInput,
            &["not one of its 2 time steps"],
        );
    }
    for encoding in ["gzip", "ascii"] {
        let encoding = format!("encoding: {encoding}");
        let text = bytes.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
        let data = if encoding.ends_with("gzip") { super::gzip(&bytes) } else { text.into_bytes() };
        for step in [0, 1] {
            let volume = load(&[sizes[0], sizes[1], &encoding], &data, frame(step)).unwrap();
            assert_eq!(*volume.samples(), Samples::U8(bytes[step * 8..][..8].to_vec()), "{encoding}");
        }
    }
    // Consecutive images, and two axes of them.
    let pictures = ["dimension: 4", "sizes: 2 2 2 2", "kinds: domain domain list time"];
    let third = load(&pictures, &bytes, frame(3)).unwrap();
    assert_eq!((third.dims(), third.samples()), ([2, 2, 1], &Samples::U8(vec![12, 13, 14, 15])));
    let short = load(&plain, &bytes[..15], frame(0));
    assert_refused(short, LoadErrorKind::BadInput, &["truncated", "16 bytes"]);
}

#[test]
fn the_fastest_axis_holds_components() {
    let colors = [3, 4, 0, 10, 10, 10, 0, 0, 0, 255, 255, 255];
    let sizes = ["dimension: 4", "sizes: 3 2 2 1"];
    for kind in ["RGB-color", "vector", "none"] {
        let kinds = format!("kinds: {kind} domain domain domain");
        let fields = [sizes[0], sizes[1], &kinds, "space directions: none (1,0,0) (0,1,0) (0,0,1)"];
        let volume = load(&fields, &colors, VolumeChoice::default()).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(vec![3, 10, 0, 255]), "{kind}");
        assert_eq!(volume.dims(), [2, 2, 1]);
        assert!(volume.remarks()[0].contains("luminance"));
        let green = load(&fields, &colors, component(1)).unwrap();
        assert_eq!(*green.samples(), Samples::U8(vec![4, 10, 0, 255]));
        assert_refused(load(&fields, &colors, component(3)), LoadErrorKind::BadInput, &["0 to 2"]);
    }
    let vectors: Vec<u8> = [3i16, 4, 0, -12, 5, 0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let fields = [
        "dimension: 4",
        "sizes: 3 2 1 1",
        "type: int16",
        "endian: little",
        "kinds: vector space space space",
    ];
    let lengths = load(&fields, &vectors, VolumeChoice::default()).unwrap();
    assert_eq!(*lengths.samples(), Samples::F32(vec![5.0, 13.0]));
    // A large volume with three values per voxel holds colours; a small one holds time steps.
    let steps: Vec<u8> = (0..24).collect();
    let small = load(&["dimension: 4", "sizes: 3 2 2 2"], &steps, frame(1)).unwrap();
    assert_eq!((small.dims(), small.samples()), ([3, 2, 2], &Samples::U8(steps[12..].to_vec())));
    let large = load(&["dimension: 4", "sizes: 3 5 5 5"], &[7; 375], VolumeChoice::default()).unwrap();
    assert_eq!((large.dims(), large.value(0, 0, 0)), ([5; 3], 7.0));
    // Both at once: components before the spatial axes, and time steps behind them.
    let both = ["dimension: 5", "sizes: 2 1 2 1 3", "kinds: complex domain domain domain time"];
    let bytes: Vec<u8> = (0..12).collect();
    let choice = VolumeChoice { frame: Some(2), component: Some(1), ..VolumeChoice::default() };
    assert_eq!(*load(&both, &bytes, choice).unwrap().samples(), Samples::U8(vec![9, 11]));
}

#[test]
fn components_behind_each_other_are_no_time_steps() {
    // Planar components: 3, 4 and 0 form one vector, 0, −12 and 5 the other.
    let planes: Vec<u8> = [3i16, 0, 4, -12, 0, 5].iter().flat_map(|value| value.to_be_bytes()).collect();
    let fields =
        ["dimension: 4", "sizes: 2 1 1 3", "type: int16", "endian: big", "kinds: space space space vector"];
    let lengths = load(&fields, &planes, VolumeChoice::default()).unwrap();
    assert_eq!((lengths.dims(), lengths.samples()), ([2, 1, 1], &Samples::F32(vec![5.0, 13.0])));
    assert_eq!(*load(&fields, &planes, component(1)).unwrap().samples(), Samples::I16(vec![4, -12]));
    assert_refused(
        load(&fields, &planes[..11], VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["truncated"],
    );
    assert_refused(load(&fields, &planes, component(3)), LoadErrorKind::BadInput, &["0 to 2"]);
    let colors = ["dimension: 4", "sizes: 2 1 1 3", "kinds: domain domain domain RGB-color"];
    let light = load(&colors, &[255, 0, 255, 0, 255, 0], VolumeChoice::default()).unwrap();
    assert_eq!(*light.samples(), Samples::U8(vec![255, 0]));
    assert!(light.remarks()[0].contains("luminance"));
}

#[test]
fn times_beside_each_other_are_time_steps_too() {
    let fields = ["dimension: 4", "sizes: 2 2 2 1", "kinds: time domain domain domain"];
    let bytes: Vec<u8> = (0..8).collect();
    assert_refused(
        load(&fields, &bytes, VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["2 time steps"],
    );
    assert_eq!(*load(&fields, &bytes, frame(1)).unwrap().samples(), Samples::U8(vec![1, 3, 5, 7]));
}

#[test]
fn a_list_holds_volumes_wherever_it_stands() {
    let fields = ["dimension: 4", "sizes: 7 2 2 1", "kinds: list domain domain domain"];
    let bytes: Vec<u8> = (0..28).collect();
    let listed = ["7 time steps", "--frame", "6 (2 x 2 x 1)"];
    assert_refused(load(&fields, &bytes, VolumeChoice::default()), LoadErrorKind::BadInput, &listed);
    for step in 0..7 {
        let volume = load(&fields, &bytes, frame(step)).unwrap();
        let expected: Vec<u8> = (0..4).map(|at| 7 * at + step as u8).collect();
        assert_eq!((volume.dims(), volume.samples()), ([2, 2, 1], &Samples::U8(expected)));
    }
    assert_refused(load(&fields, &bytes, component(1)), LoadErrorKind::BadInput, &["7 time steps"]);
    // With a time axis behind the spatial ones, a list holds channels.
    let both = ["dimension: 5", "sizes: 2 2 1 1 3", "kinds: list domain domain domain time"];
    let choice = VolumeChoice { channel: Some(1), ..frame(2) };
    assert_eq!(*load(&both, &bytes[..12], choice).unwrap().samples(), Samples::U8(vec![9, 11]));
    assert_refused(load(&both, &bytes[..12], frame(1)), LoadErrorKind::BadInput, &["2 channels"]);
}

#[test]
fn segments_in_layers_are_those_of_the_first() {
    let segments = "Segment0_Name:=a\nSegment0_LabelValue:=1\nSegment0_Layer:=0";
    let fields = ["dimension: 4", "sizes: 2 2 2 1", "kinds: list domain domain domain", segments];
    let volume = load(&fields, &[0, 9, 1, 9, 1, 9, 0, 9], VolumeChoice::default()).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![0, 1, 1, 0]));
    assert!(volume.remarks()[0].contains("2 layers"));
}

#[test]
fn many_numbers_are_bounded() {
    let limit = LoadErrorKind::Limit;
    let many = ["dimension: 4", "sizes: 2 2 2 9999999", "kinds: domain domain domain time"];
    assert_refused(load(&many, &[0; 8], frame(0)), limit, &["65536 time steps"]);
    let wide = ["dimension: 4", "sizes: 9999999 2 2 2", "kinds: vector domain domain domain"];
    assert_refused(load(&wide, &[0; 8], VolumeChoice::default()), limit, &["9999999 numbers"]);
    let most = u64::MAX.to_string();
    let most =
        ["dimension: 5", &format!("sizes: 2 2 2 {most} {most}"), "kinds: domain domain domain list list"];
    assert_refused(load(&most, &[0; 8], frame(0)), limit, &["time steps"]);
}
