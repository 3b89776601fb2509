// Voxel list of the scattering engine (crates/render/src/scatter/voxels.rs).
#import "common/sizes.wgsl"

// Densities of 8³ voxels per brick, two per word, as 16-bit normalised numbers.
@group(0) @binding(6) var<storage, read> voxels: array<u32>;

// Density of a voxel of the brick whose words begin at `first`.
fn voxel_density(first: u32, local: vec3u) -> f32 {
    let at = local.x + BRICK_EDGE * (local.y + BRICK_EDGE * local.z);
    let pair = unpack2x16unorm(voxels[first + at / 2u]);
    return select(pair.x, pair.y, at % 2u == 1u);
}
