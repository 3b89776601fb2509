//! Layout of raw files: guesses by name and length, and NRRD headers that record it permanently.

use std::io::Read as _;
use std::path::Path;

use super::super::input::is_gzip;
use super::super::{Endian, nrrd};
use super::name_hints::RawNameHints;
use super::{RawFormat, name, sidecar};
use chiaroscuro_volume::VoxelType;

/// Complete description of how a raw file stores its voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawLayout {
    /// Voxels along x, y and z.
    pub dims: [usize; 3],
    /// Number type of the voxels.
    pub voxel_type: VoxelType,
    /// Distance between voxel centres in millimetres, where it is known.
    pub spacing_mm: Option<[f64; 3]>,
    /// Byte order of the voxels.
    pub endian: Endian,
    /// Bytes before the first voxel, in the uncompressed file.
    pub offset: u64,
}

/// Guess of a raw file's layout, and the facts behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawGuess {
    /// Most likely layout by name and length.
    pub layout: RawLayout,
    /// Length of the file, in bytes.
    pub file_bytes: u64,
    /// True if it is compressed, so that its length carries no information.
    pub is_gzip: bool,
    /// Layout hints in its name.
    pub name_hints: RawNameHints,
}

impl RawLayout {
    /// Length in bytes of an uncompressed file with this layout; `None` beyond 64 bits.
    pub fn file_bytes(&self) -> Option<u64> {
        let voxels = self.dims.iter().try_fold(1u64, |product, &n| product.checked_mul(n as u64))?;
        voxels.checked_mul(self.voxel_type.bytes() as u64)?.checked_add(self.offset)
    }

    /// Converts to the options of the RAW reader.
    pub fn to_format(&self) -> RawFormat {
        RawFormat {
            dims: Some(self.dims),
            voxel_type: Some(self.voxel_type),
            spacing_mm: self.spacing_mm,
            endian: Some(self.endian),
            offset: Some(self.offset),
        }
    }

    /// Text of a detached NRRD header for a data file in the same folder, which lets every NRRD reader open it.
    pub fn nrrd_header(&self, data_file: &str, is_gzip: bool) -> String {
        let [x, y, z] = self.dims;
        let spacings = self.spacing_mm.map_or(String::new(), |[sx, sy, sz]| {
            format!("spacings: {sx} {sy} {sz}\nunits: \"mm\" \"mm\" \"mm\"\n")
        });
        let voxel_type = match self.voxel_type {
            VoxelType::F32 => "float",
            VoxelType::F64 => "double",
            other => other.name(),
        };
        let endian = match self.endian {
            Endian::Little => "little",
            Endian::Big => "big",
        };
        let encoding = if is_gzip { "gzip" } else { "raw" };
        format!(
            "NRRD0004\ntype: {voxel_type}\ndimension: 3\nsizes: {x} {y} {z}\n{spacings}\
             endian: {endian}\nencoding: {encoding}\nbyte skip: {}\ndata file: {data_file}\n",
            self.offset
        )
    }

    /// Guesses the layout by the name and the length of a file; `None` for NRRD and for descriptions, which need no
    /// guess.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn guess(path: &Path) -> std::io::Result<Option<RawGuess>> {
        let file = std::fs::File::open(path)?;
        let file_bytes = file.metadata()?.len();
        let mut magic = Vec::new();
        file.take(1024).read_to_end(&mut magic)?;
        if nrrd::is_nrrd(&magic) || sidecar::is_description(&magic) {
            return Ok(None);
        }
        let is_gzip = is_gzip(&magic);
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let length = (!is_gzip).then_some(file_bytes);
        let (dims, voxel_type) = guess_from(&name, length);
        let endian = name::byte_order_in_name(&name);
        let said = RawNameHints { dims: three_numbers(&name), voxel_type: type_in_name(&name), endian };
        let endian = endian.unwrap_or(Endian::Little);
        let layout = Self { dims, voxel_type, spacing_mm: None, endian, offset: 0 };
        Ok(Some(RawGuess { layout, file_bytes, is_gzip, name_hints: said }))
    }
}

/// Words for number types in file names.
const TYPE_WORDS: [(&str, VoxelType); 13] = [
    ("uint8", VoxelType::U8),
    ("uchar", VoxelType::U8),
    ("byte", VoxelType::U8),
    ("uint16", VoxelType::U16),
    ("ushort", VoxelType::U16),
    ("uint32", VoxelType::U32),
    ("int8", VoxelType::I8),
    ("int16", VoxelType::I16),
    ("short", VoxelType::I16),
    ("int32", VoxelType::I32),
    ("float64", VoxelType::F64),
    ("double", VoxelType::F64),
    ("float", VoxelType::F32),
];

/// Number types in order of frequency, one for each size.
const COMMON_TYPES: [VoxelType; 4] = [VoxelType::U8, VoxelType::U16, VoxelType::F32, VoxelType::F64];

/// Default dimensions where nothing is known.
const DEFAULT_DIMS: [usize; 3] = [256; 3];

fn type_in_name(name: &str) -> Option<VoxelType> {
    TYPE_WORDS.iter().find(|(word, _)| name.contains(word)).map(|(_, voxel_type)| *voxel_type)
}

fn guess_from(name: &str, length: Option<u64>) -> ([usize; 3], VoxelType) {
    let said = type_in_name(name);
    if let Some(dims) = three_numbers(name) {
        // At most 10¹⁵, so that the product cannot overflow.
        let voxels: u64 = dims.iter().map(|&n| n as u64).product();
        let fitting = |t: &VoxelType| length == Some(voxels.saturating_mul(t.bytes() as u64));
        let voxel_type = said.or_else(|| COMMON_TYPES.into_iter().find(fitting)).unwrap_or(VoxelType::U8);
        return (dims, voxel_type);
    }
    // Equal numbers of voxels along all axes.
    let cube = |voxel_type: VoxelType| {
        let voxels = length? / voxel_type.bytes() as u64;
        let n = (voxels as f64).cbrt().round() as u64;
        let length_of_cube = n.checked_pow(3)?.checked_mul(voxel_type.bytes() as u64);
        (n > 0 && length_of_cube == length).then_some(([n as usize; 3], voxel_type))
    };
    let types = said.map_or(COMMON_TYPES.to_vec(), |voxel_type| vec![voxel_type]);
    types.into_iter().find_map(cube).unwrap_or((DEFAULT_DIMS, said.unwrap_or(VoxelType::U8)))
}

/// Finds three consecutive numbers, each at most a hundred thousand, between separators such as `x` or underscore.
fn three_numbers(name: &str) -> Option<[usize; 3]> {
    let pieces: Vec<Option<usize>> = name
        .split(['x', '_', '-', '.', ' '])
        .map(|piece| piece.parse().ok().filter(|n| (1..=100_000).contains(n)))
        .collect();
    pieces.windows(3).find_map(|window| Some([window[0]?, window[1]?, window[2]?]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, load};
    use chiaroscuro_volume::LoadControl;

    #[test]
    fn names_and_lengths_are_guessed_from() {
        for (name, length, expected) in [
            ("foot_256x255x254.raw", Some(256 * 255 * 254 * 2), ([256, 255, 254], VoxelType::U16)),
            ("head 64x64x93 int16.bin", None, ([64, 64, 93], VoxelType::I16)),
            ("sim_10_20_30_float.dat", Some(1), ([10, 20, 30], VoxelType::F32)),
            ("cube.raw", Some(27), ([3; 3], VoxelType::U8)),
            ("cube.raw", Some(54), ([3; 3], VoxelType::U16)),
            ("cube_float.raw", Some(108), ([3; 3], VoxelType::F32)),
            ("scan_short.raw", Some(1001), (DEFAULT_DIMS, VoxelType::I16)),
            ("empty", Some(0), (DEFAULT_DIMS, VoxelType::U8)),
            ("999999999x2x2.raw", Some(u64::MAX), (DEFAULT_DIMS, VoxelType::U8)),
        ] {
            assert_eq!(guess_from(name, length), expected, "{name}");
        }
    }

    #[test]
    fn headers_say_it_for_good() {
        let folder = tempfile::tempdir().unwrap();
        let values: Vec<u8> = (0..3 * 4 * 5 * 2 + 7).map(|at| (at * 13) as u8).collect();
        let path = folder.path().join("odd name.bin");
        std::fs::write(&path, &values).unwrap();
        let guess = RawLayout::guess(&path).unwrap().unwrap();
        assert_eq!((guess.file_bytes, guess.is_gzip), (values.len() as u64, false));
        let layout = RawLayout {
            dims: [3, 4, 5],
            voxel_type: VoxelType::U16,
            spacing_mm: Some([0.5, 0.5, 1.25]),
            endian: Endian::Big,
            offset: 7,
        };
        assert_eq!(layout.file_bytes(), Some(values.len() as u64));
        let header = folder.path().join("odd name.nhdr");
        std::fs::write(&header, layout.nrrd_header("odd name.bin", false)).unwrap();
        let control = LoadControl::new();
        let by_header = load(&header, &LoadOptions::default(), &control).unwrap();
        let options = LoadOptions { raw: layout.to_format(), ..LoadOptions::default() };
        let by_options = load(&path, &options, &control).unwrap();
        assert_eq!(by_header.samples(), by_options.samples());
        assert_eq!(by_header.spacing_mm(), by_options.spacing_mm());
        let unspaced = RawLayout { spacing_mm: None, ..layout };
        std::fs::write(&header, unspaced.nrrd_header("odd name.bin", false)).unwrap();
        let by_header = load(&header, &LoadOptions::default(), &control).unwrap();
        assert!(by_header.has_unknown_scale(), "nobody has said how large its voxels are");
        assert_eq!(RawLayout::guess(&header).unwrap(), None, "it needs no guess");
        let description = folder.path().join("foot.dat");
        std::fs::write(&description, "ObjectFileName: foot.raw\n").unwrap();
        assert_eq!(RawLayout::guess(&description).unwrap(), None, "it holds no voxels");
        assert!(RawLayout::guess(&folder.path().join("none")).is_err());
        let endless = RawLayout { dims: [usize::MAX; 3], ..layout };
        assert_eq!(endless.file_bytes(), None);
    }
}
