// Shadow ray: ray marching from a point of the volume towards a light (P eq. 7 and 8). The importing shader provides
// extinction, presence and cell distances, as ray_extinction(frame, ray, k), slab_ray_presence(frame, ray, k) and
// light_distance(cell).
#import "common/transmittance.wgsl"
#import "density/cells.wgsl"
#import "density/cut.wgsl"

// Places the first sample a whole step from the point, as P eq. 7 and 8 have it, instead of in the middle of the
// first step.
override DEPOSIT_FRONT: bool = false;

// Next slab, from `first` on, in a cell that may attenuate light; beyond the last if there is none.
fn next_attenuating_slab(walk: CellRay, first: i32, last: i32) -> i32 {
    var k = first;
    loop {
        if (k > last) {
            break;
        }
        let cell = cell_at(walk, k);
        let empty = light_distance(cell) - grid.dilation;
        if (empty <= 0) {
            break;
        }
        k = skip_empty_cells(walk, k, cell, empty);
    }
    return k;
}

// Transmittance from the point p to `reach` scene units along `direction`, a unit vector of the scene given in index
// space. Extinction is multiplied by `scale` and limited to `cut`; the ray ends at the optical depth `dark`.
fn shadow_ray(
    p: vec3f,
    direction: vec3f,
    reach: f32,
    ray_step: f32,
    scale: f32,
    dark: f32,
    cut: CutUniform,
) -> Transmittance {
    // The ray as a stack of sheets: its sample points are the middles of the slabs.
    var frame: SheetFrameUniform;
    frame.first_depth = select(0.0, 0.5 * ray_step, DEPOSIT_FRONT);
    frame.slab = ray_step;
    frame.voxel_edge = 1.0;
    // Whole slabs; the rest of the distance is a shorter one.
    frame.slab_count = u32(clamp((reach - frame.first_depth) / ray_step, 0.0, 65535.0));
    let ray = Ray(p, direction, 1.0);
    let span = span_within(cut, ray);
    let inside = slabs_within(frame, span, slabs_inside(frame, ray));
    let walk = cell_ray(frame, ray);
    var k = inside.x;
    var depth = Transmittance(0.0);
    loop {
        k = next_attenuating_slab(walk, k, inside.y);
        if (k > inside.y) {
            break;
        }
        let share = shading_fraction(cut, p + direction * depth_of(frame, f32(k))) * slab_ray_presence(frame, ray, f32(k));
        depth += ray_extinction(frame, ray, f32(k)) * share * ray_step * scale;
        if (min_component(depth) > dark) {
            break;
        }
        k += 1;
    }
    frame.first_depth += f32(frame.slab_count) * ray_step;
    let end = p + direction * reach;
    if (frame.first_depth < reach && all(end > vec3f(-2.0)) && all(end < grid.dims + 1.0)) {
        frame.slab = reach - frame.first_depth;
        let share = shading_fraction(cut, p + direction * depth_of(frame, 0.0)) * slab_ray_presence(frame, ray, 0.0);
        depth += ray_extinction(frame, ray, 0.0) * share * frame.slab * scale;
    }
    return exp(-depth);
}
