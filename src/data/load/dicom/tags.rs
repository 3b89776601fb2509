//! The tags of the data elements that are read (PS3.6): group and element as one number.

/// A tag.
pub(super) type Tag = u32;

// How the file is written.
pub(super) const TRANSFER_SYNTAX: Tag = 0x0002_0010;
pub(super) const ITEM: Tag = 0xfffe_e000;
pub(super) const ITEM_END: Tag = 0xfffe_e00d;
pub(super) const SEQUENCE_END: Tag = 0xfffe_e0dd;

// What it is, and of which series.
pub(super) const IMAGE_TYPE: Tag = 0x0008_0008;
pub(super) const SOP_CLASS: Tag = 0x0008_0016;
pub(super) const SOP_INSTANCE: Tag = 0x0008_0018;
pub(super) const ACQUISITION_TIME: Tag = 0x0008_0032;
pub(super) const MODALITY: Tag = 0x0008_0060;
pub(super) const SERIES_DESCRIPTION: Tag = 0x0008_103e;
pub(super) const PROTOCOL: Tag = 0x0018_1030;
pub(super) const SERIES: Tag = 0x0020_000e;
pub(super) const SERIES_NUMBER: Tag = 0x0020_0011;
pub(super) const ACQUISITION_NUMBER: Tag = 0x0020_0012;
pub(super) const INSTANCE_NUMBER: Tag = 0x0020_0013;
pub(super) const DIRECTORY_RECORDS: Tag = 0x0004_1220;

// In which order pictures of one place were taken.
pub(super) const ECHO_TIME: Tag = 0x0018_0081;
pub(super) const TRIGGER_TIME: Tag = 0x0018_1060;
pub(super) const EFFECTIVE_ECHO_TIME: Tag = 0x0018_9082;
pub(super) const B_VALUE: Tag = 0x0018_9087;
pub(super) const TEMPORAL_POSITION: Tag = 0x0020_0100;
pub(super) const TEMPORAL_POSITION_INDEX: Tag = 0x0020_9128;
pub(super) const CARDIAC_DELAY: Tag = 0x0020_9153;

// Where pictures lie.
pub(super) const SLICE_THICKNESS: Tag = 0x0018_0050;
pub(super) const SPACING_BETWEEN: Tag = 0x0018_0088;
pub(super) const DETECTOR_SPACING: Tag = 0x0018_1164;
pub(super) const POSITION: Tag = 0x0020_0032;
pub(super) const ORIENTATION: Tag = 0x0020_0037;
pub(super) const PIXEL_SPACING: Tag = 0x0028_0030;
pub(super) const FRAME_OFFSETS: Tag = 0x3004_000c;

// How pixels are stored.
pub(super) const SAMPLES: Tag = 0x0028_0002;
pub(super) const PHOTOMETRIC: Tag = 0x0028_0004;
pub(super) const PLANAR: Tag = 0x0028_0006;
pub(super) const FRAMES: Tag = 0x0028_0008;
pub(super) const ROWS: Tag = 0x0028_0010;
pub(super) const COLUMNS: Tag = 0x0028_0011;
pub(super) const BITS_ALLOCATED: Tag = 0x0028_0100;
pub(super) const BITS_STORED: Tag = 0x0028_0101;
pub(super) const HIGH_BIT: Tag = 0x0028_0102;
pub(super) const IS_SIGNED: Tag = 0x0028_0103;
pub(super) const FRAME_STARTS: Tag = 0x7fe0_0001;
pub(super) const FLOATS: Tag = 0x7fe0_0008;
pub(super) const DOUBLES: Tag = 0x7fe0_0009;
pub(super) const PIXELS: Tag = 0x7fe0_0010;

// What values mean.
pub(super) const PADDING: Tag = 0x0028_0120;
pub(super) const WINDOW_CENTER: Tag = 0x0028_1050;
pub(super) const WINDOW_WIDTH: Tag = 0x0028_1051;
pub(super) const INTERCEPT: Tag = 0x0028_1052;
pub(super) const SLOPE: Tag = 0x0028_1053;
pub(super) const RESCALE_TYPE: Tag = 0x0028_1054;
pub(super) const VALUE_TABLE: Tag = 0x0028_3000;
pub(super) const UNITS: Tag = 0x0054_1001;
pub(super) const DOSE_UNITS: Tag = 0x3004_0002;
pub(super) const DOSE_SCALING: Tag = 0x3004_000e;

// Sequences that hold some of these.
pub(super) const SHARED_GROUPS: Tag = 0x5200_9229;
pub(super) const FRAME_GROUPS: Tag = 0x5200_9230;
pub(super) const DETECTORS: Tag = 0x0054_0022;
pub(super) const PLANE_POSITION: Tag = 0x0020_9113;
pub(super) const PLANE_ORIENTATION: Tag = 0x0020_9116;
pub(super) const PIXEL_MEASURES: Tag = 0x0028_9110;
pub(super) const VALUE_TRANSFORMATION: Tag = 0x0028_9145;
pub(super) const FRAME_WINDOW: Tag = 0x0028_9132;
pub(super) const FRAME_CONTENT: Tag = 0x0020_9111;
pub(super) const CARDIAC: Tag = 0x0018_9118;
pub(super) const ECHO: Tag = 0x0018_9114;
pub(super) const DIFFUSION: Tag = 0x0018_9117;

/// A tag as everybody writes it.
pub(super) fn written(tag: Tag) -> String {
    format!("({:04X},{:04X})", tag >> 16, tag & 0xffff)
}
