//! Values of a DICOM header that the reader uses.

use glam::DVec3;

use super::acquisition_attributes::AcquisitionAttribute;
use super::csa;
use super::element_context::{ElementContext, MAX_FRAMES};
use super::element_value::ElementValue;
use super::image_plane::ImagePlane;
use super::plane_elements::store_plane_element;
use super::private_elements::{PrivateBlocks, PrivateElement, b_value};
use super::segments::{DicomSegment, MAX_SEGMENTS, SegmentationType};
use super::tags::{self, DicomTag};
use crate::Endian;

/// Maximum number of distinct frame types in a file.
const MAX_FRAME_TYPES: usize = 256;

/// Values of a DICOM header that the reader uses, by element.
#[derive(Debug, Clone, Default)]
pub(crate) struct DicomValues {
    pub(crate) sop_class: String,
    pub(crate) sop_instance: String,
    pub(crate) series_uid: String,
    pub(crate) series_number: Option<f64>,
    pub(crate) series_description: String,
    pub(crate) protocol: String,
    pub(crate) modality: String,
    pub(crate) image_type: String,
    pub(crate) photometric: String,
    pub(crate) rescale_type: String,
    pub(crate) units: String,
    pub(crate) samples: Option<u16>,
    pub(crate) planar: Option<u16>,
    pub(crate) frame_count: Option<f64>,
    pub(crate) rows: Option<u16>,
    pub(crate) columns: Option<u16>,
    pub(crate) bits_allocated: Option<u16>,
    pub(crate) bits_stored: Option<u16>,
    pub(crate) high_bit: Option<u16>,
    pub(crate) is_signed: bool,
    /// Pixel Padding Value as stored; the pixel representation decides if it is signed.
    pub(crate) padding: Option<u16>,
    /// True if a lookup table maps stored values to meaningful ones.
    pub(crate) has_value_table: bool,
    /// True for a DICOMDIR, which lists other files.
    pub(crate) is_directory: bool,
    /// Extended Offset Table: offsets of the frames of compressed pixels, counted from behind the basic offset table.
    pub(crate) frame_starts: Vec<u64>,
    /// Offsets of the frames from the first along the normal, in millimetres.
    pub(crate) frame_offsets: Vec<f64>,
    /// Slice Location Vector: positions of the frames along a line, in millimetres.
    pub(crate) frame_locations_mm: Vec<f64>,
    /// True if the Frame Increment Pointer names a time, that is, frames follow each other in time.
    pub(crate) is_cine: bool,
    /// Number of slices in a mosaic image, as Siemens scanners write them.
    pub(crate) mosaic_count: Option<f64>,
    /// Slice normal of a mosaic, from the first slice to the last; left-posterior-superior.
    pub(crate) mosaic_normal: Option<DVec3>,
    pub(crate) segmentation: Option<SegmentationType>,
    pub(crate) segments: Vec<DicomSegment>,
    /// Value of a pixel that lies entirely in its segment.
    pub(crate) max_fraction: Option<u16>,
    /// Distinct frame types other than the file's image type.
    pub(crate) frame_types: Vec<String>,
    /// Blocks of private elements, by their creators.
    private_blocks: PrivateBlocks,
    /// Calibrated region of an ultrasound image: units (3 is centimetres) and spacing of columns and rows.
    region: UltrasoundRegion,
    pub(crate) file_plane: ImagePlane,
    pub(crate) shared_plane: ImagePlane,
    pub(crate) frame_planes: Vec<ImagePlane>,
}

/// Pixel spacing in a calibrated region of an ultrasound image (PS3.3 section C.8.5.5).
#[derive(Debug, Clone, Copy, Default)]
struct UltrasoundRegion {
    units: [Option<u16>; 2],
    delta: [Option<f64>; 2],
}

impl UltrasoundRegion {
    /// Returns the spacing between rows and between columns, in millimetres; `None` if an axis measures something
    /// else.
    fn spacing_mm(&self) -> Option<[f64; 2]> {
        /// Code of centimetres in Physical Units X Direction.
        const CENTIMETRES: Option<u16> = Some(3);
        let [Some(x), Some(y)] = self.delta else { return None };
        (self.units == [CENTIMETRES; 2] && x != 0.0 && y != 0.0).then(|| [y.abs() * 10.0, x.abs() * 10.0])
    }
}

impl DicomValues {
    /// Returns true if the value of an element in this context is used.
    pub(crate) fn uses(place: ElementContext, tag: DicomTag) -> bool {
        match place {
            ElementContext::Unused => false,
            ElementContext::TopLevel => {
                matches!(tag >> 16, 0x0008 | 0x0018 | 0x0020 | 0x0028 | 0x0054 | 0x0062 | 0x3004)
                    || matches!(tag, tags::FRAME_STARTS | tags::SIEMENS_HEADER)
                    || PrivateBlocks::uses(tag)
            }
            _ => matches!(tag >> 16, 0x0008 | 0x0018 | 0x0020 | 0x0028 | 0x0062),
        }
    }

    /// Records that a sequence occurs.
    pub(crate) fn note_sequence(&mut self, place: ElementContext, sequence: DicomTag) {
        match (place, sequence) {
            (ElementContext::TopLevel, tags::MODALITY_LUT_SEQUENCE) => self.has_value_table = true,
            (ElementContext::TopLevel, tags::DIRECTORY_RECORDS) => self.is_directory = true,
            _ => {}
        }
    }

    /// Stores the value of an element, depending on its context.
    pub(crate) fn store(&mut self, place: ElementContext, tag: DicomTag, bytes: &[u8], endian: Endian) {
        let value = ElementValue { bytes, endian };
        // Stated for the file, for all frames or for each frame: units are never mixed in practice.
        if tag == tags::RESCALE_TYPE && self.rescale_type.is_empty() {
            self.rescale_type = value.text();
        }
        let plane = match place {
            ElementContext::TopLevel => {
                self.store_top_level(tag, value);
                Some(&mut self.file_plane)
            }
            ElementContext::Detector if matches!(tag, tags::POSITION | tags::ORIENTATION) => {
                Some(&mut self.file_plane)
            }
            ElementContext::Detector | ElementContext::Unused => None,
            ElementContext::Region => {
                self.store_region(tag, value);
                None
            }
            ElementContext::Segment(number) => {
                self.store_segment(number, tag, value);
                None
            }
            ElementContext::Shared => Some(&mut self.shared_plane),
            ElementContext::Frame(number) => {
                if number >= self.frame_planes.len() && number < MAX_FRAMES {
                    self.frame_planes.resize(number + 1, ImagePlane::default());
                }
                self.frame_planes.get_mut(number)
            }
        };
        let Some(plane) = plane else { return };
        if tag == tags::FRAME_TYPE {
            let text = value.text();
            let known_index = self.frame_types.iter().position(|known| *known == text);
            let at = known_index.unwrap_or(self.frame_types.len());
            if known_index.is_none() && at < MAX_FRAME_TYPES {
                self.frame_types.push(text);
            }
            plane.attributes.set(AcquisitionAttribute::ImageType, Some(at as f64));
        } else {
            store_plane_element(plane, tag, value);
        }
    }

    fn store_region(&mut self, tag: DicomTag, value: ElementValue<'_>) {
        match tag {
            tags::REGION_UNITS_X => self.region.units[0] = value.u16(),
            tags::REGION_UNITS_Y => self.region.units[1] = value.u16(),
            tags::REGION_DELTA_X => self.region.delta[0] = value.f64(),
            tags::REGION_DELTA_Y => self.region.delta[1] = value.f64(),
            _ => {}
        }
    }

    fn store_segment(&mut self, number: usize, tag: DicomTag, value: ElementValue<'_>) {
        if number >= self.segments.len() && number < MAX_SEGMENTS {
            self.segments.resize(number + 1, DicomSegment::default());
        }
        let Some(segment) = self.segments.get_mut(number) else { return };
        match tag {
            tags::SEGMENT_NUMBER => segment.number = value.u16(),
            tags::SEGMENT_LABEL => segment.label = value.text(),
            tags::SEGMENT_COLOR => segment.color = value.u16_array(),
            _ => {}
        }
    }

    /// Stores the values of manufacturers' private elements: mosaics and b-values.
    fn store_private(&mut self, tag: DicomTag, value: ElementValue<'_>) {
        if tag == tags::SIEMENS_HEADER {
            let count =
                csa::csa_numbers(value.bytes, "NumberOfImagesInMosaic").map(|[count]: [f64; 1]| count);
            self.mosaic_count = self.mosaic_count.or(count);
            self.mosaic_normal = csa::csa_numbers(value.bytes, "SliceNormalVector").map(DVec3::from_array);
            return;
        }
        self.private_blocks.record_creator(tag, value);
        match self.private_blocks.element(tag) {
            None => {}
            Some(PrivateElement::SiemensMosaicCount) => self.mosaic_count = value.u16().map(f64::from),
            Some(element) => {
                let attributes = &mut self.file_plane.attributes;
                // The standard's element comes first in the file, and counts.
                if attributes.get(AcquisitionAttribute::BValue).is_none() {
                    attributes.set(AcquisitionAttribute::BValue, b_value(element, value));
                }
            }
        }
    }

    fn store_top_level(&mut self, tag: DicomTag, value: ElementValue<'_>) {
        match tag {
            tags::SOP_CLASS => self.sop_class = value.text(),
            tags::SOP_INSTANCE => self.sop_instance = value.text(),
            tags::SERIES_INSTANCE_UID => self.series_uid = value.text(),
            tags::SERIES_NUMBER => self.series_number = value.decimal(),
            tags::SERIES_DESCRIPTION => self.series_description = value.text(),
            tags::PROTOCOL => self.protocol = value.text(),
            tags::MODALITY => self.modality = value.text(),
            tags::IMAGE_TYPE => self.image_type = value.text(),
            tags::PHOTOMETRIC => self.photometric = value.text(),
            tags::UNITS | tags::DOSE_UNITS => self.units = value.text(),
            tags::SAMPLES => self.samples = value.u16(),
            tags::PLANAR => self.planar = value.u16(),
            tags::FRAMES => self.frame_count = value.decimal(),
            tags::ROWS => self.rows = value.u16(),
            tags::COLUMNS => self.columns = value.u16(),
            tags::BITS_ALLOCATED => self.bits_allocated = value.u16(),
            tags::BITS_STORED => self.bits_stored = value.u16(),
            tags::HIGH_BIT => self.high_bit = value.u16(),
            tags::IS_SIGNED => self.is_signed = value.u16() == Some(1),
            tags::PADDING => self.padding = value.u16(),
            tags::DOSE_SCALING => self.file_plane.slope = value.decimal(),
            tags::FRAME_OFFSETS => self.frame_offsets = value.decimals(MAX_FRAMES),
            tags::FRAME_STARTS => self.frame_starts = value.u64s(MAX_FRAMES),
            tags::SLICE_LOCATIONS => self.frame_locations_mm = value.decimals(MAX_FRAMES),
            tags::FRAME_INCREMENT => {
                self.is_cine = matches!(value.tag(), Some(tags::FRAME_TIME | tags::FRAME_TIMES));
            }
            tags::SEGMENTATION_TYPE => self.segmentation = SegmentationType::parse(&value.text()),
            tags::MAX_FRACTION => self.max_fraction = value.u16(),
            _ => self.store_private(tag, value),
        }
    }

    /// Returns the image type of a frame, or else of the file.
    pub(crate) fn image_type(&self, frame: usize) -> &str {
        let own = self
            .frame_planes
            .get(frame)
            .and_then(|plane| plane.attributes.get(AcquisitionAttribute::ImageType));
        let said = own.or(self.shared_plane.attributes.get(AcquisitionAttribute::ImageType));
        said.and_then(|at| self.frame_types.get(at as usize)).unwrap_or(&self.image_type)
    }

    /// Returns the plane of a frame, with values shared by all frames filled in.
    pub(crate) fn plane(&self, frame: usize) -> ImagePlane {
        let of_frame = self.frame_planes.get(frame).copied().unwrap_or_default();
        let mut plane = of_frame.with_defaults(&self.shared_plane).with_defaults(&self.file_plane);
        plane.has_own_position =
            of_frame.position.is_some() || self.frame_count.is_none_or(|count| count <= 1.0);
        plane.is_cine = self.is_cine;
        plane.location_mm = self.frame_locations_mm.get(frame).copied().or(plane.location_mm);
        if plane.spacing.is_none() {
            plane.spacing = self.region.spacing_mm();
            plane.spacing_source = plane.spacing.map(|_| "the calibrated ultrasound region");
        }
        if let (Some(position), Some(normal)) = (plane.position, plane.normal())
            && let (Some(offset), Some(first)) = (self.frame_offsets.get(frame), self.frame_offsets.first())
        {
            plane.position = Some(position + normal * (offset - first));
        }
        plane
    }
}
