//! Tests of the command `turntable`: animation files and folders of frames.

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
