//! What is kept of a header.

use glam::DVec3;

use super::plane::Plane;
use super::tags::{self, Tag};
use super::value::Value;
use crate::data::load::Endian;

/// Most frames of a file that are told apart.
pub(in crate::data::load::formats::dicom) const MOST_FRAMES: usize = 1 << 18;

/// Where in a data set an element lies, as far as that matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) enum Place {
    Top,
    /// What is said of all frames.
    Shared,
    /// What is said of a frame.
    Frame(usize),
    /// A detector of nuclear medicine, which says where the pictures lie.
    Detector,
    /// Where nothing is wanted.
    Elsewhere,
}

impl Place {
    /// The place inside a sequence; `None` where nothing in it is wanted.
    pub(in crate::data::load::formats::dicom) fn inside(self, sequence: Tag) -> Option<Self> {
        match (self, sequence) {
            (Self::Top, tags::SHARED_GROUPS) => Some(Self::Shared),
            (Self::Top, tags::FRAME_GROUPS) => Some(Self::Frame(0)),
            (Self::Top, tags::DETECTORS) => Some(Self::Detector),
            (
                Self::Shared | Self::Frame(_),
                tags::PLANE_POSITION
                | tags::PLANE_ORIENTATION
                | tags::PIXEL_MEASURES
                | tags::VALUE_TRANSFORMATION
                | tags::FRAME_WINDOW
                | tags::FRAME_CONTENT
                | tags::CARDIAC
                | tags::ECHO
                | tags::DIFFUSION,
            ) => Some(self),
            _ => None,
        }
    }

    /// The place inside an item of a sequence that this is the place inside of.
    pub(in crate::data::load::formats::dicom) fn item(self, sequence: Tag, number: usize) -> Self {
        match (self, sequence) {
            (Self::Frame(_), tags::FRAME_GROUPS) if number >= MOST_FRAMES => Self::Elsewhere,
            (Self::Frame(_), tags::FRAME_GROUPS) => Self::Frame(number),
            // Several detectors: the first counts.
            (Self::Detector, tags::DETECTORS) if number > 0 => Self::Elsewhere,
            _ => self,
        }
    }
}

/// What is kept of a header.
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
    /// As it is stored: the representation of the pixels says whether it has a sign.
    pub(in crate::data::load::formats::dicom) padding: Option<u16>,
    /// Values go through a table before they mean anything.
    pub(in crate::data::load::formats::dicom) has_value_table: bool,
    /// It lists other files.
    pub(in crate::data::load::formats::dicom) is_directory: bool,
    /// Where the frames of compressed pixels begin, after the table before them.
    pub(in crate::data::load::formats::dicom) frame_starts: Vec<u64>,
    /// How far from the first frames lie, across.
    pub(in crate::data::load::formats::dicom) frame_offsets: Vec<f64>,
    pub(in crate::data::load::formats::dicom) all: Plane,
    pub(in crate::data::load::formats::dicom) shared: Plane,
    pub(in crate::data::load::formats::dicom) frames: Vec<Plane>,
}

impl Found {
    /// Whether an element's value is kept.
    pub(in crate::data::load::formats::dicom) fn wants(place: Place, tag: Tag) -> bool {
        match place {
            Place::Elsewhere => false,
            Place::Top => {
                matches!(tag >> 16, 0x0008 | 0x0018 | 0x0020 | 0x0028 | 0x0054 | 0x3004)
                    || tag == tags::FRAME_STARTS
            }
            _ => matches!(tag >> 16, 0x0018 | 0x0020 | 0x0028),
        }
    }

    /// Takes notice of a sequence.
    pub(in crate::data::load::formats::dicom) fn pass(&mut self, place: Place, sequence: Tag) {
        match (place, sequence) {
            (Place::Top, tags::VALUE_TABLE) => self.has_value_table = true,
            (Place::Top, tags::DIRECTORY_RECORDS) => self.is_directory = true,
            _ => {}
        }
    }

    /// Keeps a value.
    pub(in crate::data::load::formats::dicom) fn take(
        &mut self,
        place: Place,
        tag: Tag,
        bytes: &[u8],
        endian: Endian,
    ) {
        let value = Value { bytes, endian };
        // Said of all, of all frames or of each: nobody mixes units.
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
            Place::Shared => Some(&mut self.shared),
            Place::Frame(number) => {
                if number >= self.frames.len() && number < MOST_FRAMES {
                    self.frames.resize(number + 1, Plane::default());
                }
                self.frames.get_mut(number)
            }
        };
        if let Some(plane) = plane {
            take_plane(plane, tag, value);
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
            _ => {}
        }
    }

    /// What is said of a frame.
    pub(in crate::data::load::formats::dicom) fn plane(&self, frame: usize) -> Plane {
        let of_frame = self.frames.get(frame).copied().unwrap_or_default();
        let mut plane = of_frame.or(&self.shared).or(&self.all);
        plane.has_own_position =
            of_frame.position.is_some() || self.frame_count.is_none_or(|count| count <= 1.0);
        if let (Some(position), Some(normal)) = (plane.position, plane.normal())
            && let (Some(offset), Some(first)) = (self.frame_offsets.get(frame), self.frame_offsets.first())
        {
            plane.position = Some(position + normal * (offset - first));
        }
        plane
    }
}

/// Keeps what is said of a picture.
fn take_plane(plane: &mut Plane, tag: Tag, value: Value<'_>) {
    match tag {
        tags::POSITION => plane.position = value.decimals_of().map(DVec3::from_array),
        tags::ORIENTATION => {
            let cosines: Option<[f64; 6]> = value.decimals_of();
            plane.orientation = cosines.map(|[a, b, c, d, e, f]| [DVec3::new(a, b, c), DVec3::new(d, e, f)]);
        }
        tags::PIXEL_SPACING => plane.spacing = value.decimals_of().or(plane.spacing),
        // At the detector, where the body is not: better than nothing.
        tags::DETECTOR_SPACING => plane.spacing = plane.spacing.or_else(|| value.decimals_of()),
        tags::SLICE_THICKNESS => plane.thickness = value.decimal(),
        tags::SPACING_BETWEEN => plane.between = value.decimal(),
        tags::SLOPE => plane.slope = value.decimal(),
        tags::INTERCEPT => plane.intercept = value.decimal(),
        tags::WINDOW_CENTER => plane.window[0] = value.decimal(),
        tags::WINDOW_WIDTH => plane.window[1] = value.decimal(),
        tags::TEMPORAL_POSITION => plane.taken.temporal_position = value.decimal(),
        tags::TEMPORAL_POSITION_INDEX => plane.taken.temporal_position = value.long().map(f64::from),
        tags::B_VALUE => plane.taken.b_value = value.double(),
        tags::ECHO_TIME => plane.taken.echo_time_ms = value.decimal(),
        tags::EFFECTIVE_ECHO_TIME => plane.taken.echo_time_ms = value.double(),
        tags::TRIGGER_TIME => plane.taken.trigger_time_ms = value.decimal(),
        tags::CARDIAC_DELAY => plane.taken.trigger_time_ms = value.double(),
        tags::ACQUISITION_NUMBER => plane.taken.acquisition = value.decimal(),
        tags::ACQUISITION_TIME => plane.taken.time_s = value.time_s(),
        tags::INSTANCE_NUMBER => plane.taken.instance = value.decimal(),
        _ => {}
    }
}
