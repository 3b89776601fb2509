// Solution of the diffusion equation, and the balance of a block with its neighbours.
#import "diffusion/level.wgsl"

@group(0) @binding(1) var<storage, read> stencils: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> right_sides: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> solution: array<vec4f>;

// Set if the coarser level corrects the solution where it is read.
override CORRECTS: bool = false;

fn solution_at(at: u32, id: vec3u) -> vec3f {
    if (CORRECTS) {
        return solution[at].rgb + solution[at_coarser(id / 2u)].rgb;
    }
    return solution[at].rgb;
}

// Flow into a block from its neighbours, and the sum of its conductances.
struct Balance {
    inflow: vec3f,
    conductance: vec3f,
}

fn balance_of(at: u32, id: vec3u) -> Balance {
    let own = unpack_stencil(stencils[at]);
    let row = level.dims.x;
    let slice = row * level.dims.y;
    var found = Balance(vec3f(0.0), own.sink + own.faces.x + own.faces.y + own.faces.z);
    if (own.faces.x > 0.0) {
        found.inflow += own.faces.x * solution_at(at + 1u, id + vec3u(1u, 0u, 0u));
    }
    if (own.faces.y > 0.0) {
        found.inflow += own.faces.y * solution_at(at + row, id + vec3u(0u, 1u, 0u));
    }
    if (own.faces.z > 0.0) {
        found.inflow += own.faces.z * solution_at(at + slice, id + vec3u(0u, 0u, 1u));
    }
    if (id.x > 0u) {
        let face = unpack_stencil(stencils[at - 1u]).faces.x;
        found.inflow += face * solution_at(at - 1u, id - vec3u(1u, 0u, 0u));
        found.conductance += face;
    }
    if (id.y > 0u) {
        let face = unpack_stencil(stencils[at - row]).faces.y;
        found.inflow += face * solution_at(at - row, id - vec3u(0u, 1u, 0u));
        found.conductance += face;
    }
    if (id.z > 0u) {
        let face = unpack_stencil(stencils[at - slice]).faces.z;
        found.inflow += face * solution_at(at - slice, id - vec3u(0u, 0u, 1u));
        found.conductance += face;
    }
    return found;
}

// First solution of a block: the one that balances every other block while all others have none.
fn first_solution(at: u32, id: vec3u) -> vec4f {
    if (((id.x + id.y + id.z) & 1u) == 1u) {
        return vec4f(0.0);
    }
    let own = unpack_stencil(stencils[at]);
    let row = level.dims.x;
    let slice = row * level.dims.y;
    var conductance = own.sink + own.faces.x + own.faces.y + own.faces.z;
    if (id.x > 0u) {
        conductance += unpack_stencil(stencils[at - 1u]).faces.x;
    }
    if (id.y > 0u) {
        conductance += unpack_stencil(stencils[at - row]).faces.y;
    }
    if (id.z > 0u) {
        conductance += unpack_stencil(stencils[at - slice]).faces.z;
    }
    return vec4f(right_sides[at].rgb / max(conductance, vec3f(1e-12)), 0.0);
}

// Solution that balances a block with its neighbours (Gauss and Seidel).
fn balanced_solution(at: u32, id: vec3u) -> vec4f {
    let balance = balance_of(at, id);
    return vec4f((right_sides[at].rgb + balance.inflow) / max(balance.conductance, vec3f(1e-12)), 0.0);
}
