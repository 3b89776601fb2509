// Mean light that blocks receive from all directions of a sweep. Under lamps alone it is rid of what the interpolation
// between rays has spread: in dense material it would carry light a block further at every bounce, and out of the
// material. Under a sky it has to add up with the sky's own light, which is as spread.
#import "scattered_light/bounce.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> received: array<vec4f>;

// Share of the second difference along each axis that interpolation adds: t(1 − t)/2 at the fraction t between two
// rays, 1/12 in the mean, across two of three axes.
const SPREAD = 1.0 / 18.0;

// Set if that is taken out.
override SHARPENS: bool = true;

// Second difference of the sums along an axis whose next block is so far in the lists; 0 unless blocks on both sides
// scatter light.
fn second_difference(at: u32, next: u32, is_inside: bool) -> vec3f {
    if (!SHARPENS || !is_inside) {
        return vec3f(0.0);
    }
    if (scattering[at - next].a <= 0.0 || scattering[at + next].a <= 0.0) {
        return vec3f(0.0);
    }
    return sums[at - next].rgb + sums[at + next].rgb - 2.0 * sums[at].rgb;
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    bounce = bound_bounce;
    if (any(id >= bounce.dims)) {
        return;
    }
    let at = block_index(id);
    if (scattering[at].a <= 0.0) {
        return;
    }
    let row = bounce.dims.x;
    let is_inside = (id > vec3u(0u)) & (id + 1u < bounce.dims);
    let spread = second_difference(at, 1u, is_inside.x)
        + second_difference(at, row, is_inside.y)
        + second_difference(at, row * bounce.dims.y, is_inside.z);
    received[at] = vec4f(max(sums[at].rgb - SPREAD * spread, vec3f(0.0)) * bounce.share, 0.0);
}
