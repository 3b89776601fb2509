//! Header of an MGH file: 284 bytes, big-endian, of which the first 90 are used.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::super::number::FileNumberType;
use super::super::placement::GridPlacement;
use chiaroscuro_volume::LoadContext;

/// Offset of the voxels in bytes: 90 bytes of fields, the rest reserved (`UNUSED_SPACE_SIZE` of `mri.h`).
pub(super) const HEADER_BYTES: usize = 284;

/// Version of the format; only version 1 exists.
const VERSION: u8 = 1;

/// Intent code of labels; newer programs store the intent in the byte above the version (`MGZ_INTENT_LABEL`).
const LABEL_INTENT: u8 = 1;

/// Maximum plausible intent code for detection without magic bytes: fewer than ten are in use.
const MAX_INTENT: i32 = 15;

/// Maximum plausible number of voxels along an axis for detection without magic bytes.
const MAX_AXIS_LENGTH: i32 = 1 << 24;

/// Default axes if the header gives none: coronal slices from back to front, rows from superior to inferior
/// (`mghRead` of `mriio.cpp`).
const CORONAL: DMat3 =
    DMat3::from_cols(DVec3::new(-1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 1.0, 0.0));

const HELP: &str = "copy the file again, or write it again with mri_convert";

/// Parsed header of an MGH file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MghHeader {
    /// Voxels along x, y, z.
    pub(super) dims: [u64; 3],
    /// Number of consecutive volumes (time steps).
    pub(super) frames: u64,
    pub(super) number: FileNumberType,
    /// True if the file's intent code marks its numbers as labels.
    pub(super) are_labels: bool,
    /// Position of the voxels; `None` if `goodRASFlag` is 0, that is, unknown.
    geometry: Option<MghGeometry>,
}

/// Spacing, axis directions and centre of the grid.
#[derive(Debug, Clone, PartialEq)]
struct MghGeometry {
    /// Distances between voxel centres, in millimetres.
    spacing_mm: DVec3,
    /// Unit directions of the three axes, right-anterior-superior.
    directions: DMat3,
    /// Position of index `dims / 2` (`c_ras`), in right-anterior-superior millimetres.
    center: DVec3,
}

/// True if these bytes begin an MGH file. The format has no magic bytes, so every field is checked for plausible
/// values.
pub(super) fn is_mgh(bytes: &[u8]) -> bool {
    let fields = MghFields(bytes);
    let is_version =
        fields.int(0) & 0xff == i32::from(VERSION) && (0..=MAX_INTENT).contains(&(fields.int(0) >> 8));
    let are_counts = [4, 8, 12, 16].into_iter().all(|at| (1..=MAX_AXIS_LENGTH).contains(&fields.int(at)));
    let is_placed = fields.short(28);
    let place = fields.geometry();
    let is_place = is_placed == 0
        || is_placed == 1
            && place.spacing_mm.cmpgt(DVec3::ZERO).all()
            && place.spacing_mm.is_finite()
            && place.directions.is_finite()
            && place.center.is_finite();
    bytes.len() >= HEADER_BYTES
        && is_version
        && are_counts
        && number_from_code(fields.int(20)).is_ok()
        && is_place
}

impl MghHeader {
    /// Parses the header at the beginning of a file.
    ///
    /// # Errors
    /// `BadInput` if it is truncated, of another version, or contains invalid values.
    pub(super) fn parse(context: LoadContext<'_>, bytes: &[u8]) -> Result<Self, LoadError> {
        let fields = MghFields(bytes);
        if bytes.len() < HEADER_BYTES {
            let why =
                format!("the header is truncated: {HEADER_BYTES} bytes expected, {} found", bytes.len());
            return Err(context.bad_input_error("header", why, HELP));
        }
        let [_, _, intent, version] = fields.array(0);
        if version != VERSION || fields.int(0) >> 16 != 0 {
            let why = format!("version {VERSION} was expected, {} was found", fields.int(0));
            return Err(context.bad_input_error("version", why, HELP));
        }
        let [x, y, z, frames] = [4, 8, 12, 16].map(|at| fields.int(at));
        let count = |n: i32| u64::try_from(n).ok().filter(|&n| n > 0);
        let (Some(dims), Some(frames)) = (all_present([x, y, z].map(count)), count(frames)) else {
            let why = format!("{x} x {y} x {z} voxels in {frames} frames are not valid dimensions");
            return Err(context.bad_input_error("width, height, depth, nframes", why, HELP));
        };
        let number = number_from_code(fields.int(20)).map_err(|why| {
            let help = "write it again with numbers: mri_convert --out_data_type float IN OUT.mgz";
            context.bad_input_error("type", why, help)
        })?;
        let place = (fields.short(28) > 0).then(|| fields.geometry());
        Ok(Self { dims, frames, number, are_labels: intent == LABEL_INTENT, geometry: place })
    }

    /// Returns the placement of the voxels in the world.
    pub(super) fn placement(&self) -> GridPlacement {
        let half = DVec3::from(self.dims.map(|n| n as f64)) / 2.0;
        let centred =
            |axes: DMat3, center: DVec3| DAffine3 { matrix3: axes, translation: center - axes * half };
        match &self.geometry {
            Some(place) => {
                let axes = place.directions * DMat3::from_diagonal(place.spacing_mm);
                GridPlacement::from_ras_affine(centred(axes, place.center))
            }
            None => GridPlacement::from_ras_affine(centred(CORONAL, DVec3::ZERO)).without_anatomy().with_unknown_scale().with_remark(Some(
                "the header does not state where its voxels lie (goodRASFlag is 0): coronal slices are assumed",
            )),
        }
    }
}

/// Maps a type code (`MRI_UCHAR` … of `mri.h`) to a number type, or to the reason why it is not supported.
fn number_from_code(code: i32) -> Result<FileNumberType, String> {
    let why = match code {
        0 => return Ok(FileNumberType::U8),
        1 => return Ok(FileNumberType::I32),
        3 => return Ok(FileNumberType::F32),
        4 => return Ok(FileNumberType::I16),
        10 => return Ok(FileNumberType::U16),
        2 => "long whole numbers (type 2), whose length depends on the machine, are not supported",
        5 => "voxels of one bit (type 5) are not supported",
        6 => "tensors (type 6) are not supported",
        7 | 8 => "complex numbers (types 7 and 8) are not supported",
        9 => "colours (type 9) are not supported",
        _ => return Err(format!("type {code} is unknown; 0, 1, 3, 4 and 10 are supported")),
    };
    Err(why.to_owned())
}

/// Returns the three values if all of them are present.
fn all_present<T: Copy>(values: [Option<T>; 3]) -> Option<[T; 3]> {
    let [x, y, z] = values;
    Some([x?, y?, z?])
}

/// Reader of big-endian numbers at byte offsets; reads zeros beyond the end.
struct MghFields<'a>(&'a [u8]);

impl MghFields<'_> {
    fn array<const N: usize>(&self, at: usize) -> [u8; N] {
        let found = self.0.get(at..at + N).and_then(|bytes| bytes.try_into().ok());
        found.unwrap_or([0; N])
    }

    fn int(&self, at: usize) -> i32 {
        i32::from_be_bytes(self.array(at))
    }

    fn short(&self, at: usize) -> i16 {
        i16::from_be_bytes(self.array(at))
    }

    fn vector(&self, at: usize) -> DVec3 {
        DVec3::from_array([0, 4, 8].map(|step| f64::from(f32::from_be_bytes(self.array(at + step)))))
    }

    fn geometry(&self) -> MghGeometry {
        let directions = DMat3::from_cols(self.vector(42), self.vector(54), self.vector(66));
        MghGeometry { spacing_mm: self.vector(30), directions, center: self.vector(78) }
    }
}
