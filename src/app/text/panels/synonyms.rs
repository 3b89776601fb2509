//! Synonyms by which the command palette finds settings, in lower case.

pub(crate) const LABELS: &str = "segmentation segments classes regions table visible names colours colors";

pub(crate) const NAME_OF_LIGHT: &str = "rename title label of a light";
pub(crate) const KIND_OF_LIGHT: &str =
    "parallel perspective sun lamp point spotlight spot hood directional positional";
pub(crate) const BRIGHTNESS: &str = "brightness bright dark dim lighter darker";
pub(crate) const LIGHT_DISTANCE: &str = "position near far closer farther lamp";
pub(crate) const SPOTLIGHT: &str = "spot cone hood lampshade beam barn doors theatre";
pub(crate) const CONE: &str = "spotlight spot hood beam angle opening";
pub(crate) const RIM: &str = "spotlight spot hood rim soft edge feather fade penumbra";
pub(crate) const AREA_LIGHT: &str = "area light soft shadows penumbra disc softbox window size points";
pub(crate) const WIDTH: &str = "area light soft shadows penumbra softbox size diameter radius angle sun";
pub(crate) const ASPECT: &str = "area light aspect ratio rectangle softbox window proportions";
pub(crate) const LIGHT_ROTATION: &str = "area light rotate rotation rectangle softbox angle";
pub(crate) const LOCK: &str = "headlight follow camera attach";
pub(crate) const LIGHT_DENSITY: &str = "light attenuation extinction absorption opacity";
pub(crate) const FILL: &str = "fill light no shadow";

pub(crate) const SHADOWS: &str =
    "shadow off on algorithm splatting ray tracing raycast direct per voxel sample";
pub(crate) const QUALITY: &str = "quality fast fine exact sampling";
pub(crate) const STRENGTH: &str = "shadow strength intensity opacity lighter shadows";
pub(crate) const SHADOW_BRIGHTENING: &str = "shadows too dark black brighten lift";
pub(crate) const SHADOW_BIAS: &str = "self shadow acne light bias offset";
pub(crate) const KEEP_BALANCED: &str = "automatic auto exposure compensation brightness too dark";
pub(crate) const DARK_SHARE: &str = "shadows too dark black meter share underexposed";
pub(crate) const LIGHTING_CURVE: &str = "lighting transfer function link unlink separate follows the eye's";
pub(crate) const COLORED_SHADOWS: &str = "coloured colored shadows stained glass transmission tint spectral";
pub(crate) const CONTACT_SHADOWS: &str = "contact shadows near field sharp relief";
pub(crate) const MEMORY: &str = "memory slow performance downsample reduce resolution";
pub(crate) const FIRST_TOUCH: &str = "crisp brighter sharper deposit sheet";
pub(crate) const REVERSE_KERNEL: &str = "reverse kernel back projection tent softer sharper shadows";
pub(crate) const DEPOSIT: &str = "slab mean front light volume attenuation";
pub(crate) const SOFT_RESOLUTION: &str = "area light soft shadows memory slow performance detail";
pub(crate) const MIN_BLOCKS: &str =
    "small volumes coarse blocky fineness grid soft shadows ambient occlusion ao";

pub(crate) const KERNEL: &str =
    "splat footprint interpolation reconstruction filter smoothing blur gaussian b-spline quick prefiltered";
pub(crate) const SIGMA: &str = "gaussian kernel width sharpness blur";
pub(crate) const SLAB: &str = "sample distance step size sampling rate slice thickness sheet";
pub(crate) const QUADRATURE: &str = "samples per slab points oversampling supersampling sampling accuracy";
pub(crate) const SLABS: &str =
    "adaptive sampling weave wood grain banding stripes artefacts quality by need even";
pub(crate) const CLASSIFICATION: &str = "pre post classification transfer function labels";
pub(crate) const ENGINE: &str = "splatting gather scatter algorithm engine";
pub(crate) const ORDER: &str = "image volume aligned sheets splats compositing popping";
pub(crate) const NORMALS: &str = "gradient gradients relief bump surface direction shading";

pub(crate) const SKY: &str =
    "ambient occlusion ao environment map hdri hdr dome sky light panorama surroundings";
pub(crate) const SKY_COLOR: &str = "sky colour color gradient zenith nadir ground dome hemisphere tint";
pub(crate) const SKY_TILT: &str = "sky tilt tipped window direction angle";
pub(crate) const SKY_TURN: &str =
    "sky rotate rotation environment hdri panorama surroundings direction azimuth";
pub(crate) const SKY_DENSITY: &str = "sky ambient occlusion ao opacity attenuation depth";
pub(crate) const DIRECTIONS: &str = "samples rays noise smooth banding quality ambient occlusion scattering";
pub(crate) const SCATTERING: &str =
    "global illumination gi multiple scattering subsurface wax skin cloud translucent";
pub(crate) const BOUNCED: &str = "global illumination gi indirect scattering strength intensity";
pub(crate) const ANISOTROPY: &str =
    "anisotropy phase function henyey greenstein forward backward scattering cloud smoke fog";

pub(crate) const PATIENT_TABLE: &str = "patient table bed couch board scanner head holder";
pub(crate) const RENDER_MODE: &str = "render mode blend material surface maximum minimum mean";
pub(crate) const GLOW: &str = "glow emissive self luminous";
pub(crate) const AMBIENT: &str = "ambient light fill";
pub(crate) const DIFFUSE: &str = "lambert matte scatter evenly";
pub(crate) const HIGHLIGHTS: &str = "highlight gloss glossy shiny reflection phong";
pub(crate) const SURFACE: &str = "gradient magnitude threshold normals noise haze";
pub(crate) const SIDES: &str = "two sided double sided back faces backlight outer both";
pub(crate) const ANTIALIASING: &str = "anti-aliasing jagged smooth edges stairs multisampling samples aa";
pub(crate) const TONE_MAP: &str = "tone mapping hdr clip gamma";
pub(crate) const BACKGROUND: &str = "background colour color white black backdrop";

pub(crate) const CROP: &str = "crop box region of interest roi clipping bounding box";
pub(crate) const CROP_ALONG: &str = "crop box region of interest roi from to first last voxel side extent";
pub(crate) const CUT_AWAY: &str = "crop clip cut away hidden hide removed shadow stays effect";
pub(crate) const CLIP: &str = "clip plane section slice cut cross-section";
pub(crate) const CLIP_OFFSET: &str = "clip plane move position depth slice";
pub(crate) const CLIP_FACING: &str = "clip plane normal direction orientation axis turn flip";

pub(crate) const CUT_BY_SHAPE: &str =
    "scissors lasso outline polygon sphere eraser brush part component island hide isolate segment mask cut";

pub(crate) const FLOOR: &str = "floor ground plane shadow catcher";
pub(crate) const FLOOR_HEIGHT: &str = "ground level position raise lower";
pub(crate) const FLOOR_RADIUS: &str = "ground size extent fade";
pub(crate) const FLOOR_OPACITY: &str = "ground transparency alpha cover";
pub(crate) const FLOOR_COLOR: &str = "ground color tint";
pub(crate) const SHADOW_ALONE: &str = "shadow catcher only transparent background";

pub(crate) const PROJECTION: &str = "orthographic perspective parallel projection";
pub(crate) const UP: &str = "orientation rotate axes upside down flip";
pub(crate) const AZIMUTH: &str = "orbit rotate rotation turn heading yaw horizontal angle";
pub(crate) const ELEVATION: &str = "orbit rotate rotation pitch tilt height vertical angle latitude";
pub(crate) const ROLL: &str = "rotate rotation picture horizon bank twist";
pub(crate) const CAMERA_DISTANCE: &str = "zoom dolly closer farther near far";
pub(crate) const FIELD_OF_VIEW: &str = "fov lens focal length zoom wide angle";
pub(crate) const FIT: &str = "aspect ratio frame narrow portrait";

pub(crate) const COMPARE: &str = "before after split side by side difference";
pub(crate) const COMPARED_SIDE: &str = "look variant split before after";
pub(crate) const DIFFERENCE: &str = "subtract deviation error";

pub(crate) const KIND_OF_DATA: &str =
    "kind of data type ct hounsfield scalar signed mask labels segmentation dark on bright";
pub(crate) const RANGE: &str = "window level contrast range min max clamp values";
pub(crate) const EDGES: &str = "gradient magnitude border boundary surface interface contour modulation";
pub(crate) const NEVER_CUT: &str = "cut crop clip by layer whole uncut intact keep cutaway";
pub(crate) const OUTLINES: &str = "contour border label outline segmentation boundary";
pub(crate) const LAYERS: &str = "channels overlay segmentation mask fusion second volume merge";
pub(crate) const OPACITY_UNIT: &str = "opacity unit density scale extinction thickness";
pub(crate) const SPACING: &str = "voxel size spacing millimetres squashed stretched aspect";
pub(crate) const UNIT: &str = "voxel size length scale millimetres micrometres nanometres mm um nm";
pub(crate) const FLIP: &str = "mirror mirrored invert reverse left right axis handedness";
pub(crate) const AXES: &str = "order of axes swap transpose permute reorder";
pub(crate) const ORIENTATION: &str =
    "rotate axes upside down flip anatomical left right anterior posterior superior inferior ras lps";
pub(crate) const PADDING: &str = "nothing empty missing outside no data nan fill value air hole";
pub(crate) const RESCALE: &str = "rescale slope intercept calibration hounsfield multiply add offset values";
pub(crate) const NAME_OF_DATA: &str = "title of the volume";
pub(crate) const SOURCE: &str = "file path folder where from";
pub(crate) const DIMENSIONS: &str = "dimensions grid resolution how many";
pub(crate) const VOXEL_TYPE: &str = "bits depth number integer float";
pub(crate) const SHOWN: &str = "values range minimum maximum";
pub(crate) const RAM: &str = "mebibytes ram size";
pub(crate) const CURVE_OPACITY: &str = "transparent opaque alpha transfer function curve";
pub(crate) const LEVEL: &str = "window level width centre contrast brightness wl";
pub(crate) const WINDOW: &str = "window level width centre contrast brightness wl";
pub(crate) const FREEHAND: &str = "freehand pencil stroke sketch curve";
pub(crate) const MATERIALS: &str =
    "two-dimensional transfer function 2d gradient magnitude histogram boxes borders segment materials";
pub(crate) const LOG_HISTOGRAM: &str = "histogram logarithmic rare values transfer function";
