// Normals of surfaces near listed blocks of voxels: the direction in which the opacity of blocks falls. The points of
// wide lights are weighted by them (light/area_light.wgsl).
#import "common/listed_cells.wgsl"
#import "common/space.wgsl"

struct BlockNormalsUniform {
    space: SpaceUniform,
    // Number of blocks along x, y and z.
    dims: vec3u,
    pad0: u32,
    // One over the size of the opacity texture, including its border.
    opacity_scale: vec3f,
    pad1: f32,
}

@group(0) @binding(0) var<uniform> bound_near: BlockNormalsUniform;
var<private> near: BlockNormalsUniform;
@group(0) @binding(1) var opacity: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var<storage, read> cells: array<u32>;
// Unit normal in scene space, times the degree to which there is a surface.
@group(0) @binding(4) var normals: texture_storage_3d<rgba16float, write>;

// Distance of the 26 places around a block along each axis, in blocks, and the factor for each axis along which a place
// is not displaced. Each place takes three quarters of the nearer block and a quarter of the farther one; so surfaces
// are found up to two blocks away, and the normals of planes of any tilt within 2° (root mean square) up to 1½.
const SPREAD = 1.25;
const MIDDLE_FACTOR = 1.5;

// Opacity at a position in blocks.
fn opacity_at(b: vec3f) -> f32 {
    return textureSampleLevel(opacity, clamped, (b + 1.5) * near.opacity_scale, 0.0).r;
}

// Vector towards falling opacity. Opaque material that fills half of the space has a length of 12.
fn falling_opacity(b: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < 27u; i += 1u) {
        let side = vec3f(f32(i % 3u), f32(i / 3u % 3u), f32(i / 9u)) - 1.0;
        let factors = select(vec3f(1.0), vec3f(MIDDLE_FACTOR), side == vec3f(0.0));
        sum -= side * (factors.x * factors.y * factors.z * opacity_at(b + SPREAD * side));
    }
    return sum;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    near = bound_near;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= near.dims)) {
        return;
    }
    let falling = falling_opacity(vec3f(id));
    let slope = gradient_to_scene(near.space, falling);
    // Less than a twelfth of half a space is faint, or far away.
    let share = min(length(falling), 1.0);
    textureStore(normals, id, vec4f(slope * (share / max(length(slope), 1e-9)), 0.0));
}
