//! Searchable rows of the panels, with the synonyms by which the command palette finds them.

use super::reveal::SettingPlace;
use crate::app::text::{self, ControlText, sections};

/// Makes the place of a row by its name alone.
const fn row_named(section: &'static str, name: &'static str) -> SettingPlace {
    SettingPlace { section, row: Some(name), is_advanced: false }
}

/// Makes the place of a row outside the advanced part of its section.
const fn row(section: &'static str, named: ControlText) -> SettingPlace {
    row_named(section, named.name)
}

/// Makes the place of a row in the advanced part of its section.
const fn advanced_row(section: &'static str, named: ControlText) -> SettingPlace {
    SettingPlace { section, row: Some(named.name), is_advanced: true }
}

/// Searchable rows of the panels, each with its synonyms. Spacing and values among the facts about a volume are not
/// listed: a search for these leads to the corrections of the same name.
pub(crate) const SEARCHABLE_SETTINGS: &[(SettingPlace, &str)] = &[
    (SettingPlace { section: text::labels::TITLE, row: None, is_advanced: false }, text::synonyms::LABELS),
    (row(sections::LIGHTS, text::lights::NAME), text::synonyms::NAME_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::KIND), text::synonyms::KIND_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::INTENSITY), text::synonyms::BRIGHTNESS),
    (row(sections::LIGHTS, text::lights::DISTANCE), text::synonyms::LIGHT_DISTANCE),
    (row(sections::LIGHTS, text::lights::SPOTLIGHT), text::synonyms::SPOTLIGHT),
    (row(sections::LIGHTS, text::lights::CONE), text::synonyms::CONE),
    (row(sections::LIGHTS, text::lights::FALLOFF), text::synonyms::RIM),
    (row(sections::LIGHTS, text::lights::SHAPE), text::synonyms::AREA_LIGHT),
    // Width of directional and of positional lights: two settings of one name.
    (row(sections::LIGHTS, text::lights::ANGLE), text::synonyms::WIDTH),
    (row(sections::LIGHTS, text::lights::ASPECT), text::synonyms::ASPECT),
    (row(sections::LIGHTS, text::lights::ROTATION), text::synonyms::LIGHT_ROTATION),
    (row(sections::LIGHTS, text::lights::LOCK), text::synonyms::LOCK),
    (row(sections::LIGHTS, text::lights::DENSITY), text::synonyms::LIGHT_DENSITY),
    (row(sections::LIGHTS, text::lights::CASTS_SHADOWS), text::synonyms::FILL),
    (row(sections::SHADOWS, text::shadows::ALGORITHM), text::synonyms::SHADOWS),
    (row(sections::SHADOWS, text::shadows::QUALITY), text::synonyms::QUALITY),
    (row(sections::SHADOWS, text::shadows::STRENGTH), text::synonyms::STRENGTH),
    (row(sections::SHADOWS, text::shadows::AMBIENT_OFFSET), text::synonyms::SHADOW_BRIGHTENING),
    (row(sections::SHADOWS, text::shadows::GAIN), text::synonyms::SHADOW_BRIGHTENING),
    (row(sections::SHADOWS, text::shadows::LIGHT_BIAS), text::synonyms::SHADOW_BIAS),
    (row(sections::SHADOWS, text::shadows::BALANCE), text::synonyms::SHADOW_BRIGHTENING),
    (row(sections::SHADOWS, text::shadows::KEEP_BALANCED), text::synonyms::KEEP_BALANCED),
    (row(sections::SHADOWS, text::shadows::NEARLY_BLACK), text::synonyms::DARK_SHARE),
    (row(sections::SHADOWS, text::shadows::LIGHT_OPACITY), text::synonyms::SHADOW_BRIGHTENING),
    (row(sections::SHADOWS, text::shadows::LINKED), text::synonyms::LIGHTING_CURVE),
    (row(sections::SHADOWS, text::shadows::TRANSMISSION), text::synonyms::COLORED_SHADOWS),
    (row(sections::SHADOWS, text::shadows::NEAR_FIELD), text::synonyms::CONTACT_SHADOWS),
    (row(sections::SHADOWS, text::shadows::FIRST_TOUCH), text::synonyms::FIRST_TOUCH),
    (row(sections::SHADOWS, text::shadows::RESOLUTION), text::synonyms::MEMORY),
    (advanced_row(sections::SHADOWS, text::sampling::KERNEL), text::synonyms::KERNEL),
    (advanced_row(sections::SHADOWS, text::sampling::SIGMA), text::synonyms::SIGMA),
    (advanced_row(sections::SHADOWS, text::sampling::SLAB), text::synonyms::SLAB),
    (advanced_row(sections::SHADOWS, text::sampling::QUADRATURE), text::synonyms::QUADRATURE),
    (advanced_row(sections::SHADOWS, text::shadows::REVERSE_KERNEL), text::synonyms::REVERSE_KERNEL),
    (advanced_row(sections::SHADOWS, text::shadows::PRECISION), text::synonyms::MEMORY),
    (advanced_row(sections::SHADOWS, text::shadows::STORAGE), text::synonyms::MEMORY),
    (advanced_row(sections::SHADOWS, text::shadows::DEPOSIT), text::synonyms::DEPOSIT),
    (advanced_row(sections::SHADOWS, text::shadows::AREA_SAMPLES), text::synonyms::AREA_LIGHT),
    (advanced_row(sections::SHADOWS, text::shadows::AREA_RESOLUTION), text::synonyms::SOFT_RESOLUTION),
    (advanced_row(sections::SHADOWS, text::shadows::MIN_BLOCKS), text::synonyms::MIN_BLOCKS),
    (row(sections::SOFT_LIGHT, text::sky::MODE), text::synonyms::SKY),
    (row(sections::SOFT_LIGHT, text::sky::ENVIRONMENT_MAP), text::synonyms::SKY),
    (row(sections::SOFT_LIGHT, text::sky::INTENSITY), text::synonyms::SKY),
    (row(sections::SOFT_LIGHT, text::sky::ZENITH), text::synonyms::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::HORIZON), text::synonyms::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::GROUND), text::synonyms::SKY_COLOR),
    (row(sections::SOFT_LIGHT, text::sky::TILT), text::synonyms::SKY_TILT),
    (row(sections::SOFT_LIGHT, text::sky::TURN), text::synonyms::SKY_TURN),
    (advanced_row(sections::SOFT_LIGHT, text::sky::DENSITY), text::synonyms::SKY_DENSITY),
    (advanced_row(sections::SOFT_LIGHT, text::sky::DIRECTIONS), text::synonyms::DIRECTIONS),
    // Resolution for the sky and for bounces: both rows are revealed.
    (advanced_row(sections::SOFT_LIGHT, text::shadows::RESOLUTION), text::synonyms::MEMORY),
    (row(sections::SOFT_LIGHT, text::scattering::BOUNCES), text::synonyms::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::ALBEDO), text::synonyms::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::DENSITY), text::synonyms::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::STRENGTH), text::synonyms::BOUNCED),
    (row(sections::SOFT_LIGHT, text::scattering::ANISOTROPY), text::synonyms::ANISOTROPY),
    (advanced_row(sections::SOFT_LIGHT, text::scattering::DIRECTIONS), text::synonyms::DIRECTIONS),
    (row(sections::SHADING, text::shading::MODE), text::synonyms::RENDER_MODE),
    (row(sections::SHADING, text::shading::EMISSION), text::synonyms::GLOW),
    (row(sections::SHADING, text::shading::AMBIENT), text::synonyms::AMBIENT),
    (row(sections::SHADING, text::shading::DIFFUSE), text::synonyms::DIFFUSE),
    (row(sections::SHADING, text::shading::SPECULAR), text::synonyms::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::SHININESS), text::synonyms::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::SURFACE_GRADIENT), text::synonyms::SURFACE),
    (row(sections::SHADING, text::shading::SIDES), text::synonyms::SIDES),
    (row(sections::SHADING, text::shading::EXPOSURE), text::synonyms::BRIGHTNESS),
    (row(sections::SHADING, text::shading::TONE_MAP), text::synonyms::TONE_MAP),
    (row(sections::SHADING, text::shading::ANTIALIASING), text::synonyms::ANTIALIASING),
    (row(sections::SHADING, text::shading::BACKGROUND), text::synonyms::BACKGROUND),
    (row(sections::CUTS, text::cuts::CROP), text::synonyms::CROP),
    (row_named(sections::CUTS, text::cuts::AXES[0]), text::synonyms::CROP_ALONG),
    (row_named(sections::CUTS, text::cuts::AXES[1]), text::synonyms::CROP_ALONG),
    (row_named(sections::CUTS, text::cuts::AXES[2]), text::synonyms::CROP_ALONG),
    (row(sections::CUTS, text::cuts::OUTSIDE), text::synonyms::CUT_AWAY),
    (row(sections::CUTS, text::cuts::PLANE), text::synonyms::CLIP),
    (row(sections::CUTS, text::cuts::BY_SHAPE), text::synonyms::CUT_BY_SHAPE),
    (row(sections::CUTS, text::cuts::INSIDE_SHAPE), text::synonyms::CUT_AWAY),
    (row(sections::CUTS, text::cuts::OUTSIDE_SHAPE), text::synonyms::CUT_AWAY),
    (row(sections::CUTS, text::cuts::HALF_OFFSET), text::synonyms::CLIP_OFFSET),
    (row(sections::CUTS, text::cuts::OFFSET), text::synonyms::CLIP_OFFSET),
    (row(sections::CUTS, text::cuts::FACING), text::synonyms::CLIP_FACING),
    (row(sections::CUTS, text::cuts::IN_FRONT), text::synonyms::CUT_AWAY),
    (row(sections::FLOOR, text::floor::ON), text::synonyms::FLOOR),
    (row(sections::FLOOR, text::floor::HEIGHT), text::synonyms::FLOOR_HEIGHT),
    (row(sections::FLOOR, text::floor::RADIUS), text::synonyms::FLOOR_RADIUS),
    (row(sections::FLOOR, text::floor::OPACITY), text::synonyms::FLOOR_OPACITY),
    (row(sections::FLOOR, text::floor::COLOR), text::synonyms::FLOOR_COLOR),
    (row(sections::FLOOR, text::floor::SHADOW_ALONE), text::synonyms::SHADOW_ALONE),
    (row(sections::CAMERA, text::camera::PROJECTION), text::synonyms::PROJECTION),
    (row(sections::CAMERA, text::camera::UP), text::synonyms::UP),
    (row(sections::CAMERA, text::camera::AZIMUTH), text::synonyms::AZIMUTH),
    (row(sections::CAMERA, text::camera::ELEVATION), text::synonyms::ELEVATION),
    (row(sections::CAMERA, text::camera::ROLL), text::synonyms::ROLL),
    (row(sections::CAMERA, text::camera::DISTANCE), text::synonyms::CAMERA_DISTANCE),
    (row(sections::CAMERA, text::camera::FIELD_OF_VIEW), text::synonyms::FIELD_OF_VIEW),
    (row(sections::CAMERA, text::camera::FIT), text::synonyms::FIT),
    (advanced_row(sections::CAMERA, text::sampling::KERNEL), text::synonyms::KERNEL),
    (advanced_row(sections::CAMERA, text::sampling::SIGMA), text::synonyms::SIGMA),
    (advanced_row(sections::CAMERA, text::sampling::SLAB), text::synonyms::SLAB),
    (advanced_row(sections::CAMERA, text::sampling::QUADRATURE), text::synonyms::QUADRATURE),
    (advanced_row(sections::CAMERA, text::sampling::SLABS), text::synonyms::SLABS),
    (advanced_row(sections::CAMERA, text::sampling::CLASSIFICATION), text::synonyms::CLASSIFICATION),
    (advanced_row(sections::CAMERA, text::sampling::ENGINE), text::synonyms::ENGINE),
    (advanced_row(sections::CAMERA, text::sampling::ORDER), text::synonyms::ORDER),
    (advanced_row(sections::CAMERA, text::sampling::NORMALS), text::synonyms::NORMALS),
    (row(sections::COMPARE, text::comparison::ON), text::synonyms::COMPARE),
    (row(sections::COMPARE, text::comparison::LEFT), text::synonyms::COMPARED_SIDE),
    (row(sections::COMPARE, text::comparison::RIGHT), text::synonyms::COMPARED_SIDE),
    (row(sections::COMPARE, text::comparison::DIFFERENCE), text::synonyms::DIFFERENCE),
    (row(sections::DATA, text::data::ALL_LAYERS), text::synonyms::LAYERS),
    (row(sections::DATA, text::data::LAYER_EDGES), text::synonyms::EDGES),
    (row(sections::DATA, text::data::LAYER_OUTLINES), text::synonyms::OUTLINES),
    (row(sections::DATA, text::data::LAYER_IGNORES_CUTS), text::synonyms::NEVER_CUT),
    (row(sections::DATA, text::data::TREAT_AS), text::synonyms::KIND_OF_DATA),
    (row(sections::DATA, text::data::RANGE), text::synonyms::RANGE),
    (row(sections::DATA, text::data::SUBSAMPLE), text::synonyms::MEMORY),
    (row(sections::DATA, text::data::OPACITY_UNIT), text::synonyms::OPACITY_UNIT),
    (advanced_row(sections::DATA, text::corrections::SPACING), text::synonyms::SPACING),
    (advanced_row(sections::DATA, text::corrections::UNIT), text::synonyms::UNIT),
    (advanced_row(sections::DATA, text::corrections::FLIP), text::synonyms::FLIP),
    (advanced_row(sections::DATA, text::corrections::AXIS_ORDER), text::synonyms::AXES),
    (advanced_row(sections::DATA, text::corrections::ORIENTATION), text::synonyms::ORIENTATION),
    (advanced_row(sections::DATA, text::corrections::PADDING), text::synonyms::PADDING),
    (advanced_row(sections::DATA, text::corrections::VALUE_SCALE), text::synonyms::RESCALE),
    (advanced_row(sections::DATA, text::corrections::HIDE_TABLE), text::synonyms::PATIENT_TABLE),
    (row_named(sections::DATA, text::data::NAME), text::synonyms::NAME_OF_DATA),
    (row_named(sections::DATA, text::data::SOURCE), text::synonyms::SOURCE),
    (row_named(sections::DATA, text::data::DIMENSIONS), text::synonyms::DIMENSIONS),
    (row_named(sections::DATA, text::data::VOXEL_TYPE), text::synonyms::VOXEL_TYPE),
    (row_named(sections::DATA, text::data::KIND), text::synonyms::KIND_OF_DATA),
    (row_named(sections::DATA, text::data::SHOWN), text::synonyms::SHOWN),
    (row_named(sections::DATA, text::data::MEMORY), text::synonyms::RAM),
    (row(text::transfer::TITLE, text::transfer::OPACITY), text::synonyms::CURVE_OPACITY),
    (row(text::transfer::TITLE, text::transfer::LEVEL), text::synonyms::LEVEL),
    (row(text::transfer::TITLE, text::transfer::WINDOW), text::synonyms::WINDOW),
    (row(text::transfer::TITLE, text::transfer::FREEHAND), text::synonyms::FREEHAND),
    (row(text::transfer::TITLE, text::materials::USE_MATERIALS), text::synonyms::MATERIALS),
    (row(text::transfer::TITLE, text::transfer::LOG_HISTOGRAM), text::synonyms::LOG_HISTOGRAM),
];

/// Returns the synonyms of a place.
pub(crate) fn synonyms_of(place: SettingPlace) -> &'static str {
    SEARCHABLE_SETTINGS.iter().find(|(known, _)| *known == place).map_or("", |(_, words)| words)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sources of the panels, which the tests scan for rows.
    const PANELS: [&str; 14] = [
        include_str!("../panels/camera.rs"),
        include_str!("../panels/compare.rs"),
        include_str!("../panels/clipping/mod.rs"),
        include_str!("../panels/clipping/shape_cuts.rs"),
        include_str!("../panels/data/corrections.rs"),
        include_str!("../panels/data/mod.rs"),
        include_str!("../panels/data/range.rs"),
        include_str!("../panels/floor.rs"),
        include_str!("../panels/lights.rs"),
        include_str!("../panels/sampling.rs"),
        include_str!("../panels/scattering.rs"),
        include_str!("../panels/shading.rs"),
        include_str!("../panels/shadows.rs"),
        include_str!("../panels/sky_light.rs"),
    ];

    /// Calls that make a row with the name that follows.
    const MAKERS: [&str; 8] = [
        "row(ui,",
        "choice_row(ui,",
        "choice_row_with_tips(ui,",
        "switch_row(ui,",
        "side(ui,",
        "cut_effect_row(ui,",
        "NumberRow::new(",
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
        let listed = include_str!("searchable_settings.rs");
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
            "row(ui, text::a::B, f); NumberRow::new(\n  text::a::C_D, 0.0..=1.0); ui.button(text::a::E)";
        assert_eq!(rows(source), ["text::a::B", "text::a::C_D"]);
    }

    #[test]
    fn every_place_is_listed_once() {
        for (at, (place, words)) in SEARCHABLE_SETTINGS.iter().enumerate() {
            let mut before = SEARCHABLE_SETTINGS[..at].iter().map(|(before, _)| (before.section, before.row));
            assert!(!before.any(|other| other == (place.section, place.row)), "{place:?}");
            let is_section = sections::ALL.contains(&place.section);
            let is_below = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
            assert!(is_section || is_below, "{place:?}");
            assert!(!words.is_empty() && words.to_lowercase() == **words, "{place:?}: {words}");
        }
    }
}
