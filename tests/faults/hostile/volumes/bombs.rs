//! Decompression bombs, which expand to far more than stated, and endless nesting.

use std::io::Write as _;

use bzip2::write::BzEncoder;
use flate2::Compression;
use flate2::write::{DeflateEncoder, ZlibEncoder};

use super::BrokenVolumeMaker;
use super::text_headers::find_bytes;
use crate::samples::{gzip, stored_samples};

/// Size in MiB to which bombs expand.
const BOMB_MEBIBYTES: usize = 48;

/// Depth of nesting, in elements.
const NESTING_DEPTH: usize = 100_000;

pub(super) fn add_bombs(made: &mut BrokenVolumeMaker) {
    let zeros = vec![0u8; BOMB_MEBIBYTES << 20];
    let (small, packed) = ([7u8; 64], gzip(&zeros));
    add_text_header_bombs(made, &zeros, &packed);
    let kept = stored_samples();
    let of = |name: &str| kept.iter().find(|(kept, _)| *kept == name).expect("it is kept").1.clone();
    // Compressed as a whole.
    for (name, start) in [("plain.nii", 352), ("density.mrc", 1024), ("array.npy", 128), ("packed.pvm", 0)] {
        let bytes = of(name);
        let bomb = [&bytes[..start], zeros.as_slice()].concat();
        made.add("packed zeros behind a header", &format!("{name}.gz"), &gzip(&bomb));
        // A header that claims that all of it, or much more, is voxels.
        let mut large = bomb;
        match name {
            "plain.nii" => large[42..48].copy_from_slice(&[0, 4, 0, 4, 0, 4]),
            "density.mrc" => large[..12].copy_from_slice(&[0, 8, 0, 0, 0, 8, 0, 0, 0, 8, 0, 0]),
            _ => continue,
        }
        made.add("packed zeros, and more are said", &format!("{name}.gz"), &gzip(&large));
    }
    made.add("packed zeros", "8x8x8_uint8.raw.gz", &packed);
    made.add("packed zeros, and more are said", "2048x2048x2048_uint8.raw.gz", &packed);
    made.add("packed twice", "volume.nii.gz", &gzip(&packed));
    add_deflated_dicom(made, &of("deflated.dcm"), &zeros);
    add_nested_dicom(made, &of("frames.dcm"));
    add_nested_xml(made);
    add_npz_bombs(made, &zeros);
    add_endless_headers(made, &small);
}

/// Adds text headers before compressed voxels.
fn add_text_header_bombs(made: &mut BrokenVolumeMaker, zeros: &[u8], packed: &[u8]) {
    let mut bzip2 = BzEncoder::new(Vec::new(), bzip2::Compression::best());
    bzip2.write_all(zeros).expect("it is in memory");
    let bzip2 = bzip2.finish().expect("it is in memory");
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::best());
    zlib.write_all(zeros).expect("it is in memory");
    let zlib = zlib.finish().expect("it is in memory");
    for sizes in ["4 4 4", "512 512 512", "1024 1024 2048", "100000 100000 100000"] {
        for (encoding, data) in
            [("gzip", packed), ("bzip2", &bzip2[..]), ("hex", &b"00"[..]), ("text", &b"0 0 0"[..])]
        {
            let header =
                format!("NRRD0004\ntype: uint8\ndimension: 3\nsizes: {sizes}\nencoding: {encoding}\n\n");
            made.add(format!("{encoding} of {sizes}"), "bomb.nrrd", &[header.as_bytes(), data].concat());
        }
        let header = format!(
            "ObjectType = Image\nNDims = 3\nBinaryData = True\nCompressedData = True\nElementSpacing = 1 1 1\n\
             DimSize = {sizes}\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"
        );
        made.add(format!("zlib of {sizes}"), "bomb.mha", &[header.as_bytes(), &zlib].concat());
        let last: Vec<u64> = sizes.split(' ').map(|n| n.parse::<u64>().expect("a number") - 1).collect();
        // One block: number of blocks, size of each, size of the last, compressed size.
        let counts = [1u32, u32::MAX, 0, zlib.len() as u32].map(u32::to_le_bytes).concat();
        let header = format!(
            "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" \
             compressor=\"vtkZLibDataCompressor\"><ImageData WholeExtent=\"0 {0} 0 {1} 0 {2}\" Spacing=\"1 1 1\"><Piece \
             Extent=\"0 {0} 0 {1} 0 {2}\"><PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" \
             offset=\"0\"/></PointData></Piece></ImageData><AppendedData encoding=\"raw\">_",
            last[0], last[1], last[2]
        );
        made.add(format!("zlib of {sizes}"), "bomb.vti", &[header.as_bytes(), &counts, &zlib].concat());
        // Very many empty blocks.
        let counts = [u32::MAX, 1, 1].map(u32::to_le_bytes).concat();
        made.add(format!("blocks of {sizes}"), "blocks.vti", &[header.as_bytes(), &counts, &zlib].concat());
    }
}

/// Adds DICOM files whose data set, or whose pixels, expand to much.
fn add_deflated_dicom(made: &mut BrokenVolumeMaker, bytes: &[u8], zeros: &[u8]) {
    // The data set begins after the file's meta group, whose length is in its first element.
    let length = u32::from_le_bytes(bytes[140..144].try_into().expect("four bytes")) as usize;
    let start = &bytes[..144 + length];
    let deflated = |data: &[u8]| {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(data).expect("it is in memory");
        encoder.finish().expect("it is in memory")
    };
    made.add("a data set of zeros", "bomb.dcm", &[start, &deflated(zeros)].concat());
    let element =
        [&[0x28, 0, 0x10, 0, b'U', b'S', 2, 0, 1, 0][..], &[0x20, 0, 0, 0x40, b'L', b'T', 0xfe, 0xff]]
            .concat();
    made.add("a long text", "bomb.dcm", &[start, &deflated(&[element.as_slice(), zeros].concat())].concat());
}

/// Adds DICOM files with sequences nested in sequences.
fn add_nested_dicom(made: &mut BrokenVolumeMaker, bytes: &[u8]) {
    let length = u32::from_le_bytes(bytes[140..144].try_into().expect("four bytes")) as usize;
    let start = &bytes[..144 + length];
    let endless = [0xff; 4];
    let sequence =
        [&[0x08, 0, 0x40, 0x11, b'S', b'Q', 0, 0][..], &endless, &[0xfe, 0xff, 0, 0xe0], &endless].concat();
    made.add("sequences in sequences", "deep.dcm", &[start, &sequence.repeat(NESTING_DEPTH)].concat());
    // With lengths that each enclose the next.
    let mut nested = Vec::new();
    for depth in (0..2000u32).rev() {
        let inner = 20 * (1999 - depth);
        let head = [0x08, 0, 0x40, 0x11, b'S', b'Q', 0, 0].to_vec();
        nested.extend(
            [
                head,
                (inner + 8).to_le_bytes().to_vec(),
                vec![0xfe, 0xff, 0, 0xe0],
                inner.to_le_bytes().to_vec(),
            ]
            .concat(),
        );
    }
    made.add("sequences of lying lengths", "deep.dcm", &[start, &nested].concat());
    let items = [0xfe, 0xff, 0, 0xe0, 0, 0, 0, 0].repeat(NESTING_DEPTH);
    let many = [&[0x08, 0, 0x40, 0x11, b'S', b'Q', 0, 0][..], &endless, &items].concat();
    made.add("a sequence of very many items", "wide.dcm", &[start, &many].concat());
}

/// Adds XML files with nested elements, recursive entities, and external files.
fn add_nested_xml(made: &mut BrokenVolumeMaker) {
    let kept = stored_samples();
    let ome = &kept.iter().find(|(name, _)| *name == "ome.tif").expect("it is kept").1;
    let deep = "<a>".repeat(NESTING_DEPTH);
    let laugh = |at: usize| format!("<!ENTITY l{at} \"{}\">", format!("&l{};", at - 1).repeat(10));
    let laughs = (1..10).map(laugh).collect::<Vec<_>>().concat();
    let doctypes = [
        format!("<!DOCTYPE x [<!ENTITY l0 \"ha\">{laughs}]>"),
        "<!DOCTYPE x SYSTEM \"/etc/passwd\">".to_owned(),
        "<!DOCTYPE x [<!ENTITY e SYSTEM \"file:///etc/passwd\">]>".to_owned(),
    ];
    let image = |inner: &str| {
        format!(
            "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\">{inner}</ImageData></VTKFile>"
        )
    };
    let described = |inner: &str| {
        format!("<I><RawFile content=\"described.raw\"/><Format content=\"UINT8\"/>{inner}</I>")
    };
    for (name, text) in [("odd.vti", image(&deep)), ("odd.ivf", described(&deep)), ("odd.vti", deep.clone())]
    {
        made.add("elements in elements", name, text.as_bytes());
    }
    let attributes = (0..NESTING_DEPTH).map(|at| format!(" a{at}=\"1\"")).collect::<Vec<_>>().concat();
    for (name, text) in [
        ("odd.vti", image(&format!("<Piece{attributes}/>"))),
        ("odd.ivf", described(&format!("<b{attributes}/>"))),
    ] {
        made.add("attributes without end", name, text.as_bytes());
    }
    for doctype in &doctypes {
        for (name, inner) in [
            ("odd.vti", image("&l9;&e;")),
            ("odd.ivf", described("<Dimension x=\"&l9;\" y=\"&e;\" z=\"4\"/>")),
        ] {
            made.add(
                doctype.chars().take(60).collect::<String>(),
                name,
                format!("{doctype}{inner}").as_bytes(),
            );
        }
        // The description of the first page, within its original length.
        let start = find_bytes(ome, b"<?xml").or_else(|| find_bytes(ome, b"<OME")).expect("it is OME");
        let mut changed = ome.clone();
        let text = format!("{doctype}<OME>&l9;&e;</OME>");
        let end = (start + text.len()).min(changed.len());
        changed[start..end].copy_from_slice(&text.as_bytes()[..end - start]);
        made.add("a description with entities", "odd.ome.tif", &changed);
    }
    made.add("a dictionary in dictionaries", "odd.npy", &npy_file(&"{'a':".repeat(10_000)));
    made.add("lists in lists", "odd.npy", &npy_file(&"(".repeat(60_000)));
}

/// NumPy file with a header.
fn npy_file(header: &str) -> Vec<u8> {
    [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes()[..], header.as_bytes()].concat()
}

/// Adds archives of one array that is much longer, or much shorter, than its header says.
fn add_npz_bombs(made: &mut BrokenVolumeMaker, zeros: &[u8]) {
    for shape in ["(4, 4, 4)", "(512, 512, 512)", "(4096, 4096, 4096)"] {
        let header = npy_file(&format!("{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}, }}\n"));
        let content = [header.as_slice(), zeros].concat();
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&content).expect("it is in memory");
        let packed = encoder.finish().expect("it is in memory");
        for said in [content.len() as u32, u32::MAX - 1, 10] {
            let of = |length: u32| length.to_le_bytes();
            let sizes = [[0; 4], of(packed.len() as u32), of(said)].concat();
            let local =
                [&b"PK\x03\x04\x14\0\0\0\x08\0\0\0\0\0"[..], &sizes, b"\x05\0\0\0a.npy", &packed].concat();
            let listed =
                [&b"PK\x01\x02\x14\0\x14\0\0\0\x08\0\0\0\0\0"[..], &sizes, b"\x05\0", &[0; 16], b"a.npy"]
                    .concat();
            let end = [
                &b"PK\x05\x06\0\0\0\0\x01\0\x01\0"[..],
                &of(listed.len() as u32)[..],
                &of(local.len() as u32),
                b"\0\0",
            ];
            made.add(format!("{shape}, {said} bytes"), "bomb.npz", &[local, listed, end.concat()].concat());
        }
    }
}

/// Adds lists and numbers that do not end.
fn add_endless_headers(made: &mut BrokenVolumeMaker, data: &[u8]) {
    let fields = "key:=value\n".repeat(NESTING_DEPTH);
    let header = format!("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n{fields}\n");
    made.add("keys without end", "wide.nrrd", &[header.as_bytes(), data].concat());
    let names = "listed.raw\n".repeat(NESTING_DEPTH);
    let header = "NDims = 3\nDimSize = 4 4 100000\nElementType = MET_UCHAR\nElementDataFile = LIST\n";
    made.add("files without end", "wide.mhd", format!("{header}{names}").as_bytes());
    let header = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 100000\nencoding: raw\ndata file: LIST\n{names}"
    );
    made.add("files without end", "wide.nhdr", header.as_bytes());
    for pattern in [
        "listed%d.raw 1 999999999 1",
        "listed%999999999d.raw 1 9 1",
        "%s%s%s%n.raw 1 9 1",
        "listed%d.raw 9 1 0",
    ] {
        let header = format!(
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 9\nencoding: raw\ndata file: {pattern}\n"
        );
        made.add(pattern, "many.nhdr", header.as_bytes());
        let header =
            format!("NDims = 3\nDimSize = 4 4 9\nElementType = MET_UCHAR\nElementDataFile = {pattern}\n");
        made.add(pattern, "many.mhd", header.as_bytes());
    }
    let atoms = "T\nt\n-9999999 0 0 0\n4 1 0 0\n4 0 1 0\n4 0 0 1\n";
    made.add("atoms that are not there", "odd.cube", atoms.as_bytes());
    made.add(
        "a word without end",
        "odd.cube",
        &[&b"T\nt\n0 0 0 0\n4 1 0 0\n4 0 1 0\n4 0 0 1\n"[..], &vec![b'1'; 1 << 20]].concat(),
    );
    let header =
        b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 4 4\nPOINT_DATA 64\n";
    let arrays = "SCALARS a char 1\nLOOKUP_TABLE default\n1\n".repeat(20_000);
    made.add("arrays without end", "wide.vtk", &[&header[..], arrays.as_bytes()].concat());
    made.add(
        "a table without end",
        "wide.vtk",
        &[&header[..], b"LOOKUP_TABLE a 4294967295\nSCALARS b char\n"].concat(),
    );
}
