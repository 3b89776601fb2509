// Scattering and extinction of listed blocks of voxels: mean extinction of eight sample points in each, as optical
// depth per shortest edge of a voxel, and for each colour the scattering coefficient, extinction × albedo × colour.
#import "sky/places.wgsl"
#import "common/listed_cells.wgsl"

// Transfer function of the eye, whose colours are those of the scattering material.
@group(0) @binding(4) var<storage, read> look_table: TransferTable;
// Pyramid of voxels pre-classified by the eye's transfer function.
@group(0) @binding(5) var look_pyramid: texture_3d<f32>;
// Scattering in rgb, extinction in a.
@group(0) @binding(6) var<storage, read_write> scattering: array<vec4f>;
// Medium of the sweeps, without emission yet: emission of blocks per shortest edge in rgb, extinction in a; in r and
// g if all light has one colour.
@group(0) @binding(7) var medium: texture_storage_3d<TARGET_FORMAT, write>;

// Limit of extinction. Larger values would be no darker: half of it absorbs all light within a voxel, and it fits in
// 16 bits.
const MAX_EXTINCTION = 1024.0;

// Linear colour of the material at an index-space point.
fn color_at(p: vec3f) -> vec3f {
#if PRECLASSIFY
    let found = textureSampleLevel(look_pyramid, clamped, (p + 4.5) * grid.pyramid_scale, blocks.level);
    return clamp(found.gba / max(found.r, 1e-20), vec3f(0.0), vec3f(1.0));
#else
    let at = table_entry(pyramid(p, blocks.level));
    return mix(look_table.entries[at.low].rgb, look_table.entries[at.low + 1u].rgb, at.fraction);
#endif
}

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
            sum += extinction * vec4f(color_at(p) * blocks.albedo, 1.0);
        }
    }
    sum *= blocks.edge / 8.0;
    sum *= min(MAX_EXTINCTION / max(sum.a, 1e-9), 1.0);
#if ONE_COLOR
    textureStore(medium, id + 1u, vec4f(0.0, sum.a, 0.0, 0.0));
#else
    textureStore(medium, id + 1u, vec4f(0.0, 0.0, 0.0, sum.a));
#endif
    scattering[(id.z * blocks.dims.y + id.y) * blocks.dims.x + id.x] = sum;
}
