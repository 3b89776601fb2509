// Eye pass (P §2, §3.5, eq. 9): one thread per pixel walks through the eye's sheets front to back, sums density,
// classifies it, shades it with attenuated light and composites.
//
// The result is linear, premultiplied and not yet tone-mapped.
#import "common/sizes.wgsl"
#import "density/classify.wgsl"
#import "shading/shadow_ray.wgsl"
#import "shading/shade.wgsl"
#import "shading/near_light.wgsl"
#import "density/kernel_gradient.wgsl"
#import "sheets/tiles.wgsl"
#import "eye/slabs_by_need.wgsl"
#import "eye/preintegrated_slabs.wgsl"

// r: distance to the nearest cell that is visible to the eye.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba32float, write>;
// For rays to lights: g is the distance in cells to the nearest that attenuates light.
@group(0) @binding(5) var light_distances: texture_3d<f32>;

// DIRECT: rays to the lights are cast instead of looking up volumes (P §3.3). SHEET_GRADIENTS: gradients are
// differences of neighbouring sheets.
override SHEET_GRADIENTS: bool = false;
// BY_NEED: slabs are subdivided by need (slabs_by_need.wgsl). PREINTEGRATED: opacity is integrated through steps,
// several of which are shaded together (preintegrated_slabs.wgsl).

// Extinction of slab k for rays to lights.
fn ray_extinction(frame: SheetFrame, ray: Ray, k: f32) -> Left {
#if PRECLASSIFY
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    return met_extinction(0.5 * (lighting_density(ray.origin + ray.direction * (depth - offset), 0.0)
        + lighting_density(ray.origin + ray.direction * (depth + offset), 0.0)));
#else
    return met_extinction(slab_density(frame, ray, k));
#endif
}

fn light_distance(cell: vec3f) -> i32 {
    return near(light_distances, cell).y;
}

fn attenuation_at(light: Light, volume: texture_3d<f32>, surface: Surface, towards: Towards) -> Left {
#if DIRECT
    let p = biased(surface, towards);
    let s = eye.shading;
    let cut = eye.shading_cut;
    var sum = Left(0.0);
    for (var i = 0u; i < light.points; i += 1u) {
        let one = point_of(light, i);
        let way = to_light(one, surface.position);
        let direction = to_index(eye.space, way.direction);
        let reach = way.distance - s.bias;
        sum += shadow_ray(p, direction, reach, s.ray_step, light.extinction_scale, s.dark_depth, cut)
            * hood_share(one, way.direction);
    }
    return sum / f32(light.points);
#else
    return near_or_looked_up(light, volume, surface, towards);
#endif
}

// Value of a sheet at a pixel; 0 before the first slab and behind the last.
fn sheet(pixel: vec2f, k: f32) -> f32 {
    let inside = k >= 0.0 && k < f32(eye.frame.slab_count);
    return select(0.0, slab_density(eye.frame, ray_of(eye.frame, pixel), k), inside);
}

// Differences between neighbouring sheets and their pixels, as an engine that stores only sheets has them
// (scatter/eye.wgsl).
fn gradient_between_sheets(pixel: vec2f, k: f32) -> vec3f {
    let last = vec2f(eye.frame.size - 1u);
    let reach = f32(eye.gradient_pixels);
    let low = max(pixel - reach, vec2f(0.0));
    let high = min(pixel + reach, last);
    let across = (sheet(vec2f(high.x, pixel.y), k) - sheet(vec2f(low.x, pixel.y), k)) / max(high.x - low.x, 1.0);
    let down = (sheet(vec2f(pixel.x, high.y), k) - sheet(vec2f(pixel.x, low.y), k)) / max(high.y - low.y, 1.0);
    let slabs = f32(eye.gradient_slabs);
    let deep = (sheet(pixel, k + slabs) - sheet(pixel, k - slabs)) / (2.0 * slabs * eye.frame.slab);
    return gradient_of_sheets(pixel, depth_of(eye.frame, k), vec3f(across, down, deep), vec3f(0.0));
}

// Light from the material of slab k, where the ray crosses it.
fn shaded(ray: Ray, pixel: vec2u, k: i32, found: SlabSample) -> vec3f {
    let depth = depth_of(eye.frame, f32(k));
    let p = ray.origin + ray.direction * depth;
    let level = kernel_level(eye.frame, depth);
    let rising = presence_slope(p, level);
    if (SHEET_GRADIENTS) {
        return lit_material(p, level, gradient_between_sheets(vec2f(pixel), f32(k)), rising, found);
    }
    return lit_material(p, level, gradient_to_scene(eye.space, slope_at(p, level)), rising, found);
}

// Light from material with the gradient `volume_slope` in scene space; `rising` is the gradient of presence.
fn lit_material(p: vec3f, level: f32, volume_slope: vec3f, rising: vec3f, found: SlabSample) -> vec3f {
    let slope = volume_slope + face_slope(p, level, found.density, rising);
    return shade(Sampled(p, slope, found.density, level), found.material.rgb);
}

// Next slab, from `first` on, in a cell that may be visible; beyond the last if there is none.
fn next_seen(walk: Walk, first: i32, last: i32) -> i32 {
    var k = first;
    loop {
        if (k > last) {
            break;
        }
        let cell = cell_at(walk, k);
        let empty = near(distances, cell).x - grid.dilation;
        if (empty <= 0) {
            break;
        }
        k = leap(walk, k, cell, empty);
    }
    return k;
}

// Sample of a slab centred at slab k and `width` times as thick, reduced to the part inside the cut.
fn slab_seen(ray: Ray, span: vec2f, k: f32, width: f32) -> SlabSample {
    var found = slab_sample(eye.frame, ray, k);
    found.material.a *= share_within(span, depth_of(eye.frame, k), width * eye.frame.slab);
    return found;
}

struct Sample {
    k: i32,
    found: SlabSample,
}

// Next slab, from `first` on, with visible material. Stretched kernels are sampled far around visible cells, and
// mostly find nothing: the search continues until they do, although all lanes of a vector wait for the slowest. For
// unstretched kernels the search would take longer than shading the few empty samples.
fn next_sample(ray: Ray, walk: Walk, span: vec2f, first: i32, last: i32) -> Sample {
    var at = Sample(next_seen(walk, first, last), SlabSample(vec4f(0.0), 0.0, 1.0));
    if (STRETCH) {
        loop {
            if (at.k > last) {
                break;
            }
            at.found = slab_seen(ray, span, f32(at.k), 1.0);
            if (at.found.material.a > 0.0) {
                break;
            }
            at.k = next_seen(walk, at.k + 1, last);
            if (at.k > last) {
                break;
            }
        }
    }
    return at;
}

// Result of a ray.
struct Seen {
    // Linear, premultiplied colour.
    color: vec3f,
    // Remaining transmittance of the ray.
    left: f32,
}

fn even_slabs(ray: Ray, span: vec2f, inside: vec2i, pixel: vec2u) -> Seen {
    let walk = walk_along(eye.frame, ray);
    var at = next_sample(ray, walk, span, inside.x, inside.y);
    var color = vec3f(0.0);
    var t = 1.0;
    // Software drivers run a loop's body to its end before they test if any lane is active, so breaks are placed at
    // the end, not in the middle.
    loop {
        if (at.k > inside.y) {
            break;
        }
        if (!STRETCH) {
            at.found = slab_seen(ray, span, f32(at.k), 1.0);
        }
        if (at.found.material.a > 0.0) {
            let passed = exp(-at.found.material.a * eye.frame.slab * ray.obliquity);
            let weight = t * (1.0 - passed);
            color += weight * shaded(ray, pixel, at.k, at.found);
            t *= passed;
        }
        if (t < eye.dark) {
            break;
        }
        at = next_sample(ray, walk, span, at.k + 1, inside.y);
        if (at.k > inside.y) {
            break;
        }
    }
    return Seen(color, t);
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    eye = bound_eye;
    grid = bound_grid;
    let pixel = tile_of(group, groups.y, eye.runs) * TILE_EDGE + in_tile(local.xy) + vec2u(0u, eye.first_row);
    if (pixel.x >= eye.frame.size.x || pixel.y >= eye.end_row) {
        return;
    }
    let ray = ray_of(eye.frame, vec2f(pixel));
    let span = span_within(eye.seen, ray);
    let inside = slabs_within(eye.frame, span, slabs_inside(eye.frame, ray));
#if BY_NEED
    let seen = slabs_by_need(ray, span, inside);
#else
#if PREINTEGRATED
    let seen = preintegrated_slabs(ray, span, inside);
#else
    let seen = even_slabs(ray, span, inside, pixel);
#endif
#endif
    textureStore(picture, pixel, vec4f(seen.color, 1.0 - seen.left));
}
