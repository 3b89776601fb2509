//! Look of an image: one [`Settings`] value, with its presets, session records, transfer functions and automatic
//! first look.
//!
//! Undo, sessions, presets, screenshots and the command line all use this one value; what must be recomputed after a
//! change follows from comparing two of them (`crate::plan`).

pub mod auto;
mod exchange;
mod image_spec;
mod light_place;
mod object_turn;
mod rig;
mod settings;
mod stored;
mod transfer;
mod turntable;
mod variant;

pub use self::settings::cut::{ClipPlane, CropBox, CutEffect, Cuts, MAX_PLANE_OFFSET, MIN_CROP, Remains};
pub use self::settings::eye::camera::{Camera, FRAME_ASPECT, Fit, Projection};
pub use self::settings::eye::scene_axis::SceneAxis;
pub use self::settings::eye::view::StandardView;
pub use self::settings::floor::{Floor, MAX_FLOOR_HEIGHT, MAX_FLOOR_RADIUS};
pub use self::settings::kept::{DIGITS, Kept, KeptLook, KeptThing, MAX_KEPT, MAX_KEPT_BYTES};
pub use self::settings::labels::{LabelLook, LabelMaterial, LabelTable};
pub use self::settings::length::Length;
pub use self::settings::light::area::{
    LightArea, LightShape, MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_ASPECT, MAX_LIGHT_SIZE,
};
pub use self::settings::light::risen::Risen;
pub use self::settings::light::scattering::{MAX_ANISOTROPY, MAX_BOUNCES, Scattering};
pub use self::settings::light::sky::{
    MAX_PICTURE_RADIANCE, SKY_AHEAD, SKY_DIRECTIONS, Sky, SkyMode, SkyPicture, SkyRadiance,
};
pub use self::settings::light::surroundings::SURROUNDINGS;
pub use self::settings::light::{Cone, Hood, Light, LightKind, LightLock, MAX_LIGHTS, MAX_NAME, SceneLight};
pub use self::settings::quality::Quality;
pub use self::settings::range::DensityRange;
pub use self::settings::sampling::{
    Classification, Engine, Gradients, Kernel, PREINTEGRATED_STEPS, Quadrature, Sampling, SheetOrder, Slabs,
    THIN_SLABS,
};
pub use self::settings::shadows::{
    AreaShadows, Deposit, LightStorage, MAX_BIAS_VOXELS, MAX_LEAST_BLOCKS, MAX_LIGHT_SAMPLES, NearField,
    Precision, Resolution, ReverseKernel, ShadowAlgorithm, Shadows,
};
pub use self::stored::bounds::MAX_LOOK_BYTES;
pub use self::stored::library::{PRESETS, Preset, apply_relative};
pub use self::stored::made_by::{MADE_BY, made_by, tells_maker};
pub use self::stored::path_text::{decode_path, encode_path};
pub use self::stored::place::VolumePlace;
pub use self::stored::preset::{apply_json, apply_path, assign, load_json, to_json};
pub use self::stored::preset_error::PresetError;
pub use self::stored::record::{PictureRecord, Record, VolumeRecord};
pub use self::transfer::baked::BakedTransfer;
pub use self::transfer::categories::category;
pub use self::transfer::color_map::{COLOR_MAPS, ColorMap};
pub use self::transfer::oklab::{
    lab_from_lch, lch_from_lab, linear_from_oklab, oklab_from_linear, srgb_from_lch,
};
pub use self::transfer::transmitted::COLORS;
pub use exchange::{EXPORTED, ExchangeError, IMPORTED, export, import};
pub use image_spec::{Depth, ImageSpec, MAX_EDGE, MAX_SAMPLES, Marks};
pub use light_place::LightPlace;
pub use object_turn::{ObjectTurn, RoomTurn};
pub use rig::{Rig, key_and_fill};
pub use settings::{
    Background, LightingTransfer, MAX_EXPOSURE, MIN_EXPOSURE, Output, SCHEMA, Settings, Shading, Sides,
    ToneMap,
};
pub use transfer::{
    ControlPoint, Easing, Interpolation, LUT_SIZE, MAX_OPACITY, MAX_POINTS, Mixing, STEPS, TransferFunction,
    linear_from_srgb, srgb_from_linear,
};
pub use variant::Variant;
