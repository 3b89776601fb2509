// Extinction for sweeps, sharpened at the surfaces of dense material.
//
// Sweeps interpolate extinction between blocks, so that opaque ones would reach a block into empty ones beside them.
// A block with less than 3/8 of the largest extinction around it gets a negative one instead: where extinction falls
// through that share, interpolation falls through 0, and sweeps take negative extinction for none. Fog stays as it is.
#import "sky/surface_block.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(3) var sharpened: texture_storage_3d<STORAGE_FORMAT, write>;
@group(0) @binding(5) var<storage, read> cells: array<u32>;

// Share of what a block has less than the largest extinction around it that is taken from it. With 1 it would be
// half of the largest that falls through 0, which is right for planes. But interpolation rounds edges and rims off,
// by 0.2 blocks for rays that pass at an angle, and floors of wells are up to 20 % too bright; with 0.5 some are 5 %
// too dark.
const SURROUNDING_SHARE = 0.6;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    geometry = bound_geometry;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= geometry.dims)) {
        return;
    }
    var most = 0.0;
    for (var z = 0u; z < 3u; z += 1u) {
        for (var y = 0u; y < 3u; y += 1u) {
            for (var x = 0u; x < 3u; x += 1u) {
                most = max(most, textureLoad(extinction, id + vec3u(x, y, z), 0).r);
            }
        }
    }
    let own = textureLoad(extinction, id + 1u, 0).r;
    textureStore(sharpened, id + 1u, vec4f(own - solidity(most) * SURROUNDING_SHARE * (most - own)));
}
