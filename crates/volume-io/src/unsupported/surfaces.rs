//! Surface meshes, which are not volumes.

use std::path::Path;

use super::UnsupportedFormat;
use super::signature::{FormatSignature, InspectedFile};

/// Command that voxelises a surface.
const HELP: &str = "open the volume that it was made from, or fill it with voxels: python -c \"import trimesh, numpy; \
                    m = trimesh.load('IN', force='mesh'); \
                    numpy.save('OUT.npy', m.voxelized(m.scale / 256).fill().matrix.astype('u1'))\"";

/// Returns true for a binary STL file: a header of 80 bytes, the number of triangles, and 50 bytes for each.
fn is_binary_stl(look: &InspectedFile) -> bool {
    let count = look.stored.get(80..84).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    let is_called_so = Path::new(&look.name).extension().is_some_and(|ending| ending == "stl");
    is_called_so && count.is_some_and(|count| 84 + 50 * u64::from(count) == look.length)
}

/// Returns true for Wavefront OBJ text: vertices come first, except for comments, names and materials.
fn is_obj(look: &InspectedFile) -> bool {
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
        description: "a surface (STL), not a volume",
        signatures: &[FormatSignature::TextWith("solid", "facet"), FormatSignature::Test(is_binary_stl)],
        extensions: &[".stl"],
        advice: HELP,
    },
    UnsupportedFormat {
        description: "a surface (PLY), not a volume",
        signatures: &[FormatSignature::Bytes(0, b"ply\n"), FormatSignature::Bytes(0, b"ply\r")],
        extensions: &[".ply"],
        advice: HELP,
    },
    UnsupportedFormat {
        description: "a surface (OBJ), not a volume",
        signatures: &[FormatSignature::Test(is_obj)],
        extensions: &[".obj"],
        advice: HELP,
    },
    UnsupportedFormat {
        description: "a scene of surfaces (glTF), not a volume",
        signatures: &[
            FormatSignature::Bytes(0, b"glTF"),
            FormatSignature::BytesWithExtension(0, b"{", &[".gltf"]),
        ],
        extensions: &[".glb", ".gltf"],
        advice: HELP,
    },
    UnsupportedFormat {
        description: "a surface (OFF), not a volume",
        signatures: &[FormatSignature::BytesWithExtension(0, b"OFF", &[".off"])],
        extensions: &[".off"],
        advice: HELP,
    },
    UnsupportedFormat {
        description: "a surface of FreeSurfer, not a volume",
        signatures: &[FormatSignature::Container(0, b"\xff\xff\xfe", b"created by")],
        extensions: &[".pial", ".white", ".inflated"],
        advice: "open the volume beside it, as in mri/brain.mgz of the same subject",
    },
    UnsupportedFormat {
        description: "a surface (GIFTI), not a volume",
        signatures: &[FormatSignature::TextWith("<?xml", "<gifti")],
        extensions: &[".gii"],
        advice: "open the volume that it was made from",
    },
];
