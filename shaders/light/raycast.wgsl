// Ray casting of a light volume: a ray from every voxel to the light (P §3.4, eq. 8), one thread per voxel.
#import "volume/material.wgsl"
#import "shading/shadow_ray.wgsl"
#import "shading/lights.wgsl"
#import "common/space.wgsl"
#import "common/listed_voxels.wgsl"

struct RaycastUniform {
    light: LightUniform,
    space: SpaceUniform,
    dims: vec3u,
    // Number of bricks listed for this dispatch.
    bricks: u32,
    // Number of data voxels per voxel of the light volume, along an axis.
    voxel_step: f32,
    // Distance between samples, in scene units.
    ray_step: f32,
    // Optical depth at which a ray ends.
    max_optical_depth: f32,
    pad0: u32,
    // Region that attenuates light.
    shading_cut: CutUniform,
}

@group(0) @binding(0) var<uniform> bound_raycast: RaycastUniform;
var<private> raycast: RaycastUniform;
// g: distance to the nearest cell that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(4) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

fn slab_ray_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    return slab_presence(frame, ray, k);
}

// White light or a single colour is followed, so extinction is a scalar.
fn ray_extinction(frame: SheetFrameUniform, ray: Ray, k: f32) -> Transmittance {
    return Transmittance(extinction_of(slab_field(frame, ray, k)));
}

fn light_distance(cell: vec3f) -> i32 {
    return cell_distances(distances, cell).y;
}

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    grid = bound_grid;
    raycast = bound_raycast;
    let voxel = voxel_of_listed_brick(group, local, raycast.bricks);
    if (any(voxel >= raycast.dims)) {
        return;
    }
    let p = (vec3f(voxel) + 0.5) * raycast.voxel_step - 0.5;
    let towards = to_light(raycast.light, scene_from_index(raycast.space, p));
    let direction = index_from_scene_vector(raycast.space, towards.direction);
    let scale = raycast.light.extinction_scale;
    let reach = towards.distance;
    let cut = raycast.shading_cut;
    let arriving = shadow_ray(p, direction, reach, raycast.ray_step, scale, raycast.max_optical_depth, cut);
    textureStore(attenuation, voxel, vec4f(min_component(arriving) * cone_attenuation(raycast.light, towards.direction)));
}
