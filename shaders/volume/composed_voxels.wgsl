// Voxels composed of layers, level 0 of their pyramid: materials from several fields, spread.
#import "volume/layers.wgsl"
#import "volume/spread_voxels.wgsl"

// Material of a voxel; 0 outside the grid.
fn voxel_material(place: vec3i) -> vec4f {
    let voxel = clamp(place, vec3i(0), field_grid() - 1);
    return select(vec4f(0.0), layered_material(voxel), all(voxel == place));
}

@compute @workgroup_size(8, 8, 4)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    resample = bound_resample;
    layers = bound_layers;
    let sum = spread_material(group, local, index);
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    textureStore(level, texel, sum);
}
