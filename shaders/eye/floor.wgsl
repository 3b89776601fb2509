// Floor under the volume: one thread per pixel intersects its ray with the floor, and casts a ray from there to each
// light, through everything that attenuates it. The result is linear and premultiplied; the display pass composites
// the volume over it (output/display.wgsl).
#import "common/sizes.wgsl"
#import "density/slab_material.wgsl"
#import "shading/shadow_ray.wgsl"
#import "shading/lights.wgsl"
#import "shading/light_volumes.wgsl"
#import "shading/sky.wgsl"
#import "common/space.wgsl"
#import "sheets/tiles.wgsl"

struct FloorUniform {
    frame: SheetFrameUniform,
    space: SpaceUniform,
    shading: ShadingUniform,
    // Region that attenuates light.
    shading_cut: CutUniform,
    // Plane of the floor in index space: dot(plane.xyz, p) = plane.w; larger above it.
    plane: vec4f,
    // Normal of the floor in scene space, and the floor's height along it.
    up: vec3f,
    height: f32,
    // Linear colour of the floor.
    color: vec3f,
    opacity: f32,
    // Radius at which the floor has faded out, and the width of the fade.
    radius: f32,
    fade_width: f32,
    // Inverse of the balance, which compensates for shadows on the volume only.
    inverse_balance: f32,
    // 1 if only the shadow is visible.
    shadow_only: f32,
    // Range of rows of this dispatch; the end is exclusive.
    first_row: u32,
    end_row: u32,
    // Number of interleaved runs of tile rows (sheets/tiles.wgsl).
    runs: u32,
    pad0: u32,
    sky: SkyUniform,
    // Affine map from scene space to texture coordinates of the floor's maps.
    map_x: vec4f,
    map_y: vec4f,
    lights: array<LightUniform, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> bound_floor_disc: FloorUniform;
var<private> floor_disc: FloorUniform;
// g: distance to the nearest cell that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var picture: texture_2d<f32>;
@group(0) @binding(4) var floor_light: texture_storage_2d<rgba16float, write>;

// C₁ in rgb, C₀ in a: see sky/floor_map.wgsl.
@group(0) @binding(5) var sky_map: texture_3d<f32>;

// Number of lights that are on; those that cast shadows come first.
override LIGHTS: u32 = 1u;
override SHADOWED: u32 = 1u;

// Smallest visible opacity of the floor: an eighth of an 8-bit step.
const MIN_VISIBLE_OPACITY = 0.0005;

fn slab_ray_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    return slab_presence(frame, ray, k);
}

fn ray_extinction(frame: SheetFrameUniform, ray: Ray, k: f32) -> Transmittance {
#if COLORED
#if PRECLASSIFY
    return extinction_of_colors(preclassified_in_slab(frame, ray, k).gba);
#else
    return extinction_by_color(slab_field(frame, ray, k));
#endif
#else
    return extinction_of(slab_field(frame, ray, k));
#endif
}

fn light_distance(cell: vec3f) -> i32 {
    return cell_distances(distances, cell).y;
}

// Light on a floor that faces up: as attenuated by material, and unattenuated.
struct FloorIrradiance {
    light: vec3f,
    bare: vec3f,
}

// Texture coordinates of the maps, for sky visibility and area lights.
fn map_coordinates(place: vec3f) -> vec3f {
    // Maps are volumes of one layer, so that the placeholder texture can be bound instead.
    return vec3f(dot(floor_disc.map_x, vec4f(place, 1.0)), dot(floor_disc.map_y, vec4f(place, 1.0)), 0.5);
}

// Transmittance of a light from its map; lights with a map have zero points.
fn map_transmittance(slot: u32, at: vec3f) -> f32 {
    switch (slot) {
        case 0u: { return textureSampleLevel(attenuation_0, clamped, at, 0.0).r; }
        case 1u: { return textureSampleLevel(attenuation_1, clamped, at, 0.0).r; }
        case 2u: { return textureSampleLevel(attenuation_2, clamped, at, 0.0).r; }
        case 3u: { return textureSampleLevel(attenuation_3, clamped, at, 0.0).r; }
        case 4u: { return textureSampleLevel(attenuation_4, clamped, at, 0.0).r; }
        case 5u: { return textureSampleLevel(attenuation_5, clamped, at, 0.0).r; }
        case 6u: { return textureSampleLevel(attenuation_6, clamped, at, 0.0).r; }
        default: { return textureSampleLevel(attenuation_7, clamped, at, 0.0).r; }
    }
}

fn floor_irradiance(slot: u32, light: LightUniform, p: vec3f, place: vec3f) -> FloorIrradiance {
    let shadowed = slot < SHADOWED;
    let risen = clip_to_horizon(light, to_light(light, place), floor_disc.up, 1.0);
    let hood = cone_attenuation(light, risen.towards.direction) * risen.share;
    let bare = light.color * max(risen.facing, 0.0);
    let s = floor_disc.shading;
    var transmittance = Transmittance(0.0);
    if (shadowed) {
        let centre = to_light(light, place).direction;
        let slope = point_slope(light, place, floor_disc.up, 1.0);
        var weights = 0.0;
        for (var i = 0u; i < light.points; i += 1u) {
            let one = area_light_point(light, i);
            let way = to_light(one, place);
            let weight = point_weight(slope, centre, way.direction);
            weights += weight;
            let share = weight * cone_attenuation(one, way.direction);
            if (dot(floor_disc.up, way.direction) > 0.0 && share > 0.0) {
                let direction = index_from_scene_vector(floor_disc.space, way.direction);
                let cut = floor_disc.shading_cut;
                let scale = light.extinction_scale;
                transmittance += share * shadow_ray(p, direction, way.distance, s.ray_step, scale, s.max_optical_depth, cut);
            }
        }
        transmittance /= max(weights, 1e-6);
        if (light.points == 0u) {
            transmittance = Transmittance(map_transmittance(slot, map_coordinates(place)));
        }
    }
    let arriving = apply_shadow_cures(s, transmittance) - (1.0 - s.strength) * (1.0 - risen.share);
    return FloorIrradiance(bare * select(Transmittance(hood), arriving, shadowed), bare * hood);
}

// Moments of an unoccluded sky over a hemisphere.
fn unoccluded_sky() -> vec4f {
    return vec4f(floor_disc.up * (2.0 / 3.0), 1.0);
}

// Moments of sky visibility at a point on the floor.
fn sky_moments_at(place: vec3f) -> vec4f {
#if SKY > 1
    let stored = textureSampleLevel(sky_map, clamped, map_coordinates(place), 0.0);
    return mix(unoccluded_sky(), stored, floor_disc.shading.strength);
#else
    return unoccluded_sky();
#endif
}

// Irradiance from the sky, divided by π.
fn floor_sky_irradiance(open: vec4f) -> vec3f {
    let sky = floor_disc.sky;
    return max(vec3f(dot(sky.red, open), dot(sky.green, open), dot(sky.blue, open)), vec3f(0.0));
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    grid = bound_grid;
    floor_disc = bound_floor_disc;
    let pixel = tile_of(group, groups.y, floor_disc.runs) * TILE_EDGE + local.xy + vec2u(0u, floor_disc.first_row);
    if (pixel.x >= floor_disc.frame.size.x || pixel.y >= floor_disc.end_row) {
        return;
    }
    let ray = ray_of(floor_disc.frame, vec2f(pixel));
    let speed = dot(floor_disc.plane.xyz, ray.direction);
    let depth = (floor_disc.plane.w - dot(floor_disc.plane.xyz, ray.origin)) / min(speed, -1e-9);
    let p = ray.origin + ray.direction * depth;
    let place = scene_from_index(floor_disc.space, p);
    let t = clamp((floor_disc.radius - distance(place, floor_disc.up * floor_disc.height)) / floor_disc.fade_width, 0.0, 1.0);
    // Visible from above, and in front of a perspective eye.
    let is_visible = speed < 0.0 && 1.0 + depth * floor_disc.frame.inverse_distance > 1e-3;
    let presence = select(0.0, floor_disc.opacity * t * t * (3.0 - 2.0 * t), is_visible);
    var result = vec4f(0.0);
    if (presence * (1.0 - textureLoad(picture, pixel, 0).a) > MIN_VISIBLE_OPACITY) {
        var light = vec3f(0.0);
        var bare = vec3f(0.0);
        for (var i = 0u; i < LIGHTS; i += 1u) {
            // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
            let one = floor_irradiance(i, bound_floor_disc.lights[i], p, place);
            light += one.light;
            bare += one.bare;
        }
        let s = floor_disc.shading;
        let open = sky_moments_at(place);
        let everywhere = s.ambient + floor_sky_irradiance(open);
        let shown = everywhere + s.diffuse * floor_disc.inverse_balance * light;
        let luminance = vec3f(0.2126, 0.7152, 0.0722);
        let unshadowed = dot(luminance, s.ambient + floor_sky_irradiance(unoccluded_sky()) + s.diffuse * floor_disc.inverse_balance * bare);
        let missing = clamp(1.0 - dot(luminance, shown) / max(unshadowed, 1e-6), 0.0, 1.0);
        let whole = vec4f(floor_disc.color * shown, 1.0);
        let shadow = vec4f(0.0, 0.0, 0.0, missing);
        result = presence * mix(whole, shadow, floor_disc.shadow_only);
    }
    textureStore(floor_light, pixel, result);
}
