//! Which axes are the volume's and where they lie in the world.
//!
//! `dimension`, `sizes`, `kinds`, `spacings`, `space`, `space dimension`, `space directions`,
//! `space origin`, `units` and `space units`. The world is right-anterior-superior millimetres.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::header::Header;
use super::space::{directions, flips, is_anatomical, mm_per_unit, origin};
use crate::data::attempt::{Attempt, quoted};
use crate::data::attempt::{is_usable_affine, is_usable_spacing, unlike_spacings};

/// The largest dimension that NRRD allows.
const MOST_AXES: usize = 16;

const SPACING_HELP: &str = "give each spatial axis a length in millimetres above 0";

/// Kinds of axes that hold components or times, not places.
const OTHER_KINDS: [&str; 11] = [
    "time",
    "list",
    "point",
    "vector",
    "covariant-vector",
    "normal",
    "complex",
    "quaternion",
    "color",
    "gradient",
    "matrix",
];

/// The volume's grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Geometry {
    /// Voxels along the three axes, not yet checked.
    pub(super) dims: [u64; 3],
    /// Voxel indices to millimetres, right-anterior-superior.
    pub(super) world_from_index: DAffine3,
    /// Whether the file says so.
    pub(super) is_anatomical: bool,
}

/// One axis of the array.
#[derive(Debug, Clone, Copy)]
struct Axis {
    size: u64,
    /// Whether the header does not say that it holds components or times.
    spatial: bool,
    /// One step along it in the file's space, in millimetres.
    direction_mm: Option<DVec3>,
    /// The distance of its samples in millimetres; NaN where it is not known.
    spacing_mm: f64,
}

impl Geometry {
    pub(super) fn from_header(attempt: Attempt<'_>, header: &Header) -> Result<Self, LoadError> {
        let axes = volume_axes(attempt, axes(attempt, header)?)?;
        let mut steps: Vec<DVec3> = Vec::new();
        for (index, axis) in axes.iter().enumerate() {
            steps.push(step(attempt, index, axis)?);
        }
        if let [a, b] = steps[..] {
            // A picture: its one slice is as thick as its pixels are wide.
            steps.push(a.cross(b).normalize_or_zero() * (a.length() * b.length()).sqrt());
        }
        let size = |axis: usize| axes.get(axis).map_or(1, |axis| axis.size);
        let step = |axis: usize| steps.get(axis).copied().unwrap_or(DVec3::ZERO);

        let ras_from_file = DMat3::from_diagonal(flips(attempt, header)?);
        let origin_mm = origin(attempt, header)? * mm_per_unit(header, "space units").unwrap_or(1.0);
        let world_from_index = DAffine3 {
            matrix3: ras_from_file * DMat3::from_cols(step(0), step(1), step(2)),
            translation: ras_from_file * origin_mm,
        };
        let field = if header.get("space directions").is_some() { "space directions" } else { "spacings" };
        let axes = world_from_index.matrix3;
        if let Some(why) = unlike_spacings([axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length)) {
            return Err(attempt.bad_input(field, why, "give the lengths of all axes in one unit"));
        }
        if is_usable_affine(&world_from_index) {
            let dims = [size(0), size(1), size(2)];
            Ok(Self { dims, world_from_index, is_anatomical: is_anatomical(header) })
        } else {
            Err(attempt.bad_input(
                field,
                "the axes are unusable: too short, too long, or in one plane",
                "give three independent axes in millimetres",
            ))
        }
    }
}

/// One step along an axis, in the file's space and in millimetres.
fn step(attempt: Attempt<'_>, index: usize, axis: &Axis) -> Result<DVec3, LoadError> {
    if let Some(direction) = axis.direction_mm {
        return if is_usable_spacing(direction.length()) {
            Ok(direction)
        } else {
            Err(attempt.bad_input(
                "space directions",
                format!("{direction} is not a usable step along an axis"),
                SPACING_HELP,
            ))
        };
    }
    let unit = DVec3::AXES[index];
    if axis.spacing_mm.is_nan() {
        return Ok(unit);
    }
    if is_usable_spacing(axis.spacing_mm) {
        Ok(unit * axis.spacing_mm)
    } else {
        Err(attempt.bad_input(
            "spacings",
            format!("{} is not a usable distance", axis.spacing_mm),
            SPACING_HELP,
        ))
    }
}

/// All axes of the array, as the header describes them.
fn axes(attempt: Attempt<'_>, header: &Header) -> Result<Vec<Axis>, LoadError> {
    let dimension_text = header.require(attempt, "dimension", "add dimension: 3")?;
    let dimension = dimension_text.parse().ok().filter(|n| (1..=MOST_AXES).contains(n)).ok_or_else(|| {
        attempt.bad_input(
            "dimension",
            format!("a number from 1 to {MOST_AXES} was expected, {} was found", quoted(dimension_text)),
            "correct the header",
        )
    })?;
    header.require(attempt, "sizes", "add the number of samples along each axis")?;
    let sizes: Vec<u64> = numbers(attempt, header, "sizes", dimension)?.unwrap_or_default();
    let spacings: Option<Vec<f64>> = numbers(attempt, header, "spacings", dimension)?;
    let directions = directions(attempt, header, dimension)?;
    let kinds: Vec<_> = header.get("kinds").unwrap_or_default().split_whitespace().collect();
    let space_unit_mm = mm_per_unit(header, "space units").unwrap_or(1.0);
    // Axes with different known units are not a case that occurs: the first known one counts.
    let axis_unit_mm = mm_per_unit(header, "units").unwrap_or(space_unit_mm);
    if directions.is_none() && spacings.is_none() {
        attempt.warn("no spacings: the voxels are taken as 1 mm cubes");
    }
    Ok((0..dimension)
        .map(|i| {
            let direction_mm = directions.as_ref().and_then(|all| all[i]).map(|step| step * space_unit_mm);
            let kind_is_spatial = kinds.get(i).is_none_or(|kind| is_spatial(kind));
            let spatial = kind_is_spatial && (directions.is_none() || direction_mm.is_some());
            let spacing_mm = spacings.as_ref().map_or(1.0, |all| all[i] * axis_unit_mm);
            if spatial && direction_mm.is_none() && spacing_mm.is_nan() {
                attempt.warn(format_args!("the spacing of axis {i} is unknown: 1 mm is used"));
            }
            Axis { size: sizes[i], spatial, direction_mm, spacing_mm }
        })
        .collect())
}

fn is_spatial(kind: &str) -> bool {
    let kind = kind.to_lowercase();
    !OTHER_KINDS.iter().any(|other| kind.ends_with(other))
}

/// The two or three axes of the volume: axes of one sample are dropped, those of components first.
fn volume_axes(attempt: Attempt<'_>, axes: Vec<Axis>) -> Result<Vec<Axis>, LoadError> {
    if let Some(index) = axes.iter().position(|axis| !axis.spatial && axis.size > 1) {
        return Err(attempt.bad_input(
            "sizes",
            format!(
                "axis {index} holds {} components or time steps per voxel; one is expected",
                axes[index].size
            ),
            "extract one component or time step (for example: unu slice -a AXIS -p POSITION)",
        ));
    }
    let dimension = axes.len();
    let mut kept: Vec<_> = axes.into_iter().filter(|axis| axis.spatial).collect();
    while kept.len() > 3 {
        let Some(single) = kept.iter().position(|axis| axis.size == 1) else {
            return Err(attempt.bad_input(
                "dimension",
                format!("{dimension} axes are more than the three of a volume, and none has size 1"),
                "extract one component or time step (for example: unu slice -a AXIS -p POSITION)",
            ));
        };
        kept.remove(single);
    }
    if kept.len() < 2 {
        return Err(attempt.bad_input(
            "dimension",
            format!(
                "{} spatial axes of {dimension} are no volume; 3, or 2 for a slice, are expected",
                kept.len()
            ),
            "check dimension, kinds and space directions",
        ));
    }
    Ok(kept)
}

/// A list of `count` numbers, if the header has the field.
fn numbers<T: std::str::FromStr>(
    attempt: Attempt<'_>,
    header: &Header,
    field: &str,
    count: usize,
) -> Result<Option<Vec<T>>, LoadError> {
    let Some(text) = header.get(field) else {
        return Ok(None);
    };
    let numbers: Option<Vec<T>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    match numbers {
        Some(numbers) if numbers.len() == count => Ok(Some(numbers)),
        _ => Err(attempt.bad_input(
            field,
            format!("{count} numbers were expected, one for each axis; {} was found", quoted(text)),
            "correct the header",
        )),
    }
}
