// A light volume filled by a ray from every voxel to the light (P §3.4, eq. 8): one thread per voxel.
#import "common/table.wgsl"
#import "common/shadow_ray.wgsl"
#import "common/lights.wgsl"

struct Raycast {
    light: Light,
    // Index space to scene space: three rows of an affine map.
    scene_from_index_x: vec4f,
    scene_from_index_y: vec4f,
    scene_from_index_z: vec4f,
    // Scene vectors to index vectors: three rows.
    index_from_scene_x: vec4f,
    index_from_scene_y: vec4f,
    index_from_scene_z: vec4f,
    dims: vec3u,
    // Bricks listed for this dispatch.
    bricks: u32,
    // Data voxels per voxel of the light volume.
    voxel_step: f32,
    // Distance between samples, in scene units.
    ray_step: f32,
    // Optical depth at which a ray ends.
    dark: f32,
    // 1: consult the bricks.
    leaping: u32,
}

@group(0) @binding(0) var<uniform> raycast: Raycast;
// Distance in bricks to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<u32>;
@group(0) @binding(3) var<storage, read> bricks: array<u32>;
@group(0) @binding(4) var attenuation: texture_storage_3d<STORAGE_FORMAT, write>;

fn light_extinction(density: f32) -> f32 {
    return classify(density).a;
}

fn light_distance(brick: vec3i) -> i32 {
    return select(0, i32(textureLoad(distances, brick, 0).r), raycast.leaping != 0u);
}

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    // As in light_backproject.wgsl.
    let listed = group.y * 32768u + group.x / 2u;
    if (listed >= raycast.bricks) {
        return;
    }
    let packed = bricks[listed];
    let brick = vec3u(packed & 1023u, packed >> 10u & 1023u, packed >> 20u);
    let voxel = brick * 8u + local + vec3u(0u, 0u, group.x % 2u * 4u);
    if (any(voxel >= raycast.dims)) {
        return;
    }
    let p = (vec3f(voxel) + 0.5) * raycast.voxel_step - 0.5;
    let homogeneous = vec4f(p, 1.0);
    let position = vec3f(
        dot(raycast.scene_from_index_x, homogeneous),
        dot(raycast.scene_from_index_y, homogeneous),
        dot(raycast.scene_from_index_z, homogeneous),
    );
    let towards = to_light(raycast.light, position);
    let direction = vec3f(
        dot(raycast.index_from_scene_x.xyz, towards.direction),
        dot(raycast.index_from_scene_y.xyz, towards.direction),
        dot(raycast.index_from_scene_z.xyz, towards.direction),
    );
    let scale = raycast.light.extinction_scale;
    let arriving = shadow_ray(p, direction, towards.distance, raycast.ray_step, scale, raycast.dark);
    textureStore(attenuation, voxel, vec4f(arriving * hood_share(raycast.light, towards.direction)));
}
