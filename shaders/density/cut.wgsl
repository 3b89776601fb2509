// Crop box and clip plane (crates/volume/src/math/clip_region.rs): region of the volume that remains, and the part of
// each slab of a ray inside it.
#import "density/boundaries.wgsl"
#import "sheets/sheet_frame.wgsl"

// Set if the crop box or the clip plane removes anything.
override CUT: bool = false;

// Region that remains, in index space.
struct CutUniform {
    low: vec3f,
    pad0: f32,
    high: vec3f,
    pad1: f32,
    // Normal and offset: points with dot(plane.xyz, p) <= plane.w remain.
    plane: vec4f,
}

// Depths at which a ray enters and leaves the region; if it misses the region, the first is larger.
fn span_within(cut: CutUniform, ray: Ray) -> vec2f {
    let along = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), along);
    let a = (cut.low - ray.origin) / direction;
    let b = (cut.high - ray.origin) / direction;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    // Clip plane: depth of the ray's origin behind it, and speed towards it.
    let depth = cut.plane.w - dot(cut.plane.xyz, ray.origin);
    let speed = dot(cut.plane.xyz, ray.direction);
    let is_along = abs(speed) < 1e-12;
    let met = depth / select(speed, 1e-12, is_along);
    let enters = speed < 0.0 && !is_along;
    return vec2f(select(enter, max(enter, met), enters), select(min(leave, met), leave, enters));
}

// Fraction of a slab around `depth` inside the span; exactly 1 where nothing is cut.
fn slab_fraction_inside(span: vec2f, depth: f32, slab: f32) -> f32 {
    if (!CUT) {
        return 1.0;
    }
    let before = clamp((span.x - depth) / slab + 0.5, 0.0, 1.0);
    let behind = clamp((depth - span.y) / slab + 0.5, 0.0, 1.0);
    return max(1.0 - before - behind, 0.0);
}

// Depth below a face, in voxels, over which extinction for light fades in: a light volume cannot represent a step
// within a voxel, which would show as a pattern on the face.
const FADE_DEPTH_VOXELS = 2.0;

// Fraction of the material at a point that attenuates light: smoothly from 0 at the faces to 1.
fn shading_fraction(cut: CutUniform, p: vec3f) -> f32 {
    if (!CUT) {
        return 1.0;
    }
    let inside = smoothstep(vec3f(0.0), vec3f(FADE_DEPTH_VOXELS), p - cut.low) * smoothstep(vec3f(0.0), vec3f(FADE_DEPTH_VOXELS), cut.high - p);
    let behind = smoothstep(0.0, FADE_DEPTH_VOXELS, cut.plane.w - dot(cut.plane.xyz, p));
    return inside.x * inside.y * inside.z * behind;
}

// Restricts a range of slabs (first and last) to those that can overlap the span.
fn slabs_within(frame: SheetFrameUniform, span: vec2f, slabs: vec2i) -> vec2i {
    if (!CUT) {
        return slabs;
    }
    let ends = (span - frame.first_depth) / frame.slab;
    let last = f32(frame.slab_count);
    let within = vec2i(floor(clamp(ends, vec2f(0.0, -1.0), vec2f(last))));
    return vec2i(max(slabs.x, within.x), min(slabs.y, within.y));
}

// Whether a point lies inside the region.
fn is_inside_cut(cut: CutUniform, p: vec3f) -> bool {
    return !CUT || (all(p >= cut.low) && all(p <= cut.high) && dot(cut.plane.xyz, p) <= cut.plane.w);
}

// Cubic B-spline at a distance from its centre, in voxels.
fn blurred_edge(distance: f32) -> f32 {
    let d = abs(distance);
    let near = 2.0 / 3.0 - d * d * (1.0 - 0.5 * d);
    let far = (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0;
    return select(select(0.0, far, d < 2.0), near, d < 1.0);
}

// Gradient, in index space, of the faces at which data end or are cut: that of a solid that ends there, reconstructed
// with a B-spline stretched 2^level times. Data behind the face would only add noise to its direction, and there are
// none outside the grid.
fn face_gradient(cut: CutUniform, p: vec3f, level: f32) -> vec3f {
#if FACES
#else
    if (!CUT) {
        return vec3f(0.0);
    }
#endif
    let width = exp2(level);
    let nearest = min(p - cut.low, cut.high - p);
    let behind = select(1e9, cut.plane.w - dot(cut.plane.xyz, p), CUT);
    // Almost everywhere no face is near.
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
