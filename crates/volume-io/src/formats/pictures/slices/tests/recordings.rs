//! Tests of folders in whose names a time or a channel is counted beside the slices.

use super::*;
use chiaroscuro_volume::FileDimension;

/// Folder of pictures of 2 x 1 pixels, each with the three numbers (time, channel, slice) of its name.
fn recording(names: &[(String, [u8; 3])]) -> TempDir {
    let pictures = names.iter().map(|(name, [t, c, z])| (name.as_str(), grey(2, &[100 * t + 10 * c, *z])));
    folder(&pictures.collect::<Vec<_>>())
}

/// Names of all pictures of a recording, in an order of the letters and with separators that a vendor uses.
fn names(vendor: impl Fn([u8; 3]) -> String, [times, channels, slices]: [u8; 3]) -> Vec<(String, [u8; 3])> {
    let all = (0..times).flat_map(|t| (0..channels).flat_map(move |c| (0..slices).map(move |z| [t, c, z])));
    all.map(|place| (vendor(place), place)).collect()
}

fn choice(frame: Option<usize>, channel: Option<usize>) -> VolumeChoice {
    VolumeChoice { frame, channel, ..VolumeChoice::default() }
}

/// Voxels of one time and channel.
fn voxels([t, c]: [u8; 2], slices: impl IntoIterator<Item = u8>) -> Samples {
    Samples::U8(slices.into_iter().flat_map(|z| [100 * t + 10 * c, z]).collect())
}

fn remarks(volume: &Volume) -> String {
    volume.remarks().join("; ")
}

#[test]
fn times_and_channels_in_names_are_chosen_as_such() {
    let vendors: [fn([u8; 3]) -> String; 5] = [
        |[t, c, z]| format!("Series001_t{t:02}_z{z:02}_ch{c:02}.png"),
        |[t, c, z]| format!("s_C{c:03}Z{z:03}T{t:03}.png"),
        |[t, c, z]| format!("img_channel{c:03}_position001_time{t:09}_z{z:03}.png"),
        |[t, c, z]| format!("b0t{t}z{z}c{c}x0-512y0-512.png"),
        |[t, c, z]| format!("{z:04}_w{}_t{}.png", c + 1, t + 1),
    ];
    for vendor in vendors {
        let stacks = recording(&names(vendor, [2, 2, 3]));
        let name = vendor([0, 1, 2]);
        assert_refused(load_path(stacks.path()), LoadErrorKind::BadInput, &["2 channels", "(2 x 1 x 3)"]);
        let one = load_with(stacks.path(), choice(None, Some(1)));
        assert_refused(one, LoadErrorKind::BadInput, &["2 time steps", "--frame"]);
        for (t, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let volume = load_with(stacks.path(), choice(Some(t.into()), Some(c.into()))).unwrap();
            assert_eq!(volume.samples(), &voxels([t, c], 0..3), "{name}");
            assert!(volume.remarks().is_empty(), "{name} {}", remarks(&volume));
            let held = volume.contents();
            assert!(held.alternatives_in(FileDimension::Series).is_none(), "{name}");
            assert_eq!(held.alternatives_in(FileDimension::Frame).unwrap().offers.len(), 2);
        }
        let unknown = load_with(stacks.path(), choice(Some(0), Some(2)));
        assert_refused(unknown, LoadErrorKind::BadInput, &["\"2\" is not one of its 2 channels"]);
    }
    let two = recording(&names(|[_, c, z]| format!("Series001_z{z:02}_ch{c:02}.png"), [1, 2, 8]));
    let listed = ["2 channels", "0 \"ch00\" (2 x 1 x 8)", "1 \"ch01\""];
    assert_refused(load_path(two.path()), LoadErrorKind::BadInput, &listed);
    let volume = load_with(two.path(), choice(None, Some(1))).unwrap();
    assert_eq!((volume.samples(), volume.dims()), (&voxels([0, 1], 0..8), [2, 1, 8]));
    assert_refused(
        load_with(two.path(), choice(Some(1), Some(1))),
        LoadErrorKind::BadInput,
        &["\"1\" is not one of its 1 time steps"],
    );
}

#[test]
fn what_a_stack_lacks_is_empty_and_said() {
    let all = names(|[t, c, z]| format!("z{z}_c{c}_t{t}.png"), [3, 2, 5]);
    // The last time has one slice of one channel; others lack one in between, or their first.
    let is_there = |picture: &&(String, [u8; 3])| match picture.1 {
        [2, c, z] => c == 0 && z == 0,
        [0, 1, 2] | [1, 0, 0] => false,
        _ => true,
    };
    let some: Vec<_> = all.iter().filter(is_there).cloned().collect();
    let stacks = recording(&some);
    let load = |t: usize, c: usize| load_with(stacks.path(), choice(Some(t), Some(c)));
    let whole = load(1, 1).unwrap();
    assert_eq!((whole.samples(), whole.remarks().len()), (&voxels([1, 1], 0..5), 0));
    let between = load(0, 1).unwrap();
    assert_eq!(between.samples(), &Samples::U8(vec![10, 0, 10, 1, 0, 0, 10, 3, 10, 4]));
    assert!(remarks(&between).contains("no files exist for slices 2"), "{}", remarks(&between));
    let late = load(1, 0).unwrap();
    assert_eq!(late.samples(), &voxels([1, 0], 1..5));
    let words = "5 slices are in the whole recording, and there are files for 1 to 4 of them";
    assert!(remarks(&late).contains(words), "{}", remarks(&late));
    let stopped = load(2, 0).unwrap();
    assert_eq!(stopped.samples(), &voxels([2, 0], 0..1));
    assert!(remarks(&stopped).contains("files for the first 1"), "{}", remarks(&stopped));
    assert_refused(load(2, 1), LoadErrorKind::BadInput, &["no files for t2 and c1", "--frame"]);
    // A gap in all of them.
    let all = names(|[_, c, z]| format!("{:02}_ch{c}.png", if z < 2 { z } else { z + 5 }), [1, 2, 4]);
    let volume = load_with(recording(&all).path(), choice(None, Some(0))).unwrap();
    assert_eq!(volume.samples(), &voxels([0, 0], 0..4));
    assert!(remarks(&volume).contains("between numbers 1 and 7"), "{}", remarks(&volume));
}

#[test]
fn stacks_that_go_on_counting_are_channels() {
    let all = names(|[_, c, z]| format!("ch{c}_{:02}.png", 3 * c + z), [1, 2, 3]);
    let volume = load_with(recording(&all).path(), choice(None, Some(1))).unwrap();
    assert_eq!((volume.samples(), volume.remarks().len()), (&voxels([0, 1], 0..3), 0));
}

#[test]
fn what_does_not_fit_together_stays_apart() {
    let series = |pictures: &[(String, DynamicImage)]| {
        let pictures: Vec<(&str, DynamicImage)> =
            pictures.iter().map(|(name, picture)| (name.as_str(), picture.clone())).collect();
        load_path(folder(&pictures).path()).unwrap_err().to_string()
    };
    let named = |names: &[&str], width: fn(&str) -> u32| -> Vec<(String, DynamicImage)> {
        names
            .iter()
            .map(|&name| (name.to_owned(), grey(width(name), &vec![1; width(name) as usize])))
            .collect()
    };
    // Sizes differ between channels.
    let sizes = named(&["z0_ch0.png", "z0_ch1.png", "z1_ch0.png", "z1_ch1.png"], |name| {
        if name.contains("ch1") { 3 } else { 2 }
    });
    let message = series(&sizes);
    assert!(message.contains("2 series") && message.contains("\"z#_ch1.png\" (3 x 1 x 2)"), "{message}");
    // Numbers and counts differ.
    let counts = named(&["ch0_1.png", "ch0_2.png", "ch1_3.png", "ch1_4.png", "ch1_5.png"], |_| 2);
    assert!(series(&counts).contains("2 series"));
    // Positions are other objects, each with its channels.
    let places = named(
        &[
            "xy1_z0_c0.png",
            "xy1_z0_c1.png",
            "xy1_z1_c0.png",
            "xy1_z1_c1.png",
            "xy2_z0_c0.png",
            "xy2_z0_c1.png",
            "xy2_z1_c0.png",
            "xy2_z1_c1.png",
        ],
        |_| 2,
    );
    let message = series(&places);
    assert!(message.contains("2 series") && message.contains("1 \"xy2_z#_c#.png\" (2 x 1 x 2)"), "{message}");
}

#[test]
fn times_alone_are_slices_as_before() {
    let all = names(|[t, c, _]| format!("t{t}_c{c}.png"), [2, 2, 1]);
    let volume = load_with(recording(&all).path(), choice(None, Some(1))).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![10, 0, 110, 0]));
}
