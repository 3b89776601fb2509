// Pages: cubes of 64³ voxels of levels that are finer than the volume in memory, in slots of one texture
// (crates/volume/src/pages). Index space is then that of the finest level of the picture; where a page is absent, the
// next coarser level takes its place.
#option PAGED: samples read pages of finer levels

#if PAGED
// Edge of a page, width of the border that is stored around it, and edge of its slot, in voxels.
const PAGE_EDGE = 64.0;
const PAGE_BORDER = 3.0;
const PAGE_STORED_EDGE = 70.0;
// Steps per voxel in which places in the texture are rounded: 32-bit numbers below 2048 have thirteen bits behind the point.
const PLACE_STEPS = 8192.0;

struct PageLevelUniform {
    // Number of its voxels per voxel of the picture's index space.
    scale: vec3f,
    // Index of its first page in the table.
    first: u32,
    // Number of pages along x, y and z.
    pages: vec3u,
    pad0: u32,
}

struct PagesUniform {
    // Number of voxels in memory per voxel of the picture's index space, along x, y and z.
    coarse: vec3f,
    // Number of levels with pages.
    count: u32,
    // One over the size of the texture of pages, whose edges are powers of two.
    texel: vec3f,
    // Level of the picture whose voxels are those in memory.
    level_in_memory: f32,
    // Finest level first.
    level_0: PageLevelUniform,
    level_1: PageLevelUniform,
    level_2: PageLevelUniform,
    level_3: PageLevelUniform,
    // Index of the finest level of the picture among those of the file.
    first_level: u32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

@group(1) @binding(13) var<uniform> bound_pages: PagesUniform;
// Prefiltered densities of the pages in their slots, each with a border.
@group(1) @binding(14) var page_pool: texture_3d<f32>;
// Slot of each page or, if it is absent, of the finest coarser one that takes its place: x, y and z in eight bits each, then
// the level of that page in three, counted from the finest of the file, and the highest bit. For a page whose densities show
// nothing, or are all the same, one of them in sixteen bits, and the next lower bit. 0 if there is none.
@group(1) @binding(15) var<storage, read> page_table: array<u32>;
// Copied before anything branches (volume/field.wgsl).
var<private> pages: PagesUniform;

// Place of a point in the texture of pages.
struct PagePlace {
    // Texture coordinates; of a page without texels its density.
    place: vec3f,
    // Number of texels per voxel of the picture's index space; 0 if no page holds the point, -1 if the page has no texels.
    scale: vec3f,
}

// Level of pages with this index, without an array that is indexed dynamically, which would be kept in memory.
fn page_level(level: u32) -> PageLevelUniform {
    if (!STRETCH || level == 0u) {
        return pages.level_0;
    }
    if (level == 1u) {
        return pages.level_1;
    }
    if (level == 2u) {
        return pages.level_2;
    }
    return pages.level_3;
}

// Number of voxels of a level per voxel of the picture's index space.
fn level_scale(level: u32) -> vec3f {
    let fine = select(pages.level_1.scale, pages.level_0.scale, level == 0u);
    let coarse = select(pages.level_3.scale, pages.level_2.scale, level == 2u);
    return select(coarse, fine, level < 2u);
}

// Place of a point on a level or, where that is absent, on the finest coarser one with a page.
fn page_place(p: vec3f, level: u32) -> PagePlace {
    if (level >= pages.count) {
        return PagePlace(vec3f(0.0), vec3f(0.0));
    }
    let wanted = page_level(level);
    let page = clamp(floor((p + 0.5) * (wanted.scale * (1.0 / PAGE_EDGE))), vec3f(0.0), vec3f(wanted.pages) - 1.0);
    let index = vec3u(page);
    let entry = page_table[wanted.first + index.x + wanted.pages.x * (index.y + wanted.pages.y * index.z)];
    if (entry == 0u) {
        return PagePlace(vec3f(0.0), vec3f(0.0));
    }
    if ((entry & 0x40000000u) != 0u) {
        return PagePlace(vec3f(f32(entry & 0xffffu) / 65535.0), vec3f(-1.0));
    }
    let scale = level_scale((entry >> 24u & 7u) - pages.first_level);
    let first = floor(page * (scale / wanted.scale)) * PAGE_EDGE;
    let slot = vec3f(vec3u(entry & 0xffu, entry >> 8u & 0xffu, entry >> 16u & 0xffu)) * PAGE_STORED_EDGE;
    // Differences reach two texels, and a fetch half a texel more; points farther out lie beyond the grid.
    let place = clamp((p + 0.5) * scale - first + PAGE_BORDER, vec3f(2.5), vec3f(PAGE_STORED_EDGE - 2.5));
    // As many bits as are left in the last slot of the largest texture, so that all slots show the same.
    let texel = round(place * PLACE_STEPS) * (1.0 / PLACE_STEPS);
    return PagePlace((slot + texel) * pages.texel, scale);
}

// Density at an offset, in texels, from a place.
fn page_density(place: PagePlace, offset: vec3f) -> f32 {
    return textureSampleLevel(page_pool, clamped, place.place + offset * pages.texel, 0.0).r;
}

// Level of the pyramid in memory that takes the place of a level of the picture.
fn level_in_memory(level: f32) -> f32 {
    return max(level - pages.level_in_memory, 0.0);
}

// Density on one level, from the page at a point or, where none is resident, from the pyramid in memory.
fn density_on_level(p: vec3f, level: f32) -> f32 {
    let place = page_place(p, u32(level));
    if (place.scale.x > 0.0) {
        return page_density(place, vec3f(0.0));
    }
    if (place.scale.x < 0.0) {
        return place.place.x;
    }
    return pyramid_texel(p, level_in_memory(level)).r;
}

// Density at a point, between the levels around `level`.
fn paged_density(p: vec3f, level: f32) -> f32 {
    let finer = floor(level);
    let density = density_on_level(p, finer);
    if (!STRETCH || level == finer) {
        return density;
    }
    return mix(density, density_on_level(p, finer + 1.0), level - finer);
}

// Derivative of the density of a page along an axis, per texel (density/gradient.wgsl).
fn page_derivative(place: PagePlace, axis: vec3f) -> f32 {
    let near = page_density(place, axis) - page_density(place, -axis);
    let far = page_density(place, 2.0 * axis) - page_density(place, -2.0 * axis);
    return (8.0 * near - far) / 12.0;
}

// Derivative of the density of the pyramid in memory along an axis, per texel.
fn derivative_in_memory(p: vec3f, axis: vec3f, level: f32) -> f32 {
    let step = axis * exp2(level) / pages.coarse;
    let near = pyramid_texel(p + step, level).r - pyramid_texel(p - step, level).r;
    let far = pyramid_texel(p + 2.0 * step, level).r - pyramid_texel(p - 2.0 * step, level).r;
    return (8.0 * near - far) / 12.0;
}

// Gradient of the volume in memory, per voxel of the picture's index space.
fn gradient_in_memory(p: vec3f, level: f32) -> vec3f {
    // Software drivers run both branches of each condition, and this one for every sample.
    if (GRADIENT_TEXTURE) {
        return stored_gradient(p, level) * pages.coarse;
    }
    let slope = vec3f(
        derivative_in_memory(p, vec3f(1.0, 0.0, 0.0), level),
        derivative_in_memory(p, vec3f(0.0, 1.0, 0.0), level),
        derivative_in_memory(p, vec3f(0.0, 0.0, 1.0), level),
    );
    return slope * pages.coarse * exp2(-level);
}

// Gradient, in index space, of the density on one level.
fn gradient_on_level(p: vec3f, level: f32) -> vec3f {
    let place = page_place(p, u32(level));
    if (place.scale.x > 0.0) {
        let slope = vec3f(
            page_derivative(place, vec3f(1.0, 0.0, 0.0)),
            page_derivative(place, vec3f(0.0, 1.0, 0.0)),
            page_derivative(place, vec3f(0.0, 0.0, 1.0)),
        );
        return slope * place.scale;
    }
    if (place.scale.x < 0.0) {
        return vec3f(0.0);
    }
    return gradient_in_memory(p, level_in_memory(level));
}

// Gradient at a point, between the levels around `level`.
fn paged_gradient(p: vec3f, level: f32) -> vec3f {
    let finer = floor(level);
    let slope = gradient_on_level(p, finer);
    if (!STRETCH || level == finer) {
        return slope;
    }
    return mix(slope, gradient_on_level(p, finer + 1.0), level - finer);
}
#endif
