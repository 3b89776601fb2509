// Field: values of the volume in voxels, at points and at texels. This file alone fetches voxels
// (tests/shaders/voxel_access.rs); volume/material.wgsl turns what it finds into matter.
//
// Bindings of group 0 have numbers from 20 on, because passes use the smaller ones for other resources.
#import "common/sizes.wgsl"
#import "common/transmittance.wgsl"
#import "density/kernel.wgsl"
#import "density/presence.wgsl"
#import "volume/pages.wgsl"

#option PRECLASSIFY: voxels are classified before reconstruction
// The pyramid then holds materials (volume/preclassified.wgsl), its first channel takes the place of density, and the
// table converts it to extinction.

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
// Density in r.
@group(1) @binding(2) var pyramid_texture: texture_3d<f32>;
@group(1) @binding(3) var clamped: sampler;
// Sampler that takes the nearest texel.
@group(1) @binding(4) var nearest: sampler;
// Presence where voxels are missing or hidden, with the levels of the pyramid: r is presence, from −1 for none to 1, and gba
// are its differences from the previous to the next texel along x, y and z.
@group(1) @binding(9) var presence_texture: texture_3d<f32>;
// Presence for light, like presence_texture, in passes of the eye. Passes that follow light have it in presence_texture.
@group(1) @binding(12) var lighting_presence_texture: texture_3d<f32>;
// Pyramid that rays in the near field read: with pre-classification that of light, which is 0 where no voxel is.
@group(1) @binding(10) var lighting_pyramid: texture_3d<f32>;
// Pyramid of the tints of further layers (volume/composed_voxels.wgsl).
@group(1) @binding(11) var tint_pyramid: texture_3d<f32>;
// Density texture, or pyramid level, from which a pass makes a level of a pyramid.
@group(0) @binding(20) var source_texture: texture_3d<f32>;
@group(0) @binding(21) var source_sampler: sampler;
// Level of the presence texture with the same texels as the level that is made.
@group(0) @binding(22) var presence_level: texture_3d<f32>;
// Pyramid of voxels pre-classified by the eye's transfer function, for passes whose own pyramid is that of light.
@group(0) @binding(23) var look_pyramid: texture_3d<f32>;
// Gradients at the texels of the pyramid (volume/gradients.wgsl).
@group(0) @binding(24) var gradients: texture_3d<f32>;
// Voxels of the scattering engine (crates/render/src/scatter/voxels.rs): densities of 8³ voxels per brick, two per
// word, as 16-bit normalised numbers.
@group(0) @binding(25) var<storage, read> voxels: array<u32>;

// Densities of up to four fields at the voxels of the grid, as 16-bit integers up to LARGEST_STORED_DENSITY; larger ones
// mark missing voxels (crates/render/src/volume/field_texture.rs).
@group(0) @binding(28) var field_texture: texture_3d<u32>;

const LARGEST_STORED_DENSITY = 65534u;

// Channel of the pyramid that is gathered; with pre-classification each colour of light has its own extinction.
override EXTINCTION_CHANNEL: u32 = 0u;

// Takes gradients from the texture instead of computing them from the pyramid.
override GRADIENT_TEXTURE: bool = false;

// Set if pixels are wider than voxels in any slab.
override STRETCH: bool = false;

// Values of the volume at a point, or their mean over a slab. Gradient and presence have functions of their own,
// because most callers need neither.
struct Field {
    density: f32,
}

fn mean_of_fields(a: Field, b: Field) -> Field {
    return Field(0.5 * (a.density + b.density));
}

// Index-space point of the volume in memory: another one if samples read pages of finer levels.
fn place_in_memory(p: vec3f) -> vec3f {
#if PAGED
    return (p + 0.5) * pages.coarse - 0.5;
#else
    return p;
#endif
}

// Index-space vector of the volume in memory.
fn vector_in_memory(v: vec3f) -> vec3f {
#if PAGED
    return v * pages.coarse;
#else
    return v;
#endif
}

// Texture coordinates of an index-space point in the pyramid and in textures with the same texels.
fn pyramid_place(p: vec3f) -> vec3f {
    return (place_in_memory(p) + 4.5) * grid.pyramid_scale;
}

fn pyramid_texel(p: vec3f, level: f32) -> vec4f {
    return textureSampleLevel(pyramid_texture, clamped, pyramid_place(p), level);
}

// Density from the pyramid of prefiltered volumes, in one fetch.
fn pyramid_density(p: vec3f, level: f32) -> f32 {
#if PAGED
    return paged_density(p, level);
#else
#if EXTINCTION_CHANNEL
    return pyramid_texel(p, level)[EXTINCTION_CHANNEL];
#else
    return pyramid_texel(p, level).r;
#endif
#endif
}

// Field from the pyramid, whatever the kernel.
fn pyramid_field(p: vec3f, level: f32) -> Field {
    return Field(pyramid_density(p, level));
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

// Field at a point, with the kernel stretched to a pyramid level.
fn field_at(p: vec3f, level: f32) -> Field {
    if (KERNEL == KERNEL_PREFILTERED) {
        return pyramid_field(p, level);
    }
    if (!STRETCH) {
        return Field(density_by_kernel(p));
    }
    let blurred = pyramid_density(p, max(level, 1.0));
    if (level >= 1.0) {
        return Field(blurred);
    }
    return Field(mix(density_by_kernel(p), blurred, level));
}

// Density interpolated linearly between voxels; that of the outermost ones continues beyond them.
fn linear_density(p: vec3f) -> f32 {
    let inside = clamp(p, vec3f(0.0), grid.dims - 1.0);
    // The texture has a border of one voxel.
    return textureSampleLevel(density_texture, clamped, (inside + 1.5) * grid.density_scale, 0.0).r;
}

// Gradient of the prefiltered density in index space, precomputed.
fn stored_gradient(p: vec3f, level: f32) -> vec3f {
    return textureSampleLevel(gradients, clamped, pyramid_place(p), level).xyz;
}

// Fraction of the kernel at a point that lies within the grid, stretched to a pyramid level.
fn presence_in_grid(p: vec3f, level: f32) -> f32 {
#if FACES
    return grid_presence(p, grid.dims, select(1.0, exp2(level), STRETCH));
#else
    return 1.0;
#endif
}

// Presence, 0 … 1, from a texel that stores it as −1 … 1: signed bytes, so that a difference of exactly 0 can be
// represented.
fn decode_presence(texel: vec4f) -> f32 {
    return 0.5 * texel.r + 0.5;
}

// Presence at a point: the fraction of the kernel on existing voxels.
fn presence_at(p: vec3f, level: f32) -> f32 {
#if MISSING
    return decode_presence(textureSampleLevel(presence_texture, clamped, pyramid_place(p), level));
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
    let changes = textureSampleLevel(presence_texture, clamped, pyramid_place(p), level).gba;
    return changes * (0.5 * exp2(-level));
#else
    return vec3f(0.0);
#endif
}

// Tint of further layers at a point: opacity, and colour times opacity.
fn tint_texel(p: vec3f, level: f32) -> vec4f {
    return textureSampleLevel(tint_pyramid, clamped, pyramid_place(p), level);
}

// Pre-classified material of the eye at a point, as volume/material.wgsl stores it.
fn look_texel(p: vec3f, level: f32) -> vec4f {
    return textureSampleLevel(look_pyramid, clamped, pyramid_place(p), level);
}

#if PRECLASSIFY
// Pre-classified material at a point, as volume/material.wgsl stores it.
fn preclassified_at(p: vec3f, level: f32) -> vec4f {
    return pyramid_texel(p, level);
}

// Extinction relative to the maximum, for each colour of light if shadows are coloured.
alias LightingField = Transmittance;
#else
alias LightingField = Field;
#endif

// Field for rays towards lights in the near field: one fetch from a pyramid.
fn lighting_field(p: vec3f, level: f32) -> LightingField {
#if PRECLASSIFY
    let texel = textureSampleLevel(lighting_pyramid, clamped, pyramid_place(p), level);
#if COLORED
    return texel.gba;
#else
    return texel.r;
#endif
#else
    return pyramid_field(p, level);
#endif
}

// Presence for light at a point, in passes of the eye.
fn lighting_presence_at(p: vec3f, level: f32) -> f32 {
#if MISSING
    return decode_presence(textureSampleLevel(lighting_presence_texture, clamped, pyramid_place(p), level));
#else
    return presence_at(p, level);
#endif
}

// Presence for values of lighting_field().
fn lighting_presence(p: vec3f, level: f32) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
#if MISSING
    return lighting_presence_at(p, level);
#else
    return pyramid_presence(p, level);
#endif
#endif
}

// Field of a voxel of the brick whose words begin at `first`.
fn voxel_field(first: u32, local: vec3u) -> Field {
    let at = local.x + BRICK_EDGE * (local.y + BRICK_EDGE * local.z);
    let pair = unpack2x16unorm(voxels[first + at / 2u]);
    return Field(select(pair.x, pair.y, at % 2u == 1u));
}

// Number of texels of the source along x, y and z.
fn source_size() -> vec3u {
    return textureDimensions(source_texture);
}

// Texel of the source: a density or a pre-classified material.
fn source_texel(texel: vec3i) -> vec4f {
    return textureLoad(source_texture, texel, 0);
}

// Trilinear fetch from the source at texture coordinates.
fn source_at(place: vec3f) -> vec4f {
    return textureSampleLevel(source_texture, source_sampler, place, 0.0);
}

// Presence at a texel of the level that is made.
fn presence_at_texel(texel: vec3u) -> f32 {
    return decode_presence(textureLoad(presence_level, texel, 0));
}

// Densities of the fields around a voxel.
struct FieldNeighbourhood {
    // Densities at the voxel itself.
    own: vec4f,
    // Whether a field has this voxel.
    is_present: vec4<bool>,
    // Lengths of the gradients, per voxel, by central differences.
    slope: vec4f,
    // Ranges over the voxel and the six beside it.
    lowest: vec4f,
    highest: vec4f,
}

fn stored_density(stored: vec4u) -> vec4f {
    return vec4f(stored) / f32(LARGEST_STORED_DENSITY);
}

// Number of voxels of the fields along x, y and z.
fn field_grid() -> vec3i {
    return vec3i(textureDimensions(field_texture));
}

// Density of a field at a voxel; −1 if it is missing or outside the grid.
fn field_value(i: u32, voxel: vec3i) -> f32 {
    let inside = clamp(voxel, vec3i(0), field_grid() - 1);
    let stored = textureLoad(field_texture, inside, 0);
    let is_there = all(inside == voxel) && stored[i] <= LARGEST_STORED_DENSITY;
    return select(-1.0, stored_density(stored)[i], is_there);
}

// Densities of the fields around a voxel. Beside missing voxels, and outside the grid, its own continue.
fn field_neighbourhood(voxel: vec3i) -> FieldNeighbourhood {
    let last = field_grid() - 1;
    let stored = textureLoad(field_texture, voxel, 0);
    let own = stored_density(stored);
    var found = FieldNeighbourhood(own, stored <= vec4u(LARGEST_STORED_DENSITY), vec4f(0.0), own, own);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let step = vec3i(vec3u(axis) == vec3u(0u, 1u, 2u));
        let before = textureLoad(field_texture, max(voxel - step, vec3i(0)), 0);
        let behind = textureLoad(field_texture, min(voxel + step, last), 0);
        let low = select(own, stored_density(before), before <= vec4u(LARGEST_STORED_DENSITY));
        let high = select(own, stored_density(behind), behind <= vec4u(LARGEST_STORED_DENSITY));
        found.slope += 0.25 * (high - low) * (high - low);
        found.lowest = min(found.lowest, min(low, high));
        found.highest = max(found.highest, max(low, high));
    }
    found.slope = sqrt(found.slope);
    return found;
}
