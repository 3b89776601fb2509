// Footprints: slices of a voxel's kernel, averaged over a slab along a pixel's ray (h̄ of P eq. 9).
#import "density/kernel.wgsl"
#import "scatter/slab.wgsl"

// Pre-integrated Gaussian of radius two voxels: x is its profile by the squared distance from the ray, 0 to 4; y its
// integral along the ray up to a distance from −2 to 2.
const FOOTPRINT_SIZE = 512u;

@group(1) @binding(7) var<storage, read> footprint_table: array<vec2f, 512>;

fn entry_at(at: f32) -> vec2f {
    let clamped_at = clamp(at, 0.0, 1.0) * f32(FOOTPRINT_SIZE - 1u);
    let low = min(u32(clamped_at), FOOTPRINT_SIZE - 2u);
    return mix(footprint_table[low], footprint_table[low + 1u], clamped_at - f32(low));
}

// Footprint of the Gaussian. It is isotropic, so the mean over a slab along any ray is a product: of the profile at
// the ray's distance from the voxel, and of the part of the kernel's length within the slab.
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

// Footprint of the other kernels. They are separable along the axes of the grid, and no low-dimensional table holds
// their oblique slices, so these are evaluated at one or two points.
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

// Kernel along an axis. For densities the prefilter and the tent are combined.
fn profile(t: f32, of_light: bool) -> f32 {
    if (KERNEL == KERNEL_PREFILTERED && !of_light) {
        return (kernel_at(t - 1.0) + 10.0 * kernel_at(t) + kernel_at(t + 1.0)) / 12.0;
    }
    return kernel_at(t);
}

// Isotropic Gaussian integrated along the whole ray, relative to the index-space length of a unit of depth; stretched
// where pixels are wider than voxels.
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

// Stretch of a kernel at a depth.
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

// Pixels that a kernel around a projected voxel can touch; empty if first is beyond last.
fn pixels_under(at: vec3f) -> Box {
    // Projected at the nearest and at the furthest depth of the kernel.
    let spread = scatter.frame.inverse_distance;
    let near = max(1.0 + (at.z - scatter.half_extents.z) * spread, 1e-6);
    let far = max(1.0 + (at.z + scatter.half_extents.z) * spread, 1e-6);
    let low = at.xy - scatter.half_extents.xy;
    let high = at.xy + scatter.half_extents.xy;
    return Box(
        max(ceil(min(low / near, low / far)), vec2f(0.0)),
        min(floor(max(high / near, high / far)), vec2f(scatter.frame.size) - 1.0),
    );
}
