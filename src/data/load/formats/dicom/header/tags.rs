//! Tags of the data elements that are read (PS3.6): group and element as one number.

/// Tag of a data element: group in the upper, element in the lower 16 bits.
pub(in crate::data::load::formats::dicom) type Tag = u32;

// Encoding of the file.
pub(in crate::data::load::formats::dicom) const TRANSFER_SYNTAX: Tag = 0x0002_0010;
pub(in crate::data::load::formats::dicom) const ITEM: Tag = 0xfffe_e000;
pub(in crate::data::load::formats::dicom) const ITEM_END: Tag = 0xfffe_e00d;
pub(in crate::data::load::formats::dicom) const SEQUENCE_END: Tag = 0xfffe_e0dd;

// Object and series identification.
pub(in crate::data::load::formats::dicom) const IMAGE_TYPE: Tag = 0x0008_0008;
pub(in crate::data::load::formats::dicom) const SOP_CLASS: Tag = 0x0008_0016;
pub(in crate::data::load::formats::dicom) const SOP_INSTANCE: Tag = 0x0008_0018;
pub(in crate::data::load::formats::dicom) const ACQUISITION_TIME: Tag = 0x0008_0032;
pub(crate) const CONTENT_TIME: Tag = 0x0008_0033;
pub(crate) const FRAME_TYPE: Tag = 0x0008_9007;
pub(in crate::data::load::formats::dicom) const MODALITY: Tag = 0x0008_0060;
pub(in crate::data::load::formats::dicom) const SERIES_DESCRIPTION: Tag = 0x0008_103e;
pub(in crate::data::load::formats::dicom) const PROTOCOL: Tag = 0x0018_1030;
pub(in crate::data::load::formats::dicom) const SERIES: Tag = 0x0020_000e;
pub(in crate::data::load::formats::dicom) const SERIES_NUMBER: Tag = 0x0020_0011;
pub(in crate::data::load::formats::dicom) const ACQUISITION_NUMBER: Tag = 0x0020_0012;
pub(in crate::data::load::formats::dicom) const INSTANCE_NUMBER: Tag = 0x0020_0013;
pub(in crate::data::load::formats::dicom) const DIRECTORY_RECORDS: Tag = 0x0004_1220;

// Acquisition attributes, which distinguish images at one position.
pub(in crate::data::load::formats::dicom) const ECHO_TIME: Tag = 0x0018_0081;
pub(crate) const ECHO_NUMBER: Tag = 0x0018_0086;
pub(crate) const TUBE_VOLTAGE: Tag = 0x0018_0060;
pub(crate) const INVERSION_TIME: Tag = 0x0018_0082;
pub(crate) const FLIP_ANGLE: Tag = 0x0018_1314;
pub(in crate::data::load::formats::dicom) const TRIGGER_TIME: Tag = 0x0018_1060;
pub(in crate::data::load::formats::dicom) const EFFECTIVE_ECHO_TIME: Tag = 0x0018_9082;
pub(in crate::data::load::formats::dicom) const B_VALUE: Tag = 0x0018_9087;
pub(in crate::data::load::formats::dicom) const TEMPORAL_POSITION: Tag = 0x0020_0100;
pub(in crate::data::load::formats::dicom) const TEMPORAL_POSITION_INDEX: Tag = 0x0020_9128;
pub(in crate::data::load::formats::dicom) const CARDIAC_DELAY: Tag = 0x0020_9153;
pub(crate) const FRAME_ACQUISITION_NUMBER: Tag = 0x0020_9156;
pub(crate) const CARDIAC_PHASE: Tag = 0x0020_9241;
pub(crate) const REFERENCE_TIME: Tag = 0x0054_1300;

// Position, orientation and spacing of images.
pub(in crate::data::load::formats::dicom) const SLICE_THICKNESS: Tag = 0x0018_0050;
pub(in crate::data::load::formats::dicom) const SPACING_BETWEEN: Tag = 0x0018_0088;
pub(in crate::data::load::formats::dicom) const DETECTOR_SPACING: Tag = 0x0018_1164;
pub(crate) const NOMINAL_SPACING: Tag = 0x0018_2010;
pub(crate) const SLICE_LOCATIONS: Tag = 0x0018_2005;
pub(crate) const SLICE_LOCATION: Tag = 0x0020_1041;
pub(crate) const VOLUME_POSITION: Tag = 0x0020_9301;
pub(crate) const VOLUME_ORIENTATION: Tag = 0x0020_9302;
pub(crate) const FRAME_INCREMENT: Tag = 0x0028_0009;
pub(crate) const FRAME_TIME: Tag = 0x0018_1063;
pub(crate) const FRAME_TIMES: Tag = 0x0018_1065;
pub(crate) const REGION_UNITS_X: Tag = 0x0018_6024;
pub(crate) const REGION_UNITS_Y: Tag = 0x0018_6026;
pub(crate) const REGION_DELTA_X: Tag = 0x0018_602c;
pub(crate) const REGION_DELTA_Y: Tag = 0x0018_602e;
pub(crate) const SIEMENS_CREATOR: Tag = 0x0019_0010;
pub(crate) const SIEMENS_B_VALUE: Tag = 0x0019_100c;
pub(crate) const MOSAIC_COUNT: Tag = 0x0019_100a;
pub(crate) const SIEMENS_HEADER: Tag = 0x0029_1010;
pub(in crate::data::load::formats::dicom) const POSITION: Tag = 0x0020_0032;
pub(in crate::data::load::formats::dicom) const ORIENTATION: Tag = 0x0020_0037;
pub(in crate::data::load::formats::dicom) const PIXEL_SPACING: Tag = 0x0028_0030;
pub(in crate::data::load::formats::dicom) const FRAME_OFFSETS: Tag = 0x3004_000c;

// Storage of pixels.
pub(in crate::data::load::formats::dicom) const SAMPLES: Tag = 0x0028_0002;
pub(in crate::data::load::formats::dicom) const PHOTOMETRIC: Tag = 0x0028_0004;
pub(in crate::data::load::formats::dicom) const PLANAR: Tag = 0x0028_0006;
pub(in crate::data::load::formats::dicom) const FRAMES: Tag = 0x0028_0008;
pub(in crate::data::load::formats::dicom) const ROWS: Tag = 0x0028_0010;
pub(in crate::data::load::formats::dicom) const COLUMNS: Tag = 0x0028_0011;
pub(in crate::data::load::formats::dicom) const BITS_ALLOCATED: Tag = 0x0028_0100;
pub(in crate::data::load::formats::dicom) const BITS_STORED: Tag = 0x0028_0101;
pub(in crate::data::load::formats::dicom) const HIGH_BIT: Tag = 0x0028_0102;
pub(in crate::data::load::formats::dicom) const IS_SIGNED: Tag = 0x0028_0103;
pub(in crate::data::load::formats::dicom) const FRAME_STARTS: Tag = 0x7fe0_0001;
pub(in crate::data::load::formats::dicom) const FLOATS: Tag = 0x7fe0_0008;
pub(in crate::data::load::formats::dicom) const DOUBLES: Tag = 0x7fe0_0009;
pub(in crate::data::load::formats::dicom) const PIXELS: Tag = 0x7fe0_0010;

// Meaning of values.
pub(in crate::data::load::formats::dicom) const PADDING: Tag = 0x0028_0120;
pub(in crate::data::load::formats::dicom) const WINDOW_CENTER: Tag = 0x0028_1050;
pub(in crate::data::load::formats::dicom) const WINDOW_WIDTH: Tag = 0x0028_1051;
pub(in crate::data::load::formats::dicom) const INTERCEPT: Tag = 0x0028_1052;
pub(in crate::data::load::formats::dicom) const SLOPE: Tag = 0x0028_1053;
pub(in crate::data::load::formats::dicom) const RESCALE_TYPE: Tag = 0x0028_1054;
pub(in crate::data::load::formats::dicom) const VALUE_TABLE: Tag = 0x0028_3000;
pub(in crate::data::load::formats::dicom) const UNITS: Tag = 0x0054_1001;
pub(in crate::data::load::formats::dicom) const DOSE_UNITS: Tag = 0x3004_0002;
pub(in crate::data::load::formats::dicom) const DOSE_SCALING: Tag = 0x3004_000e;
pub(crate) const SEGMENTATION_TYPE: Tag = 0x0062_0001;
pub(crate) const SEGMENT_NUMBER: Tag = 0x0062_0004;
pub(crate) const SEGMENT_LABEL: Tag = 0x0062_0005;
pub(crate) const REFERENCED_SEGMENT: Tag = 0x0062_000b;
pub(crate) const SEGMENT_COLOR: Tag = 0x0062_000d;
pub(crate) const MOST_FRACTION: Tag = 0x0062_000e;

// Sequences that contain some of these elements.
pub(in crate::data::load::formats::dicom) const SHARED_GROUPS: Tag = 0x5200_9229;
pub(in crate::data::load::formats::dicom) const FRAME_GROUPS: Tag = 0x5200_9230;
pub(in crate::data::load::formats::dicom) const DETECTORS: Tag = 0x0054_0022;
pub(in crate::data::load::formats::dicom) const PLANE_POSITION: Tag = 0x0020_9113;
pub(in crate::data::load::formats::dicom) const PLANE_ORIENTATION: Tag = 0x0020_9116;
pub(crate) const VOLUME_PLANE_POSITION: Tag = 0x0020_930e;
pub(crate) const VOLUME_PLANE_ORIENTATION: Tag = 0x0020_930f;
pub(crate) const MR_FRAME_TYPE: Tag = 0x0018_9226;
pub(crate) const CT_FRAME_TYPE: Tag = 0x0018_9329;
pub(crate) const PET_FRAME_TYPE: Tag = 0x0018_9751;
pub(crate) const MR_TIMING: Tag = 0x0018_9112;
pub(crate) const REGIONS: Tag = 0x0018_6011;
pub(crate) const SEGMENTS: Tag = 0x0062_0002;
pub(crate) const SEGMENT_IDENTIFICATION: Tag = 0x0062_000a;
pub(in crate::data::load::formats::dicom) const PIXEL_MEASURES: Tag = 0x0028_9110;
pub(in crate::data::load::formats::dicom) const VALUE_TRANSFORMATION: Tag = 0x0028_9145;
pub(in crate::data::load::formats::dicom) const FRAME_WINDOW: Tag = 0x0028_9132;
pub(in crate::data::load::formats::dicom) const FRAME_CONTENT: Tag = 0x0020_9111;
pub(in crate::data::load::formats::dicom) const CARDIAC: Tag = 0x0018_9118;
pub(in crate::data::load::formats::dicom) const ECHO: Tag = 0x0018_9114;
pub(in crate::data::load::formats::dicom) const DIFFUSION: Tag = 0x0018_9117;

/// Formats a tag in the usual notation, `(GGGG,EEEE)`.
pub(in crate::data::load::formats::dicom) fn written(tag: Tag) -> String {
    format!("({:04X},{:04X})", tag >> 16, tag & 0xffff)
}
