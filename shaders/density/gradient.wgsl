// Normals from the volume.
#import "density/volume.wgsl"

// Central differences of the reconstructed density at ± one voxel of a level of the pyramid, in index
// space.
fn index_gradient(p: vec3f, level: f32) -> vec3f {
    let h = exp2(level);
    return vec3f(
        pyramid(p + vec3f(h, 0.0, 0.0), level) - pyramid(p - vec3f(h, 0.0, 0.0), level),
        pyramid(p + vec3f(0.0, h, 0.0), level) - pyramid(p - vec3f(0.0, h, 0.0), level),
        pyramid(p + vec3f(0.0, 0.0, h), level) - pyramid(p - vec3f(0.0, 0.0, h), level),
    ) / (2.0 * h);
}
