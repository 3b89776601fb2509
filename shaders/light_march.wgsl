// Forward half of the light pass (P §3.5, eq. 10): one thread per light pixel walks its slabs front
// to back, and stores for each the transmittance that the slab deposits.
//
// Sheets go to a ring of layers; the back-projection reads them before they are overwritten. Only
// what it will read is stored: the rest of the ring holds leftovers.
#import "common/classify.wgsl"
#import "common/cells.wgsl"
#import "common/march.wgsl"
#import "common/tiles.wgsl"

// Distances: r to the nearest cell whose light is looked up, g to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;

@compute @workgroup_size(8, 8)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let id = tile_of(group, groups.y, march.runs) * 8u + local.xy + vec2u(0u, march.first_row);
    if (id.x >= march.frame.size.x || id.y >= march.end_row) {
        return;
    }
    let ray = ray_of(march.frame, vec2f(id));
    let span = span_within(march.shading_cut, ray);
    let inside = slabs_within(march.frame, span, slabs_inside(march.frame, ray));
    let pixel = id.y * march.frame.size.x + id.x;
    let end = i32(march.end);
    // The first of four slabs that share a texel of the ring.
    var k = i32(march.begin);
    var t = select(transmittance[pixel], unattenuated(vec2f(id)), march.begin == 0u);
    let walk = walk_along(march.frame, ray);
    loop {
        // Cheap steps in loops of their own: leap over what nobody reads, and pass the light on where
        // nothing attenuates it. Software drivers save work only by leaving a loop.
        loop {
            loop {
                if (k >= end) {
                    break;
                }
                let cell = cell_at(walk, k);
                let next = leap(walk, k, cell, near(distances, cell).x - march.reach);
                if (next < k + 4) {
                    break;
                }
                k = next & ~3;
            }
            var attenuates = false;
            loop {
                if (k >= end) {
                    break;
                }
                let cell = cell_at(walk, k);
                let found = near(distances, cell);
                let is_read = leap(walk, k, cell, found.x - march.reach) < k + 4;
                attenuates = is_read && t > march.dark && k + 3 >= inside.x && k <= inside.y
                    && leap(walk, k, cell, found.y - grid.dilation) < k + 4;
                if (attenuates || !is_read) {
                    break;
                }
                keep(id, u32(k), vec4f(t));
                k += 4;
            }
            if (attenuates || k >= end) {
                break;
            }
        }
        if (k >= end) {
            break;
        }
        let last = min(k + 4, end);
        var deposits = vec4f(t);
        var slab = k;
        loop {
            loop {
                if (slab >= last) {
                    break;
                }
                let attenuates = near(distances, cell_at(walk, slab)).y <= grid.dilation;
                if (attenuates && t > march.dark && slab >= inside.x && slab <= inside.y) {
                    break;
                }
                slab += 1;
            }
            if (slab >= last) {
                break;
            }
            let place = ray.origin + ray.direction * depth_of(march.frame, f32(slab));
            let share = share_that_shades(march.shading_cut, place);
            let extinction = slab_material(march.frame, ray, f32(slab)).a * share;
            let tau = extinction * march.extinction_scale * march.frame.slab * ray.obliquity;
            deposits = with_deposit(deposits, u32(slab), deposited(t, tau));
            t *= exp(-tau);
            deposits = with_deposits_behind(deposits, u32(slab), t);
            slab += 1;
        }
        keep(id, u32(k), deposits);
        k += 4;
    }
    transmittance[pixel] = t;
}
