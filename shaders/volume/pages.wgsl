// Pages: cubes of 64³ voxels of levels that are finer than the volume in memory, in slots of one texture
// (crates/volume/src/pages). Index space is then that of the finest level of the picture; where a page is absent, the
// next coarser level takes its place.
#option PAGED: samples read pages of finer levels

#if PAGED
// Edge of a page, width of the border that is stored around it, and edge of its slot, in voxels.
const PAGE_EDGE = 64.0;
const PAGE_BORDER = 3.0;
const PAGE_STORED_EDGE = 70.0;

// Number of levels of pages that a picture reads at most.
const MAX_PAGE_LEVELS = 4;

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
    // One over the size of the texture of pages.
    texel: vec3f,
    // Level of the picture whose voxels are those in memory.
    level_in_memory: f32,
    // Finest level first.
    levels: array<PageLevelUniform, MAX_PAGE_LEVELS>,
}

@group(1) @binding(13) var<uniform> bound_pages: PagesUniform;
// Prefiltered densities of the pages in their slots, each with a border.
@group(1) @binding(14) var page_pool: texture_3d<f32>;
// Slot of each page, x in the low ten bits, then y and z, plus one along z; 0 if the page is absent.
@group(1) @binding(15) var<storage, read> page_table: array<u32>;

// Place of a point in the texture of pages.
struct PagePlace {
    // Texel, from 0 at the corner of the texture.
    texel: vec3f,
    // Middle of the first texel of the slot.
    low: vec3f,
    // Number of texels per voxel of the picture's index space; 0 if no page holds the point.
    scale: vec3f,
}

// Place of a point on a level or, where that is absent, on the finest coarser one with a page.
fn page_place(p: vec3f, level: u32) -> PagePlace {
    var place = PagePlace(vec3f(0.0), vec3f(0.0), vec3f(0.0));
    for (var l = level; l < bound_pages.count; l += 1u) {
        let scale = bound_pages.levels[l].scale;
        let pages = bound_pages.levels[l].pages;
        let at = (p + 0.5) * scale;
        let page = clamp(vec3i(floor(at * (1.0 / PAGE_EDGE))), vec3i(0), vec3i(pages) - 1);
        let index = vec3u(page);
        let entry = page_table[bound_pages.levels[l].first + index.x + pages.x * (index.y + pages.y * index.z)];
        if (entry != 0u) {
            let slot = vec3f(vec3u(entry & 0x3ffu, entry >> 10u & 0x3ffu, (entry >> 20u) - 1u)) * PAGE_STORED_EDGE;
            place = PagePlace(slot + PAGE_BORDER + at - vec3f(page) * PAGE_EDGE, slot + 0.5, scale);
            break;
        }
    }
    return place;
}

// Density at an offset, in texels, from a place; beyond the border of the page it is repeated.
fn page_density(place: PagePlace, offset: vec3f) -> f32 {
    let texel = clamp(place.texel + offset, place.low, place.low + (PAGE_STORED_EDGE - 1.0));
    return textureSampleLevel(page_pool, clamped, texel * bound_pages.texel, 0.0).r;
}

// Level of the pyramid in memory that takes the place of a level of the picture.
fn level_in_memory(level: f32) -> f32 {
    return max(level - bound_pages.level_in_memory, 0.0);
}

// Density on one level, from the page at a point or, where none is resident, from the pyramid in memory.
fn density_on_level(p: vec3f, level: f32) -> f32 {
    let place = page_place(p, u32(level));
    if (place.scale.x > 0.0) {
        return page_density(place, vec3f(0.0));
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

// Derivative of the density along an axis on one level, per texel (density/gradient.wgsl).
fn derivative_on_level(place: PagePlace, p: vec3f, axis: vec3f, coarse: f32) -> f32 {
    if (place.scale.x > 0.0) {
        let near = page_density(place, axis) - page_density(place, -axis);
        let far = page_density(place, 2.0 * axis) - page_density(place, -2.0 * axis);
        return (8.0 * near - far) / 12.0;
    }
    let step = axis * exp2(coarse) / bound_pages.coarse;
    let near = pyramid_texel(p + step, coarse).r - pyramid_texel(p - step, coarse).r;
    let far = pyramid_texel(p + 2.0 * step, coarse).r - pyramid_texel(p - 2.0 * step, coarse).r;
    return (8.0 * near - far) / 12.0;
}

// Gradient, in index space, of the density on one level.
fn gradient_on_level(p: vec3f, level: f32) -> vec3f {
    let place = page_place(p, u32(level));
    let coarse = level_in_memory(level);
    let slope = vec3f(
        derivative_on_level(place, p, vec3f(1.0, 0.0, 0.0), coarse),
        derivative_on_level(place, p, vec3f(0.0, 1.0, 0.0), coarse),
        derivative_on_level(place, p, vec3f(0.0, 0.0, 1.0), coarse),
    );
    return slope * select(bound_pages.coarse * exp2(-coarse), place.scale, place.scale.x > 0.0);
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
