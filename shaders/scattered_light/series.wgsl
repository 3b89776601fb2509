// Steps towards the limit of the series of bounces: what the last sweep brought, and what diffusion says that all later
// ones would bring (shaders/diffusion).

// Mean light that the last sweep brought.
@group(0) @binding(5) var<storage, read> received: array<vec4f>;
// Light of which the last sweep followed a bounce.
@group(0) @binding(7) var<storage, read_write> last: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> step_before: array<vec4f>;
@group(0) @binding(11) var<storage, read> solution: array<vec4f>;

// Set if the change that the last sweep brought has diffused.
override DIFFUSES: bool = true;

// Step of a block from the light before the last sweep.
fn series_step(at: u32) -> vec3f {
    let change = received[at].rgb - last[at].rgb;
    if (DIFFUSES) {
        return change + solution[at].rgb;
    }
    return change;
}
