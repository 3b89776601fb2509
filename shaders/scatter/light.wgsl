// March of light through scattered sheets (P §3.5, eq. 10): one thread per pixel takes the slab's sum and clears it
// for the next slab.
#import "density/slab_field.wgsl"
#import "sheets/march.wgsl"
#import "scatter/slab.wgsl"
#import "volume/material.wgsl"

// Distances in bricks: g to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<u32>;

// Deposits of the slabs that share a texel of the ring.
@group(0) @binding(5) var<storage, read_write> deposits: array<vec4f>;

// Reach of a stretched kernel, in bricks beyond an occupied one.
override DILATION: i32 = 0;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    march = bound_march;
    scatter = bound_scatter;
    grid = bound_grid;
    if (any(id.xy >= march.frame.size)) {
        return;
    }
    let pixel = id.y * march.frame.size.x + id.x;
    let sum = f32(atomicExchange(&sheets[sheet_index(id.xy, scatter.k)], 0)) / FIXED_POINT_ONE;
    let t = select(transmittance[pixel], cone_light(vec2f(id.xy)), scatter.k == 0u);
    let ray = ray_of(march.frame, vec2f(id.xy));
    let brick = brick_with_material(ray.origin + ray.direction * depth_of(march.frame, f32(scatter.k)));
    var tau = 0.0;
    if (t > march.min_transmittance && brick.x >= 0) {
        // Sums are complete only near bricks that attenuate light.
        if (i32(textureLoad(distances, brick, 0).g) <= DILATION) {
            // Mean over the existing voxels, times presence.
            let in_grid = slab_in_grid(march.frame, ray, f32(scatter.k));
            let presence = slab_presence(march.frame, ray, f32(scatter.k));
            let mean = sum / max(in_grid, MIN_PRESENCE);
            let classified = extinction_of(Field(mean)) * presence;
            // Neighbours stand in for missing voxels, but not outside the grid.
            let splatted = select(sum, mean * presence, MISSING) * scatter.extinction_unit;
            let extinction = select(classified, splatted, SPLAT == SPLAT_EXTINCTION);
            let place = ray.origin + ray.direction * depth_of(march.frame, f32(scatter.k));
            let share = shading_fraction(march.shading_cut, place);
            tau = share * extinction * march.extinction_scale * march.frame.slab * ray.obliquity;
        }
    }
    let kept = with_deposit(deposits[pixel], scatter.k, slab_deposit(t, tau));
    deposits[pixel] = kept;
    store_deposits(id.xy, scatter.k, kept);
    transmittance[pixel] = t * exp(-tau);
}
