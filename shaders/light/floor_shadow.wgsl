// What of a light gets to a floor behind the volume: for places on a map of it the transmittance behind the last slab of one
// view of the light, where that sees them. Of a light that has a size, the mean over its points. What is summed is what is
// missing, of which there is none away from the sheets: only the first and the last of the views visit all of the map.
#import "sheets/march.wgsl"

struct FloorShadow {
    // In scene space: the middle of texel (0, 0), and how far it is to the next along both edges.
    origin: vec3f,
    size: u32,
    along_x: vec3f,
    // One over the points of the light.
    share: f32,
    along_y: vec3f,
    // 1 when the view owns only the quarter-space around its axis.
    cube_face: u32,
    // Where the floor faces, in scene space.
    up: vec3f,
    perspective: f32,
    // Unit direction towards a parallel light, or the position of a perspective one; scene space.
    place: vec3f,
    pad0: f32,
    // Scene space to the light's axes at the anchor, x and y in pixels of the anchor plane, z in scene units: three rows of
    // an affine map.
    light_from_scene_x: vec4f,
    light_from_scene_y: vec4f,
    light_from_scene_z: vec4f,
    first_pixel: vec2f,
    // Of this dispatch.
    first_texel: vec2u,
}

@group(0) @binding(1) var<uniform> bound_floor_map: FloorShadow;
var<private> floor_map: FloorShadow;
// What is missing in the views before.
@group(0) @binding(2) var<storage, read_write> sums: array<f32>;
@group(0) @binding(5) var shadow: texture_storage_3d<STORAGE_FORMAT, write>;

// Whether this is the first and the last of the views of all points.
override IS_FIRST: bool = true;
override IS_LAST: bool = true;

// Behind the last slab, and beside the sheets, which nothing in the way reaches.
fn behind(pixel: vec2f) -> f32 {
    let size = vec2f(march.frame.size);
    let is_inside = all(pixel >= vec2f(0.0)) && all(pixel < size);
    let at = vec2u(clamp(pixel, vec2f(0.0), size - 1.0));
    return select(unattenuated(pixel), transmittance[at.y * march.frame.size.x + at.x], is_inside);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) global: vec3u) {
    march = bound_march;
    floor_map = bound_floor_map;
    let id = global.xy + floor_map.first_texel;
    if (any(id >= vec2u(floor_map.size))) {
        return;
    }
    let place = floor_map.origin + floor_map.along_x * f32(id.x) + floor_map.along_y * f32(id.y);
    let p = vec4f(place, 1.0);
    let across = vec2f(dot(floor_map.light_from_scene_x, p), dot(floor_map.light_from_scene_y, p));
    let spread = 1.0 + dot(floor_map.light_from_scene_z, p) * march.frame.inverse_distance;
    let limit = spread / max(march.frame.inverse_distance * march.frame.pitch, 1e-20);
    let is_owned = spread > 1e-3 && (all(abs(across) <= vec2f(limit)) | (floor_map.cube_face == 0u));
    // From above.
    let is_lit = dot(floor_map.up, floor_map.place - place * floor_map.perspective) > 0.0;
    let pixel = across / max(spread, 1e-3) - floor_map.first_pixel;
    let low = floor(pixel);
    let f = pixel - low;
    let near = mix(behind(low), behind(low + vec2f(1.0, 0.0)), f.x);
    let far = mix(behind(low + vec2f(0.0, 1.0)), behind(low + vec2f(1.0, 1.0)), f.x);
    let at = id.y * floor_map.size + id.x;
    var missing = select(0.0, 1.0 - select(0.0, mix(near, far, f.y), is_lit), is_owned);
    if (!IS_FIRST) {
        missing += sums[at];
    }
    if (IS_LAST) {
        textureStore(shadow, vec3u(id, 0u), vec4f(1.0 - missing * floor_map.share));
    } else {
        sums[at] = missing;
    }
}
