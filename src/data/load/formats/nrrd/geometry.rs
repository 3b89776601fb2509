//! Geometry of an NRRD volume: which axes are spatial, what the others hold, and the placement in the world.
//!
//! Reads `dimension`, `sizes`, `kinds`, `spacings`, `space`, `space dimension`, `space directions`, `space origin`,
//! `axis mins`, `axis maxs`, `centers`, `units` and `space units`. World space is right-anterior-superior
//! millimetres.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::super::placement::Placement;
use super::bounds::AxisBounds;
use super::header::Header;
use super::space::{counts_voxels, directions, flips, is_anatomical, mm_per_unit, origin};
use crate::data::attempt::{Attempt, quoted};

/// Maximum dimension that NRRD allows.
const MOST_AXES: usize = 16;

/// Maximum number of components per voxel.
const MOST_COMPONENTS: u64 = 1 << 10;

/// Maximum length of an axis of unknown kind that may hold colours: red, green, blue and opacity.
const MOST_COLORS: u64 = 4;

/// Kinds of non-spatial axes: the first two hold times or listed volumes, the others hold components.
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

/// Kinds of axes that hold red, green, blue and perhaps opacity.
const COLORS: [&str; 4] = ["rgb-color", "rgba-color", "3-color", "4-color"];

/// Grid of a volume, its placement, and the numbers stored per voxel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Geometry {
    /// Number of voxels along the three axes, not yet validated.
    pub(super) dims: [u64; 3],
    pub(super) placement: Placement,
    /// Number of components of each voxel.
    pub(super) components: usize,
    /// True if components are planar, that is, each is a whole volume behind the previous one.
    pub(super) are_planes: bool,
    pub(super) is_color: bool,
    /// True if the interleaved numbers are time steps, not components.
    pub(super) are_times: bool,
    /// True if the header calls the interleaved numbers a list: separate volumes, unless they are layers of labels.
    pub(super) are_listed: bool,
    /// Number of consecutive volumes (time steps).
    pub(super) frames: u64,
    /// Lengths of all axes of the array, fastest first.
    pub(super) sizes: Vec<u64>,
}

/// One axis of the array, as the header describes it.
#[derive(Debug, Clone)]
struct Axis {
    size: u64,
    kind: String,
    /// True unless the header says that the axis holds components or times.
    spatial: bool,
    /// Step along the axis in the file's space, in millimetres.
    direction_mm: Option<DVec3>,
    /// Spacing of the samples in millimetres; NaN if unknown.
    spacing_mm: f64,
    /// Position of the first sample in millimetres, from the axis bounds; 0 if unknown.
    first_mm: f64,
}

impl Axis {
    /// True if the header says that the axis holds the components of a voxel.
    fn is_of_components(&self) -> bool {
        !self.spatial && OTHER_KINDS[2..].iter().any(|kind| self.kind.ends_with(kind))
    }
}

impl Geometry {
    pub(super) fn from_header(attempt: Attempt<'_>, header: &Header) -> Result<Self, LoadError> {
        let all = axes(attempt, header)?;
        let sizes = all.iter().map(|axis| axis.size).collect();
        let all = volume_axes(attempt, all)?;
        let spatial: Vec<&Axis> = all.iter().filter(|axis| axis.spatial).collect();
        let size = |axis: usize| spatial.get(axis).map_or(1, |axis| axis.size);
        let dims = [size(0), size(1), size(2)];
        let placement = placement(attempt, header, &spatial)?;
        let unit = mm_per_unit(header, "space units").or_else(|| mm_per_unit(header, "units"));
        let placement = placement.said_in(unit.unwrap_or(1.0));
        let placement = if counts_voxels(header) { placement.of_unknown_scale() } else { placement };

        let before: Vec<&Axis> = all.iter().take_while(|axis| !axis.spatial).collect();
        let behind: Vec<&Axis> = all.iter().rev().take_while(|axis| !axis.spatial).collect();
        let are_planes =
            before.is_empty() && !behind.is_empty() && behind.iter().all(|axis| axis.is_of_components());
        let (before, behind) = if are_planes { (behind, before) } else { (before, behind) };
        let product = |axes: &[&Axis]| axes.iter().fold(1_u64, |size, axis| size.saturating_mul(axis.size));
        let (components, frames) = (product(&before), product(&behind));
        if components == 0 || frames == 0 {
            let why = "an axis that is none of space has no samples: 1 or more were expected, 0 was found";
            return Err(attempt.bad_input("sizes", why.to_owned(), "correct the header"));
        }
        if components > MOST_COMPONENTS {
            return Err(attempt.limit(
                "sizes",
                format!(
                    "{components} numbers for each voxel are more than the {MOST_COMPONENTS} that are read"
                ),
                "extract some of them (for example: unu crop)",
            ));
        }
        Ok(Self {
            dims,
            placement,
            components: components as usize,
            are_planes,
            is_color: before.iter().any(|axis| COLORS.contains(&axis.kind.as_str())),
            are_times: before.iter().any(|axis| axis.kind == "time"),
            are_listed: !before.is_empty() && before.iter().all(|axis| axis.kind == "list"),
            frames,
            sizes,
        })
    }
}

/// Returns the placement of the voxels in the world.
fn placement(attempt: Attempt<'_>, header: &Header, axes: &[&Axis]) -> Result<Placement, LoadError> {
    let ras_from_file = DMat3::from_diagonal(flips(attempt, header)?);
    let origin_mm = origin(attempt, header)? * mm_per_unit(header, "space units").unwrap_or(1.0);
    let has_origin = header.get("space origin").is_some();
    let is_anatomical = is_anatomical(header);
    let has_directions = axes.iter().any(|axis| axis.direction_mm.is_some());
    if !has_directions && axes.iter().all(|axis| axis.spacing_mm.is_nan()) {
        attempt.warn("no spacings: how large the voxels are is not known");
        let world_from_index = DAffine3 { matrix3: ras_from_file, translation: DVec3::ZERO };
        return Ok(Placement { world_from_index, is_anatomical, ..Placement::unknown() });
    }
    if !has_directions {
        let spacing = |axis: usize| axes.get(axis).map(|axis| axis.spacing_mm);
        // A two-dimensional image: its single slice is as thick as its pixels are wide.
        let thickness = || axes.iter().map(|axis| axis.spacing_mm.abs()).product::<f64>().sqrt();
        let spacings = [0, 1, 2].map(|axis| spacing(axis).unwrap_or_else(thickness));
        let spaced = Placement::spaced(spacings);
        let first_mm = |axis: usize| axes.get(axis).map_or(0.0, |axis| axis.first_mm);
        let origin_mm = if has_origin { origin_mm } else { DVec3::from_array([0, 1, 2].map(first_mm)) };
        let world_from_index = DAffine3 {
            matrix3: ras_from_file * spaced.world_from_index.matrix3,
            translation: ras_from_file * origin_mm,
        };
        return Ok(Placement { world_from_index, is_anatomical, ..spaced });
    }
    let step = |(index, axis): (usize, &&Axis)| {
        axis.direction_mm.unwrap_or_else(|| {
            let is_known = !axis.spacing_mm.is_nan();
            DVec3::AXES[index] * if is_known { axis.spacing_mm } else { 1.0 }
        })
    };
    let mut steps: Vec<DVec3> = axes.iter().enumerate().map(step).collect();
    if let [a, b] = steps[..] {
        steps.push(a.cross(b).normalize_or_zero() * (a.length() * b.length()).sqrt());
    }
    let step = |axis: usize| steps.get(axis).copied().unwrap_or(DVec3::ZERO);
    let placement = Placement::ras(DAffine3 {
        matrix3: ras_from_file * DMat3::from_cols(step(0), step(1), step(2)),
        translation: ras_from_file * origin_mm,
    });
    Ok(if is_anatomical { placement } else { placement.of_no_body() })
}

/// Reads all axes of the array from the header.
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
    // Older headers give the bounds of an axis instead of its spacing.
    let bounds = |field: &str| match numbers::<f64>(attempt, header, field, dimension) {
        Ok(bounds) => bounds,
        Err(error) => {
            attempt.warn(format_args!("{field} is not used: {error}"));
            None
        }
    };
    let (mins, maxs) = (bounds("axis mins"), bounds("axis maxs"));
    let centers: Vec<_> = header.either("centers", "centerings").split_whitespace().collect();
    let directions = directions(attempt, header, dimension)?;
    let kinds: Vec<_> = header.get("kinds").unwrap_or_default().split_whitespace().collect();
    let space_unit_mm = mm_per_unit(header, "space units").unwrap_or(1.0);
    // Different known units per axis do not occur in practice: the first known one counts.
    let axis_unit_mm = mm_per_unit(header, "units").unwrap_or(space_unit_mm);
    Ok((0..dimension)
        .map(|i| {
            let direction_mm = directions.as_ref().and_then(|all| all[i]).map(|step| step * space_unit_mm);
            let kind = kinds.get(i).map(|kind| kind.to_lowercase()).unwrap_or_default();
            let kind_is_spatial = !OTHER_KINDS.iter().any(|other| kind.ends_with(other));
            let spatial = kind_is_spatial && (directions.is_none() || direction_mm.is_some());
            let bound = |all: &Option<Vec<f64>>| all.as_ref().map_or(f64::NAN, |all| all[i]);
            let bounds = AxisBounds {
                low: bound(&mins),
                high: bound(&maxs),
                is_node: centers.get(i).is_some_and(|center| center.eq_ignore_ascii_case("node")),
            };
            let between = bounds.spacing(sizes[i]);
            let spacing = Some(bound(&spacings)).filter(|spacing| !spacing.is_nan()).unwrap_or(between);
            let (spacing_mm, first_mm) =
                (spacing * axis_unit_mm, bounds.first_sample(spacing) * axis_unit_mm);
            Axis { size: sizes[i], kind, spatial, direction_mm, spacing_mm, first_mm }
        })
        .collect())
}

/// Drops surplus axes of length 1; afterwards two or three axes are spatial, and the others lie before or behind
/// them.
fn volume_axes(attempt: Attempt<'_>, mut axes: Vec<Axis>) -> Result<Vec<Axis>, LoadError> {
    let dimension = axes.len();
    axes.retain(|axis| axis.spatial || axis.size != 1);
    while axes.iter().filter(|axis| axis.spatial).count() > 3 {
        match axes.iter().position(|axis| axis.spatial && axis.size == 1) {
            Some(single) => drop(axes.remove(single)),
            None => set_apart(&mut axes),
        }
    }
    let spatial = axes.iter().filter(|axis| axis.spatial).count();
    if spatial < 2 {
        return Err(attempt.bad_input(
            "dimension",
            format!("{spatial} spatial axes of {dimension} are no volume; 3, or 2 for a slice, are expected"),
            "check dimension, kinds and space directions",
        ));
    }
    let first = axes.iter().position(|axis| axis.spatial).unwrap_or(0);
    let last = axes.iter().rposition(|axis| axis.spatial).unwrap_or(0);
    if let Some(within) = axes[first..=last].iter().position(|axis| !axis.spatial) {
        return Err(attempt.bad_input(
            "sizes",
            format!(
                "{} components or time steps lie between the axes of space; before or behind them they are read",
                axes[first + within].size
            ),
            "change the order of the axes (for example: unu permute)",
        ));
    }
    Ok(axes)
}

/// Marks one of too many spatial axes as non-spatial if the header does not tell which: the one without a spacing, or
/// the first if it may hold colours, or else the last.
fn set_apart(axes: &mut [Axis]) {
    let spatial: Vec<usize> = (0..axes.len()).filter(|&at| axes[at].spatial).collect();
    let [first, others @ .., last] = &spatial[..] else { return };
    let is_marked = |at: usize| axes[at].direction_mm.is_none() && axes[at].spacing_mm.is_nan();
    let is_color = || {
        let is_large = |&at: &usize| axes[at].size > MOST_COLORS;
        axes[*first].size <= MOST_COLORS && others.iter().all(is_large) && is_large(last)
    };
    let is_first = match (is_marked(*first), is_marked(*last)) {
        (true, false) => true,
        (false, true) => false,
        _ => is_color(),
    };
    axes[if is_first { *first } else { *last }].spatial = false;
}

/// Returns a list of `count` numbers, if the header has the field.
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
