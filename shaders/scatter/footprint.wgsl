// Footprints: slices of a voxel's kernel, averaged over a slab along a pixel's ray (h̄ of P eq. 9).
#import "density/kernel.wgsl"
#import "scatter/slab.wgsl"

// Pre-integrated Gaussian of radius two voxels: x by the square of the distance across the ray, from 0
// to 4; y its integral along the ray up to a distance from −2 to 2.
const FOOTPRINT_SIZE = 512u;

@group(1) @binding(7) var<storage, read> footprint_table: array<vec2f, 512>;

fn entry_at(at: f32) -> vec2f {
    let clamped_at = clamp(at, 0.0, 1.0) * f32(FOOTPRINT_SIZE - 1u);
    let low = min(u32(clamped_at), FOOTPRINT_SIZE - 2u);
    return mix(footprint_table[low], footprint_table[low + 1u], clamped_at - f32(low));
}

// The Gaussian is round, so its mean over a slab along any ray is a product: of how far the ray passes
// the voxel, and of which part of the kernel's length lies in the slab.
fn gaussian_footprint(centre: vec3f, ray: Ray, depth: f32) -> f32 {
    let speed = length(ray.direction);
    let along = ray.direction / speed;
    let offset = ray.origin + ray.direction * depth - centre;
    let middle = dot(offset, along);
    let miss = offset - along * middle;
    let squared = dot(miss, miss) / (scatter.stretch * scatter.stretch);
    if (squared >= 4.0) {
        return 0.0;
    }
    let reach = 0.5 * scatter.frame.slab * speed;
    let near = entry_at((middle - reach) / scatter.stretch * 0.25 + 0.5).y;
    let far = entry_at((middle + reach) / scatter.stretch * 0.25 + 0.5).y;
    return entry_at(squared * 0.25).x * (far - near) / (2.0 * reach * scatter.stretch * scatter.stretch);
}

// The other kernels are products along the axes of the grid: no table of few dimensions holds their
// oblique slices, so these are taken at one or two points.
fn sliced_footprint(centre: vec3f, ray: Ray, depth: f32, of_light: bool) -> f32 {
    let offset = select(0.0, 0.28867513 * scatter.frame.slab, QUADRATURE == 2u);
    let near = product_at(ray.origin + ray.direction * (depth - offset) - centre, of_light);
    let far = product_at(ray.origin + ray.direction * (depth + offset) - centre, of_light);
    return 0.5 * (near + far);
}

fn product_at(p: vec3f, of_light: bool) -> f32 {
    let q = p / scatter.stretch;
    let product = profile(q.x, of_light) * profile(q.y, of_light) * profile(q.z, of_light);
    return product / (scatter.stretch * scatter.stretch * scatter.stretch);
}

// The kernel along an axis; densities take the prefilter and the tent in one.
fn profile(t: f32, of_light: bool) -> f32 {
    if (KERNEL == KERNEL_PREFILTERED && !of_light) {
        return (kernel_at(t - 1.0) + 10.0 * kernel_at(t) + kernel_at(t + 1.0)) / 12.0;
    }
    return kernel_at(t);
}

// A round Gaussian integrated along the whole ray, over the length that a step of one depth takes in index
// space; stretched where pixels are wider than voxels.
fn whole_footprint(centre: vec3f, ray: Ray, stretch: f32) -> f32 {
    let speed = length(ray.direction);
    let along = ray.direction / speed;
    let offset = ray.origin - centre;
    let miss = offset - along * dot(offset, along);
    let squared = dot(miss, miss) / (stretch * stretch);
    if (squared >= 4.0) {
        return 0.0;
    }
    return entry_at(squared * 0.25).x * entry_at(1.0).y / (speed * stretch * stretch);
}

// The stretch of a kernel at a depth.
fn stretch_of(depth: f32) -> f32 {
    let pitch = scatter.frame.pitch * (1.0 + depth * scatter.frame.inverse_distance);
    return max(pitch / scatter.frame.voxel_edge, 1.0);
}

fn footprint(centre: vec3f, ray: Ray, depth: f32, of_light: bool) -> f32 {
    if (KERNEL == KERNEL_GAUSSIAN) {
        return gaussian_footprint(centre, ray, depth);
    }
    return sliced_footprint(centre, ray, depth, of_light);
}

struct Box {
    first: vec2f,
    last: vec2f,
}

// Pixels that a kernel around a voxel can touch, by where it is seen: none when first is beyond last.
fn pixels_under(at: vec3f) -> Box {
    // Seen from where it is widest and where it is narrowest.
    let spread = scatter.frame.inverse_distance;
    let near = max(1.0 + (at.z - scatter.half.z) * spread, 1e-6);
    let far = max(1.0 + (at.z + scatter.half.z) * spread, 1e-6);
    let low = at.xy - scatter.half.xy;
    let high = at.xy + scatter.half.xy;
    return Box(
        max(ceil(min(low / near, low / far)), vec2f(0.0)),
        min(floor(max(high / near, high / far)), vec2f(scatter.frame.size) - 1.0),
    );
}
