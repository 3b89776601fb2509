//! Data elements of an image plane: position, acquisition attributes and value scale.

use glam::DVec3;

use super::plane::Plane;
use super::tags::{self, Tag};
use super::taken::Attribute;
use super::value::Value;

/// Stores the value of an element that describes one image.
pub(super) fn take_plane(plane: &mut Plane, tag: Tag, value: Value<'_>) {
    match tag {
        tags::POSITION => plane.position = value.decimals_of().map(DVec3::from_array),
        tags::ORIENTATION => {
            plane.orientation = value.decimals_of().map(orientation);
        }
        tags::PIXEL_SPACING => {
            if let Some(spacing) = value.decimals_of() {
                (plane.spacing, plane.spacing_source) = (Some(spacing), None);
            }
        }
        // Spacing at the detector, not at the body: a fallback.
        tags::DETECTOR_SPACING if plane.spacing.is_none() => {
            plane.spacing = value.decimals_of();
            plane.spacing_source = Some("Imager Pixel Spacing");
        }
        tags::NOMINAL_SPACING if plane.spacing.is_none() => {
            plane.spacing = value.decimals_of();
            plane.spacing_source = Some("Nominal Scanned Pixel Spacing");
        }
        tags::SLICE_THICKNESS => plane.thickness = value.decimal(),
        tags::SPACING_BETWEEN => plane.between = value.decimal(),
        tags::SLOPE => plane.slope = value.decimal(),
        tags::INTERCEPT => plane.intercept = value.decimal(),
        tags::WINDOW_CENTER => plane.window[0] = value.decimal(),
        tags::WINDOW_WIDTH => plane.window[1] = value.decimal(),
        tags::SLICE_LOCATION => plane.location_mm = value.decimal(),
        tags::VOLUME_POSITION => {
            plane.position = value.doubles_of().map(DVec3::from_array);
            plane.is_in_volume_frame = true;
        }
        tags::VOLUME_ORIENTATION => {
            plane.orientation = value.doubles_of().map(orientation);
            plane.is_in_volume_frame = true;
        }
        tags::REFERENCED_SEGMENT => plane.segment = value.short(),
        _ => take_attribute(plane, tag, value),
    }
}

/// Splits six direction cosines into the directions along rows and along columns.
fn orientation([a, b, c, d, e, f]: [f64; 6]) -> [DVec3; 2] {
    [DVec3::new(a, b, c), DVec3::new(d, e, f)]
}

/// Stores the value of an acquisition attribute, if the element is one.
fn take_attribute(plane: &mut Plane, tag: Tag, value: Value<'_>) {
    let (attribute, value) = match tag {
        tags::TEMPORAL_POSITION => (Attribute::TemporalPosition, value.decimal()),
        tags::TEMPORAL_POSITION_INDEX => (Attribute::TemporalPosition, value.long().map(f64::from)),
        tags::B_VALUE => (Attribute::BValue, value.double()),
        tags::ECHO_TIME => (Attribute::EchoTime, value.decimal()),
        tags::EFFECTIVE_ECHO_TIME => (Attribute::EchoTime, value.double()),
        tags::ECHO_NUMBER => (Attribute::EchoNumber, value.decimal()),
        tags::INVERSION_TIME => (Attribute::InversionTime, value.decimal()),
        tags::FLIP_ANGLE => (Attribute::FlipAngle, value.decimal()),
        tags::TUBE_VOLTAGE => (Attribute::TubeVoltage, value.decimal()),
        tags::CARDIAC_PHASE => (Attribute::CardiacPhase, value.double()),
        tags::TRIGGER_TIME => (Attribute::TriggerTime, value.decimal()),
        tags::CARDIAC_DELAY => (Attribute::TriggerTime, value.double()),
        tags::REFERENCE_TIME => (Attribute::ReferenceTime, value.decimal()),
        tags::ACQUISITION_NUMBER => (Attribute::Acquisition, value.decimal()),
        tags::FRAME_ACQUISITION_NUMBER => (Attribute::Acquisition, value.short().map(f64::from)),
        tags::ACQUISITION_TIME => (Attribute::AcquisitionTime, value.time_s()),
        tags::CONTENT_TIME => (Attribute::ContentTime, value.time_s()),
        tags::INSTANCE_NUMBER => (Attribute::Instance, value.decimal()),
        _ => return,
    };
    plane.taken.set(attribute, value);
}
