// The floor under the volume: one thread per pixel finds where its ray meets the floor, and sends a ray from
// there to each light, through all that attenuates it. The result is linear and premultiplied; what the volume
// covers is laid over it when the picture is shown (output/display.wgsl).
#import "common/sizes.wgsl"
#import "density/classify.wgsl"
#import "shading/shadow_ray.wgsl"
#import "shading/lights.wgsl"
#import "shading/light_volumes.wgsl"
#import "shading/sky.wgsl"
#import "common/space.wgsl"
#import "sheets/tiles.wgsl"

struct Floor {
    frame: SheetFrame,
    space: Space,
    shading: Shading,
    // What attenuates light.
    shading_cut: Cut,
    // In index space: the floor is where dot(plane.xyz, p) = plane.w, and above it is more.
    plane: vec4f,
    // In scene space: the floor looks there, and that far from the middle it lies.
    up: vec3f,
    height: f32,
    // Linear.
    color: vec3f,
    opacity: f32,
    // Distance from the middle at which nothing is left, and what the way from whole to nothing is divided by.
    radius: f32,
    fade: f32,
    // Takes back what makes up for shadows on the volume.
    light_share: f32,
    // 1: seen only where it is in shadow.
    shadow_only: f32,
    // Rows of this dispatch: first, and one beyond the last.
    first_row: u32,
    end_row: u32,
    // Runs of rows of tiles (sheets/tiles.wgsl).
    runs: u32,
    pad0: u32,
    sky: Sky,
    // From scene space to texture coordinates of maps: vectors, and what is added.
    map_x: vec4f,
    map_y: vec4f,
    lights: array<Light, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> bound_floor_disc: Floor;
var<private> floor_disc: Floor;
// g: distance to the nearest cell that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var picture: texture_2d<f32>;
@group(0) @binding(4) var floor_light: texture_storage_2d<rgba16float, write>;

// C₁ in rgb, C₀ in a: see sky/floor_map.wgsl.
@group(0) @binding(5) var sky_map: texture_3d<f32>;

// Lights that are on; those that material attenuates come first.
override LIGHTS: u32 = 1u;
override SHADOWED: u32 = 1u;

// Nobody sees less than this of the floor: an eighth of an 8-bit step.
const LEAST = 0.0005;

fn ray_extinction(frame: SheetFrame, ray: Ray, k: f32) -> Left {
#if COLORED
#if PRECLASSIFY
    let met = slab_spread(frame, ray, k).gba;
    return vec3f(classified_extinction(met.r), classified_extinction(met.g), classified_extinction(met.b));
#else
    let at = table_entry(slab_density(frame, ray, k));
    return mix(extinction_of(table.entries[at.low]), extinction_of(table.entries[at.low + 1u]), vec3f(at.fraction));
#endif
#else
    return classified_extinction(slab_density(frame, ray, k));
#endif
}

fn light_distance(cell: vec3f) -> i32 {
    return near(distances, cell).y;
}

// Light on a floor that looks up: with all that material lets through, and as it would be without any.
struct Fallen {
    light: vec3f,
    bare: vec3f,
}

// Places on maps: of what it sees of the sky, and of lights.
fn place_on_map(place: vec3f) -> vec3f {
    // A map is one layer of a volume, for which there is something else to bind where there is none.
    return vec3f(dot(floor_disc.map_x, vec4f(place, 1.0)), dot(floor_disc.map_y, vec4f(place, 1.0)), 0.5);
}

// Lights that have a map of what gets there have no points.
fn left_on_map(slot: u32, at: vec3f) -> f32 {
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

fn fallen(slot: u32, light: Light, p: vec3f, place: vec3f) -> Fallen {
    let shadowed = slot < SHADOWED;
    let risen = risen_above(light, to_light(light, place), floor_disc.up, 1.0);
    let hood = hood_share(light, risen.towards.direction) * risen.share;
    let bare = light.color * max(risen.facing, 0.0);
    let s = floor_disc.shading;
    var left = Left(0.0);
    if (shadowed) {
        for (var i = 0u; i < light.points; i += 1u) {
            let one = point_of(light, i);
            let way = to_light(one, place);
            let share = hood_share(one, way.direction);
            if (dot(floor_disc.up, way.direction) > 0.0 && share > 0.0) {
                let direction = to_index(floor_disc.space, way.direction);
                let cut = floor_disc.shading_cut;
                let scale = light.extinction_scale;
                left += share * shadow_ray(p, direction, way.distance, s.ray_step, scale, s.dark_depth, cut);
            }
        }
        left /= max(f32(light.points), 1.0);
        if (light.points == 0u) {
            left = Left(left_on_map(slot, place_on_map(place)));
        }
    }
    let arriving = received(s, left) - (1.0 - s.strength) * (1.0 - risen.share);
    return Fallen(bare * select(Left(hood), arriving, shadowed), bare * hood);
}

// What an open floor sees of the sky: moments over a hemisphere.
fn bare_sky() -> vec4f {
    return vec4f(floor_disc.up * (2.0 / 3.0), 1.0);
}

// What it sees of it at a place.
fn open_sky(place: vec3f) -> vec4f {
#if SKY > 1
    let stored = textureSampleLevel(sky_map, clamped, place_on_map(place), 0.0);
    return mix(bare_sky(), stored, floor_disc.shading.strength);
#else
    return bare_sky();
#endif
}

// The sky's light on it, as a share of its colour.
fn fallen_from_sky(open: vec4f) -> vec3f {
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
    let place = place_of(floor_disc.space, p);
    let t = clamp((floor_disc.radius - distance(place, floor_disc.up * floor_disc.height)) / floor_disc.fade, 0.0, 1.0);
    // From above, and in front of a perspective eye.
    let is_seen = speed < 0.0 && 1.0 + depth * floor_disc.frame.inverse_distance > 1e-3;
    let presence = select(0.0, floor_disc.opacity * t * t * (3.0 - 2.0 * t), is_seen);
    var result = vec4f(0.0);
    if (presence * (1.0 - textureLoad(picture, pixel, 0).a) > LEAST) {
        var light = vec3f(0.0);
        var bare = vec3f(0.0);
        for (var i = 0u; i < LIGHTS; i += 1u) {
            // Not from the copy: an index that varies would keep that as an array in memory.
            let one = fallen(i, bound_floor_disc.lights[i], p, place);
            light += one.light;
            bare += one.bare;
        }
        let s = floor_disc.shading;
        let open = open_sky(place);
        let everywhere = s.ambient + fallen_from_sky(open);
        let shown = everywhere + s.diffuse * floor_disc.light_share * light;
        let luminance = vec3f(0.2126, 0.7152, 0.0722);
        let unshadowed = dot(luminance, s.ambient + fallen_from_sky(bare_sky()) + s.diffuse * floor_disc.light_share * bare);
        let missing = clamp(1.0 - dot(luminance, shown) / max(unshadowed, 1e-6), 0.0, 1.0);
        let whole = vec4f(floor_disc.color * shown, 1.0);
        let shadow = vec4f(0.0, 0.0, 0.0, missing);
        result = presence * mix(whole, shadow, floor_disc.shadow_only);
    }
    textureStore(floor_light, pixel, result);
}
