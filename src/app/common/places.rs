//! Searchable rows of the panels, with the synonyms by which the command palette finds them.

use super::reveal::Place;
use crate::app::text::{self, Named, sections};

/// Makes the place of a row by its name alone.
const fn called(section: &'static str, name: &'static str) -> Place {
    Place { section, row: Some(name), is_advanced: false }
}

/// Makes the place of a row outside the advanced part of its section.
const fn row(section: &'static str, named: Named) -> Place {
    called(section, named.name)
}

/// Makes the place of a row in the advanced part of its section.
const fn advanced(section: &'static str, named: Named) -> Place {
    Place { section, row: Some(named.name), is_advanced: true }
}

/// Searchable rows of the panels, each with its synonyms. Spacing and values among the facts about a volume are not
/// listed: a search for these leads to the corrections of the same name.
pub(crate) const PLACES: &[(Place, &str)] = &[
    (Place { section: text::labels::TITLE, row: None, is_advanced: false }, text::found::LABELS),
    (row(sections::LIGHTS, text::lights::NAME), text::found::NAME_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::KIND), text::found::KIND_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::INTENSITY), text::found::BRIGHTNESS),
    (row(sections::LIGHTS, text::lights::DISTANCE), text::found::LIGHT_DISTANCE),
    (row(sections::LIGHTS, text::lights::HOOD), text::found::SPOTLIGHT),
    (row(sections::LIGHTS, text::lights::CONE), text::found::CONE),
    (row(sections::LIGHTS, text::lights::RIM), text::found::RIM),
    (row(sections::LIGHTS, text::lights::SHAPE), text::found::AREA_LIGHT),
    // Width of directional and of positional lights: two settings of one name.
    (row(sections::LIGHTS, text::lights::ANGLE), text::found::WIDTH),
    (row(sections::LIGHTS, text::lights::ASPECT), text::found::ASPECT),
    (row(sections::LIGHTS, text::lights::TURN), text::found::TURN_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::LOCK), text::found::LOCK),
    (row(sections::LIGHTS, text::lights::DENSITY), text::found::LIGHT_DENSITY),
    (row(sections::LIGHTS, text::lights::CASTS_SHADOWS), text::found::FILL),
    (row(sections::SHADOWS, text::shadows::ALGORITHM), text::found::SHADOWS),
    (row(sections::SHADOWS, text::shadows::QUALITY), text::found::QUALITY),
    (row(sections::SHADOWS, text::shadows::STRENGTH), text::found::STRENGTH),
    (row(sections::SHADOWS, text::shadows::AMBIENT_OFFSET), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::GAIN), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::LIGHT_BIAS), text::found::ACNE),
    (row(sections::SHADOWS, text::shadows::BALANCE), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::KEEP_BALANCED), text::found::KEEP_BALANCED),
    (row(sections::SHADOWS, text::shadows::NEARLY_BLACK), text::found::NEARLY_BLACK),
    (row(sections::SHADOWS, text::shadows::LIGHT_OPACITY), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::LINKED), text::found::LIGHTING_CURVE),
    (row(sections::SHADOWS, text::shadows::TRANSMISSION), text::found::GLASS),
    (row(sections::SHADOWS, text::shadows::NEAR_FIELD), text::found::CONTACT),
    (row(sections::SHADOWS, text::shadows::FIRST_TOUCH), text::found::FIRST_TOUCH),
    (row(sections::SHADOWS, text::shadows::RESOLUTION), text::found::MEMORY),
    (advanced(sections::SHADOWS, text::sampling::KERNEL), text::found::KERNEL),
    (advanced(sections::SHADOWS, text::sampling::SIGMA), text::found::SIGMA),
    (advanced(sections::SHADOWS, text::sampling::SLAB), text::found::SLAB),
    (advanced(sections::SHADOWS, text::sampling::QUADRATURE), text::found::QUADRATURE),
    (advanced(sections::SHADOWS, text::shadows::REVERSE_KERNEL), text::found::WAY_BACK),
    (advanced(sections::SHADOWS, text::shadows::PRECISION), text::found::MEMORY),
    (advanced(sections::SHADOWS, text::shadows::STORAGE), text::found::MEMORY),
    (advanced(sections::SHADOWS, text::shadows::DEPOSIT), text::found::DEPOSIT),
    (advanced(sections::SHADOWS, text::shadows::AREA_SAMPLES), text::found::AREA_LIGHT),
    (advanced(sections::SHADOWS, text::shadows::AREA_RESOLUTION), text::found::SOFT_RESOLUTION),
    (advanced(sections::SHADOWS, text::shadows::LEAST_BLOCKS), text::found::LEAST_BLOCKS),
    (row(sections::SOFT_LIGHT, text::sky::MODE), text::found::SKY),
    (row(sections::SOFT_LIGHT, text::sky::SURROUNDINGS), text::found::SKY),
    (row(sections::SOFT_LIGHT, text::sky::INTENSITY), text::found::SKY),
    (row(sections::SOFT_LIGHT, text::sky::ZENITH), text::found::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::HORIZON), text::found::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::GROUND), text::found::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::TILT), text::found::SKY_LEAN),
    (row(sections::SOFT_LIGHT, text::sky::TURN), text::found::SKY_TURN),
    (advanced(sections::SOFT_LIGHT, text::sky::DENSITY), text::found::SKY_DENSITY),
    (advanced(sections::SOFT_LIGHT, text::sky::DIRECTIONS), text::found::DIRECTIONS),
    // Resolution for the sky and for bounces: both rows are revealed.
    (advanced(sections::SOFT_LIGHT, text::shadows::RESOLUTION), text::found::MEMORY),
    (row(sections::SOFT_LIGHT, text::scattering::BOUNCES), text::found::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::ALBEDO), text::found::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::DENSITY), text::found::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::STRENGTH), text::found::BOUNCED),
    (row(sections::SOFT_LIGHT, text::scattering::ANISOTROPY), text::found::FORWARD),
    (advanced(sections::SOFT_LIGHT, text::scattering::DIRECTIONS), text::found::DIRECTIONS),
    (row(sections::SHADING, text::shading::EMISSION), text::found::GLOW),
    (row(sections::SHADING, text::shading::AMBIENT), text::found::AMBIENT),
    (row(sections::SHADING, text::shading::DIFFUSE), text::found::DIFFUSE),
    (row(sections::SHADING, text::shading::SPECULAR), text::found::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::SHININESS), text::found::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::SURFACE_GRADIENT), text::found::SURFACE),
    (row(sections::SHADING, text::shading::SIDES), text::found::SIDES),
    (row(sections::SHADING, text::shading::EXPOSURE), text::found::BRIGHTNESS),
    (row(sections::SHADING, text::shading::TONE_MAP), text::found::TONE_MAP),
    (row(sections::SHADING, text::shading::BACKGROUND), text::found::BACKGROUND),
    (row(sections::CUTS, text::cuts::CROP), text::found::CROP),
    (called(sections::CUTS, text::cuts::AXES[0]), text::found::CROP_ALONG),
    (called(sections::CUTS, text::cuts::AXES[1]), text::found::CROP_ALONG),
    (called(sections::CUTS, text::cuts::AXES[2]), text::found::CROP_ALONG),
    (row(sections::CUTS, text::cuts::OUTSIDE), text::found::CUT_AWAY),
    (row(sections::CUTS, text::cuts::PLANE), text::found::CLIP),
    (row(sections::CUTS, text::cuts::OFFSET), text::found::CLIP_OFFSET),
    (row(sections::CUTS, text::cuts::FACING), text::found::CLIP_FACING),
    (row(sections::CUTS, text::cuts::IN_FRONT), text::found::CUT_AWAY),
    (row(sections::FLOOR, text::floor::ON), text::found::FLOOR),
    (row(sections::FLOOR, text::floor::HEIGHT), text::found::FLOOR_HEIGHT),
    (row(sections::FLOOR, text::floor::RADIUS), text::found::FLOOR_RADIUS),
    (row(sections::FLOOR, text::floor::OPACITY), text::found::FLOOR_OPACITY),
    (row(sections::FLOOR, text::floor::COLOR), text::found::FLOOR_COLOR),
    (row(sections::FLOOR, text::floor::SHADOW_ALONE), text::found::SHADOW_ALONE),
    (row(sections::CAMERA, text::camera::PROJECTION), text::found::PROJECTION),
    (row(sections::CAMERA, text::camera::UP), text::found::UP),
    (row(sections::CAMERA, text::camera::AZIMUTH), text::found::AZIMUTH),
    (row(sections::CAMERA, text::camera::ELEVATION), text::found::ELEVATION),
    (row(sections::CAMERA, text::camera::ROLL), text::found::ROLL),
    (row(sections::CAMERA, text::camera::DISTANCE), text::found::CAMERA_DISTANCE),
    (row(sections::CAMERA, text::camera::FIELD_OF_VIEW), text::found::FIELD_OF_VIEW),
    (row(sections::CAMERA, text::camera::FIT), text::found::FIT),
    (advanced(sections::CAMERA, text::sampling::KERNEL), text::found::KERNEL),
    (advanced(sections::CAMERA, text::sampling::SIGMA), text::found::SIGMA),
    (advanced(sections::CAMERA, text::sampling::SLAB), text::found::SLAB),
    (advanced(sections::CAMERA, text::sampling::QUADRATURE), text::found::QUADRATURE),
    (advanced(sections::CAMERA, text::sampling::SLABS), text::found::SLABS),
    (advanced(sections::CAMERA, text::sampling::CLASSIFICATION), text::found::CLASSIFICATION),
    (advanced(sections::CAMERA, text::sampling::ENGINE), text::found::ENGINE),
    (advanced(sections::CAMERA, text::sampling::ORDER), text::found::ORDER),
    (advanced(sections::CAMERA, text::sampling::NORMALS), text::found::NORMALS),
    (row(sections::COMPARE, text::compared::ON), text::found::COMPARE),
    (row(sections::COMPARE, text::compared::LEFT), text::found::COMPARED_SIDE),
    (row(sections::COMPARE, text::compared::RIGHT), text::found::COMPARED_SIDE),
    (row(sections::COMPARE, text::compared::DIFFERENCE), text::found::DIFFERENCE),
    (row(sections::DATA, text::data::TREAT_AS), text::found::KIND_OF_DATA),
    (row(sections::DATA, text::data::RANGE), text::found::RANGE),
    (row(sections::DATA, text::data::THINNING), text::found::MEMORY),
    (row(sections::DATA, text::data::OPACITY_UNIT), text::found::OPACITY_UNIT),
    (advanced(sections::DATA, text::corrections::SPACING), text::found::SPACING),
    (advanced(sections::DATA, text::corrections::UNIT), text::found::UNIT),
    (advanced(sections::DATA, text::corrections::FLIP), text::found::MIRROR),
    (advanced(sections::DATA, text::corrections::AXIS_ORDER), text::found::AXES),
    (advanced(sections::DATA, text::corrections::ORIENTATION), text::found::ANATOMY),
    (advanced(sections::DATA, text::corrections::PADDING), text::found::PADDING),
    (advanced(sections::DATA, text::corrections::VALUE_SCALE), text::found::RESCALE),
    (called(sections::DATA, text::data::NAME), text::found::NAME_OF_DATA),
    (called(sections::DATA, text::data::SOURCE), text::found::SOURCE),
    (called(sections::DATA, text::data::DIMENSIONS), text::found::DIMENSIONS),
    (called(sections::DATA, text::data::VOXEL_TYPE), text::found::VOXEL_TYPE),
    (called(sections::DATA, text::data::KIND), text::found::KIND_OF_DATA),
    (called(sections::DATA, text::data::SHOWN), text::found::SHOWN),
    (called(sections::DATA, text::data::MEMORY), text::found::RAM),
    (row(text::transfer::TITLE, text::transfer::OPACITY), text::found::CURVE_OPACITY),
    (row(text::transfer::TITLE, text::transfer::LEVEL), text::found::LEVEL),
    (row(text::transfer::TITLE, text::transfer::WINDOW), text::found::WINDOW),
    (row(text::transfer::TITLE, text::transfer::FREEHAND), text::found::FREEHAND),
    (row(text::transfer::TITLE, text::transfer::LOG_HISTOGRAM), text::found::LOG_HISTOGRAM),
];

/// Returns the synonyms of a place.
pub(crate) fn words(place: Place) -> &'static str {
    PLACES.iter().find(|(known, _)| *known == place).map_or("", |(_, words)| words)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sources of the panels, which the tests scan for rows.
    const PANELS: [&str; 13] = [
        include_str!("../panels/camera.rs"),
        include_str!("../panels/compare.rs"),
        include_str!("../panels/cuts.rs"),
        include_str!("../panels/data/corrections.rs"),
        include_str!("../panels/data/mod.rs"),
        include_str!("../panels/data/range.rs"),
        include_str!("../panels/floor.rs"),
        include_str!("../panels/lights.rs"),
        include_str!("../panels/sampling.rs"),
        include_str!("../panels/scattering.rs"),
        include_str!("../panels/shading.rs"),
        include_str!("../panels/shadows.rs"),
        include_str!("../panels/sky.rs"),
    ];

    /// Calls that make a row with the name that follows.
    const MAKERS: [&str; 8] = [
        "row(ui,",
        "choice(ui,",
        "choice_with(ui,",
        "switch(ui,",
        "side(ui,",
        "effect(ui,",
        "Number::new(",
        "voxels(",
    ];

    /// Finds the names of rows in a source text.
    fn rows(source: &str) -> Vec<&str> {
        let name = |(at, _): (usize, &str)| {
            let is_made = MAKERS.iter().any(|maker| source[..at].trim_end().ends_with(maker));
            let path = source[at..].split(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).next()?;
            (is_made && path.ends_with(char::is_uppercase)).then_some(path)
        };
        source.match_indices("text::").filter_map(name).collect()
    }

    #[test]
    fn every_row_of_the_panels_is_listed() {
        let listed = include_str!("places.rs");
        let made: Vec<_> = PANELS.into_iter().flat_map(rows).collect();
        assert!(made.len() > 70, "{made:?}");
        assert_eq!(text::lights::SIZE.name, text::lights::ANGLE.name, "one of them stands for both");
        for name in made.into_iter().filter(|name| *name != "text::lights::SIZE") {
            assert!(listed.contains(&format!(", {name})")), "{name}");
        }
    }

    #[test]
    fn rows_that_are_not_listed_would_be_noticed() {
        let source =
            "row(ui, text::a::B, f); Number::new(\n  text::a::C_D, 0.0..=1.0); ui.button(text::a::E)";
        assert_eq!(rows(source), ["text::a::B", "text::a::C_D"]);
    }

    #[test]
    fn every_place_is_listed_once() {
        for (at, (place, words)) in PLACES.iter().enumerate() {
            let mut before = PLACES[..at].iter().map(|(before, _)| (before.section, before.row));
            assert!(!before.any(|other| other == (place.section, place.row)), "{place:?}");
            let is_section = sections::ALL.contains(&place.section);
            let is_below = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
            assert!(is_section || is_below, "{place:?}");
            assert!(!words.is_empty() && words.to_lowercase() == **words, "{place:?}: {words}");
        }
    }
}
