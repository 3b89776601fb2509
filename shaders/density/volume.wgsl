// Volume sampling: density at an index-space point, by kernel or from the pyramid, and presence; both also averaged
// over slabs.
#import "density/kernel.wgsl"
#import "density/presence.wgsl"
#import "density/stored_presence.wgsl"
#import "sheets/sheet_frame.wgsl"

struct GridUniform {
    // Number of voxels along x, y and z.
    dims: vec3f,
    // Reach of samples, in cells beyond their own, from stretched kernels and quadrature points.
    dilation: i32,
    // One over the size of the density texture, which has a border of one voxel.
    density_scale: vec3f,
    pad0: f32,
    // One over the size of the pyramid's level 0, which has a border of four voxels.
    pyramid_scale: vec3f,
    pad1: f32,
    // One over the number of cells of 2³ voxels.
    cell_scale: vec3f,
    pad2: f32,
}

// Uniforms are copied before anything branches: behind a branch Mesa's software driver reads them lane by lane, with
// some thirty instructions for each number.
@group(1) @binding(0) var<uniform> bound_grid: GridUniform;
var<private> grid: GridUniform;
@group(1) @binding(1) var density_texture: texture_3d<f32>;
// Density in r; presence in g where voxels are missing.
@group(1) @binding(2) var pyramid_texture: texture_3d<f32>;
@group(1) @binding(3) var clamped: sampler;
// Sampler that takes the nearest texel.
@group(1) @binding(4) var nearest: sampler;
// Presence where voxels are missing, with the levels of the pyramid: r is presence, from −1 for none to 1, and gba
// are its differences from the previous to the next texel along x, y and z.
@group(1) @binding(9) var presence_texture: texture_3d<f32>;

// Channel of the pyramid that is gathered; with pre-classification each colour of light has its own extinction.
override EXTINCTION_CHANNEL: u32 = 0u;

// Set if pixels are wider than voxels in any slab.
override STRETCH: bool = false;

// Gauss–Legendre with two points: ± 1/(2√3) of the interval's length.
const TWO_POINT_OFFSET = 0.28867513;

// Density from the pyramid of prefiltered volumes, in one fetch.
fn pyramid(p: vec3f, level: f32) -> f32 {
#if EXTINCTION_CHANNEL
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level)[EXTINCTION_CHANNEL];
#else
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).r;
#endif
}

// Density at a point: Σ over the 4³ neighbours of density × kernel.
fn density_by_kernel(p: vec3f) -> f32 {
    let cell = floor(p);
    let f = p - cell;
    return weighted_sum(cell, kernel_weights(f.x), kernel_weights(f.y), kernel_weights(f.z));
}

// Σ over the 4³ voxels, from the one before `cell` on along each axis, of density × weights. The four weights of an
// axis form two pairs of equal sign, and each pair is one linear fetch between its voxels: eight trilinear fetches
// for 64 voxels.
fn weighted_sum(cell: vec3f, wx: vec4f, wy: vec4f, wz: vec4f) -> f32 {
    let low = vec3f(wx.x + wx.y, wy.x + wy.y, wz.x + wz.y);
    let high = vec3f(wx.z + wx.w, wy.z + wy.w, wz.z + wz.w);
    // Texel centres: one voxel of border and half a texel.
    let a = (cell + vec3f(wx.y, wy.y, wz.y) / low + 0.5) * grid.density_scale;
    let b = (cell + vec3f(wx.w, wy.w, wz.w) / high + 2.5) * grid.density_scale;
    let near = high.x * textureSampleLevel(density_texture, clamped, vec3f(b.x, a.y, a.z), 0.0).r
        + low.x * textureSampleLevel(density_texture, clamped, vec3f(a.x, a.y, a.z), 0.0).r;
    let near_up = high.x * textureSampleLevel(density_texture, clamped, vec3f(b.x, b.y, a.z), 0.0).r
        + low.x * textureSampleLevel(density_texture, clamped, vec3f(a.x, b.y, a.z), 0.0).r;
    let far = high.x * textureSampleLevel(density_texture, clamped, vec3f(b.x, a.y, b.z), 0.0).r
        + low.x * textureSampleLevel(density_texture, clamped, vec3f(a.x, a.y, b.z), 0.0).r;
    let far_up = high.x * textureSampleLevel(density_texture, clamped, vec3f(b.x, b.y, b.z), 0.0).r
        + low.x * textureSampleLevel(density_texture, clamped, vec3f(a.x, b.y, b.z), 0.0).r;
    return low.z * (low.y * near + high.y * near_up) + high.z * (low.y * far + high.y * far_up);
}

// Pyramid level for the kernel's stretch at a depth.
fn kernel_level(frame: SheetFrameUniform, depth: f32) -> f32 {
    if (!STRETCH) {
        return 0.0;
    }
    return stretch_level(frame, depth);
}

// Density at a point, with the kernel stretched to a pyramid level.
fn density(p: vec3f, level: f32) -> f32 {
    if (KERNEL == KERNEL_PREFILTERED) {
        return pyramid(p, level);
    }
    if (!STRETCH) {
        return density_by_kernel(p);
    }
    let blurred = pyramid(p, max(level, 1.0));
    if (level >= 1.0) {
        return blurred;
    }
    return mix(density_by_kernel(p), blurred, level);
}

// Fraction of the kernel at a point that lies within the grid, stretched to a pyramid level.
fn presence_in_grid(p: vec3f, level: f32) -> f32 {
#if FACES
    return grid_presence(p, grid.dims, select(1.0, exp2(level), STRETCH));
#else
    return 1.0;
#endif
}

// Presence at a point: the fraction of the kernel on existing voxels.
fn presence_at(p: vec3f, level: f32) -> f32 {
#if MISSING
#if PRECLASSIFY
    // With pre-classification the pyramid holds materials instead of presence.
    return decode_presence(textureSampleLevel(presence_texture, clamped, (p + 4.5) * grid.pyramid_scale, level));
#else
    // Together with a density from the pyramid at the same point this needs no additional fetch.
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).g;
#endif
#else
    return presence_in_grid(p, level);
#endif
}

// Presence for values fetched from the pyramid, whatever the kernel.
fn pyramid_presence(p: vec3f, level: f32) -> f32 {
#if MISSING
    return presence_at(p, level);
#else
#if FACES
    return prefiltered_presence(p, grid.dims, select(1.0, exp2(level), STRETCH));
#else
    return 1.0;
#endif
#endif
}

// Gradient of presence, in index space, where voxels are missing: precomputed central differences as wide as the
// stretched kernel.
fn presence_gradient(p: vec3f, level: f32) -> vec3f {
#if MISSING
    let changes = textureSampleLevel(presence_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).gba;
    return changes * (0.5 * exp2(-level));
#else
    return vec3f(0.0);
#endif
}

// Presence averaged over slab k, where the ray crosses it.
fn slab_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
#if FACES
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return 0.5 * (presence_at(ray.origin + ray.direction * near, kernel_level(frame, near))
            + presence_at(ray.origin + ray.direction * far, kernel_level(frame, far)));
    }
    return presence_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));
#else
    return 1.0;
#endif
}

// Fraction of slab k within the grid, where the ray crosses it.
fn slab_in_grid(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
#if MISSING
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    return 0.5 * (presence_in_grid(ray.origin + ray.direction * (depth - offset), kernel_level(frame, depth - offset))
        + presence_in_grid(ray.origin + ray.direction * (depth + offset), kernel_level(frame, depth + offset)));
#else
    return slab_presence(frame, ray, k);
#endif
}

// Value of the sheet: density averaged over slab k, where the ray crosses it.
fn slab_density(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return 0.5 * (density(ray.origin + ray.direction * near, kernel_level(frame, near))
            + density(ray.origin + ray.direction * far, kernel_level(frame, far)));
    }
    return density(ray.origin + ray.direction * depth, kernel_level(frame, depth));
}

// First and last slab whose middle can contain material: the grid and two voxels around it.
fn slabs_inside(frame: SheetFrameUniform, ray: Ray) -> vec2i {
    let parallel_to = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), parallel_to);
    let a = (vec3f(-2.0) - ray.origin) / direction;
    let b = (grid.dims + 1.0 - ray.origin) / direction;
    let near = min(a, b);
    let far = max(a, b);
    let enter = (max(max(near.x, near.y), near.z) - frame.first_depth) / frame.slab - 0.5;
    let leave = (min(min(far.x, far.y), far.z) - frame.first_depth) / frame.slab - 0.5;
    let last = f32(frame.slab_count) - 1.0;
    // Slack of 1e-5 of a slab, for faces exactly in the middle of a slab.
    return vec2i(i32(ceil(clamp(enter - 1e-5, 0.0, last + 1.0))), i32(floor(clamp(leave + 1e-5, -1.0, last))));
}
