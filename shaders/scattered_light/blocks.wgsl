// Scattering and extinction of listed blocks of voxels: mean extinction of eight sample points in each, as optical
// depth per shortest edge of a voxel, and for each colour the scattering coefficient, extinction × albedo × colour.
#import "sky/places.wgsl"
#import "common/listed_cells.wgsl"
#import "scattered_light/medium.wgsl"

// Scattering in rgb, extinction in a.
@group(0) @binding(6) var<storage, read_write> scattering: array<vec4f>;
// Medium of the sweeps, without emission yet.
@group(0) @binding(7) var medium: texture_storage_3d<TARGET_FORMAT, write>;

// Limit of extinction. Larger values would be no darker: half of it absorbs all light within a voxel, and it fits in
// 16 bits.
const MAX_EXTINCTION = 1024.0;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    blocks = bound_blocks;
    grid = bound_grid;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= blocks.dims)) {
        return;
    }
    var sum = vec4f(0.0);
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let p = block_sample_point(id, corner);
        let extinction = extinction_at(p);
        if (extinction > 0.0) {
            sum += extinction * vec4f(look_color(p, blocks.level) * blocks.albedo, 1.0);
        }
    }
    sum *= blocks.edge / 8.0;
    sum *= min(MAX_EXTINCTION / max(sum.a, 1e-9), 1.0);
    textureStore(medium, id + 1u, medium_texel(vec3f(0.0), sum.a));
    scattering[(id.z * blocks.dims.y + id.y) * blocks.dims.x + id.x] = sum;
}
