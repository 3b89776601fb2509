//! Look of an image: one [`Settings`] value, with its presets, session records, transfer functions and automatic first
//! look.
//!
//! Undo, sessions, presets, screenshots and the command line all use this one value; what must be recomputed after a
//! change follows from comparing the keys that two of them have (`plan` of chiaroscuro-render).
//!
//! Begin with [`Settings`] in `settings/mod.rs`. The settings of a newly opened volume come from
//! `first_look/mod.rs`, without rendering; chiaroscuro-render then tries small pictures to choose light, floor and
//! brightness. `settings_io/` reads and writes settings, and `transfer_exchange/` has the transfer functions of other
//! programs. CONTRIBUTING.md lists what a new setting touches.

mod comparison_variant;
mod environment_map;
pub mod first_look;
mod image_spec;
mod light_direction;
mod lighting_rig;
mod object_rotation;
mod settings;
mod settings_io;
mod shape_mask;
mod simple_light;
mod transfer;
mod transfer_exchange;
mod turntable;

pub use self::settings::camera_settings::camera::{Camera, FRAME_ASPECT, FovReference, Projection};
pub use self::settings::camera_settings::scene_axis::SceneAxis;
pub use self::settings::camera_settings::standard_view::StandardView;
pub use self::settings::clip_effect::ClipEffect;
pub use self::settings::clipping::{
    ClipPlane, ClippedPart, Clipping, CropBox, MAX_PLANE_OFFSET, MIN_CROP_EXTENT,
};
pub use self::settings::floor::{FloorSettings, MAX_FLOOR_HEIGHT, MAX_FLOOR_RADIUS};
pub use self::settings::layer::composition::{LayerBlend, LayerComposition, LayerVisibility};
pub use self::settings::layer::density_range::DensityRange;
pub use self::settings::layer::label_table::{LabelLook, LabelMaterial, LabelTable};
pub use self::settings::layer::length::OpacityLength;
pub use self::settings::layer::material_box::{
    MATERIAL_COLORS, MAX_MATERIAL_BOXES, MaterialBox, SoftInterval,
};
pub use self::settings::layer::material_sample::MaterialSample;
pub use self::settings::layer::{LayerCountError, LightingTransfer, VolumeLayer, VolumeLayers};
pub use self::settings::light::area_light::{
    LightArea, LightShape, MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_ASPECT, MAX_LIGHT_SIZE,
};
pub use self::settings::light::cube_axes::cube_axes;
pub use self::settings::light::direction_sets::{
    SKY_DIRECTION_SETS, directions_above, sky_direction_set, sweep_directions,
};
pub use self::settings::light::environment_map::ENVIRONMENT_LIGHT_NAME;
pub use self::settings::light::horizon_clipping::VisibleLight;
pub use self::settings::light::scattering::{MAX_ANISOTROPY, MAX_BOUNCES, ScatteringSettings};
pub use self::settings::light::sky::{
    EnvironmentLight, MAX_ENVIRONMENT_RADIANCE, SKY_DIRECTIONS, SKY_LOOKUP_DISTANCE, SkyMode, SkyRadiance,
    SkySettings,
};
pub use self::settings::light::{
    LightGeometry, LightLock, LightSettings, MAX_LIGHTS, MAX_NAME_CHARS, SceneLight, Spotlight, SpotlightCone,
};
pub use self::settings::quality::QualityPreset;
pub use self::settings::render_mode::{RayProjection, RenderMode, RenderModeSettings};
pub use self::settings::sampling::{
    ClassificationOrder, FINE_UNDIVIDED_SHARE, GradientSource, MAX_SLAB_PARTS, PREINTEGRATED_STEPS,
    ReconstructionKernel, RenderEngine, STANDARD_UNDIVIDED_SHARE, SamplingSettings, SheetOrder, SlabMode,
    SlabQuadrature,
};
pub use self::settings::saved_entries::{
    DIGIT_KEYS, MAX_SAVED_BYTES, MAX_SAVED_ENTRIES, SavedContent, SavedEntry, SavedLook,
};
pub use self::settings::shadows::{
    AreaLightSampling, DepositMode, LightStorage, LightVolumePrecision, LightVolumeResolution,
    MAX_BIAS_VOXELS, MAX_LIGHT_SAMPLES, MAX_MIN_BLOCKS, NearFieldRay, ReverseKernel, ShadowAlgorithm,
    ShadowSettings,
};
pub use self::settings::shape_cuts::{
    BoxCut, ComponentCut, CutAction, CutDepth, CutShape, CutShapeKind, HalfSpaceCut, MAX_OUTLINE_POINTS,
    MAX_SHAPE_CUTS, OutlineCut, ShapeCut, SphereCut,
};
pub use self::settings_io::path_encoding::{decode_path, encode_path};
pub use self::settings_io::preset_error::PresetError;
pub use self::settings_io::preset_json::{AppliedSettings, apply_json, set_value, setting_value};
#[cfg(any(test, feature = "testing"))]
pub use self::settings_io::preset_json::{apply_path, load_json, settings_to_json};
pub use self::settings_io::preset_library::{PRESETS, Preset, apply_relative};
pub use self::settings_io::record::{FinerLevelRecord, ImageRecord, LookRecord, VolumeRecord};
pub use self::settings_io::volume_location::VolumeLocation;
pub use self::shape_mask::{ComponentSilhouette, mask_from_shapes};
pub use self::transfer::baked_transfer::BakedTransfer;
pub use self::transfer::color_map::{COLOR_MAPS, ColorMap};
pub use self::transfer::colored_shadows::LIGHT_COLORS;
pub use self::transfer::label_colors::label_color;
pub use self::transfer::oklab::{
    lab_from_lch, lch_from_lab, linear_from_oklab, oklab_from_linear, srgb_from_lch,
};
pub use comparison_variant::ComparisonVariant;
pub use environment_map::{BrightLight, EnvironmentMap, Panorama};
pub use image_spec::{Annotations, ImageSpec, MAX_IMAGE_EDGE, MAX_SAMPLES_PER_EDGE, PixelFormat};
pub use light_direction::LightDirection;
pub use lighting_rig::{LightingRig, key_and_fill, key_and_rim};
pub use object_rotation::{CameraLightRotation, ObjectRotation};
pub use settings::{
    ANTIALIASING_RAYS, Background, LitSides, MAX_EXPOSURE, MIN_EXPOSURE, OutputSettings, PhongShading,
    SCHEMA, Settings, ToneMap,
};
pub use simple_light::LightSimplification;
pub use transfer::{
    ColorMixing, ControlPoint, Easing, LUT_SIZE, MAX_OPACITY, MAX_POINTS, OpacityInterpolation,
    SMOOTH_SEGMENT_PIECES, TransferFunction, TransferSample, linear_from_srgb, srgb_from_linear,
};
pub use transfer_exchange::{
    EXPORT_EXTENSIONS, ExchangeError, IMPORT_EXTENSIONS, export_transfer, import_transfer,
};
