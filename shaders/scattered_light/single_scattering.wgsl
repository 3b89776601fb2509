// Single scattering: direct light of lights and sky at each block, and the light that the block scatters or emits.
//
// A light that gives a white surface facing it the radiance E/π has a mean radiance over all directions of a quarter
// of that: E / 4π.
#import "scattered_light/bounce.wgsl"
#import "scattered_light/medium.wgsl"
#import "common/slab_mean.wgsl"
#import "common/space.wgsl"
#import "shading/lights.wgsl"

struct SingleScatteringUniform {
    space: SpaceUniform,
    // One over the size of the block texture, including the border.
    block_scale: vec3f,
    // Number of voxels along the edge of a block.
    voxel_step: f32,
    // Number of lights that are on.
    count: u32,
    // Number of lights, at the front of the list, that cast shadows.
    shadowed: u32,
    // Shortest edge of a voxel, in scene units.
    edge: f32,
    // Emission relative to the block's colour, divided by the albedo.
    emission: f32,
    // Range of slices of this dispatch.
    slice: u32,
    end: u32,
    pad0: f32,
    // 1 if `received` is the light of the sky, else 0.
    has_sky: f32,
    lights: array<LightUniform, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> bound_scene: SingleScatteringUniform;
var<private> scene: SingleScatteringUniform;
@group(0) @binding(1) var medium: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(5) var<storage, read> received: array<vec4f>;
// Source term: light that blocks scatter or emit per shortest edge before the first bounce.
@group(0) @binding(6) var<storage, read_write> first: array<vec4f>;

// Extinction of the medium at texture coordinates.
fn medium_at(place: vec3f) -> f32 {
    return extinction_in(textureSampleLevel(medium, clamped, place, 0.0));
}

// Transmittance of a light to a block with this extinction: the mean over the block, as for slabs, along a ray with
// steps of one block.
fn transmittance_to_light(light: LightUniform, block: vec3f, extinction: f32, towards: LightDirection) -> f32 {
    let along = index_from_scene_vector(scene.space, towards.direction) / scene.voxel_step;
    let step = 1.0 / max(max(abs(along.x), abs(along.y)), abs(along.z));
    let scale = light.extinction_scale / scene.edge;
    let own = slab_mean_transmittance(extinction * min(step, towards.distance) * scale);
    var depth = 0.0;
    var way = 0.5 * step;
    loop {
        // The grid has a border of empty blocks; rays end beyond it.
        let length = min(step, towards.distance - way);
        let place = block + along * (way + 0.5 * length);
        if (length <= 0.0 || any(place < vec3f(-1.0)) || any(place > vec3f(bounce.dims))) {
            break;
        }
        depth += medium_at((place + 1.5) * scene.block_scale) * length * scale;
        if (depth > 20.0) {
            break;
        }
        way += length;
    }
    return own * exp(-depth);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    bounce = bound_bounce;
    scene = bound_scene;
    let id = thread + vec3u(0u, 0u, scene.slice);
    if (any(id >= vec3u(bounce.dims.xy, min(bounce.dims.z, scene.end)))) {
        return;
    }
    let at = block_index(id);
    let found = scattering[at];
    if (found.a <= 0.0) {
        return;
    }
    let block = vec3f(id);
    let position = scene_from_index(scene.space, (block + 0.5) * scene.voxel_step - 0.5);
    var light = received[at].rgb * scene.has_sky + scene.emission;
    // Never true: software drivers compile loops whose length is a uniform alone for each dispatch anew, and never free
    // them.
    let count = select(scene.count, 0u, found.a > 1e30);
    for (var i = 0u; i < count; i += 1u) {
        // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
        let whole = bound_scene.lights[i];
        var arriving = 0.0;
        for (var number = 0u; number < whole.points; number += 1u) {
            let one = area_light_point(whole, number);
            let towards = to_light(one, position);
            var transmittance = cone_attenuation(one, towards.direction);
            if (i < scene.shadowed && transmittance > 0.0) {
                transmittance *= transmittance_to_light(one, block, found.a, towards);
            }
            arriving += transmittance;
        }
        light += whole.color * (0.25 * arriving / f32(whole.points));
    }
    first[at] = vec4f(found.rgb * light, 0.0);
}
