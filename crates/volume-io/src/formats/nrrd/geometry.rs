//! Geometry of an NRRD volume: which axes are spatial, what the others hold, and the placement in the world.
//!
//! Reads `dimension`, `sizes`, `kinds`, `spacings`, `space`, `space dimension`, `space directions`, `space origin`,
//! `axis mins`, `axis maxs`, `centers`, `units` and `space units`. World space is right-anterior-superior
//! millimetres.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::super::placement::GridPlacement;
use super::axis_bounds::AxisBounds;
use super::header::NrrdHeader;
use super::space::{directions, is_anatomical, is_in_voxel_units, mm_per_unit, origin, ras_signs};
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum dimension that NRRD allows.
const MAX_AXES: usize = 16;

/// Maximum number of components per voxel.
const MAX_COMPONENTS: u64 = 1 << 10;

/// Maximum length of an axis of unknown kind that may hold colours: red, green, blue and opacity.
const MAX_COLORS: u64 = 4;

/// Kinds of non-spatial axes: the first two hold times or listed volumes, the others hold components.
const NON_SPATIAL_KINDS: [&str; 11] = [
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
const COLOR_KINDS: [&str; 4] = ["rgb-color", "rgba-color", "3-color", "4-color"];

/// Grid of a volume, its placement, and the numbers stored per voxel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NrrdGeometry {
    /// Number of voxels along the three axes, not yet validated.
    pub(super) dims: [u64; 3],
    pub(super) placement: GridPlacement,
    /// Number of components of each voxel.
    pub(super) components: usize,
    /// True if components are planar, that is, each is a whole volume behind the previous one.
    pub(super) is_planar: bool,
    pub(super) is_color: bool,
    /// True if the interleaved numbers are time steps, not components.
    pub(super) has_interleaved_times: bool,
    /// True if the header calls the interleaved numbers a list: separate volumes, unless they are layers of labels.
    pub(super) is_list: bool,
    /// Number of consecutive volumes (time steps).
    pub(super) frames: u64,
    /// Lengths of all axes of the array, fastest first.
    pub(super) sizes: Vec<u64>,
}

/// One axis of the array, as the header describes it.
#[derive(Debug, Clone)]
struct NrrdAxis {
    size: u64,
    kind: String,
    /// True unless the header says that the axis holds components or times.
    is_spatial: bool,
    /// Step along the axis in the file's space, in millimetres.
    step_mm: Option<DVec3>,
    /// Spacing of the samples in millimetres; NaN if unknown.
    spacing_mm: f64,
    /// Position of the first sample in millimetres, from the axis bounds; 0 if unknown.
    first_mm: f64,
}

impl NrrdAxis {
    /// True if the header says that the axis holds the components of a voxel.
    fn is_of_components(&self) -> bool {
        !self.is_spatial && NON_SPATIAL_KINDS[2..].iter().any(|kind| self.kind.ends_with(kind))
    }
}

impl NrrdGeometry {
    pub(super) fn from_header(context: LoadContext<'_>, header: &NrrdHeader) -> Result<Self, LoadError> {
        let all = parse_axes(context, header)?;
        let sizes = all.iter().map(|axis| axis.size).collect();
        let all = drop_single_axes(context, all)?;
        let spatial: Vec<&NrrdAxis> = all.iter().filter(|axis| axis.is_spatial).collect();
        let size = |axis: usize| spatial.get(axis).map_or(1, |axis| axis.size);
        let dims = [size(0), size(1), size(2)];
        let placement = placement(context, header, &spatial)?;
        let unit = mm_per_unit(header, "space units").or_else(|| mm_per_unit(header, "units"));
        let placement = placement.with_length_unit(unit.unwrap_or(1.0));
        let placement = if is_in_voxel_units(header) { placement.with_unknown_scale() } else { placement };

        let leading: Vec<&NrrdAxis> = all.iter().take_while(|axis| !axis.is_spatial).collect();
        let trailing: Vec<&NrrdAxis> = all.iter().rev().take_while(|axis| !axis.is_spatial).collect();
        let are_planes =
            leading.is_empty() && !trailing.is_empty() && trailing.iter().all(|axis| axis.is_of_components());
        let (before, behind) = if are_planes { (trailing, leading) } else { (leading, trailing) };
        let product =
            |axes: &[&NrrdAxis]| axes.iter().fold(1_u64, |size, axis| size.saturating_mul(axis.size));
        let (components, frames) = (product(&before), product(&behind));
        if components == 0 || frames == 0 {
            let why = "a non-spatial axis has no samples: 1 or more were expected, 0 was found";
            return Err(context.bad_input_error("sizes", why.to_owned(), "correct the header"));
        }
        if components > MAX_COMPONENTS {
            return Err(context.limit_error(
                "sizes",
                format!(
                    "{components} numbers for each voxel are more than the {MAX_COMPONENTS} that are supported"
                ),
                "extract some of them (for example: unu crop)",
            ));
        }
        Ok(Self {
            dims,
            placement,
            components: components as usize,
            is_planar: are_planes,
            is_color: before.iter().any(|axis| COLOR_KINDS.contains(&axis.kind.as_str())),
            has_interleaved_times: before.iter().any(|axis| axis.kind == "time"),
            is_list: !before.is_empty() && before.iter().all(|axis| axis.kind == "list"),
            frames,
            sizes,
        })
    }
}

/// Returns the placement of the voxels in the world.
fn placement(
    context: LoadContext<'_>,
    header: &NrrdHeader,
    axes: &[&NrrdAxis],
) -> Result<GridPlacement, LoadError> {
    let ras_from_file = DMat3::from_diagonal(ras_signs(context, header)?);
    let origin_mm = origin(context, header)? * mm_per_unit(header, "space units").unwrap_or(1.0);
    let has_origin = header.get("space origin").is_some();
    let is_anatomical = is_anatomical(header);
    let has_directions = axes.iter().any(|axis| axis.step_mm.is_some());
    if !has_directions && axes.iter().all(|axis| axis.spacing_mm.is_nan()) {
        context.warn("no spacings: the voxel size is unknown");
        let world_from_index = DAffine3 { matrix3: ras_from_file, translation: DVec3::ZERO };
        return Ok(GridPlacement { world_from_index, is_anatomical, ..GridPlacement::unknown() });
    }
    if !has_directions {
        let spacing = |axis: usize| axes.get(axis).map(|axis| axis.spacing_mm);
        // A two-dimensional image: its single slice is as thick as its pixels are wide.
        let thickness = || axes.iter().map(|axis| axis.spacing_mm.abs()).product::<f64>().sqrt();
        let spacings = [0, 1, 2].map(|axis| spacing(axis).unwrap_or_else(thickness));
        let spaced = GridPlacement::from_spacing(spacings);
        let first_mm = |axis: usize| axes.get(axis).map_or(0.0, |axis| axis.first_mm);
        let origin_mm = if has_origin { origin_mm } else { DVec3::from_array([0, 1, 2].map(first_mm)) };
        let world_from_index = DAffine3 {
            matrix3: ras_from_file * spaced.world_from_index.matrix3,
            translation: ras_from_file * origin_mm,
        };
        return Ok(GridPlacement { world_from_index, is_anatomical, ..spaced });
    }
    let step = |(index, axis): (usize, &&NrrdAxis)| {
        axis.step_mm.unwrap_or_else(|| {
            let is_known = !axis.spacing_mm.is_nan();
            DVec3::AXES[index] * if is_known { axis.spacing_mm } else { 1.0 }
        })
    };
    let mut steps: Vec<DVec3> = axes.iter().enumerate().map(step).collect();
    if let [a, b] = steps[..] {
        steps.push(a.cross(b).normalize_or_zero() * (a.length() * b.length()).sqrt());
    }
    let step = |axis: usize| steps.get(axis).copied().unwrap_or(DVec3::ZERO);
    let placement = GridPlacement::from_ras_affine(DAffine3 {
        matrix3: ras_from_file * DMat3::from_cols(step(0), step(1), step(2)),
        translation: ras_from_file * origin_mm,
    });
    Ok(if is_anatomical { placement } else { placement.without_anatomy() })
}

/// Reads all axes of the array from the header.
fn parse_axes(context: LoadContext<'_>, header: &NrrdHeader) -> Result<Vec<NrrdAxis>, LoadError> {
    let dimension_text = header.require(context, "dimension", "add dimension: 3")?;
    let dimension = dimension_text.parse().ok().filter(|n| (1..=MAX_AXES).contains(n)).ok_or_else(|| {
        context.bad_input_error(
            "dimension",
            format!("a number from 1 to {MAX_AXES} was expected, {} was found", quoted(dimension_text)),
            "correct the header",
        )
    })?;
    header.require(context, "sizes", "add the number of samples along each axis")?;
    let sizes: Vec<u64> = parse_numbers(context, header, "sizes", dimension)?.unwrap_or_default();
    let spacings: Option<Vec<f64>> = parse_numbers(context, header, "spacings", dimension)?;
    // Older headers give the bounds of an axis instead of its spacing.
    let bounds = |field: &str| match parse_numbers::<f64>(context, header, field, dimension) {
        Ok(bounds) => bounds,
        Err(error) => {
            context.warn(format_args!("{field} is not used: {error}"));
            None
        }
    };
    let (mins, maxs) = (bounds("axis mins"), bounds("axis maxs"));
    let centers: Vec<_> = header.get_any("centers", "centerings").split_whitespace().collect();
    let directions = directions(context, header, dimension)?;
    let kinds: Vec<_> = header.get("kinds").unwrap_or_default().split_whitespace().collect();
    let space_unit_mm = mm_per_unit(header, "space units").unwrap_or(1.0);
    // Different known units per axis do not occur in practice: the first known one counts.
    let axis_unit_mm = mm_per_unit(header, "units").unwrap_or(space_unit_mm);
    Ok((0..dimension)
        .map(|i| {
            let direction_mm = directions.as_ref().and_then(|all| all[i]).map(|step| step * space_unit_mm);
            let kind = kinds.get(i).map(|kind| kind.to_lowercase()).unwrap_or_default();
            let kind_is_spatial = !NON_SPATIAL_KINDS.iter().any(|other| kind.ends_with(other));
            let spatial = kind_is_spatial && (directions.is_none() || direction_mm.is_some());
            let bound = |all: &Option<Vec<f64>>| all.as_ref().map_or(f64::NAN, |all| all[i]);
            let bounds = AxisBounds {
                low: bound(&mins),
                high: bound(&maxs),
                is_node: centers.get(i).is_some_and(|center| center.eq_ignore_ascii_case("node")),
            };
            let bounds_spacing = bounds.spacing(sizes[i]);
            let spacing =
                Some(bound(&spacings)).filter(|spacing| !spacing.is_nan()).unwrap_or(bounds_spacing);
            let (spacing_mm, first_mm) =
                (spacing * axis_unit_mm, bounds.first_sample(spacing) * axis_unit_mm);
            NrrdAxis {
                size: sizes[i],
                kind,
                is_spatial: spatial,
                step_mm: direction_mm,
                spacing_mm,
                first_mm,
            }
        })
        .collect())
}

/// Drops surplus axes of length 1; afterwards two or three axes are spatial, and the others lie before or behind
/// them.
fn drop_single_axes(context: LoadContext<'_>, mut axes: Vec<NrrdAxis>) -> Result<Vec<NrrdAxis>, LoadError> {
    let dimension = axes.len();
    axes.retain(|axis| axis.is_spatial || axis.size != 1);
    while axes.iter().filter(|axis| axis.is_spatial).count() > 3 {
        match axes.iter().position(|axis| axis.is_spatial && axis.size == 1) {
            Some(single) => drop(axes.remove(single)),
            None => mark_non_spatial(&mut axes),
        }
    }
    let spatial = axes.iter().filter(|axis| axis.is_spatial).count();
    if spatial < 2 {
        return Err(context.bad_input_error(
            "dimension",
            format!("{spatial} of {dimension} axes are spatial; 3, or 2 for a slice, are expected"),
            "check dimension, kinds and space directions",
        ));
    }
    let first = axes.iter().position(|axis| axis.is_spatial).unwrap_or(0);
    let last = axes.iter().rposition(|axis| axis.is_spatial).unwrap_or(0);
    if let Some(within) = axes[first..=last].iter().position(|axis| !axis.is_spatial) {
        return Err(context.bad_input_error(
            "sizes",
            format!(
                "{} components or time steps lie between the spatial axes; they must lie before or after them",
                axes[first + within].size
            ),
            "change the order of the axes (for example: unu permute)",
        ));
    }
    Ok(axes)
}

/// Marks one of too many spatial axes as non-spatial if the header does not tell which: the one without a spacing, or
/// the first if it may hold colours, or else the last.
fn mark_non_spatial(axes: &mut [NrrdAxis]) {
    let spatial: Vec<usize> = (0..axes.len()).filter(|&at| axes[at].is_spatial).collect();
    let [first, others @ .., last] = &spatial[..] else { return };
    let is_marked = |at: usize| axes[at].step_mm.is_none() && axes[at].spacing_mm.is_nan();
    let is_color = || {
        let is_large = |&at: &usize| axes[at].size > MAX_COLORS;
        axes[*first].size <= MAX_COLORS && others.iter().all(is_large) && is_large(last)
    };
    let is_first = match (is_marked(*first), is_marked(*last)) {
        (true, false) => true,
        (false, true) => false,
        _ => is_color(),
    };
    axes[if is_first { *first } else { *last }].is_spatial = false;
}

/// Returns a list of `count` numbers, if the header has the field.
fn parse_numbers<T: std::str::FromStr>(
    context: LoadContext<'_>,
    header: &NrrdHeader,
    field: &str,
    count: usize,
) -> Result<Option<Vec<T>>, LoadError> {
    let Some(text) = header.get(field) else {
        return Ok(None);
    };
    let numbers: Option<Vec<T>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    match numbers {
        Some(numbers) if numbers.len() == count => Ok(Some(numbers)),
        _ => Err(context.bad_input_error(
            field,
            format!("{count} numbers were expected, one for each axis; {} was found", quoted(text)),
            "correct the header",
        )),
    }
}
