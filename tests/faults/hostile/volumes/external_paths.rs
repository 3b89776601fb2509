//! Headers that name files elsewhere: above their folder, absolute, through links, on other machines, devices.

use std::path::Path;

use super::super::files::hostile_names;
use super::{BrokenVolume, BrokenVolumeMaker};
use crate::samples::stored_samples;

pub(super) fn add_external_paths(made: &mut BrokenVolumeMaker, forbidden: &Path) {
    let kept = stored_samples();
    let of = |name: &str| kept.iter().find(|(kept, _)| *kept == name).expect("it is kept").1.clone();
    // Beside the forbidden folder, as the names expect it.
    let folder = made.folder.join("places");
    std::fs::create_dir(&folder).expect("a folder");
    for (at, name) in hostile_names(&folder, forbidden).iter().enumerate() {
        let escaped = name.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
        for (ending, text) in [
            (
                "nhdr",
                format!(
                    "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\ndata file: {name}\n"
                ),
            ),
            (
                "nrrd",
                format!(
                    "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\ndata file: LIST\n{name}\n"
                ),
            ),
            (
                "mhd",
                format!("NDims = 3\nDimSize = 8 8 8\nElementType = MET_UCHAR\nElementDataFile = {name}\n"),
            ),
            (
                "mha",
                format!(
                    "NDims = 3\nDimSize = 8 8 8\nElementType = MET_UCHAR\nElementDataFile = LIST\n{name}\n"
                ),
            ),
            ("dat", format!("ObjectFileName: {name}\nResolution: 8 8 8\nFormat: UCHAR\n")),
            (
                "ivf",
                format!(
                    "<I><RawFile content=\"{escaped}\"/><Format content=\"UINT8\"/><Dimension x=\"8\" y=\"8\" z=\"8\"/></I>"
                ),
            ),
            (
                "companion.ome",
                format!(
                    "<OME><Image><Pixels SizeX=\"8\" SizeY=\"8\" SizeZ=\"1\" SizeC=\"1\" SizeT=\"1\"><TiffData><UUID \
                     FileName=\"{escaped}\">urn:uuid:1</UUID></TiffData></Pixels></Image></OME>"
                ),
            ),
            (
                "vti",
                format!(
                    "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 7 0 7 0 7\"><Piece Extent=\"0 7 0 7 0 7\" \
                     Source=\"{escaped}\"/></ImageData></VTKFile>"
                ),
            ),
        ] {
            add_file_at(made, &folder.join(format!("place_{at}.{ending}")), text.as_bytes(), name);
        }
        // Only pages name other files: the description is replaced by another of the same length or less.
        let ome = of("ome.tif");
        let xml = format!(
            "<?xml version=\"1.0\"?><OME><BinaryOnly MetadataFile=\"{escaped}\" UUID=\"urn:uuid:1\"/></OME>"
        );
        let start = super::text_headers::find_bytes(&ome, b"<?xml")
            .or_else(|| super::text_headers::find_bytes(&ome, b"<OME"))
            .expect("OME");
        let room = ome[start..].iter().position(|&byte| byte == 0).unwrap_or(ome.len() - start);
        if xml.len() <= room {
            let padded = [xml.as_bytes(), &b" ".repeat(room - xml.len())].concat();
            let changed = [&ome[..start], &padded, &ome[start + room..]].concat();
            add_file_at(made, &folder.join(format!("place_{at}.ome.tif")), &changed, name);
        }
    }
    add_linked_pairs(made, &folder, forbidden);
}

fn add_file_at(made: &mut BrokenVolumeMaker, path: &Path, bytes: &[u8], name: &str) {
    std::fs::write(path, bytes).expect("room");
    let what = format!("names {:?}", name.chars().take(60).collect::<String>());
    made.cases.push(BrokenVolume { fault: what, path: path.to_owned(), is_forbidden: true });
}

/// Adds pairs of files of which the second, or the voxels of a description, is a link.
#[cfg(unix)]
fn add_linked_pairs(made: &mut BrokenVolumeMaker, folder: &Path, forbidden: &Path) {
    let header: Vec<u8> = {
        let mut bytes =
            stored_samples().into_iter().find(|(name, _)| *name == "plain.nii").expect("it is kept").1;
        bytes.truncate(348);
        bytes[344..348].copy_from_slice(b"ni1\0");
        bytes
    };
    for (at, ending) in ["img", "img.gz", "IMG"].into_iter().enumerate() {
        let path = folder.join(format!("pair_{at}.hdr"));
        std::os::unix::fs::symlink(forbidden.join("voxels.raw"), folder.join(format!("pair_{at}.{ending}")))
            .expect("a link");
        add_file_at(made, &path, &header, ending);
    }
    let link = folder.join("linked.raw");
    std::os::unix::fs::symlink(forbidden.join("voxels.raw"), link).expect("a link");
    add_file_at(
        made,
        &folder.join("linked.raw.ini"),
        b"dimx:8\ndimy:8\ndimz:8\nskip:0\nformat:uint8\n",
        "linked.raw",
    );
}

/// Only Unix systems let every user create links.
#[cfg(not(unix))]
fn pairs(_made: &mut BrokenVolumeMaker, _folder: &Path, _forbidden: &Path) {}
