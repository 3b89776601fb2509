// What of the volume attenuates light where rays to lights are short: a fetch from the pyramid. PRECLASSIFY: from that of
// what voxels mean for light, in which nothing is where no voxel is.
#import "density/volume.wgsl"

#if PRECLASSIFY
@group(1) @binding(10) var lighting_pyramid: texture_3d<f32>;
#endif

fn lighting_density(p: vec3f, level: f32) -> f32 {
#if PRECLASSIFY
    return textureSampleLevel(lighting_pyramid, clamped, (p + 4.5) * grid.pyramid_scale, level).r;
#else
    return pyramid(p, level);
#endif
}

fn lighting_presence(p: vec3f, level: f32) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
    return pyramid_presence(p, level);
#endif
}
