//! Tags of the data elements that are read (PS3.6): group and element as one number.

/// Tag of a data element: group in the upper, element in the lower 16 bits.
pub(crate) type DicomTag = u32;

// Encoding of the file.
pub(crate) const TRANSFER_SYNTAX: DicomTag = 0x0002_0010;
pub(crate) const ITEM: DicomTag = 0xfffe_e000;
pub(crate) const ITEM_END: DicomTag = 0xfffe_e00d;
pub(crate) const SEQUENCE_END: DicomTag = 0xfffe_e0dd;

// Object and series identification.
pub(crate) const IMAGE_TYPE: DicomTag = 0x0008_0008;
pub(crate) const SOP_CLASS: DicomTag = 0x0008_0016;
pub(crate) const SOP_INSTANCE: DicomTag = 0x0008_0018;
pub(crate) const ACQUISITION_TIME: DicomTag = 0x0008_0032;
pub(crate) const CONTENT_TIME: DicomTag = 0x0008_0033;
pub(crate) const FRAME_TYPE: DicomTag = 0x0008_9007;
pub(crate) const MODALITY: DicomTag = 0x0008_0060;
pub(crate) const SERIES_DESCRIPTION: DicomTag = 0x0008_103e;
pub(crate) const PROTOCOL: DicomTag = 0x0018_1030;
pub(crate) const SERIES_INSTANCE_UID: DicomTag = 0x0020_000e;
pub(crate) const SERIES_NUMBER: DicomTag = 0x0020_0011;
pub(crate) const ACQUISITION_NUMBER: DicomTag = 0x0020_0012;
pub(crate) const INSTANCE_NUMBER: DicomTag = 0x0020_0013;
pub(crate) const DIRECTORY_RECORDS: DicomTag = 0x0004_1220;

// Acquisition attributes, which distinguish images at one position.
pub(crate) const ECHO_TIME: DicomTag = 0x0018_0081;
pub(crate) const ECHO_NUMBER: DicomTag = 0x0018_0086;
pub(crate) const TUBE_VOLTAGE: DicomTag = 0x0018_0060;
pub(crate) const INVERSION_TIME: DicomTag = 0x0018_0082;
pub(crate) const FLIP_ANGLE: DicomTag = 0x0018_1314;
pub(crate) const TRIGGER_TIME: DicomTag = 0x0018_1060;
pub(crate) const EFFECTIVE_ECHO_TIME: DicomTag = 0x0018_9082;
pub(crate) const B_VALUE: DicomTag = 0x0018_9087;
pub(crate) const TEMPORAL_POSITION: DicomTag = 0x0020_0100;
pub(crate) const TEMPORAL_POSITION_INDEX: DicomTag = 0x0020_9128;
pub(crate) const CARDIAC_DELAY: DicomTag = 0x0020_9153;
pub(crate) const FRAME_ACQUISITION_NUMBER: DicomTag = 0x0020_9156;
pub(crate) const CARDIAC_PHASE: DicomTag = 0x0020_9241;
pub(crate) const REFERENCE_TIME: DicomTag = 0x0054_1300;

// Position, orientation and spacing of images.
pub(crate) const SLICE_THICKNESS: DicomTag = 0x0018_0050;
pub(crate) const SPACING_BETWEEN_SLICES: DicomTag = 0x0018_0088;
pub(crate) const DETECTOR_SPACING: DicomTag = 0x0018_1164;
pub(crate) const NOMINAL_SPACING: DicomTag = 0x0018_2010;
pub(crate) const SLICE_LOCATIONS: DicomTag = 0x0018_2005;
pub(crate) const SLICE_LOCATION: DicomTag = 0x0020_1041;
pub(crate) const VOLUME_POSITION: DicomTag = 0x0020_9301;
pub(crate) const VOLUME_ORIENTATION: DicomTag = 0x0020_9302;
pub(crate) const FRAME_INCREMENT: DicomTag = 0x0028_0009;
pub(crate) const FRAME_TIME: DicomTag = 0x0018_1063;
pub(crate) const FRAME_TIMES: DicomTag = 0x0018_1065;
pub(crate) const REGION_UNITS_X: DicomTag = 0x0018_6024;
pub(crate) const REGION_UNITS_Y: DicomTag = 0x0018_6026;
pub(crate) const REGION_DELTA_X: DicomTag = 0x0018_602c;
pub(crate) const REGION_DELTA_Y: DicomTag = 0x0018_602e;
pub(crate) const SIEMENS_HEADER: DicomTag = 0x0029_1010;
pub(crate) const POSITION: DicomTag = 0x0020_0032;
pub(crate) const ORIENTATION: DicomTag = 0x0020_0037;
pub(crate) const PIXEL_SPACING: DicomTag = 0x0028_0030;
pub(crate) const FRAME_OFFSETS: DicomTag = 0x3004_000c;

// Storage of pixels.
pub(crate) const SAMPLES: DicomTag = 0x0028_0002;
pub(crate) const PHOTOMETRIC: DicomTag = 0x0028_0004;
pub(crate) const PLANAR: DicomTag = 0x0028_0006;
pub(crate) const FRAMES: DicomTag = 0x0028_0008;
pub(crate) const ROWS: DicomTag = 0x0028_0010;
pub(crate) const COLUMNS: DicomTag = 0x0028_0011;
pub(crate) const BITS_ALLOCATED: DicomTag = 0x0028_0100;
pub(crate) const BITS_STORED: DicomTag = 0x0028_0101;
pub(crate) const HIGH_BIT: DicomTag = 0x0028_0102;
pub(crate) const IS_SIGNED: DicomTag = 0x0028_0103;
pub(crate) const FRAME_STARTS: DicomTag = 0x7fe0_0001;
pub(crate) const FLOATS: DicomTag = 0x7fe0_0008;
pub(crate) const DOUBLES: DicomTag = 0x7fe0_0009;
pub(crate) const PIXELS: DicomTag = 0x7fe0_0010;

// Meaning of values.
pub(crate) const PADDING: DicomTag = 0x0028_0120;
pub(crate) const WINDOW_CENTER: DicomTag = 0x0028_1050;
pub(crate) const WINDOW_WIDTH: DicomTag = 0x0028_1051;
pub(crate) const INTERCEPT: DicomTag = 0x0028_1052;
pub(crate) const SLOPE: DicomTag = 0x0028_1053;
pub(crate) const RESCALE_TYPE: DicomTag = 0x0028_1054;
pub(crate) const MODALITY_LUT_SEQUENCE: DicomTag = 0x0028_3000;
pub(crate) const UNITS: DicomTag = 0x0054_1001;
pub(crate) const DOSE_UNITS: DicomTag = 0x3004_0002;
pub(crate) const DOSE_SCALING: DicomTag = 0x3004_000e;
pub(crate) const SEGMENTATION_TYPE: DicomTag = 0x0062_0001;
pub(crate) const SEGMENT_NUMBER: DicomTag = 0x0062_0004;
pub(crate) const SEGMENT_LABEL: DicomTag = 0x0062_0005;
pub(crate) const REFERENCED_SEGMENT: DicomTag = 0x0062_000b;
pub(crate) const SEGMENT_COLOR: DicomTag = 0x0062_000d;
pub(crate) const MAX_FRACTION: DicomTag = 0x0062_000e;

// Sequences that contain some of these elements.
pub(crate) const SHARED_GROUPS: DicomTag = 0x5200_9229;
pub(crate) const FRAME_GROUPS: DicomTag = 0x5200_9230;
pub(crate) const DETECTORS: DicomTag = 0x0054_0022;
pub(crate) const PLANE_POSITION: DicomTag = 0x0020_9113;
pub(crate) const PLANE_ORIENTATION: DicomTag = 0x0020_9116;
pub(crate) const VOLUME_PLANE_POSITION: DicomTag = 0x0020_930e;
pub(crate) const VOLUME_PLANE_ORIENTATION: DicomTag = 0x0020_930f;
pub(crate) const MR_FRAME_TYPE: DicomTag = 0x0018_9226;
pub(crate) const CT_FRAME_TYPE: DicomTag = 0x0018_9329;
pub(crate) const PET_FRAME_TYPE: DicomTag = 0x0018_9751;
pub(crate) const MR_TIMING: DicomTag = 0x0018_9112;
pub(crate) const REGIONS: DicomTag = 0x0018_6011;
pub(crate) const SEGMENTS: DicomTag = 0x0062_0002;
pub(crate) const SEGMENT_IDENTIFICATION: DicomTag = 0x0062_000a;
pub(crate) const PIXEL_MEASURES: DicomTag = 0x0028_9110;
pub(crate) const VALUE_TRANSFORMATION: DicomTag = 0x0028_9145;
pub(crate) const FRAME_WINDOW: DicomTag = 0x0028_9132;
pub(crate) const FRAME_CONTENT: DicomTag = 0x0020_9111;
pub(crate) const CARDIAC: DicomTag = 0x0018_9118;
pub(crate) const ECHO: DicomTag = 0x0018_9114;
pub(crate) const DIFFUSION: DicomTag = 0x0018_9117;

/// Formats a tag in the usual notation, `(GGGG,EEEE)`.
pub(crate) fn format_tag(tag: DicomTag) -> String {
    format!("({:04X},{:04X})", tag >> 16, tag & 0xffff)
}
