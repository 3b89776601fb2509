// Light march, the first half of the light pass (P §3.5, eq. 10): one thread per light pixel walks through its slabs
// front to back, and stores for each the transmittance that the slab deposits.
//
// Sheets are stored in a ring of layers, which the back-projection reads before they are overwritten. Only what it
// will read is stored; the rest of the ring holds stale values.
#import "common/sizes.wgsl"
#import "density/slab_material.wgsl"
#import "density/cells.wgsl"
#import "sheets/march.wgsl"
#import "sheets/tiles.wgsl"

// Distances: r to the nearest cell visible in either transfer function, g to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;
// Tiles to be marched (crates/render/src/plan/geometry/march_tiles.rs): column, row from bit 15, and a bit for the
// first chunk in which light reaches the tile. The buffer may be longer than the list.
@group(0) @binding(5) var<storage, read> tiles: array<u32>;

// Progress of the march along a ray.
struct MarchProgress {
    // First of the four slabs that share a texel of the ring.
    k: i32,
    // Next slab of the four to be marched.
    slab: i32,
    // Deposits of the four slabs if nothing attenuates the light from `slab` on.
    deposits: vec4f,
}

// Next slab that attenuates light, or the end: skips slabs that are not read, and stores unattenuated light in those
// that are. One loop for both, across texels, because all lanes of a vector wait there for the slowest.
fn next_attenuating(walk: CellRay, pixel: vec2u, inside: vec2i, t: f32, start: MarchProgress) -> MarchProgress {
    var at = start;
    loop {
        if (at.slab == at.k + 4) {
            store_deposits(pixel, u32(at.k), at.deposits);
            at = MarchProgress(at.slab, at.slab, vec4f(t));
        }
        if (at.k >= i32(march.end)) {
            break;
        }
        let cell = cell_at(walk, at.slab);
        let found = cell_distances(distances, cell);
        // Tested once per texel, at the first of its slabs.
        let next_read = select(0, skip_empty_cells(walk, at.k, cell, found.x - march.reach), at.slab == at.k);
        let is_read = next_read < at.k + 4;
        let shines = t > march.min_transmittance && at.slab <= inside.y;
        if (is_read && shines && at.slab >= inside.x && found.y <= grid.dilation) {
            break;
        }
        let behind = select(at.k + 4, skip_empty_cells(walk, at.slab, cell, found.y - grid.dilation), shines);
        at.k = select(next_read & ~3, at.k, is_read);
        at.slab = select(at.k, min(behind, at.k + 4), is_read);
    }
    return at;
}

// Bits of a tile's column, and of its row after shifting.
const TILE_PLACE = (1u << TILE_ROW_BIT) - 1u;

@compute @workgroup_size(8, 8)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    grid = bound_grid;
    march = bound_march;
    let listed = group.y * LISTED_PER_ROW + group.x;
    if (listed >= march.tiles) {
        return;
    }
    let tile = tiles[listed];
    let id = vec2u(tile & TILE_PLACE, tile >> TILE_ROW_BIT & TILE_PLACE) * TILE_EDGE + in_tile(local.xy);
    if (any(id >= march.frame.size)) {
        return;
    }
    let ray = ray_of(march.frame, vec2f(id));
    let span = span_within(march.shading_cut, ray);
    let inside = slabs_within(march.frame, span, slabs_inside(march.frame, ray));
    let pixel = id.y * march.frame.size.x + id.x;
    let end = i32(march.end);
    var t = select(transmittance[pixel], cone_light(vec2f(id)), tile >> TILE_FIRST_BIT == 1u);
    let walk = cell_ray(march.frame, ray);
    let begin = i32(march.begin);
    var at = next_attenuating(walk, id, inside, t, MarchProgress(begin, begin, vec4f(t)));
    // Software drivers run a loop's body to its end before they test if any lane is active, so breaks are placed at
    // the end, not in the middle.
    loop {
        if (at.k >= end) {
            break;
        }
        let place = ray.origin + ray.direction * depth_of(march.frame, f32(at.slab));
        let share = shading_fraction(march.shading_cut, place);
        let extinction = slab_extinction(march.frame, ray, f32(at.slab)) * share;
        let tau = extinction * march.extinction_scale * march.frame.slab * ray.obliquity;
        at.deposits = with_deposit(at.deposits, u32(at.slab), slab_deposit(t, tau));
        t *= exp(-tau);
        at.deposits = with_deposits_behind(at.deposits, u32(at.slab), t);
        at.slab += 1;
        at = next_attenuating(walk, id, inside, t, at);
        if (at.k >= end) {
            break;
        }
    }
    transmittance[pixel] = t;
}
