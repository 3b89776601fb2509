// Sweep of scattered light along parallel rays: one thread per ray walks through slices of blocks, and stores the
// mean light in each: attenuated light from behind, L, and emission of the slice, S. For a slab of optical depth τ
// with m = (1 − e^−τ)/τ the mean is L m + S (1 − m), and L e^−τ + S (1 − e^−τ) leaves it.
#import "sky/rays.wgsl"
#import "sky/near.wgsl"
#import "common/slab_source.wgsl"
#import "common/most_light.wgsl"

// Emission per shortest edge (S times extinction) and extinction: in rgb and a, or in r and g.
@group(0) @binding(1) var medium: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var sheets: texture_storage_3d<TARGET_FORMAT, write>;

// If all light has one colour only its amount is followed, a third of the numbers.
#if ONE_COLOR
alias Light = f32;

fn arriving_of(rays: SkyRays) -> Light {
    return rays.arriving.r;
}

fn given_in(found: vec4f) -> Light {
    return found.r;
}

fn extinction_in(found: vec4f) -> f32 {
    return found.g;
}

fn texel_of(light: Light) -> vec4f {
    return vec4f(light);
}
#else
alias Light = vec3f;

fn arriving_of(rays: SkyRays) -> Light {
    return rays.arriving;
}

fn given_in(found: vec4f) -> Light {
    return found.rgb;
}

fn extinction_in(found: vec4f) -> f32 {
    return found.a;
}

fn texel_of(light: Light) -> vec4f {
    return vec4f(light, 0.0);
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sweep = bound_sweep;
    // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
    let rays = bound_sweep.rays[id.z];
    if (any(id.xy >= rays.size)) {
        return;
    }
    let size = turned_to(rays, vec3f(sweep.dims));
    let last = size.x - 1.0;
    let start = vec2f(id.xy) + rays.first;
    let span = slices_of_ray(rays, id.xy, start, size);
    var light = arriving_of(rays);
    for (var n = span.x; n <= span.y; n += 1.0) {
        let slice = select(last - n, n, rays.rises == 1u);
        let block = turned_from(rays, vec3f(slice, start + rays.drift * n));
        let found = textureSampleLevel(medium, clamped, (block + 1.5) * sweep.block_scale, 0.0) * rays.step;
        let tau = extinction_in(found);
        let given = given_in(found);
        let share = slab_source(tau);
        let mean = 1.0 - tau * share;
        textureStore(sheets, vec3u(id.xy, rays.layer + u32(n)), texel_of(min(light * mean + given * share, Light(MOST_LIGHT))));
        light = light * exp(-tau) + given * mean;
    }
}
