//! Context of a data element: the sequence in which it is nested, if its values are used.

use super::segments::MAX_SEGMENTS;
use super::tags::{self, DicomTag};

/// Maximum number of frames of a file that are distinguished.
pub(crate) const MAX_FRAMES: usize = 1 << 18;

/// Context of a data element within the nested sequences of a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ElementContext {
    TopLevel,
    /// Functional groups shared by all frames.
    Shared,
    /// Functional groups of one frame, by index.
    Frame(usize),
    /// Detector of nuclear medicine, whose sequence gives position and orientation of the images.
    Detector,
    /// Calibrated region of an ultrasound image, which gives its pixel spacing.
    Region,
    /// Description of one segment, by index.
    Segment(usize),
    /// Sequence without values of interest.
    Unused,
}

impl ElementContext {
    /// Returns the context inside a sequence; `None` if none of its values are used.
    pub(crate) fn in_sequence(self, sequence: DicomTag) -> Option<Self> {
        match (self, sequence) {
            (Self::TopLevel, tags::SHARED_GROUPS) => Some(Self::Shared),
            (Self::TopLevel, tags::FRAME_GROUPS) => Some(Self::Frame(0)),
            (Self::TopLevel, tags::DETECTORS) => Some(Self::Detector),
            (Self::TopLevel, tags::REGIONS) => Some(Self::Region),
            (Self::TopLevel, tags::SEGMENTS) => Some(Self::Segment(0)),
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

    /// Returns the context inside item `number` of a sequence, given the context inside the sequence.
    pub(crate) fn in_item(self, sequence: DicomTag, number: usize) -> Self {
        match (self, sequence) {
            (Self::Frame(_), tags::FRAME_GROUPS) if number >= MAX_FRAMES => Self::Unused,
            (Self::Frame(_), tags::FRAME_GROUPS) => Self::Frame(number),
            (Self::Segment(_), tags::SEGMENTS) if number >= MAX_SEGMENTS => Self::Unused,
            (Self::Segment(_), tags::SEGMENTS) => Self::Segment(number),
            // Of several detectors or regions only the first counts.
            (Self::Detector, tags::DETECTORS) | (Self::Region, tags::REGIONS) if number > 0 => Self::Unused,
            _ => self,
        }
    }
}
