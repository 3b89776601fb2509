// Share of the step before that is taken out of each step towards the limit of the series, for each colour:
// γ = ⟨pₙ − pₙ₋₁, pₙ⟩ / ⟨pₙ − pₙ₋₁, pₙ − pₙ₋₁⟩ over all blocks that scatter light, which makes what is left smallest
// (Anderson 1965). Steps that come back, or fall short all alike, are so made right.
#import "scattered_light/bounce.wgsl"
#import "scattered_light/series.wgsl"

@group(0) @binding(9) var<storage, read_write> mixing: array<vec4f>;

// A single workgroup whose threads stride over the blocks, so that the order of summation is always the same.
const THREADS = 256u;

// Largest magnitude of the share. Beyond it the two steps are so alike that their difference says little.
const MAX_SHARE = 1.0;

var<workgroup> products: array<vec3f, THREADS>;
var<workgroup> squares: array<vec3f, THREADS>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    bounce = bound_bounce;
    let count = bounce.dims.x * bounce.dims.y * bounce.dims.z;
    var product = vec3f(0.0);
    var square = vec3f(0.0);
    for (var at = thread; at < count; at += THREADS) {
        if (scattering[at].a > 0.0) {
            let step = series_step(at);
            let change = step - step_before[at].rgb;
            product += change * step;
            square += change * change;
        }
    }
    products[thread] = product;
    squares[thread] = square;
    workgroupBarrier();
    for (var half = THREADS / 2u; half > 0u; half /= 2u) {
        if (thread < half) {
            products[thread] += products[thread + half];
            squares[thread] += squares[thread + half];
        }
        workgroupBarrier();
    }
    if (thread == 0u) {
        let found = products[0] / max(squares[0], vec3f(1e-20));
        mixing[0] = vec4f(clamp(found, vec3f(-MAX_SHARE), vec3f(MAX_SHARE)), 0.0);
    }
}
