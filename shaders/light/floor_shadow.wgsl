// Floor shadow map of an area light: for each texel the transmittance behind the last slab of a view of the light,
// averaged over its points. The sum is that of the missing light, which is 0 away from the sheets, so that only the
// first and the last view have to visit the whole map.
#import "sheets/march.wgsl"
#import "shading/point_weights.wgsl"

struct FloorShadowUniform {
    // Centre of texel (0, 0), and the steps to the next texel along both edges, in scene space.
    origin: vec3f,
    size: u32,
    along_x: vec3f,
    // One over the number of points on the light.
    share: f32,
    along_y: vec3f,
    // 1 if the view is a cube face, which covers only the quarter-space around its axis.
    cube_face: u32,
    // Normal of the floor, in scene space.
    up: vec3f,
    perspective: f32,
    // Unit direction towards a parallel light, or position of a perspective one, in scene space.
    place: vec3f,
    pad0: f32,
    // Place of the centre of the light; vectors from there to its right and its upper border, and in w the coordinate
    // of the point between the centre and the border.
    centre: vec4f,
    right: vec4f,
    top: vec4f,
    // Scene space to light axes at the anchor, x and y in pixels of the anchor plane, z in scene units: three rows of
    // an affine map.
    light_from_scene_x: vec4f,
    light_from_scene_y: vec4f,
    light_from_scene_z: vec4f,
    first_pixel: vec2f,
    // First texel of this dispatch.
    first_texel: vec2u,
}

@group(0) @binding(1) var<uniform> bound_floor_map: FloorShadowUniform;
var<private> floor_map: FloorShadowUniform;
// Missing light, summed over the previous views.
@group(0) @binding(2) var<storage, read_write> sums: array<f32>;
@group(0) @binding(5) var shadow: texture_storage_3d<STORAGE_FORMAT, write>;

// Flags for the first and the last view of all points.
override IS_FIRST: bool = true;
override IS_LAST: bool = true;

// Transmittance behind the last slab; beside the sheets light is not attenuated.
fn transmittance_behind(pixel: vec2f) -> f32 {
    let size = vec2f(march.frame.size);
    let is_inside = all(pixel >= vec2f(0.0)) && all(pixel < size);
    let at = vec2u(clamp(pixel, vec2f(0.0), size - 1.0));
    return select(cone_light(pixel), transmittance[at.y * march.frame.size.x + at.x], is_inside);
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
    // Lit from above only.
    let is_lit = dot(floor_map.up, floor_map.place - place * floor_map.perspective) > 0.0;
    let pixel = across / max(spread, 1e-3) - floor_map.first_pixel;
    let low = floor(pixel);
    let f = pixel - low;
    let near = mix(transmittance_behind(low), transmittance_behind(low + vec2f(1.0, 0.0)), f.x);
    let far = mix(transmittance_behind(low + vec2f(0.0, 1.0)), transmittance_behind(low + vec2f(1.0, 1.0)), f.x);
    let at = id.y * floor_map.size + id.x;
    var missing = select(0.0, 1.0 - select(0.0, mix(near, far, f.y), is_lit), is_owned);
    let towards = floor_map.centre.xyz - place * floor_map.perspective;
    let right = floor_map.right;
    let top = floor_map.top;
    let slope = weight_slope(towards, right.xyz, top.xyz, floor_map.up, 1.0);
    missing *= 1.0 + dot(slope, right.xyz * right.w + top.xyz * top.w);
    if (!IS_FIRST) {
        missing += sums[at];
    }
    if (IS_LAST) {
        textureStore(shadow, vec3u(id, 0u), vec4f(1.0 - missing * floor_map.share));
    } else {
        sums[at] = missing;
    }
}
