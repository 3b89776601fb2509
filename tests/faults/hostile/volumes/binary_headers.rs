//! Formats with binary headers: each number is replaced by impossible values.

use super::BrokenVolumeMaker;
use super::text_headers::find_bytes;
use crate::samples::{gzip, stored_samples};

/// Values that replace a number in a header.
const IMPOSSIBLE_NUMBERS: [u32; 8] =
    [0, 1, 0x7fff, 0xffff, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x7fc0_0000];

/// Copy of a file with a number replaced.
fn with_number(bytes: &[u8], at: usize, number: &[u8]) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    if let Some(place) = changed.get_mut(at..at + number.len()) {
        place.copy_from_slice(number);
    }
    changed
}

pub(super) fn add_binary_headers(made: &mut BrokenVolumeMaker) {
    let kept = stored_samples();
    let of = |name: &str| kept.iter().find(|(kept, _)| *kept == name).expect("it is kept").1.clone();
    nifti(made, &of("plain.nii"));
    mrc(made, &of("density.mrc"));
    mgh(made, &of("brain.mgh"));
    // BigTIFF: offset of the directory, number of its entries, and its first entries.
    let big = of("tiles.tif");
    for at in (4..16).chain(big.len() - 200..big.len()).step_by(4) {
        for value in IMPOSSIBLE_NUMBERS {
            made.add(
                format!("four bytes at {at} are {value:x}"),
                "tiles.tif",
                &with_number(&big, at, &value.to_be_bytes()),
            );
        }
    }
    for name in ["lzw.tif", "zstd.tif", "jpeg.tif", "colors.tif", "imagej.tif", "ome.tif"] {
        tiff(made, name, &of(name));
    }
    for name in [
        "frames.dcm",
        "runs.dcm",
        "jpeg.dcm",
        "extended.dcm",
        "jpeg_2000.dcm",
        "jpeg_ls.dcm",
        "jpeg_ls_colour.dcm",
        "lossless.dcm",
    ] {
        dicom(made, name, &of(name));
    }
    npz(made, &of("arrays.npz"));
    pvm(made);
}

/// Adds `NIfTI` files with hostile dimensions, type, bits, spacing, voxel offset, scale and orientation codes.
fn nifti(made: &mut BrokenVolumeMaker, bytes: &[u8]) {
    for at in [0, 70, 72].into_iter().chain((40..56).step_by(2)) {
        for value in IMPOSSIBLE_NUMBERS {
            let changed = with_number(bytes, at, &(value as u16).to_le_bytes());
            made.add(format!("two bytes at {at} are {value:x}"), "odd.nii", &changed);
        }
    }
    for at in (76..92).step_by(4).chain([108, 112, 116, 252, 256, 280, 300, 348]) {
        for value in IMPOSSIBLE_NUMBERS {
            let changed = with_number(bytes, at, &value.to_le_bytes());
            made.add(format!("four bytes at {at} are {value:x}"), "odd.nii", &changed);
            if at == 108 {
                made.add(format!("four bytes at {at} are {value:x}"), "odd.nii.gz", &gzip(&changed));
            }
        }
    }
}

/// Adds MRC files in which a used word of the header is hostile.
fn mrc(made: &mut BrokenVolumeMaker, bytes: &[u8]) {
    for word in (1..20).chain([23, 24, 28, 50, 53, 54]) {
        for value in IMPOSSIBLE_NUMBERS {
            let changed = with_number(bytes, 4 * (word - 1), &value.to_le_bytes());
            made.add(format!("word {word} is {value:x}"), "odd.mrc", &changed);
        }
    }
}

/// Adds MGH files with hostile dimensions, type, spacing and position; big-endian.
fn mgh(made: &mut BrokenVolumeMaker, bytes: &[u8]) {
    for at in (0..28).chain(30..90).step_by(4) {
        for value in IMPOSSIBLE_NUMBERS {
            let changed = with_number(bytes, at, &value.to_be_bytes());
            made.add(format!("four bytes at {at} are {value:x}"), "odd.mgh", &changed);
            made.add(format!("four bytes at {at} are {value:x}"), "odd.mgz", &gzip(&changed));
        }
    }
}

/// Adds TIFF files with hostile counts and values of all entries, and a hostile offset of the next directory: itself,
/// nowhere, beyond the end.
fn tiff(made: &mut BrokenVolumeMaker, name: &str, bytes: &[u8]) {
    let is_big = bytes.starts_with(b"MM");
    let word = |at: usize| {
        let four: [u8; 4] = bytes[at..at + 4].try_into().expect("four bytes");
        if is_big { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) }
    };
    let put = |value: u32| if is_big { value.to_be_bytes() } else { value.to_le_bytes() };
    let first = word(4) as usize;
    let two: [u8; 2] = bytes[first..first + 2].try_into().expect("two bytes");
    let count = usize::from(if is_big { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) });
    assert!(count < 32, "{name} is a plain TIFF file");
    for entry in 0..count {
        let at = first + 2 + 12 * entry;
        for value in [0, 2, 0xffff, 0xffff_ffff] {
            made.add(
                format!("count of entry {entry} is {value:x}"),
                name,
                &with_number(bytes, at + 4, &put(value)),
            );
            made.add(
                format!("value of entry {entry} is {value:x}"),
                name,
                &with_number(bytes, at + 8, &put(value)),
            );
        }
    }
    let next = first + 2 + 12 * count;
    for value in [first, 4, next, bytes.len() - 1, bytes.len(), u32::MAX as usize] {
        let changed = with_number(bytes, next, &put(value as u32));
        made.add(format!("the next directory is at {value}"), name, &changed);
        made.add(
            format!("the first directory is at {value}"),
            name,
            &with_number(bytes, 4, &put(value as u32)),
        );
    }
    for value in [0u16, 0xffff] {
        made.add(format!("{value} entries"), name, &with_number(bytes, first, &value.to_le_bytes()));
    }
}

/// Adds DICOM files with hostile sizes, bits, samples, frames, or length of the pixel data.
fn dicom(made: &mut BrokenVolumeMaker, name: &str, bytes: &[u8]) {
    let tags = [
        ("Rows", [0x28, 0, 0x10, 0]),
        ("Columns", [0x28, 0, 0x11, 0]),
        ("BitsAllocated", [0x28, 0, 0, 1]),
        ("BitsStored", [0x28, 0, 1, 1]),
        ("HighBit", [0x28, 0, 2, 1]),
        ("PixelRepresentation", [0x28, 0, 3, 1]),
        ("SamplesPerPixel", [0x28, 0, 2, 0]),
    ];
    for (tag, mark) in tags {
        let Some(at) = find_bytes(bytes, &mark) else { continue };
        for value in [0u16, 1, 7, 0x7fff, 0xffff] {
            made.add(format!("{tag} is {value}"), name, &with_number(bytes, at + 8, &value.to_le_bytes()));
        }
        made.add(format!("{tag} is endless"), name, &with_number(bytes, at + 6, &[0xff, 0xff]));
        let twice = [&bytes[..at + 10], &bytes[at..]].concat();
        made.add(format!("{tag} is there twice"), name, &twice);
    }
    if let Some(at) = find_bytes(bytes, &[0xe0, 0x7f, 0x10, 0]) {
        for value in IMPOSSIBLE_NUMBERS {
            made.add(
                format!("{value:x} bytes of pixels"),
                name,
                &with_number(bytes, at + 8, &value.to_le_bytes()),
            );
        }
        for value in IMPOSSIBLE_NUMBERS {
            made.add(
                format!("the first fragment is {value:x}"),
                name,
                &with_number(bytes, at + 16, &value.to_le_bytes()),
            );
        }
    }
    if let Some(at) = find_bytes(bytes, &[0x28, 0, 8, 0]) {
        for value in ["0 ", "-1", "99", "xx"] {
            made.add(format!("{value} frames"), name, &with_number(bytes, at + 8, value.as_bytes()));
        }
    }
}

/// Adds NPZ files with hostile sizes, offsets and methods in the central directory, and in the headers of entries.
fn npz(made: &mut BrokenVolumeMaker, bytes: &[u8]) {
    for (mark, places) in [
        (&b"PK\x01\x02"[..], &[8, 10, 16, 20, 24, 28, 30, 42][..]),
        (&b"PK\x03\x04"[..], &[6, 8, 14, 18, 22, 26][..]),
        (&b"PK\x05\x06"[..], &[4, 8, 10, 12, 16, 20][..]),
    ] {
        let at = find_bytes(bytes, mark).expect("an archive has it");
        for place in places {
            for value in IMPOSSIBLE_NUMBERS {
                let changed = with_number(bytes, at + place, &value.to_le_bytes());
                made.add(format!("{:?} + {place} is {value:x}", mark[3]), "odd.npz", &changed);
            }
        }
    }
}

/// Adds PVM files with hostile text lines before the voxels.
fn pvm(made: &mut BrokenVolumeMaker) {
    for lines in [
        "PVM\n0 3 4\n1\n",
        "PVM\n-2 3 4\n1\n",
        "PVM\n2 3\n1\n",
        "PVM\n2 3 4\n0\n",
        "PVM\n2 3 4\n9\n",
        "PVM\n4294967296 4294967296 4\n1\n",
        "PVM2\n2 3 4\nnan 1 1\n1\n",
        "PVM2\n2 3 4\n0 0 0\n1\n",
        "PVM2\n2 3 4\n1e308 1 1\n1\n",
        "PVM3\n2 3 4\n1 1 1\n2\n",
        "PVM3\n2 3 4\n1 1 1\n1\n",
        "PVM9\n2 3 4\n1 1 1\n1\n",
    ] {
        made.add(format!("{lines:?}"), "odd.pvm", &[lines.as_bytes(), &[7; 24]].concat());
    }
}
