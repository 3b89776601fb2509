// Voxels composed of layers, level 0 of their pyramid: materials from several fields, spread; or the tints of the first
// field's material by further ones.
#option TINTS: tints instead of materials
#import "volume/layers.wgsl"
#import "volume/spread_voxels.wgsl"

// Material or tint of a voxel; 0 outside the grid.
fn voxel_material(place: vec3i) -> vec4f {
    let voxel = clamp(place, vec3i(0), field_grid() - 1);
#if TINTS
    let found = voxel_tint(voxel);
#else
    let found = layered_material(voxel);
#endif
#if MISSING
    // The sum is multiplied by presence, which is 0 outside.
    let is_in_grid = true;
#else
    let is_in_grid = all(voxel == place);
#endif
    return select(vec4f(0.0), found, is_in_grid);
}

@compute @workgroup_size(8, 8, 4)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    resample = bound_resample;
    layers = bound_layers;
    var sum = spread_material(group, local, index);
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
#if MISSING
    // The fraction of the blur on voxels that are not hidden.
    sum *= presence_at_texel(texel);
#endif
    textureStore(level, texel, sum);
}
