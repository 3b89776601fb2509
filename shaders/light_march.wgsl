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
    let inside = slabs_inside(march.frame, ray);
    let pixel = id.y * march.frame.size.x + id.x;
    let end = i32(march.end);
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
                let unread = near(distances, cell).x - march.reach;
                if (unread <= 0) {
                    break;
                }
                k = leap(walk, k, cell, unread);
            }
            var attenuates = false;
            loop {
                if (k >= end) {
                    break;
                }
                let found = near(distances, cell_at(walk, k));
                let is_read = found.x <= march.reach;
                attenuates = is_read && found.y <= grid.dilation && t > march.dark && k >= inside.x && k <= inside.y;
                if (attenuates || !is_read) {
                    break;
                }
                textureStore(ring, vec3u(id, u32(k) % march.layers), vec4f(t));
                k += 1;
            }
            if (attenuates || k >= end) {
                break;
            }
        }
        if (k >= end) {
            break;
        }
        let extinction = slab_material(march.frame, ray, f32(k)).a;
        let tau = extinction * march.extinction_scale * march.frame.slab * ray.obliquity;
        textureStore(ring, vec3u(id, u32(k) % march.layers), vec4f(deposited(t, tau)));
        t *= exp(-tau);
        k += 1;
    }
    transmittance[pixel] = t;
}
