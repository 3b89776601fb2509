//! Values of a DICOM header that the reader uses.

use glam::DVec3;

use super::csa;
use super::place::{MOST_FRAMES, Place};
use super::plane::Plane;
use super::plane_elements::take_plane;
use super::segments::{MOST_SEGMENTS, Segment, SegmentationType};
use super::tags::{self, Tag};
use super::taken::Attribute;
use super::value::Value;
use crate::data::load::Endian;

/// Maximum number of distinct frame types in a file.
const MOST_FRAME_TYPES: usize = 256;

/// Private creator of Siemens' elements in an image header.
const SIEMENS: &str = "SIEMENS MR HEADER";

/// Values of a DICOM header that the reader uses, by element.
#[derive(Debug, Clone, Default)]
pub(in crate::data::load::formats::dicom) struct Found {
    pub(in crate::data::load::formats::dicom) sop_class: String,
    pub(in crate::data::load::formats::dicom) sop_instance: String,
    pub(in crate::data::load::formats::dicom) series: String,
    pub(in crate::data::load::formats::dicom) series_number: Option<f64>,
    pub(in crate::data::load::formats::dicom) series_description: String,
    pub(in crate::data::load::formats::dicom) protocol: String,
    pub(in crate::data::load::formats::dicom) modality: String,
    pub(in crate::data::load::formats::dicom) image_type: String,
    pub(in crate::data::load::formats::dicom) photometric: String,
    pub(in crate::data::load::formats::dicom) rescale_type: String,
    pub(in crate::data::load::formats::dicom) units: String,
    pub(in crate::data::load::formats::dicom) samples: Option<u16>,
    pub(in crate::data::load::formats::dicom) planar: Option<u16>,
    pub(in crate::data::load::formats::dicom) frame_count: Option<f64>,
    pub(in crate::data::load::formats::dicom) rows: Option<u16>,
    pub(in crate::data::load::formats::dicom) columns: Option<u16>,
    pub(in crate::data::load::formats::dicom) bits_allocated: Option<u16>,
    pub(in crate::data::load::formats::dicom) bits_stored: Option<u16>,
    pub(in crate::data::load::formats::dicom) high_bit: Option<u16>,
    pub(in crate::data::load::formats::dicom) is_signed: bool,
    /// Pixel Padding Value as stored; the pixel representation decides if it is signed.
    pub(in crate::data::load::formats::dicom) padding: Option<u16>,
    /// True if a lookup table maps stored values to meaningful ones.
    pub(in crate::data::load::formats::dicom) has_value_table: bool,
    /// True for a DICOMDIR, which lists other files.
    pub(in crate::data::load::formats::dicom) is_directory: bool,
    /// Extended Offset Table: offsets of the frames of compressed pixels, counted from behind the basic offset table.
    pub(in crate::data::load::formats::dicom) frame_starts: Vec<u64>,
    /// Offsets of the frames from the first along the normal, in millimetres.
    pub(in crate::data::load::formats::dicom) frame_offsets: Vec<f64>,
    /// Slice Location Vector: positions of the frames along a line, in millimetres.
    pub(crate) frame_locations_mm: Vec<f64>,
    /// True if the Frame Increment Pointer names a time, that is, frames follow each other in time.
    pub(crate) is_film: bool,
    /// Number of slices in a mosaic image, as Siemens scanners write them.
    pub(crate) mosaic_count: Option<f64>,
    /// Slice normal of a mosaic, from the first slice to the last; left-posterior-superior.
    pub(crate) mosaic_normal: Option<DVec3>,
    pub(crate) segmentation: Option<SegmentationType>,
    pub(crate) segments: Vec<Segment>,
    /// Value of a pixel that lies entirely in its segment.
    pub(crate) most_fraction: Option<u16>,
    /// Distinct frame types other than the file's image type.
    pub(crate) frame_types: Vec<String>,
    /// True if the private creator is Siemens, so that private elements have their known meaning.
    has_siemens_header: bool,
    /// Calibrated region of an ultrasound image: units (3 is centimetres) and spacing of columns and rows.
    region: Region,
    pub(in crate::data::load::formats::dicom) all: Plane,
    pub(in crate::data::load::formats::dicom) shared: Plane,
    pub(in crate::data::load::formats::dicom) frames: Vec<Plane>,
}

/// Pixel spacing in a calibrated region of an ultrasound image (PS3.3 section C.8.5.5).
#[derive(Debug, Clone, Copy, Default)]
struct Region {
    units: [Option<u16>; 2],
    delta: [Option<f64>; 2],
}

impl Region {
    /// Returns the spacing between rows and between columns, in millimetres; `None` if an axis measures something
    /// else.
    fn spacing_mm(&self) -> Option<[f64; 2]> {
        /// Code of centimetres in Physical Units X Direction.
        const CENTIMETRES: Option<u16> = Some(3);
        let [Some(x), Some(y)] = self.delta else { return None };
        (self.units == [CENTIMETRES; 2] && x != 0.0 && y != 0.0).then(|| [y.abs() * 10.0, x.abs() * 10.0])
    }
}

impl Found {
    /// Returns true if the value of an element in this context is used.
    pub(in crate::data::load::formats::dicom) fn wants(place: Place, tag: Tag) -> bool {
        match place {
            Place::Elsewhere => false,
            Place::Top => {
                matches!(tag >> 16, 0x0008 | 0x0018 | 0x0019 | 0x0020 | 0x0028 | 0x0054 | 0x0062 | 0x3004)
                    || matches!(tag, tags::FRAME_STARTS | tags::SIEMENS_HEADER)
            }
            _ => matches!(tag >> 16, 0x0008 | 0x0018 | 0x0020 | 0x0028 | 0x0062),
        }
    }

    /// Records that a sequence occurs.
    pub(in crate::data::load::formats::dicom) fn pass(&mut self, place: Place, sequence: Tag) {
        match (place, sequence) {
            (Place::Top, tags::VALUE_TABLE) => self.has_value_table = true,
            (Place::Top, tags::DIRECTORY_RECORDS) => self.is_directory = true,
            _ => {}
        }
    }

    /// Stores the value of an element, depending on its context.
    pub(in crate::data::load::formats::dicom) fn take(
        &mut self,
        place: Place,
        tag: Tag,
        bytes: &[u8],
        endian: Endian,
    ) {
        let value = Value { bytes, endian };
        // Stated for the file, for all frames or for each frame: units are never mixed in practice.
        if tag == tags::RESCALE_TYPE && self.rescale_type.is_empty() {
            self.rescale_type = value.text();
        }
        let plane = match place {
            Place::Top => {
                self.take_top(tag, value);
                Some(&mut self.all)
            }
            Place::Detector if matches!(tag, tags::POSITION | tags::ORIENTATION) => Some(&mut self.all),
            Place::Detector | Place::Elsewhere => None,
            Place::Region => {
                self.take_region(tag, value);
                None
            }
            Place::Segment(number) => {
                self.take_segment(number, tag, value);
                None
            }
            Place::Shared => Some(&mut self.shared),
            Place::Frame(number) => {
                if number >= self.frames.len() && number < MOST_FRAMES {
                    self.frames.resize(number + 1, Plane::default());
                }
                self.frames.get_mut(number)
            }
        };
        let Some(plane) = plane else { return };
        if tag == tags::FRAME_TYPE {
            let text = value.text();
            let known = self.frame_types.iter().position(|known| *known == text);
            let at = known.unwrap_or(self.frame_types.len());
            if known.is_none() && at < MOST_FRAME_TYPES {
                self.frame_types.push(text);
            }
            plane.taken.set(Attribute::ImageType, Some(at as f64));
        } else {
            take_plane(plane, tag, value);
        }
    }

    fn take_region(&mut self, tag: Tag, value: Value<'_>) {
        match tag {
            tags::REGION_UNITS_X => self.region.units[0] = value.short(),
            tags::REGION_UNITS_Y => self.region.units[1] = value.short(),
            tags::REGION_DELTA_X => self.region.delta[0] = value.double(),
            tags::REGION_DELTA_Y => self.region.delta[1] = value.double(),
            _ => {}
        }
    }

    fn take_segment(&mut self, number: usize, tag: Tag, value: Value<'_>) {
        if number >= self.segments.len() && number < MOST_SEGMENTS {
            self.segments.resize(number + 1, Segment::default());
        }
        let Some(segment) = self.segments.get_mut(number) else { return };
        match tag {
            tags::SEGMENT_NUMBER => segment.number = value.short(),
            tags::SEGMENT_LABEL => segment.label = value.text(),
            tags::SEGMENT_COLOR => segment.color = value.shorts_of(),
            _ => {}
        }
    }

    /// Stores the values of Siemens' private elements: mosaic and b-value.
    fn take_siemens(&mut self, tag: Tag, value: Value<'_>) {
        match tag {
            tags::SIEMENS_CREATOR => self.has_siemens_header = value.text() == SIEMENS,
            tags::MOSAIC_COUNT if self.has_siemens_header => {
                self.mosaic_count = value.short().map(f64::from);
            }
            tags::SIEMENS_B_VALUE if self.has_siemens_header => {
                self.all.taken.set(Attribute::BValue, value.decimal());
            }
            tags::SIEMENS_HEADER => {
                let count =
                    csa::numbers(value.bytes, "NumberOfImagesInMosaic").map(|[count]: [f64; 1]| count);
                self.mosaic_count = self.mosaic_count.or(count);
                self.mosaic_normal = csa::numbers(value.bytes, "SliceNormalVector").map(DVec3::from_array);
            }
            _ => {}
        }
    }

    fn take_top(&mut self, tag: Tag, value: Value<'_>) {
        match tag {
            tags::SOP_CLASS => self.sop_class = value.text(),
            tags::SOP_INSTANCE => self.sop_instance = value.text(),
            tags::SERIES => self.series = value.text(),
            tags::SERIES_NUMBER => self.series_number = value.decimal(),
            tags::SERIES_DESCRIPTION => self.series_description = value.text(),
            tags::PROTOCOL => self.protocol = value.text(),
            tags::MODALITY => self.modality = value.text(),
            tags::IMAGE_TYPE => self.image_type = value.text(),
            tags::PHOTOMETRIC => self.photometric = value.text(),
            tags::UNITS | tags::DOSE_UNITS => self.units = value.text(),
            tags::SAMPLES => self.samples = value.short(),
            tags::PLANAR => self.planar = value.short(),
            tags::FRAMES => self.frame_count = value.decimal(),
            tags::ROWS => self.rows = value.short(),
            tags::COLUMNS => self.columns = value.short(),
            tags::BITS_ALLOCATED => self.bits_allocated = value.short(),
            tags::BITS_STORED => self.bits_stored = value.short(),
            tags::HIGH_BIT => self.high_bit = value.short(),
            tags::IS_SIGNED => self.is_signed = value.short() == Some(1),
            tags::PADDING => self.padding = value.short(),
            tags::DOSE_SCALING => self.all.slope = value.decimal(),
            tags::FRAME_OFFSETS => self.frame_offsets = value.decimals(MOST_FRAMES),
            tags::FRAME_STARTS => self.frame_starts = value.longs(MOST_FRAMES),
            tags::SLICE_LOCATIONS => self.frame_locations_mm = value.decimals(MOST_FRAMES),
            tags::FRAME_INCREMENT => {
                self.is_film = matches!(value.tag(), Some(tags::FRAME_TIME | tags::FRAME_TIMES));
            }
            tags::SEGMENTATION_TYPE => self.segmentation = SegmentationType::parse(&value.text()),
            tags::MOST_FRACTION => self.most_fraction = value.short(),
            _ => self.take_siemens(tag, value),
        }
    }

    /// Returns the image type of a frame, or else of the file.
    pub(crate) fn image_type(&self, frame: usize) -> &str {
        let own = self.frames.get(frame).and_then(|plane| plane.taken.get(Attribute::ImageType));
        let said = own.or(self.shared.taken.get(Attribute::ImageType));
        said.and_then(|at| self.frame_types.get(at as usize)).unwrap_or(&self.image_type)
    }

    /// Returns the plane of a frame, with values shared by all frames filled in.
    pub(in crate::data::load::formats::dicom) fn plane(&self, frame: usize) -> Plane {
        let of_frame = self.frames.get(frame).copied().unwrap_or_default();
        let mut plane = of_frame.or(&self.shared).or(&self.all);
        plane.has_own_position =
            of_frame.position.is_some() || self.frame_count.is_none_or(|count| count <= 1.0);
        plane.is_of_film = self.is_film;
        plane.location_mm = self.frame_locations_mm.get(frame).copied().or(plane.location_mm);
        if plane.spacing.is_none() {
            plane.spacing = self.region.spacing_mm();
            plane.spacing_source = plane.spacing.map(|_| "its calibrated region");
        }
        if let (Some(position), Some(normal)) = (plane.position, plane.normal())
            && let (Some(offset), Some(first)) = (self.frame_offsets.get(frame), self.frame_offsets.first())
        {
            plane.position = Some(position + normal * (offset - first));
        }
        plane
    }
}
