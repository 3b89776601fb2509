//! Data files beside the header, and those that must not be opened.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{HEADER, VOXELS, assert_refused, load_path, write};
use crate::data::Samples;
use crate::data::load::LoadErrorKind;

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
    refused("LIST\na.raw\nb.raw", bad, &["several files", "unu"]);
    refused("slice%03d.raw 1 2 1", bad, &["several files"]);
    refused("missing.raw", LoadErrorKind::Io, &["no such file"]);
    refused(".", LoadErrorKind::Io, &["directory"]);
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
