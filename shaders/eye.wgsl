// The picture (P §2, §3.5, eq. 9): one thread per pixel walks the eye's sheets front to back, sums
// density, classifies the sum, shades it with the attenuated light and composites.
//
// The result is linear, premultiplied and not yet tone-mapped.
#import "common/table.wgsl"
#import "common/shadow_ray.wgsl"
#import "common/lights.wgsl"
#import "common/space.wgsl"

struct Eye {
    frame: SheetFrame,
    shading: Shading,
    space: Space,
    // The eye in scene space; w is 0 for an orthographic camera, whose eye is the direction to it.
    eye: vec4f,
    // Rows of this dispatch start here.
    first_row: u32,
    // One beyond the last row of this dispatch.
    end_row: u32,
    // 1: consult the bricks (always, but for the check that they change nothing).
    leaping: u32,
    // The ray ends when less than this is left of its transmittance.
    dark: f32,
    lights: array<Light, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> eye: Eye;
// Distance in bricks to the nearest that the eye's transfer function shows.
@group(0) @binding(2) var distances: texture_3d<u32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba32float, write>;
// For rays to lights: the lighting transfer function, and the distance in bricks to the nearest that
// it makes attenuate light.
@group(0) @binding(4) var<storage, read> lighting_table: array<vec4f, 1024>;
@group(0) @binding(5) var lighting_distances: texture_3d<u32>;

@group(2) @binding(0) var attenuation_0: texture_3d<f32>;
@group(2) @binding(1) var attenuation_1: texture_3d<f32>;
@group(2) @binding(2) var attenuation_2: texture_3d<f32>;
@group(2) @binding(3) var attenuation_3: texture_3d<f32>;
@group(2) @binding(4) var attenuation_4: texture_3d<f32>;
@group(2) @binding(5) var attenuation_5: texture_3d<f32>;
@group(2) @binding(6) var attenuation_6: texture_3d<f32>;
@group(2) @binding(7) var attenuation_7: texture_3d<f32>;

// Lights that are on; those with an attenuation volume come first.
override LIGHTS: u32 = 1u;
// How many of them have one, or would have.
override SHADOWED: u32 = 1u;
// Cast rays to the lights instead of looking into volumes (P §3.3).
override DIRECT: bool = false;

fn light_extinction(density: f32) -> f32 {
    let at = table_entry(density);
    return mix(lighting_table[at.low].a, lighting_table[at.low + 1u].a, at.fraction);
}

fn light_distance(brick: vec3i) -> i32 {
    return select(0, i32(textureLoad(lighting_distances, brick, 0).r), eye.leaping != 0u);
}

fn lit_by(index: u32, volume: texture_3d<f32>, surface: Surface) -> Lit {
    let light = eye.lights[index];
    let towards = to_light(light, surface.position);
    let direction = to_index(eye.space, towards.direction);
    let p = surface.point + direction * eye.shading.bias;
    var attenuation: f32;
    if (DIRECT) {
        let reach = towards.distance - eye.shading.bias;
        let s = eye.shading;
        attenuation = shadow_ray(p, direction, reach, s.ray_step, light.extinction_scale, s.dark_depth)
            * hood_share(light, towards.direction);
    } else {
        attenuation = textureSampleLevel(volume, clamped, (p + 0.5) * light.lookup, 0.0).r;
    }
    return reflect_light(eye.shading, light, surface, towards.direction, attenuation);
}

fn add(a: Lit, b: Lit) -> Lit {
    return Lit(a.diffuse + b.diffuse, a.specular + b.specular);
}

// Central differences of the reconstructed density at ± one voxel (of the pyramid's level), per
// scene unit.
fn gradient(p: vec3f, level: f32) -> vec3f {
    let l = select(0.0, level, STRETCH);
    let h = exp2(l);
    let difference = vec3f(
        pyramid(p + vec3f(h, 0.0, 0.0), l) - pyramid(p - vec3f(h, 0.0, 0.0), l),
        pyramid(p + vec3f(0.0, h, 0.0), l) - pyramid(p - vec3f(0.0, h, 0.0), l),
        pyramid(p + vec3f(0.0, 0.0, h), l) - pyramid(p - vec3f(0.0, 0.0, h), l),
    ) / (2.0 * h);
    return gradient_to_scene(eye.space, difference);
}

fn shade(p: vec3f, level: f32, material: vec3f) -> vec3f {
    let slope = gradient(p, level);
    let steepness = length(slope);
    let s = eye.shading;
    let steep2 = steepness * steepness;
    let position = place_of(eye.space, p);
    let away = eye.eye.xyz - position * eye.eye.w;
    let surface = Surface(
        position,
        p,
        -slope / max(steepness, 1e-9),
        steep2 / (steep2 + s.surface_gradient * s.surface_gradient),
        away / max(length(away), 1e-9),
    );
    var lit = Lit(vec3f(0.0), vec3f(0.0));
    if (SHADOWED > 0u) { lit = add(lit, lit_by(0u, attenuation_0, surface)); }
    if (SHADOWED > 1u) { lit = add(lit, lit_by(1u, attenuation_1, surface)); }
    if (SHADOWED > 2u) { lit = add(lit, lit_by(2u, attenuation_2, surface)); }
    if (SHADOWED > 3u) { lit = add(lit, lit_by(3u, attenuation_3, surface)); }
    if (SHADOWED > 4u) { lit = add(lit, lit_by(4u, attenuation_4, surface)); }
    if (SHADOWED > 5u) { lit = add(lit, lit_by(5u, attenuation_5, surface)); }
    if (SHADOWED > 6u) { lit = add(lit, lit_by(6u, attenuation_6, surface)); }
    if (SHADOWED > 7u) { lit = add(lit, lit_by(7u, attenuation_7, surface)); }
    for (var i = SHADOWED; i < LIGHTS; i += 1u) {
        let light = eye.lights[i];
        lit = add(lit, reflect_light(s, light, surface, to_light(light, surface.position).direction, 1.0));
    }
    return material * (s.emission + s.ambient + s.diffuse * lit.diffuse) + s.specular * lit.specular;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2u(id.x, id.y + eye.first_row);
    if (pixel.x >= eye.frame.size.x || pixel.y >= eye.end_row) {
        return;
    }
    let ray = ray_of(eye.frame, vec2f(pixel));
    let inside = slabs_inside(eye.frame, ray);
    var k = inside.x;
    var color = vec3f(0.0);
    var t = 1.0;
    loop {
        // Find the next slab with material: leap over empty bricks, then look at the sheet. These are
        // loops of their own because software drivers save work only by leaving a loop.
        var material = vec4f(0.0);
        loop {
            loop {
                if (k > inside.y) {
                    break;
                }
                let brick = brick_of(ray.origin + ray.direction * depth_of(eye.frame, f32(k)));
                let distance = i32(textureLoad(distances, brick, 0).r) - grid.dilation;
                if (distance <= 0 || eye.leaping == 0u) {
                    break;
                }
                k = leap(eye.frame, ray, k, brick, distance);
            }
            if (k > inside.y) {
                break;
            }
            material = classify(slab_density(eye.frame, ray, f32(k)));
            if (material.a > 0.0) {
                break;
            }
            k += 1;
        }
        if (k > inside.y) {
            break;
        }
        let depth = depth_of(eye.frame, f32(k));
        let rgb = shade(ray.origin + ray.direction * depth, stretch_level(eye.frame, depth), material.rgb);
        let passed = exp(-material.a * eye.frame.slab * ray.obliquity);
        color += t * (1.0 - passed) * rgb;
        t *= passed;
        if (t < eye.dark) {
            break;
        }
        k += 1;
    }
    textureStore(picture, pixel, vec4f(color, 1.0 - t));
}
