//! Tests of detached NRRD data files, and of files that must not be opened.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{HEADER, VOXELS, assert_refused, load_path, write};
use chiaroscuro_volume::{LoadErrorKind, Samples};

#[test]
fn detached_data_are_found_below_the_header() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    write(&folder, "with space.raw", "", &VOXELS);
    write(&folder, "sub/v.raw", "", &VOXELS);
    for field in ["data file: with space.raw", "datafile: ./sub/v.raw", "Data File: sub/v.raw"] {
        for end in ["", "\n\n"] {
            let path = write(&folder, "v.nhdr", &format!("{HEADER}{field}{end}"), &[]);
            assert_eq!(*load_path(&path).unwrap().samples(), Samples::U8(VOXELS.to_vec()), "{field}");
        }
    }
}

#[test]
fn detached_data_elsewhere_are_refused() {
    let folder = TempDir::new().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::create_dir(folder.path().join("inner2")).unwrap();
    let secret = write(&folder, "inner2/secret.raw", "", &VOXELS);
    let refused = |value: &str, kind, words: &[&str]| {
        let path = write(&folder, "inner/v.nhdr", &format!("{HEADER}data file: {value}\n"), &[]);
        assert_refused(load_path(&path), kind, words);
    };
    let bad = LoadErrorKind::BadInput;
    refused(secret.to_str().unwrap(), bad, &["absolute", "data file"]);
    refused("../inner2/secret.raw", bad, &["out of the header's folder"]);
    refused("sub/../../inner2/secret.raw", bad, &["out of the header's folder"]);
    refused("http://host/secret.raw", bad, &["network"]);
    refused("\\\\host\\share\\secret.raw", bad, &["absolute"]);
    refused("C:\\secret.raw", bad, &["drive"]);
    refused("a\0b.raw", bad, &["zero byte"]);
    refused("", bad, &["empty"]);
    for list in ["LIST\n{}\nb.raw", "LIST 2\n{}\nb.raw"] {
        refused(&list.replace("{}", "../inner2/secret.raw"), bad, &["out of the header's folder"]);
        refused(&list.replace("{}", secret.to_str().unwrap()), bad, &["absolute"]);
    }
    refused("../inner2/secret%d.raw 1 2 1", bad, &["out of the header's folder"]);
    refused("slice%03d.raw 1 2 1", LoadErrorKind::Io, &["no such file"]);
    refused("missing.raw", LoadErrorKind::Io, &["no such file"]);
    refused(".", bad, &["is a folder"]);
    #[cfg(unix)]
    {
        let link = |target: &Path, name: &str| std::os::unix::fs::symlink(target, inner.join(name)).unwrap();
        link(&secret, "link.raw");
        refused("link.raw", bad, &["link", "out of the header's folder"]);
        link(secret.parent().unwrap(), "linked");
        refused("linked/secret.raw", bad, &["link"]);
        link(Path::new("/dev/zero"), "zero.raw");
        refused("zero.raw", bad, &["link"]);
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed_where_repositories_keep_their_files() {
    use std::os::unix::fs::symlink;
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    let expected = Samples::U8(VOXELS.to_vec());
    let header = format!("{HEADER}data file: v.raw\n");
    // As in git-annex: header and data are links into its content-addressed store.
    for store in [".git/annex/objects", ".dvc/cache"] {
        let root = path(&store.replace(['/', '.'], "_"));
        fs::create_dir_all(root.join(store).join("ab")).unwrap();
        fs::create_dir_all(root.join("sub/anat")).unwrap();
        fs::write(root.join(store).join("ab/header"), &header).unwrap();
        fs::write(root.join(store).join("ab/data"), VOXELS).unwrap();
        let to = Path::new("../..").join(store);
        symlink(to.join("ab/header"), root.join("sub/anat/v.nhdr")).unwrap();
        symlink(to.join("ab/data"), root.join("sub/anat/v.raw")).unwrap();
        assert_eq!(*load_path(&root.join("sub/anat/v.nhdr")).unwrap().samples(), expected, "{store}");
        // Content that has not been fetched yet.
        fs::remove_file(root.join(store).join("ab/data")).unwrap();
        let words = ["link to a file that is not there", "datalad get"];
        assert_refused(load_path(&root.join("sub/anat/v.nhdr")), LoadErrorKind::Io, &words);
        fs::remove_file(root.join(store).join("ab/header")).unwrap();
        assert_refused(load_path(&root.join("sub/anat/v.nhdr")), LoadErrorKind::Io, &words);
    }
    // A header that is a link: its data lie beside the link, or beside its target.
    fs::create_dir_all(path("study")).unwrap();
    fs::create_dir_all(path("desk")).unwrap();
    fs::write(path("study/v.nhdr"), &header).unwrap();
    fs::write(path("study/v.raw"), VOXELS).unwrap();
    symlink(path("study/v.nhdr"), path("desk/v.nhdr")).unwrap();
    assert_eq!(*load_path(&path("desk/v.nhdr")).unwrap().samples(), expected);
    symlink(path("study/v.raw"), path("desk/v.raw")).unwrap();
    assert_eq!(*load_path(&path("desk/v.nhdr")).unwrap().samples(), expected);
    // A link in place of a store is not trusted.
    fs::create_dir_all(path("hostile/.git/annex")).unwrap();
    symlink(path("study"), path("hostile/.git/annex/objects")).unwrap();
    fs::write(path("hostile/v.nhdr"), &header).unwrap();
    symlink(path("study/v.raw"), path("hostile/v.raw")).unwrap();
    assert_refused(
        load_path(&path("hostile/v.nhdr")),
        LoadErrorKind::BadInput,
        &["out of the header's folder"],
    );
}

#[test]
fn data_in_several_files_are_put_together() {
    let folder = TempDir::new().unwrap();
    for (number, voxels) in VOXELS.chunks(4).enumerate() {
        write(&folder, &format!("s{number:02}.raw"), "", voxels);
        write(&folder, &format!("skip{number}.raw"), "line\nxx", voxels);
        write(&folder, &format!("z{number}.gz"), "", &super::gzip(voxels));
    }
    for (number, voxels) in VOXELS.chunks(2).enumerate() {
        write(&folder, &format!("row {number}"), "", voxels);
    }
    let load = |lines: &str| load_path(&write(&folder, "v.nhdr", &format!("{HEADER}{lines}\n"), &[]));
    let expected = Samples::U8(VOXELS.to_vec());
    for lines in [
        "data file: LIST\ns00.raw\n\n./s01.raw",
        "data file: LIST 2\r\ns00.raw\r\ns01.raw\r",
        "data file: LIST 3\ns00.raw\ns01.raw",
        "data file: LIST 1\nrow 0\nrow 1\nrow 2\nrow 3",
        "data file: s%02d.raw 0 1 1",
        "datafile: s%02d.raw 0 1 1 3",
        "line skip: 1\nbyte skip: 2\ndata file: skip%d.raw 0 1 1",
        "byte skip: -1\ndata file: skip%i.raw 0 1 1",
    ] {
        assert_eq!(*load(lines).unwrap().samples(), expected, "{lines}");
    }
    let zipped = HEADER.replace("raw", "gzip");
    let path = write(&folder, "z.nhdr", &format!("{zipped}data file: z%d.gz 0 1 1\n"), &[]);
    assert_eq!(*load_path(&path).unwrap().samples(), expected);
    let backwards = load("data file: s%02d.raw 1 0 -1").unwrap();
    assert_eq!(*backwards.samples(), Samples::U8(vec![5, 6, 7, 8, 1, 2, 3, 4]));
    let bad = LoadErrorKind::BadInput;
    for (lines, words) in [
        ("data file: LIST", &["0 are named"][..]),
        ("data file: LIST\ns00.raw", &["1 files", "2 were expected"]),
        ("data file: LIST 1\ns00.raw\ns01.raw", &["4 were expected"]),
        ("data file: LIST 9\ns00.raw\ns01.raw", &["dimension", "\"9\""]),
        ("data file: LIST 3\ns00.raw\ns01.raw\ns00.raw", &["3 files"]),
        ("data file: s%02d.raw 0 1 0", &["steps of 0"]),
        ("data file: s%d%d.raw 0 1 1", &["one number"]),
        ("byte skip: 1\ndata file: s%02d.raw 0 1 1", &["truncated", "s00.raw"]),
    ] {
        assert_refused(load(lines), bad, words);
    }
    assert_refused(load("data file: s%02d.raw 0 99999 1"), LoadErrorKind::Limit, &["100000 files"]);
}
