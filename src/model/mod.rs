//! What the user decides: one [`Settings`] value that is the whole look of a picture.
//!
//! Undo, sessions, presets, screenshots and the command line all use this one value; what must be
//! recomputed after a change follows from comparing two of them (`crate::plan`).

pub mod auto;
mod camera;
mod color_map;
mod cut;
mod exchange;
mod ground;
mod length;
mod library;
mod light;
mod oklab;
mod preset;
mod record;
mod rig;
mod sampling;
mod sanitise;
mod settings;
mod shadows;
mod shot;
mod transfer;
mod turn;
mod variant;
mod view;

pub use camera::{Camera, Projection};
pub use color_map::{COLOR_MAPS, ColorMap};
pub use cut::{ClipPlane, CropBox, CutEffect, Cuts, MAX_PLANE_OFFSET, MIN_CROP, Remains};
pub use exchange::{EXPORTED, ExchangeError, IMPORTED, export, import};
pub use ground::{Ground, MAX_GROUND_HEIGHT, MAX_GROUND_RADIUS};
pub use length::Length;
pub use library::{PRESETS, Preset, apply_relative};
pub use light::{Cone, Hood, Light, LightKind, LightLock, MAX_LIGHTS};
pub use oklab::{lab_from_lch, lch_from_lab, linear_from_oklab, oklab_from_linear};
pub use preset::{PresetError, apply_json, apply_path, load_json, to_json};
pub use record::{PictureRecord, Record, VolumeRecord};
pub use rig::Rig;
pub use sampling::{Classification, Engine, Gradients, Kernel, Quadrature, Sampling, SheetOrder};
pub use settings::{Background, LightingTransfer, Output, SCHEMA, Settings, Shading, ToneMap};
pub use shadows::{Deposit, LightStorage, MAX_BIAS_VOXELS, Precision, Resolution, ShadowAlgorithm, Shadows};
pub use shot::{Depth, MAX_EDGE, MAX_SAMPLES, Shot};
pub use transfer::{
    BakedTransfer, ControlPoint, Easing, Interpolation, LUT_SIZE, MAX_OPACITY, Mixing, STEPS,
    TransferFunction, linear_from_srgb, srgb_from_linear,
};
pub use variant::Variant;
pub use view::StandardView;
