// Extinction for sweeps, sharpened at the surfaces of dense material.
//
// Sweeps interpolate extinction between blocks, so that opaque ones would reach a block into empty ones beside them.
// A block with less than half of the largest extinction around it gets a negative one instead: where extinction falls
// through half, interpolation falls through 0, and sweeps take negative extinction for none. Fog stays as it is.
#import "sky/surface_block.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(3) var sharpened: texture_storage_3d<STORAGE_FORMAT, write>;
@group(0) @binding(5) var<storage, read> cells: array<u32>;

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
    textureStore(sharpened, id + 1u, vec4f(own - solidity(most) * (most - own)));
}
