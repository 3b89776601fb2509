//! Tests of the command `turntable`: animation files and folders of frames.

use crate::checks::pixels;
use crate::program::ProgramFolder;

#[test]
fn turntables_are_files_that_move_or_folders() {
    let folder = ProgramFolder::new();
    folder.run_successfully("turntable builtin:chair:16 -o turn.png --size 40x30 --frames 4 --rate 8");
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(folder.read("turn.png")))
        .expect("a PNG file");
    assert!(decoder.is_apng().expect("it can be read"));
    let frames = image::AnimationDecoder::into_frames(decoder.apng().expect("it moves"));
    let frames: Vec<_> = frames.map(|frame| frame.expect("a frame").into_buffer().into_raw()).collect();
    assert_eq!(frames.len(), 4);
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]), "the camera turns");

    folder.run_successfully("turntable builtin:chair:16 -o pictures --size 40x30 --frames 3 --light 1");
    let names = ["0000.png", "0001.png", "0002.png"].map(|name| format!("pictures/{name}"));
    assert!(names.iter().all(|name| folder.path(name).exists()));
    assert!(folder.run_successfully("replay pictures/0001.png --check").contains("identical"));
    folder.run_successfully("turntable builtin:chair:16 -o turn.gif --size 40x30 --frames 3 --transparent");
    let gif =
        image::codecs::gif::GifDecoder::new(std::io::Cursor::new(folder.read("turn.gif"))).expect("a GIF");
    let frames = image::AnimationDecoder::into_frames(gif).collect_frames().expect("its pictures");
    assert_eq!(frames.len(), 3);
    let alphas = |frame: &image::Frame| frame.buffer().pixels().filter(|pixel| pixel.0[3] == 0).count();
    assert!(frames.iter().all(|frame| (300..1150).contains(&alphas(frame))), "the background is left out");
    let outcome = folder.run("turntable builtin:chair:16 -o x.mp4 --size 40x30 --frames 3 --transparent");
    assert_eq!(outcome.code, Some(6), "{outcome:?}");
    assert!(outcome.stderr.contains("no transparency"), "{outcome:?}");
    let outcome = folder.run("turntable builtin:chair:16 -o x.png --light 9");
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("no light 9"), "{outcome:?}");
}

#[test]
fn parts_of_a_turn_are_drawn_by_several_programs() {
    let folder = ProgramFolder::new();
    let turn = "turntable builtin:chair:16 --size 40x30 --frames 5";
    folder.run_successfully(&format!("{turn} -o whole"));
    folder.run_successfully(&format!("{turn} -o parts --part 2/2"));
    assert!(!folder.path("parts/0001.png").exists() && folder.path("parts/0002.png").exists());
    folder.run_successfully(&format!("{turn} -o parts --part 1/2"));
    let is_same =
        |at: u32| folder.read(&format!("whole/000{at}.png")) == folder.read(&format!("parts/000{at}.png"));
    assert!((0..5).all(is_same));
    // Truncated and missing frames, and those of another look, are drawn again; others stay as they are.
    let bytes = folder.read("parts/0003.png");
    std::fs::write(folder.path("parts/0003.png"), &bytes[..bytes.len() / 2]).expect("a part of a file");
    std::fs::remove_file(folder.path("parts/0002.png")).expect("it was there");
    std::fs::copy(folder.path("parts/0001.png"), folder.path("parts/0004.png")).expect("another picture");
    let written_at = |at: u32| {
        let path = folder.path(&format!("parts/000{at}.png"));
        std::fs::metadata(path).and_then(|file| file.modified()).expect("a file")
    };
    let before = written_at(1);
    folder.run_successfully(&format!("{turn} -o parts --only 1..4"));
    assert!((0..5).all(is_same));
    assert_eq!(written_at(1), before, "it was there");
    for (wrong, why) in [
        ("-o parts --part 3/2", "expected a part"),
        ("-o parts --only 3..5", "there is no frame 5"),
        ("-o parts.gif --part 1/2", "into a folder"),
        ("-o parts --part 1/2 --only 0..1", "cannot be used with"),
    ] {
        let outcome = folder.run(&format!("{turn} {wrong}"));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(why), "{outcome:?}");
    }
}

#[test]
fn frames_show_the_finest_level_that_their_pixels_call_for() {
    let folder = ProgramFolder::new();
    folder.run_successfully("convert builtin:chair:256 chair.ome.zarr");
    let look = "--size 200x150 --set camera.distance=1.5";
    folder.run_successfully(&format!("turntable chair.ome.zarr -o turn --frames 2 --pool 32MiB {look}"));
    let frames = ["turn/0000.png", "turn/0001.png"].map(|name| pixels(&folder.path(name)));
    folder.run_successfully(&format!("render chair.ome.zarr -o one.png --pool 64MiB --require-full {look}"));
    assert!(frames[0] == pixels(&folder.path("one.png")) && frames[0] != frames[1]);
    assert!(
        folder
            .run_successfully("replay turn/0001.png --check --pool 32MiB --trust-paths")
            .contains("identical")
    );
}
