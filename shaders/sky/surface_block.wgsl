// Surface of dense material near a block of voxels: rays from the block to the sky start in front of it, so that the
// material does not hide the sky from its own surface.

struct SurfaceBlocksUniform {
    // Number of blocks along x, y and z.
    dims: vec3u,
    // 1 if dense material has surfaces, 0 if all of it is fog.
    has_surfaces: u32,
    // One over the size of the block texture, including its border.
    block_scale: vec3f,
    // Number of directions in which light is followed.
    directions: u32,
    // Change of the position in blocks along x, y and z of scene space.
    along_x: vec3f,
    pad1: f32,
    along_y: vec3f,
    pad2: f32,
    along_z: vec3f,
    pad3: f32,
}

@group(0) @binding(7) var<uniform> bound_geometry: SurfaceBlocksUniform;
var<private> geometry: SurfaceBlocksUniform;

// Surface near a block; lengths and right angles are those of block coordinates.
struct BlockSurface {
    // Unit vector out of the material.
    normal: vec3f,
    // Height of the block's centre above the surface.
    height: f32,
    // Degree to which the block belongs to the surface, 0 … 1; else it is fog.
    share: f32,
    // Factors of V₀ and of the light that make them 1 on an open surface, which means over few directions miss.
    scale: vec2f,
    // True if the block is so deep in dense material that no light reaches it.
    is_buried: bool,
}

// Range of optical depths per shortest edge of a voxel over which fog turns into material with a surface: opacities
// of 0.4 … 0.8 per voxel. Light enters less deeply than two voxels then.
const FOG_DEPTH = 0.5;
const SURFACE_DEPTH = 1.5;

// Degree to which material of an optical depth per shortest edge of a voxel has a surface, 0 … 1.
fn solidity(depth: f32) -> f32 {
    return smoothstep(FOG_DEPTH, SURFACE_DEPTH, depth);
}

// Largest height that is packed, in blocks: places end 2.5 blocks from a block's centre (sky/surfaces.wgsl).
const MAX_HEIGHT = 4.0;

// Packs a surface; the share of buried blocks is −1.
fn pack_surface(surface: BlockSurface) -> vec4u {
    let rest = pack2x16snorm(vec2f(surface.height / MAX_HEIGHT, select(surface.share, -1.0, surface.is_buried)));
    return vec4u(pack2x16snorm(surface.normal.xy), pack2x16snorm(vec2f(surface.normal.z, 0.0)), rest,
        pack2x16snorm(0.5 * surface.scale));
}

fn unpack_surface(packed: vec4u) -> BlockSurface {
    let normal = vec3f(unpack2x16snorm(packed.x), unpack2x16snorm(packed.y).x);
    let rest = unpack2x16snorm(packed.z);
    let scale = 2.0 * unpack2x16snorm(packed.w);
    return BlockSurface(normal, rest.x * MAX_HEIGHT, max(rest.y, 0.0), scale, rest.y < 0.0);
}

// Unit normal in scene space.
fn scene_normal(surface: BlockSurface) -> vec3f {
    let n = surface.normal;
    return normalize(vec3f(dot(geometry.along_x, n), dot(geometry.along_y, n), dot(geometry.along_z, n)));
}

// Height above a surface at which its own material hides nothing.
//
// Transmittance is interpolated between rays and slices that are a block apart, which spreads a surface by one block
// along each axis, |nx| + |ny| + |nz| along the normal. Errors of its position and the tails of soft curves make tilted
// plates up to 2 % too dark; half a block more would mend that, but light a third of the bottom of grooves and corners.
fn clearance(normal: vec3f) -> f32 {
    return dot(abs(normal), vec3f(1.0));
}
