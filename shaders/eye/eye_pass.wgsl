// Eye pass (P §2, §3.5, eq. 9): one thread per pixel walks through the eye's sheets front to back, sums density,
// classifies it, shades it with attenuated light and composites: along the ray through its middle, or along one of
// several in pixels with edges, which edges.wgsl has listed. One pipeline does both, since compiling another would take
// longer than most edges; and each dispatch has one ray, since a loop around it costs a tenth of the time.
//
// The result is linear, premultiplied and not yet tone-mapped.
#import "common/sizes.wgsl"
#import "density/slab_material.wgsl"
#import "shading/shadow_ray.wgsl"
#import "shading/integrated_ray.wgsl"
#import "shading/shade.wgsl"
#import "shading/near_light.wgsl"
#import "density/kernel_gradient.wgsl"
#import "sheets/tiles.wgsl"
#import "eye/adaptive_slabs.wgsl"
#import "eye/preintegrated_slabs.wgsl"
#import "eye/projection.wgsl"

// r: distance to the nearest cell that is visible to the eye.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba32float, write>;
// Workgroups for the pixels with edges, their number, and each with its column in the low half and its row in the high.
@group(0) @binding(4) var<storage, read> edge_list: array<u32>;
// For rays to lights: g is the distance in cells to the nearest that attenuates light.
@group(0) @binding(5) var light_distances: texture_3d<f32>;
@group(0) @binding(6) var<uniform> bound_pixel_ray: PixelRayUniform;
var<private> pixel_ray: PixelRayUniform;
// Weighted sum of the rays of earlier dispatches.
@group(0) @binding(7) var earlier: texture_2d<f32>;

struct PixelRayUniform {
    // Place of the ray in pixels right and down of the middle (xy), shift of its slabs in scene units (z), and weight.
    place: vec4f,
    // 1 if only the listed pixels are drawn.
    is_listed: u32,
    // 1 if the ray is added to earlier ones.
    is_added: u32,
    pad0: u32,
    pad1: u32,
}

#option DIRECT: rays to the lights are cast instead of looking up volumes (P §3.3)
#option BY_NEED: slabs are integrated between their faces, and halved by need (adaptive_slabs.wgsl)
#option PREINTEGRATED: opacity is integrated through steps that are shaded together (preintegrated_slabs.wgsl)

// Takes gradients from differences of neighbouring sheets.
override SHEET_GRADIENTS: bool = false;

fn slab_ray_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    return slab_lighting_presence(frame, ray, k);
}

// Extinction of slab k for rays to lights.
fn ray_extinction(frame: SheetFrameUniform, ray: Ray, k: f32) -> Transmittance {
#if PRECLASSIFY
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    return lighting_extinction(0.5 * (lighting_field(ray.origin + ray.direction * (depth - offset), 0.0)
        + lighting_field(ray.origin + ray.direction * (depth + offset), 0.0)));
#else
    return lighting_extinction(slab_field(frame, ray, k));
#endif
}

fn light_distance(cell: vec3f) -> i32 {
    return cell_distances(light_distances, cell).y;
}

// Field for rays towards lights, with the kernel of the eye.
fn sharp_lighting_field(p: vec3f, level: f32) -> LightingField {
#if PRECLASSIFY
    return lighting_field(p, level);
#else
    return field_at(p, level);
#endif
}

fn attenuation_at(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
#if DIRECT
    let p = biased_point(surface, towards);
    let s = eye.shading;
    let cut = eye.shading_cut;
    let centre = to_light(light, surface.position).direction;
    let slope = point_slope(light, surface.position, surface.normal, surface.surfaceness);
    var sum = Transmittance(0.0);
    var weights = 0.0;
    for (var i = 0u; i < light.points; i += 1u) {
        let one = area_light_point(light, i);
        let way = to_light(one, surface.position);
        let direction = index_from_scene_vector(eye.space, way.direction);
        let reach = way.distance - s.bias;
#if BY_NEED
        let passed = integrated_ray(p, direction, reach, s.ray_step, light.extinction_scale, s.max_optical_depth, cut);
#else
        let passed = shadow_ray(p, direction, reach, s.ray_step, light.extinction_scale, s.max_optical_depth, cut);
#endif
        let weight = point_weight(slope, centre, way.direction);
        sum += passed * (weight * cone_attenuation(one, way.direction));
        weights += weight;
    }
    return sum / weights;
#else
    return shadowed_light(light, volume, surface, towards);
#endif
}

// Value of a sheet at a pixel; 0 before the first slab and behind the last.
fn sheet_value(pixel: vec2f, k: f32) -> f32 {
    let inside = k >= 0.0 && k < f32(eye.frame.slab_count);
    return select(0.0, slab_field(eye.frame, ray_of(eye.frame, pixel), k).density, inside);
}

// Differences between neighbouring sheets and their pixels, as an engine that stores only sheets has them
// (scatter/eye.wgsl).
fn gradient_between_sheets(pixel: vec2f, k: f32) -> vec3f {
    let last = vec2f(eye.frame.size - 1u);
    let reach = f32(eye.gradient_pixels);
    let low = max(pixel - reach, vec2f(0.0));
    let high = min(pixel + reach, last);
    let across = (sheet_value(vec2f(high.x, pixel.y), k) - sheet_value(vec2f(low.x, pixel.y), k)) / max(high.x - low.x, 1.0);
    let down = (sheet_value(vec2f(pixel.x, high.y), k) - sheet_value(vec2f(pixel.x, low.y), k)) / max(high.y - low.y, 1.0);
    let slabs = f32(eye.gradient_slabs);
    let deep = (sheet_value(pixel, k + slabs) - sheet_value(pixel, k - slabs)) / (2.0 * slabs * eye.frame.slab);
    return gradient_of_sheets(pixel, depth_of(eye.frame, k), vec3f(across, down, deep), vec3f(0.0));
}

// Light from the material of slab k, where the ray crosses it.
fn shade_slab(ray: Ray, pixel: vec2f, k: i32, found: SlabSample) -> vec3f {
    let depth = depth_of(eye.frame, f32(k));
    let p = ray.origin + ray.direction * depth;
    let level = kernel_level(eye.frame, depth);
    let rising = presence_gradient(p, level);
    if (SHEET_GRADIENTS) {
        return shade_material(p, level, gradient_between_sheets(pixel, f32(k)), rising, found);
    }
    return shade_material(p, level, gradient_to_scene(eye.space, gradient_at(p, level)), rising, found);
}

// Light from material with the gradient `volume_slope` in scene space; `rising` is the gradient of presence.
fn shade_material(p: vec3f, level: f32, volume_slope: vec3f, rising: vec3f, found: SlabSample) -> vec3f {
    let slope = volume_slope + face_slope(p, level, found.field, rising);
    return shade(VolumeSample(p, slope, found.field, level), found.material.color);
}

// Next slab, from `first` on, in a cell that may be visible; beyond the last if there is none.
fn next_visible_slab(walk: CellRay, first: i32, last: i32) -> i32 {
    var k = first;
    loop {
        if (k > last) {
            break;
        }
        let cell = cell_at(walk, k);
        let empty = cell_distances(distances, cell).x - grid.dilation;
        if (empty <= 0) {
            break;
        }
        k = skip_empty_cells(walk, k, cell, empty);
    }
    return k;
}

// Sample of a slab centred at slab k and `width` times as thick, reduced to the part inside the cut.
fn visible_slab_sample(ray: Ray, span: vec2f, k: f32, width: f32) -> SlabSample {
    var found = slab_sample(eye.frame, ray, k);
    found.material.extinction *= slab_fraction_inside(span, depth_of(eye.frame, k), width * eye.frame.slab);
    return found;
}

struct VisibleSample {
    k: i32,
    found: SlabSample,
}

// Next slab, from `first` on, with visible material. Stretched kernels are sampled far around visible cells, and
// mostly find nothing: the search continues until they do, although all lanes of a vector wait for the slowest. For
// unstretched kernels the search would take longer than shading the few empty samples.
fn next_sample(ray: Ray, walk: CellRay, span: vec2f, first: i32, last: i32) -> VisibleSample {
    var at = VisibleSample(next_visible_slab(walk, first, last), SlabSample(Material(vec3f(0.0), 0.0), Field(0.0), 1.0));
    if (STRETCH) {
        loop {
            if (at.k > last) {
                break;
            }
            at.found = visible_slab_sample(ray, span, f32(at.k), 1.0);
            if (at.found.material.extinction > 0.0) {
                break;
            }
            at.k = next_visible_slab(walk, at.k + 1, last);
            if (at.k > last) {
                break;
            }
        }
    }
    return at;
}

// Result of a ray.
struct RayResult {
    // Linear, premultiplied colour.
    color: vec3f,
    // Remaining transmittance of the ray.
    transmittance: f32,
}

fn even_slabs(ray: Ray, span: vec2f, inside: vec2i, pixel: vec2f) -> RayResult {
    let walk = cell_ray(eye.frame, ray);
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
            at.found = visible_slab_sample(ray, span, f32(at.k), 1.0);
        }
        if (at.found.material.extinction > 0.0) {
            let passed = exp(-at.found.material.extinction * eye.frame.slab * ray.obliquity);
            let weight = t * (1.0 - passed);
            color += weight * shade_slab(ray, pixel, at.k, at.found);
            t *= passed;
        }
        if (t < eye.min_transmittance) {
            break;
        }
        at = next_sample(ray, walk, span, at.k + 1, inside.y);
        if (at.k > inside.y) {
            break;
        }
    }
    return RayResult(color, t);
}

// Linear, premultiplied light and opacity along the ray through a place on the picture, in pixels.
fn light_along_ray(place: vec2f) -> vec4f {
    let ray = ray_of(eye.frame, place);
#if PROJECTION
    let result = projection(ray);
#else
    let span = span_within(eye.visible_cut, ray);
    let inside = slabs_within(eye.frame, span, slabs_inside(eye.frame, ray));
#if BY_NEED
    let result = adaptive_slabs(ray, span, inside);
#else
#if PREINTEGRATED
    let result = preintegrated_slabs(ray, span, inside);
#else
    let result = even_slabs(ray, span, inside, place);
#endif
#endif
#endif
    return vec4f(result.color, 1.0 - result.transmittance);
}

// Pixel of an entry of the list; outside of the picture behind its end.
fn listed_pixel(entry: u32) -> vec2u {
    let packed = edge_list[min(entry + 4u, arrayLength(&edge_list) - 1u)];
    return select(vec2u(0xffffffffu), vec2u(packed & 0xffffu, packed >> 16u), entry < edge_list[3]);
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
#if PAGED
    pages = bound_pages;
#endif
    eye = bound_eye;
    pixel_ray = bound_pixel_ray;
    grid = bound_grid;
    let tile = tile_of(group, groups.y, eye.runs);
    let in_order = tile * TILE_EDGE + in_tile(local.xy) + vec2u(0u, eye.first_row);
    let entry = (tile.y * groups.x + tile.x) * TILE_EDGE * TILE_EDGE + index;
    let pixel = select(in_order, listed_pixel(entry), pixel_ray.is_listed != 0u);
    if (pixel.x >= eye.frame.size.x || pixel.y >= eye.end_row) {
        return;
    }
    eye.frame.first_depth += pixel_ray.place.z;
    let light = pixel_ray.place.w * light_along_ray(vec2f(pixel) + pixel_ray.place.xy);
    let sum = select(vec4f(0.0), textureLoad(earlier, pixel, 0), pixel_ray.is_added != 0u);
    textureStore(picture, pixel, sum + light);
}
