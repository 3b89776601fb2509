//! Surface meshes, which are not volumes.

use std::path::Path;

use super::UnsupportedFormat;
use super::mark::{Look, Mark};

/// Command that voxelises a surface.
const HELP: &str = "open the volume that it was made from, or fill it with voxels: python -c \"import trimesh, numpy; \
                    m = trimesh.load('IN', force='mesh'); \
                    numpy.save('OUT.npy', m.voxelized(m.scale / 256).fill().matrix.astype('u1'))\"";

/// Returns true for a binary STL file: a header of 80 bytes, the number of triangles, and 50 bytes for each.
fn is_binary_stl(look: &Look) -> bool {
    let count = look.stored.get(80..84).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    let is_called_so = Path::new(&look.name).extension().is_some_and(|ending| ending == "stl");
    is_called_so && count.is_some_and(|count| 84 + 50 * u64::from(count) == look.length)
}

/// Returns true for Wavefront OBJ text: vertices come first, except for comments, names and materials.
fn is_obj(look: &Look) -> bool {
    let text = look.text();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let before = ["#", "mtllib", "o ", "g ", "s ", "usemtl"];
    let first = lines.find(|line| !before.iter().any(|word| line.starts_with(word)));
    let is_vertex = |line: &str| {
        let mut words = line.split_whitespace();
        words.next() == Some("v")
            && words.clone().count() >= 3
            && words.all(|word| word.parse::<f64>().is_ok())
    };
    first.is_some_and(is_vertex)
}

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a surface (STL), not a volume",
        marks: &[Mark::WordsWith("solid", "facet"), Mark::Test(is_binary_stl)],
        endings: &[".stl"],
        help: HELP,
    },
    UnsupportedFormat {
        what: "a surface (PLY), not a volume",
        marks: &[Mark::Bytes(0, b"ply\n"), Mark::Bytes(0, b"ply\r")],
        endings: &[".ply"],
        help: HELP,
    },
    UnsupportedFormat {
        what: "a surface (OBJ), not a volume",
        marks: &[Mark::Test(is_obj)],
        endings: &[".obj"],
        help: HELP,
    },
    UnsupportedFormat {
        what: "a scene of surfaces (glTF), not a volume",
        marks: &[Mark::Bytes(0, b"glTF"), Mark::Named(0, b"{", &[".gltf"])],
        endings: &[".glb", ".gltf"],
        help: HELP,
    },
    UnsupportedFormat {
        what: "a surface (OFF), not a volume",
        marks: &[Mark::Named(0, b"OFF", &[".off"])],
        endings: &[".off"],
        help: HELP,
    },
    UnsupportedFormat {
        what: "a surface of FreeSurfer, not a volume",
        marks: &[Mark::Holding(0, b"\xff\xff\xfe", b"created by")],
        endings: &[".pial", ".white", ".inflated"],
        help: "open the volume beside it, as in mri/brain.mgz of the same subject",
    },
    UnsupportedFormat {
        what: "a surface (GIFTI), not a volume",
        marks: &[Mark::WordsWith("<?xml", "<gifti")],
        endings: &[".gii"],
        help: "open the volume that it was made from",
    },
];
