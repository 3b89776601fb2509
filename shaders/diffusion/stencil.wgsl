// Conductances between the blocks of the finest level, from their extinction and scattering.
#import "diffusion/level.wgsl"

@group(0) @binding(1) var<storage, read> scattering: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> stencils: array<vec4u>;

// Optical depth of the grid's longest edge below which D grows no further. In emptiness light does not diffuse, and a D
// of a ninth of that edge is about what light that goes straight across a cavity amounts to.
const MIN_DEPTH = 3.0;
// Share of an edge's optical depth by which the interpolation of sweeps spreads light. A linear interpolation at the
// fraction t adds t(1 − t)/2 times the second difference, 1/12 in the mean over t; rays are interpolated twice, into
// the medium and out of it, across two of three axes: 2/12 · 2/3 = 1/9.
const SPREAD = 0.111;

// Diffusion coefficient, D = 1/(3σ), times what slabs of optical depth τ make of it, τ/2 · coth(τ/2): the second
// moment of the way that light goes before it is scattered, from the middle of one slab to that of another.
fn diffusion_coefficient(extinction: f32, edge: f32) -> f32 {
    let size = level.edges * vec3f(level.dims);
    let sigma = max(extinction, MIN_DEPTH / max(max(size.x, size.y), size.z));
    let half_depth = 0.5 * sigma * edge;
    // The hyperbolic tangent overflows on some drivers; beyond 9 it is 1.
    return half_depth / tanh(min(half_depth, 9.0)) / (3.0 * sigma) + SPREAD * sigma * edge * edge;
}

// Conductance to the next block along an axis.
fn face_conductance(own: f32, at: u32, has_next: bool, edge: f32) -> f32 {
    if (!has_next) {
        return 0.0;
    }
    return diffusion_coefficient(0.5 * (own + scattering[at].a), edge) / (edge * edge);
}

// Conductance to outside of the grid, from which no light returns (Marshak): half a block, and 2 for the half of all
// directions.
fn border_conductance(own: f32, is_first: bool, is_last: bool, edge: f32) -> f32 {
    let outward = 1.0 / (edge * (0.5 * edge / diffusion_coefficient(own, edge) + 2.0));
    return outward * (f32(is_first) + f32(is_last));
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    level = bound_level;
    if (any(id >= level.dims)) {
        return;
    }
    let at = at_level(id);
    let own = scattering[at];
    let is_last = id + 1u == level.dims;
    let row = level.dims.x;
    let faces = vec3f(
        face_conductance(own.a, at + 1u, !is_last.x, level.edges.x),
        face_conductance(own.a, at + row, !is_last.y, level.edges.y),
        face_conductance(own.a, at + row * level.dims.y, !is_last.z, level.edges.z),
    );
    let outside = border_conductance(own.a, id.x == 0u, is_last.x, level.edges.x)
        + border_conductance(own.a, id.y == 0u, is_last.y, level.edges.y)
        + border_conductance(own.a, id.z == 0u, is_last.z, level.edges.z);
    let sink = max(vec3f(own.a) - own.rgb, vec3f(0.0)) + outside;
    stencils[at] = pack_stencil(Stencil(faces, sink));
}
