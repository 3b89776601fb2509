// What is left of the volume after the crop box and the clip plane (src/math/region.rs): of every slab a
// ray meets, the part that lies within.
#import "sheets/sheet_frame.wgsl"

// Whether anything is cut at all.
override CUT: bool = false;

// In index space.
struct Cut {
    low: vec3f,
    pad0: f32,
    high: vec3f,
    pad1: f32,
    // Normal and offset: points with dot(plane.xyz, p) <= plane.w remain.
    plane: vec4f,
}

// Depths at which a ray enters what remains, and leaves it; if it never does, the first is larger.
fn span_within(cut: Cut, ray: Ray) -> vec2f {
    let along = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), along);
    let a = (cut.low - ray.origin) / direction;
    let b = (cut.high - ray.origin) / direction;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    // The plane: how deep within it the ray begins, and how fast it gets out.
    let depth = cut.plane.w - dot(cut.plane.xyz, ray.origin);
    let speed = dot(cut.plane.xyz, ray.direction);
    let is_along = abs(speed) < 1e-12;
    let met = depth / select(speed, 1e-12, is_along);
    let enters = speed < 0.0 && !is_along;
    return vec2f(select(enter, max(enter, met), enters), select(min(leave, met), leave, enters));
}

// The share of a slab around `depth` that lies within; exactly 1 where nothing is cut.
fn share_within(span: vec2f, depth: f32, slab: f32) -> f32 {
    if (!CUT) {
        return 1.0;
    }
    let before = clamp((span.x - depth) / slab + 0.5, 0.0, 1.0);
    let behind = clamp((depth - span.y) / slab + 0.5, 0.0, 1.0);
    return max(1.0 - before - behind, 0.0);
}

// How far below a face, in voxels, material begins to attenuate light, and where it does so fully: a light
// volume cannot hold a step within a voxel, which would show as a pattern on the face.
const SKIN = 2.0;

// The share of the material at a point that attenuates light: softly from nothing at the faces to all.
fn share_that_shades(cut: Cut, p: vec3f) -> f32 {
    if (!CUT) {
        return 1.0;
    }
    let inside = smoothstep(vec3f(0.0), vec3f(SKIN), p - cut.low) * smoothstep(vec3f(0.0), vec3f(SKIN), cut.high - p);
    let behind = smoothstep(0.0, SKIN, cut.plane.w - dot(cut.plane.xyz, p));
    return inside.x * inside.y * inside.z * behind;
}

// Those of some slabs, first and last, of which any part can lie within.
fn slabs_within(frame: SheetFrame, span: vec2f, slabs: vec2i) -> vec2i {
    if (!CUT) {
        return slabs;
    }
    let ends = (span - frame.first_depth) / frame.slab;
    let last = f32(frame.slab_count);
    let within = vec2i(floor(clamp(ends, vec2f(0.0, -1.0), vec2f(last))));
    return vec2i(max(slabs.x, within.x), min(slabs.y, within.y));
}

// Whether a point lies within.
fn is_within(cut: Cut, p: vec3f) -> bool {
    return !CUT || (all(p >= cut.low) && all(p <= cut.high) && dot(cut.plane.xyz, p) <= cut.plane.w);
}

// The cubic B-spline, so far from its middle.
fn blurred_edge(distance: f32) -> f32 {
    let d = abs(distance);
    let near = 2.0 / 3.0 - d * d * (1.0 - 0.5 * d);
    let far = (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0;
    return select(select(0.0, far, d < 2.0), near, d < 1.0);
}

// The gradient, in index space, that faces have of their own where data end or are cut: that of something solid which
// ends there, reconstructed with a B-spline stretched 2^level times. Data behind the face would only give it the
// direction of their noise, and there are none beyond the grid.
fn face_gradient(cut: Cut, p: vec3f, level: f32) -> vec3f {
#if FACES
#else
    if (!CUT) {
        return vec3f(0.0);
    }
#endif
    let width = exp2(level);
    let nearest = min(p - cut.low, cut.high - p);
    let behind = select(1e9, cut.plane.w - dot(cut.plane.xyz, p), CUT);
    // Nearly everywhere no face is near.
    if (min(min(nearest.x, nearest.y), min(nearest.z, behind)) >= 2.0 * width) {
        return vec3f(0.0);
    }
    let below = (p - cut.low) / width;
    let above = (cut.high - p) / width;
    let depth = behind / width;
    let faces = vec3f(
        blurred_edge(below.x) - blurred_edge(above.x),
        blurred_edge(below.y) - blurred_edge(above.y),
        blurred_edge(below.z) - blurred_edge(above.z),
    );
    return (faces - cut.plane.xyz * blurred_edge(depth)) / width;
}
