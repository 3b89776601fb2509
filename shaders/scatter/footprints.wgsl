// Compositing of every footprint separately (the paper's reference 25): one thread per voxel classifies and shades
// its voxel and composites it over all pixels under its footprint. Voxels of one dispatch are so far apart in their
// slice that no two of them touch the same pixel.
#import "scatter/footprint.wgsl"
#import "shading/shade.wgsl"
#import "shading/looked_up_light.wgsl"
#import "common/listed_bricks.wgsl"

// Phase of a dispatch: position, in the slice, of the voxels that it composites in every `stride`-th brick.
struct FootprintPhaseUniform {
    // Position within a brick.
    u: u32,
    v: u32,
    // Position of the bricks among `stride` in a row.
    brick_u: u32,
    brick_v: u32,
    stride: u32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

// Word where each brick's voxels begin; −1 for empty bricks.
@group(0) @binding(3) var<storage, read> first_words: array<i32>;
// Bricks of the slice: packed coordinates of ten bits each, and the word where their voxels begin.
@group(0) @binding(4) var<storage, read> bricks: array<vec2u>;
// Number of footprints splatted.
@group(0) @binding(5) var<storage, read_write> splats: atomic<u32>;
// Accumulated colour and opacity of each ray.
@group(1) @binding(8) var<storage, read_write> rays: array<vec4f>;
@group(3) @binding(0) var<uniform> bound_phase: FootprintPhaseUniform;
var<private> phase: FootprintPhaseUniform;

// Density of a voxel; the border value outside the grid.
fn density_of(place: vec3i) -> f32 {
    let voxel = clamp(place, vec3i(0), vec3i(scatter.dims) - 1);
    let brick = voxel / BRICK_EDGE;
    let first = first_words[brick.x + scatter.bricks.x * (brick.y + scatter.bricks.y * brick.z)];
    if (first < 0) {
        return 0.0;
    }
    return voxel_field(u32(first), vec3u(voxel % BRICK_EDGE)).density;
}

// Central differences between voxels, in scene space.
fn gradient_of(voxel: vec3i) -> vec3f {
    return gradient_to_scene(eye.space, 0.5 * vec3f(
        density_of(voxel + vec3i(1, 0, 0)) - density_of(voxel - vec3i(1, 0, 0)),
        density_of(voxel + vec3i(0, 1, 0)) - density_of(voxel - vec3i(0, 1, 0)),
        density_of(voxel + vec3i(0, 0, 1)) - density_of(voxel - vec3i(0, 0, 1)),
    ));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    eye = bound_eye;
    phase = bound_phase;
    scatter = bound_scatter;
    grid = bound_grid;
    if (id.x >= scatter.count) {
        return;
    }
    let listed = bricks[scatter.first + id.x];
    let brick = unpack_coordinates(listed.x);
    // The two axes of the slice.
    let along = vec3u(scatter.axis);
    let u_axis = select(vec3u(1u, 0u, 0u), vec3u(0u, 1u, 0u), along.x == 1u);
    let v_axis = vec3u(1u) - along - u_axis;
    if (dot(brick, u_axis) % phase.stride != phase.brick_u || dot(brick, v_axis) % phase.stride != phase.brick_v) {
        return;
    }
    let slice = u32(slice_of(f32(scatter.k)));
    let voxel = brick * BRICK_EDGE * (u_axis + v_axis) + u_axis * phase.u + v_axis * phase.v + along * slice;
    let field = voxel_field(listed.y, voxel % BRICK_EDGE);
    let material = material_of(field);
    if (material.extinction <= 0.0 || any(vec3f(voxel) >= scatter.dims)) {
        return;
    }
    let centre = vec3f(voxel);
    if (!is_inside_cut(eye.visible_cut, centre)) {
        return;
    }
    // The blur leaves at least (10/12)³ = 0.58 of an existing voxel, and at most the rest of a missing one.
    if (MISSING && presence_at(centre, 0.0) < 0.5) {
        return;
    }
    let at = project_to_sheets(centre);
    let box = pixels_under(at);
    // Behind a perspective eye, or outside the picture.
    if (1.0 + at.z * eye.frame.inverse_distance <= 1e-3 || any(box.first > box.last)) {
        return;
    }
    atomicAdd(&splats, 1u);
    let stretch = stretch_of(at.z);
    let level = log2(max(stretch, 1.0));
    let slope = gradient_of(vec3i(voxel)) + face_slope(centre, level, field, presence_gradient(centre, level));
    let rgb = shade(VolumeSample(centre, slope, field, 0.0), material.color);
    for (var j = box.first.y; j <= box.last.y; j += 1.0) {
        for (var i = box.first.x; i <= box.last.x; i += 1.0) {
            let ray = ray_of(scatter.frame, vec2f(i, j));
            let depth = whole_footprint(centre, ray, stretch) * material.extinction * ray.obliquity;
            if (depth > 0.0) {
                let pixel = u32(j) * scatter.frame.size.x + u32(i);
                let before = rays[pixel];
                rays[pixel] = before + (1.0 - before.a) * (1.0 - exp(-depth)) * vec4f(rgb, 1.0);
            }
        }
    }
}
