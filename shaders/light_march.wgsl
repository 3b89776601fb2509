// Forward half of the light pass (P §3.5, eq. 10): one thread per light pixel walks its slabs front
// to back, and stores for each the transmittance that the slab deposits.
//
// Sheets go to a ring of layers; the back-projection reads them before they are overwritten. Only
// what it will read is stored: the rest of the ring holds leftovers.
#import "common/table.wgsl"
#import "common/bricks.wgsl"

struct March {
    frame: SheetFrame,
    // Slabs of this chunk: first, and one beyond the last.
    begin: u32,
    end: u32,
    layers: u32,
    // Rows of this dispatch: first, and one beyond the last.
    first_row: u32,
    end_row: u32,
    // Multiplies extinctions.
    extinction_scale: f32,
    // The light's hood, as in common/lights.wgsl, its axis along the sheets' axes.
    hood_inner: f32,
    hood_outer: f32,
    hood_axis: vec3f,
    // Light is followed until less than this is left of it.
    dark: f32,
}

@group(0) @binding(0) var<uniform> march: March;
// Distances in bricks: r to the nearest that is read, g to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<u32>;
// Transmittance in front of the next slab, per pixel.
@group(0) @binding(3) var<storage, read_write> transmittance: array<f32>;
@group(0) @binding(4) var ring: texture_storage_3d<STORAGE_FORMAT, write>;

// P eq. 10 read literally takes the transmittance in front of the slab.
override DEPOSIT_FRONT: bool = false;

// The mean transmittance over a slab of optical depth tau, over that in front of it: (1 − e^−τ)/τ.
fn slab_mean(tau: f32) -> f32 {
    // The series avoids 0/0; at 0.01 its error is τ³/24 = 4e-8.
    return select((1.0 - exp(-tau)) / tau, 1.0 - tau * (0.5 - tau / 6.0), tau < 0.01);
}

// What the hood lets through to a pixel: the sheet in front of the first slab.
fn unattenuated(pixel: vec2f) -> f32 {
    let slope = march.frame.slope + march.frame.slope_di * pixel.x + march.frame.slope_dj * pixel.y;
    let along = normalize(vec3f(slope, 1.0));
    return smoothstep(march.hood_outer, march.hood_inner, dot(march.hood_axis, along));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) invocation: vec3u) {
    let id = invocation + vec3u(0u, march.first_row, 0u);
    if (id.x >= march.frame.size.x || id.y >= march.end_row) {
        return;
    }
    let ray = ray_of(march.frame, vec2f(id.xy));
    let inside = slabs_inside(march.frame, ray);
    let pixel = id.y * march.frame.size.x + id.x;
    let end = i32(march.end);
    var k = i32(march.begin);
    var t = select(transmittance[pixel], unattenuated(vec2f(id.xy)), march.begin == 0u);
    loop {
        // Cheap steps in a loop of their own: leap over what nobody reads, and pass the light on
        // where nothing attenuates it. Software drivers save work only by leaving a loop.
        loop {
            if (k >= end) {
                break;
            }
            let brick = brick_of(ray.origin + ray.direction * depth_of(march.frame, f32(k)));
            let distance = vec2i(textureLoad(distances, brick, 0).rg);
            if (distance.r > 0) {
                k = leap(march.frame, ray, k, brick, distance.r);
            } else {
                if (distance.g <= grid.dilation && t > march.dark && k >= inside.x && k <= inside.y) {
                    break;
                }
                textureStore(ring, vec3u(id.xy, u32(k) % march.layers), vec4f(t));
                k += 1;
            }
        }
        if (k >= end) {
            break;
        }
        let extinction = classify(slab_density(march.frame, ray, f32(k))).a;
        let tau = extinction * march.extinction_scale * march.frame.slab * ray.obliquity;
        let deposit = select(t * slab_mean(tau), t, DEPOSIT_FRONT);
        textureStore(ring, vec3u(id.xy, u32(k) % march.layers), vec4f(deposit));
        t *= exp(-tau);
        k += 1;
    }
    transmittance[pixel] = t;
}
