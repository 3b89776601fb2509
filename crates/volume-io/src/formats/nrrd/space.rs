//! World space of an NRRD file: direction vectors, orientation and units.

use glam::DVec3;

use super::super::LoadError;
use super::header::NrrdHeader;
use chiaroscuro_volume::{LoadContext, quoted};

/// Returns the vectors of `space directions`, one per axis; `None` for a non-spatial axis.
///
/// Without the field, or if it describes no axis at all, there are none.
pub(super) fn directions(
    context: LoadContext<'_>,
    header: &NrrdHeader,
    dimension: usize,
) -> Result<Option<Vec<Option<DVec3>>>, LoadError> {
    const FIELD: &str = "space directions";
    let Some(text) = header.get(FIELD) else {
        return Ok(None);
    };
    let space_dimension = space_dimension(context, header)?;
    let wrong = |why: String| {
        context.bad_input_error(
            FIELD,
            why,
            format!("write {dimension} vectors like (1,0,0), or none, one for each axis"),
        )
    };
    let vectors = parse_vectors(text)
        .filter(|vectors| vectors.len() == dimension)
        .ok_or_else(|| wrong(format!("{dimension} vectors were expected, {} was found", quoted(text))))?;
    let mut directions = Vec::new();
    for vector in vectors {
        // Old files mark a non-spatial axis with NaN.
        let Some(components) = vector.filter(|components| !components.iter().all(|c| c.is_nan())) else {
            directions.push(None);
            continue;
        };
        let direction = spatial_vector(&components, space_dimension)
            .ok_or_else(|| wrong(format!("{components:?} is not a vector of {space_dimension} numbers")))?;
        // A time axis has steps in time alone.
        let is_time = direction == DVec3::ZERO && components.get(3).is_some_and(|&step| step != 0.0);
        directions.push((!is_time).then_some(direction));
    }
    Ok(directions.iter().any(Option::is_some).then_some(directions))
}

/// Returns the centre of the first voxel, in the file's space; the origin if unknown.
pub(super) fn origin(context: LoadContext<'_>, header: &NrrdHeader) -> Result<DVec3, LoadError> {
    const FIELD: &str = "space origin";
    let Some(text) = header.get(FIELD) else {
        return Ok(DVec3::ZERO);
    };
    let space_dimension = space_dimension(context, header)?;
    let wrong = || {
        context.bad_input_error(
            FIELD,
            format!("a vector of {space_dimension} finite numbers was expected, {} was found", quoted(text)),
            "write it like (0,0,0)",
        )
    };
    let vectors = parse_vectors(text).ok_or_else(wrong)?;
    match &vectors[..] {
        [None] => Ok(DVec3::ZERO),
        [Some(components)] if components.iter().all(|component| component.is_nan()) => {
            context.warn("the space origin is unknown: 0 is used");
            Ok(DVec3::ZERO)
        }
        [Some(components)] => {
            spatial_vector(components, space_dimension).filter(|origin| origin.is_finite()).ok_or_else(wrong)
        }
        _ => Err(wrong()),
    }
}

/// Returns the signs that convert the file's space to right-anterior-superior.
///
/// Spaces without an anatomical meaning are left unchanged.
pub(super) fn ras_signs(context: LoadContext<'_>, header: &NrrdHeader) -> Result<DVec3, LoadError> {
    // Validates the dimension even if no vector uses it.
    space_dimension(context, header)?;
    Ok(match space_name(header).as_str() {
        "left-posterior-superior" | "lps" => DVec3::new(-1.0, -1.0, 1.0),
        "left-anterior-superior" | "las" => DVec3::new(-1.0, 1.0, 1.0),
        _ => DVec3::ONE,
    })
}

/// True if the file gives an anatomical orientation.
pub(super) fn is_anatomical(header: &NrrdHeader) -> bool {
    let space = space_name(header);
    let names = ["right-anterior-superior", "left-anterior-superior", "left-posterior-superior"];
    names.contains(&space.as_str()) || ["ras", "las", "lps"].contains(&space.as_str())
}

/// Returns millimetres per unit of `space units` or `units`, from the first unit that is a known length.
pub(super) fn mm_per_unit(header: &NrrdHeader, field: &str) -> Option<f64> {
    let units = header.get(field).unwrap_or_default();
    let length = |unit: &str| match unit.trim().to_lowercase().as_str() {
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Some(1.0),
        "m" | "meter" | "meters" | "metre" | "metres" => Some(1e3),
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Some(10.0),
        "um" | "\u{b5}m" | "\u{3bc}m" | "micron" | "microns" | "micrometer" | "micrometers" => Some(1e-3),
        "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => Some(1e-6),
        _ => None,
    };
    // Units are quoted: every second piece is a unit.
    units.split('"').skip(1).step_by(2).find_map(length)
}

/// True if lengths are counted in voxels, so that the physical scale is unknown.
pub(super) fn is_in_voxel_units(header: &NrrdHeader) -> bool {
    let is_voxel =
        |unit: &str| matches!(unit.trim().to_lowercase().as_str(), "voxel" | "voxels" | "pixel" | "pixels");
    ["space units", "units"]
        .iter()
        .any(|field| header.get(field).unwrap_or_default().split('"').skip(1).step_by(2).any(is_voxel))
}

/// Returns the name of the space, without its time suffix.
fn space_name(header: &NrrdHeader) -> String {
    let space = header.get("space").unwrap_or_default().to_lowercase();
    match space.as_str() {
        "rast" | "last" | "lpst" => space[..3].to_owned(),
        _ => space.trim_end_matches("-time").to_owned(),
    }
}

/// Returns the number of components of the file's vectors: 3, 4 with time, or 2 for images.
fn space_dimension(context: LoadContext<'_>, header: &NrrdHeader) -> Result<usize, LoadError> {
    let wrong = |found: &str| {
        context.bad_input_error(
            "space dimension",
            format!(
                "a space of 3 dimensions, 4 with time, or 2 for a slice, was expected, {} was found",
                quoted(found)
            ),
            "write a space like left-posterior-superior",
        )
    };
    match (header.get("space"), header.get("space dimension")) {
        // Spaces with time have four dimensions; names and abbreviations have distinct suffixes.
        (Some(space), _) if has_time(space) => Ok(4),
        (Some(_), _) | (None, None | Some("3")) => Ok(3),
        (None, Some("2")) => Ok(2),
        (None, Some("4")) => Ok(4),
        (None, Some(other)) => Err(wrong(other)),
    }
}

fn has_time(space: &str) -> bool {
    let space = space.to_lowercase();
    space.ends_with("-time") || matches!(space.as_str(), "rast" | "last" | "lpst")
}

/// Converts a vector to three dimensions, without time; `None` if its length does not match.
fn spatial_vector(components: &[f64], space_dimension: usize) -> Option<DVec3> {
    match *components {
        [x, y, z] if space_dimension == 3 => Some(DVec3::new(x, y, z)),
        [x, y, z, _] if space_dimension == 4 => Some(DVec3::new(x, y, z)),
        [x, y] if space_dimension == 2 => Some(DVec3::new(x, y, 0.0)),
        _ => None,
    }
}

/// Parses vectors like `(1,0,0) none (0, 1, 0)`.
fn parse_vectors(text: &str) -> Option<Vec<Option<Vec<f64>>>> {
    let mut vectors = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        if let Some(inside) = rest.strip_prefix('(') {
            let (numbers, after) = inside.split_once(')')?;
            vectors.push(Some(
                numbers.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?,
            ));
            rest = after.trim_start();
        } else {
            let (word, after) = rest.split_at(rest.find([' ', '\t', '(']).unwrap_or(rest.len()));
            if !word.eq_ignore_ascii_case("none") {
                return None;
            }
            vectors.push(None);
            rest = after.trim_start();
        }
    }
    Some(vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_taken_apart() {
        let vectors = parse_vectors(" (1,0, -2.5e0)none  (0,1,0) ").unwrap();
        assert_eq!(vectors, [Some(vec![1.0, 0.0, -2.5]), None, Some(vec![0.0, 1.0, 0.0])]);
        assert_eq!(parse_vectors(""), Some(vec![]));
        for text in ["(1,0", "(1,x)", "()", "1 0 0", "(1,0,0) nothing", ")"] {
            assert_eq!(parse_vectors(text), None, "{text}");
        }
    }
}
