// Normalisation of the splatted light by its weights (P §3.5), into the attenuation volume. One thread per voxel;
// voxels of other views of the light are left unchanged.
#import "scatter/slab.wgsl"
#import "common/listed_bricks.wgsl"

@group(0) @binding(0) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(1) var<storage, read> light: array<i32>;
@group(0) @binding(2) var<storage, read> weights: array<i32>;
@group(0) @binding(3) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    scatter = bound_scatter;
    let listed = listed_brick(group);
    if (listed >= scatter.count) {
        return;
    }
    let voxel = voxel_in(bricks[listed].x, group, local);
    if (any(voxel >= scatter.light_dims)) {
        return;
    }
    let at = project_to_sheets((vec3f(voxel) + 0.5) * scatter.voxel_step - 0.5);
    let spread = 1.0 + at.z * scatter.frame.inverse_distance;
    // Distance from the axis in pixels, times w.
    let across = at.xy + scatter.first_pixel * spread;
    let limit = spread / max(scatter.frame.inverse_distance * scatter.frame.pitch, 1e-20);
    if (!(spread > 0.0 && all(abs(across) <= vec2f(limit * 1.00001))) && scatter.cube_face != 0u) {
        return;
    }
    let index = voxel.x + scatter.light_dims.x * (voxel.y + scatter.light_dims.y * voxel.z);
    let weight = weights[index];
    let value = select(1.0, f32(light[index]) / f32(max(weight, 1)), weight > 0 && spread > 1e-3);
    textureStore(attenuation, voxel, vec4f(value));
}
