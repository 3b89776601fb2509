// Pre-integrated slabs: opacity is integrated through steps from the densities at both ends (Engel, Kraus and Ertl,
// "High-quality pre-integrated volume rendering using hardware-accelerated pixel shading", 2001), and steps are
// shaded in layers: several together, where along the ray their opacity lies. So the look of thin structures hardly
// depends on where samples hit them. The frame's slabs are as thick as steps; a step reaches from the middle of one
// slab to that of the next.
#import "density/cells.wgsl"
#import "density/slab_material.wgsl"

// Maximum number of steps in a layer: two slabs. A step is cheap compared with shading.
const LAYER_STEPS = 4;

// Optical depth of the last step below which a layer ends one step earlier: light varies little within a surface that
// is opaque after a voxel, and more within softer material.
const SOFT_OPTICAL_DEPTH = 0.5;

// Share of the ray from which the steps of a layer are counted: 16 of 255, too little to be shaded separately.
const MIN_COUNTED_SHARE = 0.0625;

// End point of a step.
struct StepEnd {
    density: f32,
    // Position of the density in the table.
    entry: f32,
    // Integral of extinction up to that position.
    integral: f32,
    // Presence at the point.
    presence: f32,
}

fn step_end(ray: Ray, k: i32) -> StepEnd {
    let depth = depth_of(eye.frame, f32(k));
    let p = ray.origin + ray.direction * depth;
    let level = kernel_level(eye.frame, depth);
    let found = field_at(p, level);
    let entry = table_position(found.density);
    return StepEnd(found.density, entry, extinction_integral(entry), presence_at(p, level));
}

// Steps that are shaded together.
struct Layer {
    // Contribution of the layer to the ray: its opacity behind all previous layers.
    share: f32,
    // Sum of contributions times positions, in slabs of the frame.
    places: f32,
    // Sum of contributions times densities.
    densities: f32,
    // Transmittance of the ray behind the layer.
    transmittance: f32,
    // Optical depth of the last step.
    last_depth: f32,
}

// Opacity-weighted mean depth in homogeneous material of optical depth τ, relative to its thickness: 1/τ − 1/(e^τ −
// 1), within 0.011.
fn mean_depth_fraction(tau: f32) -> f32 {
    return (6.0 + tau) / (12.0 + tau * (4.0 + tau));
}

// Adds a step from k to the next to a layer; density is linear along it, and `length` is the length of the ray in it.
fn with_step(layer: Layer, a: StepEnd, b: StepEnd, k: i32, length: f32) -> Layer {
    let middle = 0.5 * (a.density + b.density);
    let entry = 0.5 * (a.entry + b.entry);
    let integral = extinction_integral(entry);
    let half = entry - a.entry;
    // Integrals are linear between entries, and differences of nearby ones are dominated by rounding.
    let is_even = abs(half) < 1.0;
    let per_half = 1.0 / select(half, 1.0, is_even);
    let alike = nearest_extinction(Field(middle));
    let present_length = 0.25 * length * (a.presence + b.presence);
    let front = present_length * select((integral - a.integral) * per_half, alike, is_even);
    let back = present_length * select((b.integral - integral) * per_half, alike, is_even);
    let behind_front = layer.transmittance * exp(-front);
    let behind_back = behind_front * exp(-back);
    let by_front = layer.transmittance - behind_front;
    let by_back = behind_front - behind_back;
    let place = f32(k);
    return Layer(
        layer.share + by_front + by_back,
        layer.places + by_front * (place + 0.5 * mean_depth_fraction(front)) + by_back * (place + 0.5 + 0.5 * mean_depth_fraction(back)),
        layer.densities + by_front * 0.5 * (a.density + middle) + by_back * 0.5 * (middle + b.density),
        behind_back,
        front + back,
    );
}

// Colour and transmittance of a ray between two slabs of the frame, `inside.x` to `inside.y`.
fn preintegrated_slabs(ray: Ray, span: vec2f, inside: vec2i) -> RayResult {
    let walk = cell_ray(eye.frame, ray);
    // A cut volume may end behind the middle of the last slab.
    let last = inside.y + select(0, 1, CUT);
    let step_length = eye.frame.slab * ray.obliquity;
    // Steps begin at the slab before the first that may be visible.
    var k = next_visible_slab(walk, inside.x, last) - 1;
    var before = StepEnd(0.0, 0.0, 0.0, 0.0);
    // Set while the density of slab k is unknown.
    var has_skipped = true;
    var color = vec3f(0.0);
    var t = 1.0;
    loop {
        if (k >= last) {
            break;
        }
        var layer = Layer(0.0, 0.0, 0.0, t, 0.0);
        var steps = 0;
        // All lanes of a vector wait for the slowest, but shading takes as long as several steps.
        loop {
            let at = select(k + 1, k, has_skipped);
            let end = step_end(ray, at);
            let slab = eye.frame.slab;
            let depth = depth_of(eye.frame, f32(at) - 0.5);
            let length = select(step_length, 0.0, has_skipped) * slab_fraction_inside(span, depth, slab);
            layer = with_step(layer, before, end, at - 1, length);
            let is_empty = layer.last_depth < EMPTY_OPTICAL_DEPTH;
            steps += select(0, 1, layer.share > MIN_COUNTED_SHARE);
            k = at;
            before = end;
            let visible = next_visible_slab(walk, k + 1, last);
            has_skipped = is_empty && visible > k + 1;
            k = select(k, visible - 1, has_skipped);
            // Material behind a gap is shaded separately.
            let is_whole = steps >= select(LAYER_STEPS, LAYER_STEPS - 1, layer.last_depth < SOFT_OPTICAL_DEPTH);
            if (is_whole || layer.transmittance < eye.min_transmittance || k >= last || (is_empty && layer.share > 0.0)) {
                break;
            }
        }
        t = layer.transmittance;
        if (layer.share > 0.0) {
            let depth = depth_of(eye.frame, layer.places / layer.share);
            let field = Field(layer.densities / layer.share);
            let p = ray.origin + ray.direction * depth;
            let level = kernel_level(eye.frame, depth);
            let slope = gradient_to_scene(eye.space, gradient_at(p, level));
            let found = SlabSample(material_of(field), field, 1.0);
            color += layer.share * shade_material(p, level, slope, presence_gradient(p, level), found);
        }
        if (t < eye.min_transmittance) {
            break;
        }
    }
    return RayResult(color, t);
}
