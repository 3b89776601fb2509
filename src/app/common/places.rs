//! What of the panels is found by a word, and by what else people call it.

use super::reveal::Place;
use crate::app::text::{self, Named, sections};

/// A row that is always there.
const fn row(section: &'static str, named: Named) -> Place {
    Place { section, row: Some(named.name), is_advanced: false }
}

/// A row that is folded away.
const fn advanced(section: &'static str, named: Named) -> Place {
    Place { section, row: Some(named.name), is_advanced: true }
}

/// Settings, each with what else it is found by.
pub(crate) const PLACES: &[(Place, &str)] = &[
    (row(sections::LIGHTS, text::lights::KIND), text::found::KIND_OF_LIGHT),
    (row(sections::LIGHTS, text::lights::INTENSITY), text::found::BRIGHTNESS),
    (row(sections::LIGHTS, text::lights::SHAPE), text::found::AREA_LIGHT),
    (row(sections::LIGHTS, text::lights::LOCK), text::found::LOCK),
    (row(sections::LIGHTS, text::lights::DENSITY), ""),
    (row(sections::LIGHTS, text::lights::CASTS_SHADOWS), text::found::FILL),
    (row(sections::SHADOWS, text::shadows::ALGORITHM), text::found::SHADOWS),
    (row(sections::SHADOWS, text::shadows::QUALITY), text::found::QUALITY),
    (row(sections::SHADOWS, text::shadows::STRENGTH), text::found::STRENGTH),
    (row(sections::SHADOWS, text::shadows::AMBIENT_OFFSET), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::GAIN), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::LIGHT_BIAS), text::found::ACNE),
    (row(sections::SHADOWS, text::shadows::BALANCE), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::LIGHT_OPACITY), text::found::TOO_DARK),
    (row(sections::SHADOWS, text::shadows::LINKED), text::found::LIGHTING_CURVE),
    (row(sections::SHADOWS, text::shadows::TRANSMISSION), text::found::GLASS),
    (row(sections::SHADOWS, text::shadows::NEAR_FIELD), text::found::CONTACT),
    (row(sections::SHADOWS, text::shadows::RESOLUTION), text::found::MEMORY),
    (row(sections::SHADOWS, text::shadows::FIRST_TOUCH), ""),
    (advanced(sections::SHADOWS, text::shadows::PRECISION), text::found::MEMORY),
    (advanced(sections::SHADOWS, text::shadows::STORAGE), text::found::MEMORY),
    (advanced(sections::SHADOWS, text::shadows::AREA_SAMPLES), text::found::AREA_LIGHT),
    (row(sections::SOFT_LIGHT, text::sky::MODE), text::found::SKY),
    (row(sections::SOFT_LIGHT, text::sky::INTENSITY), text::found::SKY),
    (row(sections::SOFT_LIGHT, text::scattering::BOUNCES), text::found::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::ALBEDO), text::found::SCATTERING),
    (row(sections::SOFT_LIGHT, text::scattering::DENSITY), text::found::SCATTERING),
    (row(sections::SHADING, text::shading::EMISSION), text::found::GLOW),
    (row(sections::SHADING, text::shading::AMBIENT), text::found::AMBIENT),
    (row(sections::SHADING, text::shading::DIFFUSE), ""),
    (row(sections::SHADING, text::shading::SPECULAR), text::found::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::SHININESS), text::found::HIGHLIGHTS),
    (row(sections::SHADING, text::shading::EXPOSURE), text::found::BRIGHTNESS),
    (row(sections::SHADING, text::shading::TONE_MAP), text::found::TONE_MAP),
    (row(sections::SHADING, text::shading::BACKGROUND), text::found::BACKGROUND),
    (row(sections::CUTS, text::cuts::CROP), text::found::CROP),
    (row(sections::CUTS, text::cuts::PLANE), text::found::CLIP),
    (row(sections::FLOOR, text::floor::ON), text::found::FLOOR),
    (row(sections::FLOOR, text::floor::HEIGHT), ""),
    (row(sections::CAMERA, text::camera::PROJECTION), text::found::PROJECTION),
    (row(sections::CAMERA, text::camera::UP), text::found::UP),
    (row(sections::CAMERA, text::camera::FIELD_OF_VIEW), text::found::FIELD_OF_VIEW),
    (row(sections::CAMERA, text::camera::FIT), ""),
    (row(sections::CAMERA, text::camera::ROLL), ""),
    (row(sections::DATA, text::data::RANGE), text::found::RANGE),
    (row(sections::DATA, text::data::OPACITY_UNIT), text::found::OPACITY_UNIT),
    (row(sections::DATA, text::data::TREAT_AS), ""),
    (row(sections::DATA, text::data::THINNING), text::found::MEMORY),
    (row(sections::DATA, text::corrections::SPACING), text::found::SPACING),
    (row(sections::DATA, text::corrections::ORIENTATION), text::found::UP),
];

/// What else a place is found by.
pub(crate) fn words(place: Place) -> &'static str {
    PLACES.iter().find(|(known, _)| *known == place).map_or("", |(_, words)| words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_listed_once() {
        for (at, (place, _)) in PLACES.iter().enumerate() {
            assert!(!PLACES[..at].iter().any(|(other, _)| other == place), "{place:?}");
        }
    }
}
