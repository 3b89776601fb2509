// Pre-classification, level 0: materials of the voxels of one field, spread.
#import "volume/material.wgsl"
#import "volume/spread_voxels.wgsl"

// Material of a voxel of the density texture, which has a border of one voxel; 0 outside the grid.
fn voxel_material(place: vec3i) -> vec4f {
    let last = vec3i(source_size()) - 1;
    // Texels of the border are not voxels.
    let voxel = clamp(place + 1, vec3i(1), last - 1);
    let texel = preclassified_texel(material_of(Field(source_texel(voxel).r)));
#if MISSING
    // Neighbours stand in for missing voxels, and the sum is multiplied by presence.
    let is_in_grid = true;
#else
    let is_in_grid = all(voxel == place + 1);
#endif
    return select(vec4f(0.0), texel, is_in_grid);
}

@compute @workgroup_size(8, 8, 4)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    resample = bound_resample;
    var sum = spread_material(group, local, index);
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
#if MISSING
    // The fraction of the blur on existing voxels.
    sum *= presence_at_texel(texel);
#endif
    textureStore(level, texel, sum);
}
