// Eye pass over scattered sheets (P §3.5, eq. 9): one thread per pixel takes the slab's sum, classifies and shades
// it, and composites it behind the previous slabs. Gradients come from the volume, or from the neighbouring sheets,
// which are in the ring already.
#import "scatter/slab.wgsl"
#import "shading/shade.wgsl"
#import "shading/near_light.wgsl"
#import "density/stored_gradient.wgsl"
#import "density/slab_field.wgsl"

// Distance, in bricks, to the nearest brick visible to the eye.
@group(0) @binding(2) var distances: texture_3d<u32>;
// Accumulated colour and opacity of each ray.
@group(1) @binding(8) var<storage, read_write> rays: array<vec4f>;

// Takes gradients from neighbouring sheets.
override SHEET_GRADIENTS: bool = true;

// Field for rays towards lights: the sheets hold no densities at points.
fn sharp_lighting_field(p: vec3f, level: f32) -> LightingField {
    return lighting_field(p, level);
}

fn attenuation_at(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
    return shadowed_light(light, volume, surface, towards);
}

// Fraction of the kernels within the grid where a ray crosses a sheet. For a slice of voxels only the other two axes
// count.
fn sheet_in_grid(ray: Ray, k: i32) -> f32 {
    if (ORDER == ORDER_IMAGE_ALIGNED) {
        return slab_in_grid(eye.frame, ray, f32(k));
    }
    let depth = crossing_of(ray, f32(k)).depth;
    let p = mix(ray.origin + ray.direction * depth, 0.5 * (grid.dims - 1.0), scatter.axis);
    return presence_in_grid(p, kernel_level(eye.frame, depth));
}

// Presence where a ray crosses a sheet.
fn sheet_presence(ray: Ray, k: i32) -> f32 {
    if (!MISSING) {
        return sheet_in_grid(ray, k);
    }
    let depth = crossing_of(ray, f32(k)).depth;
    return presence_at(ray.origin + ray.direction * depth, kernel_level(eye.frame, depth));
}

// Value of a sheet at a pixel: the mean over the voxels that exist; 0 before the first sheet and behind the last.
fn sheet_value(pixel: vec2i, k: i32) -> f32 {
    let last = i32(scatter.sheet_count) - 1;
    let known = clamp(k, 0, last);
    let at = sheet_index(vec2u(pixel), u32(known));
#if PRECLASSIFY
    // Extinction, for pre-classified voxels.
    let found = f32(atomicLoad(&sheets[channel_index(at, 4u)])) / FIXED_POINT_ONE;
#else
    let in_grid = sheet_in_grid(ray_of(eye.frame, vec2f(pixel)), known);
    let found = f32(atomicLoad(&sheets[at])) / FIXED_POINT_ONE / max(in_grid, MIN_PRESENCE);
#endif
    return select(0.0, found, (k >= 0) & (k <= last));
}

// Material of a sheet: its classified density times presence, or the sum of the voxels' materials.
fn sheet_material(pixel: vec2i, k: i32) -> Material {
    let presence = sheet_presence(ray_of(eye.frame, vec2f(pixel)), k);
    if (SPLAT != SPLAT_MATERIAL) {
        let material = material_of(Field(sheet_value(pixel, k)));
        return Material(material.color, material.extinction * presence);
    }
    let at = sheet_index(vec2u(pixel), u32(k));
    let sums = vec4f(
        f32(atomicLoad(&sheets[channel_index(at, 1u)])),
        f32(atomicLoad(&sheets[channel_index(at, 2u)])),
        f32(atomicLoad(&sheets[channel_index(at, 3u)])),
        f32(atomicLoad(&sheets[channel_index(at, 4u)])),
    ) / FIXED_POINT_ONE;
    // Neighbours stand in for missing voxels, but not outside the grid.
    let in_grid = sheet_in_grid(ray_of(eye.frame, vec2f(pixel)), k);
    let share = select(1.0, presence / max(in_grid, MIN_PRESENCE), MISSING);
    return Material(sums.rgb / max(sums.a, 1e-20), sums.a * scatter.extinction_unit * share);
}

fn gradient_between_sheets(pixel: vec2i, k: i32, met: Crossing) -> vec3f {
    let last = vec2i(eye.frame.size) - 1;
    let low = max(pixel - eye.gradient_pixels, vec2i(0));
    let high = min(pixel + eye.gradient_pixels, last);
    let reach = vec2f(max(high - low, vec2i(1)));
    let across = (sheet_value(vec2i(high.x, pixel.y), k) - sheet_value(vec2i(low.x, pixel.y), k)) / reach.x;
    let down = (sheet_value(vec2i(pixel.x, high.y), k) - sheet_value(vec2i(pixel.x, low.y), k)) / reach.y;
    let slabs = eye.gradient_slabs;
    let deep = (sheet_value(pixel, k + slabs) - sheet_value(pixel, k - slabs)) / (2.0 * f32(slabs) * met.thickness);
    let axis = select(scatter.axis, vec3f(0.0), ORDER == ORDER_IMAGE_ALIGNED);
    return gradient_of_sheets(vec2f(pixel), met.depth, vec3f(across, down, deep), axis);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    eye = bound_eye;
    grid = bound_grid;
    scatter = bound_scatter;
    if (any(id.xy >= eye.frame.size)) {
        return;
    }
    let k = i32(scatter.k);
    let pixel = vec2i(id.xy);
    let at = id.y * eye.frame.size.x + id.x;
    let before = rays[at];
    let transmittance = 1.0 - before.a;
    let ray = ray_of(eye.frame, vec2f(id.xy));
    let met = crossing_of(ray, f32(k));
    let p = ray.origin + ray.direction * met.depth;
    let material = sheet_material(pixel, k);
    let brick = brick_with_material(p);
    // Set for points in front of a perspective eye.
    let in_front = 1.0 + met.depth * eye.frame.inverse_distance > 1e-3;
    if (material.extinction > 0.0 && transmittance >= eye.min_transmittance && brick.x >= 0 && in_front) {
        // Sums are complete only near visible bricks.
        if (i32(textureLoad(distances, brick, 0).r) <= eye.dilation) {
            let level = stretch_level(eye.frame, met.depth);
            let field = Field(sheet_value(pixel, k));
            let share = slab_fraction_inside(span_within(eye.visible_cut, ray), met.depth, met.thickness);
            let opacity = 1.0 - exp(-share * material.extinction * met.thickness * ray.obliquity);
            var gradient: vec3f;
            if (SHEET_GRADIENTS) {
                gradient = gradient_between_sheets(pixel, k, met);
            } else {
                gradient = gradient_to_scene(eye.space, volume_gradient(p, level));
            }
            let slope = gradient + face_slope(p, level, field, presence_gradient(p, level));
            let rgb = shade(VolumeSample(p, slope, field, level), material.color);
            rays[at] = before + transmittance * opacity * vec4f(rgb, 1.0);
        }
    }
    // Clears the sheet that no later slab reads, for reuse. Uniforms are not used as branch conditions
    // (output/display.wgsl).
    let kept = select(-1, 0, k >= eye.gradient_slabs);
    let past = sheet_index(id.xy, u32(max(k - eye.gradient_slabs, 0)));
    atomicAnd(&sheets[past], kept);
    for (var channel = 1u; channel < 5u && SPLAT == SPLAT_MATERIAL; channel += 1u) {
        atomicAnd(&sheets[channel_index(past, channel)], kept);
    }
}
