//! Tests of voxels in other files, and of files that must not be opened.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{HEADER, VOXELS, assert_refused, header_with, load_path, write, zlib};
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

/// A folder with the voxels in one file, in one file per slice, in compressed slices, and in rows.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    write(&folder, "with space.raw", "", &VOXELS);
    write(&folder, "sub/v.raw", "", &VOXELS);
    write(&folder, "skip.raw", "0123456789", &VOXELS);
    write(&folder, "100% sure.raw", "", &VOXELS);
    for (index, slice) in VOXELS.chunks(4).enumerate() {
        write(&folder, &format!("s{:03}.raw", index + 7), "", slice);
        write(&folder, &format!("t{}.raw", 20 - 10 * index), "", slice);
        write(&folder, &format!("z{}.raw", index + 1), "", &zlib(slice));
        write(&folder, &format!("row{index}.raw"), "", &slice[..2]);
        write(&folder, &format!("row{index}b.raw"), "", &slice[2..]);
    }
    folder
}

#[test]
fn data_are_found_in_one_file_or_many() {
    let folder = folder();
    for (fields, data_file) in [
        (&[][..], "with space.raw"),
        (&[], "./sub/v.raw"),
        (&[], "100% sure.raw"),
        (&["HeaderSize = 10"], "skip.raw"),
        (&["HeaderSize = -1"], "skip.raw"),
        (&["HeaderSize = -1"], "LIST\ns007.raw\ns008.raw"),
        (&[], "LIST\ns007.raw\r\n\n s008.raw\nleft over"),
        (&[], "LIST 2\ns007.raw\ns008.raw\n"),
        (&[], "LIST 2D\ns007.raw\ns008.raw\n"),
        (&[], "LIST 3\nsub/v.raw"),
        (&[], "LIST 1\nrow0.raw\nrow0b.raw\nrow1.raw\nrow1b.raw"),
        (&[], "s%03d.raw 7 8 1"),
        (&[], "s%03d.raw 7"),
        (&[], "t%d.raw 20 10 -10"),
        (&["CompressedData = True"], "z%d.raw"),
        (&["CompressedData = True", "CompressedDataSize = 3"], "z%d.raw 1 2"),
    ] {
        let header = header_with(fields) + &format!("ElementDataFile = {data_file}\n");
        let volume = load_path(&write(&folder, "v.mhd", &header, &[]), VolumeChoice::default());
        let volume = volume.unwrap_or_else(|error| panic!("{data_file}: {error}"));
        assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()), "{data_file}");
    }
    // The header's own file, with the data at its end or after a fixed offset.
    for (skip, data) in [("-1", [b"what ever", &VOXELS[..]].concat()), ("200", VOXELS.to_vec())] {
        let header = header_with(&[&format!("HeaderSize = {skip:>4}")]) + "ElementDataFile = LOCAL\n";
        let header = if skip == "200" { format!("{header:<200}") } else { header };
        let path = write(&folder, "v.mha", &header, &data);
        assert_eq!(
            *load_path(&path, VolumeChoice::default()).unwrap().samples(),
            Samples::U8(VOXELS.to_vec())
        );
    }
}

#[test]
fn time_steps_are_taken_from_their_files_alone() {
    let folder = folder();
    let fields = ["NDims = 4", "DimSize = 2 2 1 2"];
    for (files, frame) in
        [("LIST\ns007.raw\nmissing", 0), ("LIST\nmissing\ns008.raw", 1), ("s%03d.raw 7 8 1", 1)]
    {
        let header = header_with(&fields) + &format!("ElementDataFile = {files}\n");
        let path = write(&folder, "v.mhd", &header, &[]);
        let volume =
            load_path(&path, VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(VOXELS[4 * frame..][..4].to_vec()), "{files}");
    }
}

#[test]
fn data_elsewhere_and_broken_lists_are_refused() {
    let folder = folder();
    let inner = folder.path().join("sub");
    let refused = |value: &str, kind, words: &[&str]| {
        let path = write(&folder, "sub/v.mhd", &format!("{HEADER}ElementDataFile = {value}\n"), &[]);
        assert_refused(load_path(&path, VolumeChoice::default()), kind, words);
    };
    let bad = LoadErrorKind::BadInput;
    refused("../with space.raw", bad, &["out of the header's folder", "ElementDataFile"]);
    refused("/etc/passwd", bad, &["absolute"]);
    refused("http://host/v.raw", bad, &["network"]);
    refused("C:\\v.raw", bad, &["drive"]);
    refused("", bad, &["empty"]);
    refused("v.mhd", bad, &["header itself", "LOCAL"]);
    refused("LIST\n../s007.raw\n../s008.raw", bad, &["out of the header's folder"]);
    refused("LIST\nv.raw", bad, &["2 names", "1 were found"]);
    refused("LIST 9\nv.raw", bad, &["1 to 3 dimensions"]);
    refused("LIST x\nv.raw", bad, &["1 to 3 dimensions"]);
    refused("../s%03d.raw 7 8 1", bad, &["out of the header's folder"]);
    refused("s%03d.raw 7 7 1", bad, &["2 files", "7 to 7 by 1"]);
    refused("s%03d.raw 9223372036854775807 9223372036854775807 1", bad, &["2 files"]);
    refused("s%03d.raw 7 8 1", LoadErrorKind::Io, &["no such file"]);
    refused("s%03d.raw a b", LoadErrorKind::Io, &["no such file"]);
    refused("missing.raw", LoadErrorKind::Io, &["no such file"]);
    refused(".", bad, &["is a folder"]);
    write(&folder, "sub/a.raw", "", &VOXELS[..4]);
    write(&folder, "sub/b.raw", "", &VOXELS[..3]);
    refused("LIST\na.raw\nb.raw", bad, &["b.raw", "truncated", "4 bytes", "3 found"]);
    let path = write(
        &folder,
        "v.mhd",
        &(header_with(&["CompressedData = True"]) + "ElementDataFile = z%d.raw\n"),
        &[],
    );
    write(&folder, "z1.raw", "", &zlib(&VOXELS[..3]));
    assert_refused(load_path(&path, VolumeChoice::default()), bad, &["truncated", "3 found"]);
    let many = header_with(&["DimSize = 1 1 99999"]) + "ElementDataFile = s%d.raw\n";
    assert_refused(
        load_path(&write(&folder, "v.mhd", &many, &[]), VolumeChoice::default()),
        LoadErrorKind::Limit,
        &["99999 files"],
    );
    #[cfg(unix)]
    {
        let link = |target: &Path, name: &str| std::os::unix::fs::symlink(target, inner.join(name)).unwrap();
        link(&folder.path().join("skip.raw"), "link.raw");
        refused("link.raw", bad, &["link", "out of the header's folder"]);
        link(Path::new("/dev/zero"), "zero.raw");
        refused("zero.raw", bad, &["link"]);
    }
}
