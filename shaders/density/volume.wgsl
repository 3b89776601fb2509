// The volume as the sheets see it: density at a point of index space, by kernel or from the pyramid, and how much of
// it is there.
#import "density/kernel.wgsl"
#import "density/presence.wgsl"
#import "density/stored_presence.wgsl"
#import "sheets/sheet_frame.wgsl"

struct Grid {
    // Voxels.
    dims: vec3f,
    // Cells beyond the one around a sample that it sees: stretched, or at two points.
    dilation: i32,
    // 1 / texels of the density texture, in which the border of the data is once more around them.
    density_scale: vec3f,
    pad0: f32,
    // 1 / texels of the pyramid's level 0, which begins four voxels before the data.
    pyramid_scale: vec3f,
    pad1: f32,
    // 1 / cells of 2³ voxels.
    cell_scale: vec3f,
    pad2: f32,
}

// Uniforms are copied before anything branches: behind a branch Mesa's software driver reads them lane by
// lane, with some thirty instructions for each number.
@group(1) @binding(0) var<uniform> bound_grid: Grid;
var<private> grid: Grid;
@group(1) @binding(1) var density_texture: texture_3d<f32>;
// In r the density; where voxels are missing, in g the share of kernels that lies on those that are there.
@group(1) @binding(2) var pyramid_texture: texture_3d<f32>;
@group(1) @binding(3) var clamped: sampler;
// Takes the nearest texel.
@group(1) @binding(4) var nearest: sampler;
// Where voxels are missing, level by level as in the pyramid: r the share of kernels that lies on those that are there,
// from −1 for none to 1, gba how it changes from the texel before to the one behind along x, y and z.
@group(1) @binding(9) var presence_texture: texture_3d<f32>;

// Channel of the pyramid that is gathered: where voxels are classified first, each colour of light meets its own.
override GATHERED: u32 = 0u;

// Whether any slab's pixels are wider than voxels.
override STRETCH: bool = false;

// Gauss–Legendre with two points: ± 1/(2√3) of the interval's length.
const TWO_POINT_OFFSET = 0.28867513;

// One fetch from the pyramid of prefiltered volumes.
fn pyramid(p: vec3f, level: f32) -> f32 {
#if GATHERED
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level)[GATHERED];
#else
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).r;
#endif
}

// Σ over the 4³ neighbours of density × kernel.
fn density_by_kernel(p: vec3f) -> f32 {
    let cell = floor(p);
    let f = p - cell;
    return weighed(cell, kernel_weights(f.x), kernel_weights(f.y), kernel_weights(f.z));
}

// Σ over the 4³ voxels from the one before `cell` on along each axis, of density × weights. The four weights of an
// axis are two pairs of one sign each, and a pair is one linear fetch between its members: eight trilinear fetches for
// 64 voxels.
fn weighed(cell: vec3f, wx: vec4f, wy: vec4f, wz: vec4f) -> f32 {
    let low = vec3f(wx.x + wx.y, wy.x + wy.y, wz.x + wz.y);
    let high = vec3f(wx.z + wx.w, wy.z + wy.w, wz.z + wz.w);
    // Texel centres: one voxel of padding and half a texel.
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

// The kernel's stretch at a depth, as a level of the pyramid.
fn kernel_level(frame: SheetFrame, depth: f32) -> f32 {
    if (!STRETCH) {
        return 0.0;
    }
    return stretch_level(frame, depth);
}

// Density at a point, with the kernel stretched to pyramid level `level`.
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

// The share of the kernel at a point that lies within the grid, where it is stretched to pyramid level `level`.
fn presence_in_grid(p: vec3f, level: f32) -> f32 {
#if FACES
    return presence(p, grid.dims, select(1.0, exp2(level), STRETCH));
#else
    return 1.0;
#endif
}

// The share of it that lies on voxels that are there.
fn presence_at(p: vec3f, level: f32) -> f32 {
#if MISSING
#if PRECLASSIFY
    // Its pyramid holds what voxels mean.
    return share_stored(textureSampleLevel(presence_texture, clamped, (p + 4.5) * grid.pyramid_scale, level));
#else
    // Beside a density of the pyramid at the same point this costs no fetch of its own.
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).g;
#endif
#else
    return presence_in_grid(p, level);
#endif
}

// The same of what is fetched from the pyramid, whatever the kernel.
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

// How steeply that rises where voxels are missing, in index space: by central differences over as far as the kernel is
// stretched, made beforehand.
fn presence_slope(p: vec3f, level: f32) -> vec3f {
#if MISSING
    let changes = textureSampleLevel(presence_texture, clamped, (p + 4.5) * grid.pyramid_scale, level).gba;
    return changes * (0.5 * exp2(-level));
#else
    return vec3f(0.0);
#endif
}

// The share of the material of slab k that is there, where the ray crosses it.
fn slab_presence(frame: SheetFrame, ray: Ray, k: f32) -> f32 {
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

// The share of slab k within the grid, where the ray crosses it.
fn slab_in_grid(frame: SheetFrame, ray: Ray, k: f32) -> f32 {
#if MISSING
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    return 0.5 * (presence_in_grid(ray.origin + ray.direction * (depth - offset), kernel_level(frame, depth - offset))
        + presence_in_grid(ray.origin + ray.direction * (depth + offset), kernel_level(frame, depth + offset)));
#else
    return slab_presence(frame, ray, k);
#endif
}

// The sheet's value: density averaged over slab k where the ray crosses it.
fn slab_density(frame: SheetFrame, ray: Ray, k: f32) -> f32 {
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return 0.5 * (density(ray.origin + ray.direction * near, kernel_level(frame, near))
            + density(ray.origin + ray.direction * far, kernel_level(frame, far)));
    }
    return density(ray.origin + ray.direction * depth, kernel_level(frame, depth));
}

// First and last slab whose middle can lie where material is: the grid and two voxels around it.
fn slabs_inside(frame: SheetFrame, ray: Ray) -> vec2i {
    let parallel_to = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), parallel_to);
    let a = (vec3f(-2.0) - ray.origin) / direction;
    let b = (grid.dims + 1.0 - ray.origin) / direction;
    let near = min(a, b);
    let far = max(a, b);
    let enter = (max(max(near.x, near.y), near.z) - frame.first_depth) / frame.slab - 0.5;
    let leave = (min(min(far.x, far.y), far.z) - frame.first_depth) / frame.slab - 0.5;
    let last = f32(frame.slab_count) - 1.0;
    // A millionth of slack for faces that lie exactly on a slab's middle.
    return vec2i(i32(ceil(clamp(enter - 1e-5, 0.0, last + 1.0))), i32(floor(clamp(leave + 1e-5, -1.0, last))));
}
