//! What else settings are called, by which they are found; in small letters.

pub(crate) const KIND_OF_LIGHT: &str =
    "parallel perspective sun lamp point spotlight spot hood directional positional";
pub(crate) const BRIGHTNESS: &str = "brightness bright dark dim lighter darker";
pub(crate) const AREA_LIGHT: &str = "area light soft shadows penumbra disc softbox window size";
pub(crate) const LOCK: &str = "headlight follow camera attach";
pub(crate) const FILL: &str = "fill light no shadow";
pub(crate) const SHADOWS: &str =
    "shadow off on algorithm splatting ray tracing raycast direct per voxel sample";
pub(crate) const QUALITY: &str = "quality fast fine exact sampling";
pub(crate) const STRENGTH: &str = "shadow strength intensity opacity lighter shadows";
pub(crate) const TOO_DARK: &str = "shadows too dark black brighten lift";
pub(crate) const ACNE: &str = "self shadow acne light bias offset";
pub(crate) const LIGHTING_CURVE: &str = "lighting transfer function link unlink separate follows the eye's";
pub(crate) const GLASS: &str = "coloured colored shadows stained glass transmission tint spectral";
pub(crate) const CONTACT: &str = "contact shadows near field sharp relief";
pub(crate) const MEMORY: &str = "memory slow performance downsample reduce resolution";
pub(crate) const SKY: &str = "ambient occlusion ao environment hdri dome sky light panorama surroundings";
pub(crate) const SCATTERING: &str =
    "global illumination gi multiple scattering subsurface wax skin cloud translucent";
pub(crate) const GLOW: &str = "glow emissive self luminous";
pub(crate) const AMBIENT: &str = "ambient light fill";
pub(crate) const HIGHLIGHTS: &str = "highlight gloss glossy shiny reflection phong";
pub(crate) const TONE_MAP: &str = "tone mapping hdr clip gamma";
pub(crate) const BACKGROUND: &str = "background colour color white black backdrop";
pub(crate) const CROP: &str = "crop box region of interest roi clipping bounding box";
pub(crate) const CLIP: &str = "clip plane section slice cut cross-section";
pub(crate) const FLOOR: &str = "floor ground plane shadow catcher";
pub(crate) const PROJECTION: &str = "orthographic perspective parallel projection";
pub(crate) const UP: &str = "orientation rotate axes upside down flip";
pub(crate) const FIELD_OF_VIEW: &str = "fov lens focal length zoom wide angle";
pub(crate) const RANGE: &str = "window level contrast range min max clamp values";
pub(crate) const OPACITY_UNIT: &str = "opacity unit density scale extinction thickness";
pub(crate) const SPACING: &str = "voxel size spacing millimetres squashed stretched aspect";
