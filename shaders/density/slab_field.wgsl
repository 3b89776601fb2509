// Slabs of a ray through the field: its mean over a slab, with its presence, and the slabs inside the grid.
#import "sheets/sheet_frame.wgsl"
#import "volume/field.wgsl"

// Gauss–Legendre with two points: ± 1/(2√3) of the interval's length.
const TWO_POINT_OFFSET = 0.28867513;

// Pyramid level for the kernel's stretch at a depth.
fn kernel_level(frame: SheetFrameUniform, depth: f32) -> f32 {
    if (!STRETCH) {
        return 0.0;
    }
    return stretch_level(frame, depth);
}

// Presence averaged over slab k, where the ray crosses it.
fn slab_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
#if FACES
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return 0.5 * (presence_at(ray.origin + ray.direction * near, kernel_level(frame, near))
            + presence_at(ray.origin + ray.direction * far, kernel_level(frame, far)));
    }
    return presence_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));
#else
    return 1.0;
#endif
}

// Presence for light averaged over slab k, in passes of the eye.
fn slab_lighting_presence(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
#if MISSING
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    let near = depth - offset;
    let far = depth + offset;
    return 0.5 * (lighting_presence_at(ray.origin + ray.direction * near, kernel_level(frame, near))
        + lighting_presence_at(ray.origin + ray.direction * far, kernel_level(frame, far)));
#else
    return slab_presence(frame, ray, k);
#endif
}

// Fraction of slab k within the grid, where the ray crosses it.
fn slab_in_grid(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
#if MISSING
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    return 0.5 * (presence_in_grid(ray.origin + ray.direction * (depth - offset), kernel_level(frame, depth - offset))
        + presence_in_grid(ray.origin + ray.direction * (depth + offset), kernel_level(frame, depth + offset)));
#else
    return slab_presence(frame, ray, k);
#endif
}

// Field averaged over slab k, where the ray crosses it: the value of the sheet.
fn slab_field(frame: SheetFrameUniform, ray: Ray, k: f32) -> Field {
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return mean_of_fields(
            field_at(ray.origin + ray.direction * near, kernel_level(frame, near)),
            field_at(ray.origin + ray.direction * far, kernel_level(frame, far)),
        );
    }
    return field_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));
}

// First and last slab whose middle can contain material: the grid and two voxels around it.
fn slabs_inside(frame: SheetFrameUniform, ray: Ray) -> vec2i {
    let parallel_to = abs(ray.direction) < vec3f(1e-12);
    let direction = select(ray.direction, vec3f(1e-12), parallel_to);
    let a = (vec3f(-2.0) - ray.origin) / direction;
    let b = (grid.dims + 1.0 - ray.origin) / direction;
    let near = min(a, b);
    let far = max(a, b);
    let enter = (max(max(near.x, near.y), near.z) - frame.first_depth) / frame.slab - 0.5;
    let leave = (min(min(far.x, far.y), far.z) - frame.first_depth) / frame.slab - 0.5;
    let last = f32(frame.slab_count) - 1.0;
    // Slack of 1e-5 of a slab, for faces exactly in the middle of a slab.
    return vec2i(i32(ceil(clamp(enter - 1e-5, 0.0, last + 1.0))), i32(floor(clamp(leave + 1e-5, -1.0, last))));
}
