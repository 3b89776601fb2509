//! Where in a data set an element lies, as far as that matters.

use super::segments::MOST_SEGMENTS;
use super::tags::{self, Tag};

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
    /// A region of a picture of ultrasound, which says how far apart its pixels are.
    Region,
    /// What is said of a segment.
    Segment(usize),
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
            (Self::Top, tags::REGIONS) => Some(Self::Region),
            (Self::Top, tags::SEGMENTS) => Some(Self::Segment(0)),
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
                | tags::DIFFUSION
                | tags::MR_FRAME_TYPE
                | tags::CT_FRAME_TYPE
                | tags::PET_FRAME_TYPE
                | tags::MR_TIMING
                | tags::VOLUME_PLANE_POSITION
                | tags::VOLUME_PLANE_ORIENTATION
                | tags::SEGMENT_IDENTIFICATION,
            ) => Some(self),
            _ => None,
        }
    }

    /// The place inside an item of a sequence that this is the place inside of.
    pub(in crate::data::load::formats::dicom) fn item(self, sequence: Tag, number: usize) -> Self {
        match (self, sequence) {
            (Self::Frame(_), tags::FRAME_GROUPS) if number >= MOST_FRAMES => Self::Elsewhere,
            (Self::Frame(_), tags::FRAME_GROUPS) => Self::Frame(number),
            (Self::Segment(_), tags::SEGMENTS) if number >= MOST_SEGMENTS => Self::Elsewhere,
            (Self::Segment(_), tags::SEGMENTS) => Self::Segment(number),
            // Several detectors, or regions: the first counts.
            (Self::Detector, tags::DETECTORS) | (Self::Region, tags::REGIONS) if number > 0 => {
                Self::Elsewhere
            }
            _ => self,
        }
    }
}
