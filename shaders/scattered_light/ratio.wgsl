// Ratio of successive bounces for each colour, ρ = ⟨dₙ, dₙ₋₁⟩ / ⟨dₙ₋₁, dₙ₋₁⟩ over all blocks that scatter light. Each
// further bounce brings ρ times the previous one, in total ρ / (1 − ρ) times the last.
#import "scattered_light/bounce.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(7) var<storage, read> last: array<vec4f>;
@group(0) @binding(8) var<storage, read> change: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> ratio: array<vec4f>;

// A single workgroup whose threads stride over the blocks, so that the order of summation is always the same.
const THREADS = 256u;

// Limit of the ratio. Slower decay cannot be distinguished from none: bounces that bring as much as those before say
// little about the limit.
const MAX_RATIO = 0.98;

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
            let before = change[at].rgb;
            product += (sums[at].rgb * bounce.share - last[at].rgb) * before;
            square += before * before;
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
        ratio[0] = vec4f(clamp(found, vec3f(0.0), vec3f(MAX_RATIO)), 0.0);
    }
}
