// Adaptive slabs along a ray: a slab is half as thick as the step of four of the frame's slabs, and halved where it may
// contribute much of the visible light, because density bends within it. Slabs are shaded together, up to a step of
// them, until what they show is much: light is sampled once for each such segment.
#import "density/cells.wgsl"
#import "eye/slab_faces.wgsl"

// Number of the frame's slabs in a step, and in an undivided slab; powers of two.
const STEP_SLABS = 4;
const UNDIVIDED_SLABS = 2;

// First face of the next step, from face `first` on, that reaches into a cell that may be visible. `walk` counts faces
// in place of slabs.
fn next_step(walk: CellRay, first: i32, last: i32) -> i32 {
    let face = next_visible_slab(walk, first, last);
    return select(max(face - 1, first) & ~(STEP_SLABS - 1), face, face > last);
}

// Depth of face k; faces beyond a cut lie in it.
fn face_depth(span: vec2f, k: i32) -> f32 {
    let depth = eye.frame.first_depth + f32(k) * eye.frame.slab;
    if (!CUT) {
        return depth;
    }
    return clamp(depth, span.x, max(span.x, span.y));
}

// Largest extinction of the field between two values.
fn extinction_bound(a: FaceValue, b: FaceValue) -> f32 {
    return largest_extinction(min(density_of(a), density_of(b)), max(density_of(a), density_of(b)));
}

// Face that the next turn of the inner loop samples: in front of a step, at the end of a slab, or in its middle.
const SAMPLE_FIRST = 0;
const SAMPLE_END = 1;
const SAMPLE_MIDDLE = 2;

// Colour and transmittance of a ray between two slabs of the frame, `inside.x` to `inside.y`.
fn adaptive_slabs(ray: Ray, span: vec2f, inside: vec2i) -> RayResult {
    let middles = cell_ray(eye.frame, ray);
    let walk = CellRay(middles.origin - 0.5 * middles.step, middles.step, middles.inverse);
    let last = inside.y + 1;
    var k = next_step(walk, inside.x & ~(STEP_SLABS - 1), last);
    // State of the face at k.
    var is_known = false;
    var is_lit = false;
    var front: SlabFace;
    var light: FaceLight;
    var color = vec3f(0.0);
    var t = 1.0;
    // Software drivers run a loop's body to its end before they test if any lane is active, so breaks are placed at
    // the end, not in the middle.
    loop {
        if (k >= last) {
            break;
        }
        var sum = SlabSum(0.0, 0.0, 0.0, FaceValue(0.0));
        var begin = front;
        var back: SlabFace;
        var task = select(SAMPLE_FIRST, SAMPLE_END, is_known);
        var end = k + STEP_SLABS;
        // Next segment with material. All lanes of a vector wait for the slowest, but shading takes as long as several
        // samples.
        loop {
            let ahead = select(select(1, UNDIVIDED_SLABS, task == SAMPLE_END), 0, task == SAMPLE_FIRST);
            let found = face_at(ray, face_depth(span, k + ahead));
            if (task == SAMPLE_FIRST) {
                front = found;
                begin = found;
                task = SAMPLE_END;
            } else {
                var is_complete = true;
                if (task == SAMPLE_END) {
                    back = found;
                    let length = (found.depth - front.depth) * ray.obliquity;
                    let opacity = 1.0 - exp(-extinction_bound(front.value, found.value) * length);
                    is_complete = t * (1.0 - sum.opacity) * opacity <= eye.max_undivided_share;
                }
                // One piece of code adds a whole slab or both halves of one. Two branches would take twice the time on
                // software drivers, which run both of them for all lanes.
                let is_halved = task == SAMPLE_MIDDLE;
                task = select(SAMPLE_MIDDLE, SAMPLE_END, is_complete);
                if (is_complete) {
                    sum = with_slab(sum, front, found, ray.obliquity, 1.0);
                    sum = with_slab(sum, found, back, ray.obliquity, select(0.0, 1.0, is_halved));
                    front = back;
                    k += UNDIVIDED_SLABS;
                }
            }
            if ((k & (STEP_SLABS - 1)) == 0 && task == SAMPLE_END && sum.depth <= EMPTY_OPTICAL_DEPTH) {
                let next = next_step(walk, k, last);
                task = select(SAMPLE_FIRST, SAMPLE_END, next == k);
                begin = front;
                is_lit = false;
                k = next;
                end = k + STEP_SLABS;
            }
            let is_much = task == SAMPLE_END && t * sum.opacity > eye.max_undivided_share;
            if (k >= end || k >= last || is_much) {
                break;
            }
        }
        let is_visible = sum.depth > EMPTY_OPTICAL_DEPTH;
        if (is_visible) {
            var front_light = light;
            // Light in front of the segment, if it is the first, and behind it. As a loop, because software drivers run
            // the body of a branch for lanes that do not take it: lanes that know the light in front turn once.
            var is_behind = is_lit;
            loop {
                var face = begin;
                if (is_behind) {
                    face = front;
                }
                light = face_light(ray, face);
                if (is_behind) {
                    break;
                }
                front_light = light;
                is_behind = true;
            }
            color += t * sum.opacity * shade_segment(ray, begin.depth, front.depth, front_light, light, sum);
        }
        t *= 1.0 - sum.opacity;
        var next = k;
        if ((k & (STEP_SLABS - 1)) == 0) {
            next = next_step(walk, k, last);
        }
        is_known = next == k;
        is_lit = is_visible && is_known;
        k = next;
        if (t < eye.min_transmittance || k >= last) {
            break;
        }
    }
    return RayResult(color, t);
}
