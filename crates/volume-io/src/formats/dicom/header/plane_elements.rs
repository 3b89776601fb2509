//! Data elements of an image plane: position, acquisition attributes and value scale.

use glam::DVec3;

use super::acquisition_attributes::AcquisitionAttribute;
use super::element_value::ElementValue;
use super::image_plane::ImagePlane;
use super::tags::{self, DicomTag};

/// Stores the value of an element that describes one image.
pub(super) fn store_plane_element(plane: &mut ImagePlane, tag: DicomTag, value: ElementValue<'_>) {
    match tag {
        tags::POSITION => plane.position = value.decimal_array().map(DVec3::from_array),
        tags::ORIENTATION => {
            plane.orientation = value.decimal_array().map(split_cosines);
        }
        tags::PIXEL_SPACING => {
            if let Some(spacing) = value.decimal_array() {
                (plane.spacing, plane.spacing_source) = (Some(spacing), None);
            }
        }
        // Spacing at the detector, not at the body: a fallback.
        tags::DETECTOR_SPACING if plane.spacing.is_none() => {
            plane.spacing = value.decimal_array();
            plane.spacing_source = Some("Imager Pixel Spacing");
        }
        tags::NOMINAL_SPACING if plane.spacing.is_none() => {
            plane.spacing = value.decimal_array();
            plane.spacing_source = Some("Nominal Scanned Pixel Spacing");
        }
        tags::SLICE_THICKNESS => plane.thickness_mm = value.decimal(),
        tags::SPACING_BETWEEN_SLICES => plane.slice_spacing_mm = value.decimal(),
        tags::SLOPE => plane.slope = value.decimal(),
        tags::INTERCEPT => plane.intercept = value.decimal(),
        tags::WINDOW_CENTER => plane.window[0] = value.decimal(),
        tags::WINDOW_WIDTH => plane.window[1] = value.decimal(),
        tags::SLICE_LOCATION => plane.location_mm = value.decimal(),
        tags::VOLUME_POSITION => {
            plane.position = value.f64_array().map(DVec3::from_array);
            plane.is_in_volume_frame = true;
        }
        tags::VOLUME_ORIENTATION => {
            plane.orientation = value.f64_array().map(split_cosines);
            plane.is_in_volume_frame = true;
        }
        tags::REFERENCED_SEGMENT => plane.segment = value.u16(),
        _ => store_attribute(plane, tag, value),
    }
}

/// Splits six direction cosines into the directions along rows and along columns.
fn split_cosines([a, b, c, d, e, f]: [f64; 6]) -> [DVec3; 2] {
    [DVec3::new(a, b, c), DVec3::new(d, e, f)]
}

/// Stores the value of an acquisition attribute, if the element is one.
fn store_attribute(plane: &mut ImagePlane, tag: DicomTag, value: ElementValue<'_>) {
    let (attribute, value) = match tag {
        tags::TEMPORAL_POSITION => (AcquisitionAttribute::TemporalPosition, value.decimal()),
        tags::TEMPORAL_POSITION_INDEX => (AcquisitionAttribute::TemporalPosition, value.u32().map(f64::from)),
        tags::B_VALUE => (AcquisitionAttribute::BValue, value.f64()),
        tags::ECHO_TIME => (AcquisitionAttribute::EchoTime, value.decimal()),
        tags::EFFECTIVE_ECHO_TIME => (AcquisitionAttribute::EchoTime, value.f64()),
        tags::ECHO_NUMBER => (AcquisitionAttribute::EchoNumber, value.decimal()),
        tags::INVERSION_TIME => (AcquisitionAttribute::InversionTime, value.decimal()),
        tags::FLIP_ANGLE => (AcquisitionAttribute::FlipAngle, value.decimal()),
        tags::TUBE_VOLTAGE => (AcquisitionAttribute::TubeVoltage, value.decimal()),
        tags::CARDIAC_PHASE => (AcquisitionAttribute::CardiacPhase, value.f64()),
        tags::TRIGGER_TIME => (AcquisitionAttribute::TriggerTime, value.decimal()),
        tags::CARDIAC_DELAY => (AcquisitionAttribute::TriggerTime, value.f64()),
        tags::REFERENCE_TIME => (AcquisitionAttribute::ReferenceTime, value.decimal()),
        tags::ACQUISITION_NUMBER => (AcquisitionAttribute::Acquisition, value.decimal()),
        tags::FRAME_ACQUISITION_NUMBER => (AcquisitionAttribute::Acquisition, value.u16().map(f64::from)),
        tags::ACQUISITION_TIME => (AcquisitionAttribute::AcquisitionTime, value.time_s()),
        tags::CONTENT_TIME => (AcquisitionAttribute::ContentTime, value.time_s()),
        tags::INSTANCE_NUMBER => (AcquisitionAttribute::Instance, value.decimal()),
        _ => return,
    };
    plane.attributes.set(attribute, value);
}
