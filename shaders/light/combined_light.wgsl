// Combined light: all shadowed lights in one volume of colours (P §4). Shading is done here, once for every voxel,
// and the eye pass only looks up diffuse light. One thread per voxel.
#import "volume/field.wgsl"
#import "shading/shade.wgsl"
#import "shading/looked_up_light.wgsl"
#import "common/listed_voxels.wgsl"
#import "density/gradient.wgsl"

struct CombineUniform {
    dims: vec3u,
    // Number of bricks listed for this dispatch.
    bricks: u32,
    // Number of data voxels per voxel of the light volumes, along an axis.
    voxel_step: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}

@group(0) @binding(2) var<uniform> bound_combine: CombineUniform;
var<private> combine: CombineUniform;
@group(0) @binding(3) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(4) var combined: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    combine = bound_combine;
    eye = bound_eye;
    grid = bound_grid;
    let voxel = voxel_of_listed_brick(group, local, combine.bricks);
    if (any(voxel >= combine.dims)) {
        return;
    }
    let p = (vec3f(voxel) + 0.5) * combine.voxel_step - 0.5;
    let field = pyramid_field(p, 0.0);
    let gradient = gradient_to_scene(eye.space, index_gradient(p, normal_level(0.0)));
    let slope = gradient + face_slope(p, 0.0, field, presence_gradient(p, 0.0));
    let found = VolumeSample(p, slope, field, 0.0);
    textureStore(combined, voxel, vec4f(shadowed_light_sum(surface_of(found)).diffuse, 1.0));
}
