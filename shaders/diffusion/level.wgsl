// Levels of the diffusion equation of scattered light, −∇·(D ∇f) + (σ − ς) f = q, on coarser and coarser grids of
// blocks: σ is the extinction, ς the scattering and q the right side for each colour.

struct DiffusionLevelUniform {
    // Number of blocks along x, y and z.
    dims: vec3u,
    // Index of the level's first block in the lists.
    first: u32,
    // Number of blocks of the next coarser level.
    coarser_dims: vec3u,
    coarser_first: u32,
    // Edges of the blocks of the finest level, in shortest edges of a voxel.
    edges: vec3f,
    pad0: f32,
}

@group(0) @binding(0) var<uniform> bound_level: DiffusionLevelUniform;
var<private> level: DiffusionLevelUniform;

// Conductances of a block: light that flows per difference of f.
struct Stencil {
    // To the next block along x, y and z; 0 at the last one.
    faces: vec3f,
    // To nowhere, for each colour: light that is absorbed or leaves the grid.
    sink: vec3f,
}

// Two numbers above 0 in 32 bits, with as many bits of exponent as they have and 8 of mantissa: conductances need not be
// exact, since they decide only how fast the series is summed.
fn pack_pair(low: f32, high: f32) -> u32 {
    let rounded = vec2u(bitcast<u32>(low), bitcast<u32>(high)) + 0x8000u;
    return (rounded.x >> 16u) | (rounded.y & 0xffff0000u);
}

fn unpack_pair(pair: u32) -> vec2f {
    return vec2f(bitcast<f32>(pair << 16u), bitcast<f32>(pair & 0xffff0000u));
}

fn pack_stencil(stencil: Stencil) -> vec4u {
    let faces = stencil.faces;
    let sink = stencil.sink;
    return vec4u(pack_pair(faces.x, faces.y), pack_pair(faces.z, sink.r), pack_pair(sink.g, sink.b), 0u);
}

fn unpack_stencil(packed: vec4u) -> Stencil {
    let between = unpack_pair(packed.y);
    return Stencil(vec3f(unpack_pair(packed.x), between.x), vec3f(between.y, unpack_pair(packed.z)));
}

// Index of a block of this level in the lists.
fn at_level(id: vec3u) -> u32 {
    return level.first + (id.z * level.dims.y + id.y) * level.dims.x + id.x;
}

// Index of a block of the next coarser level in the lists.
fn at_coarser(id: vec3u) -> u32 {
    return level.coarser_first + (id.z * level.coarser_dims.y + id.y) * level.coarser_dims.x + id.x;
}

// One of the 2³ blocks that a coarser one merges, by its number: x in bit 0, y in bit 1, z in bit 2.
fn merged_block(coarser: vec3u, index: u32) -> vec3u {
    return 2u * coarser + vec3u(index & 1u, (index >> 1u) & 1u, index >> 2u);
}
