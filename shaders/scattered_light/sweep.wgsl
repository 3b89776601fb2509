// Sweep of scattered light along parallel rays: one thread per ray walks through slices of blocks, and stores the
// mean light in each: attenuated light from behind, L, and emission of the slice, S. For a slab of optical depth τ
// with m = (1 − e^−τ)/τ the mean is L m + S (1 − m), and L e^−τ + S (1 − e^−τ) leaves it.
#import "sky/swept_ray.wgsl"
#import "common/slab_source.wgsl"
#import "common/most_light.wgsl"
#import "scattered_light/medium.wgsl"

// Emission (S times extinction) and extinction.
@group(0) @binding(1) var medium: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var sheets: texture_storage_3d<TARGET_FORMAT, write>;

#if ONE_COLOR
alias Radiance = f32;

fn incoming_radiance(rays: SweepRaysUniform) -> Radiance {
    return rays.incoming_radiance.r;
}

fn emission_of(found: vec4f) -> Radiance {
    return found.r;
}

fn level_texel(light: Radiance) -> vec4f {
    return vec4f(light);
}
#else
alias Radiance = vec3f;

fn incoming_radiance(rays: SweepRaysUniform) -> Radiance {
    return rays.incoming_radiance;
}

fn emission_of(found: vec4f) -> Radiance {
    return found.rgb;
}

fn level_texel(light: Radiance) -> vec4f {
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
    let ray = swept_ray(rays, id.xy, 1.0);
    var light = incoming_radiance(rays);
    for (var n = ray.span.x; n <= ray.span.y; n += 1.0) {
        let found = textureSampleLevel(medium, clamped, place_in_blocks(rays, ray, n), 0.0) * rays.step;
        let tau = extinction_in(found);
        let given = emission_of(found);
        let share = slab_emission_share(tau);
        let mean = 1.0 - tau * share;
        let stored = rounded_to_half(level_texel(min(light * mean + given * share, Radiance(MAX_HALF_FLOAT))));
        textureStore(sheets, vec3u(id.xy, rays.layer + u32(n)), stored);
        light = light * exp(-tau) + given * mean;
    }
}
