// Projections: the largest, smallest or mean value along a ray, shown with the colour and opacity of the curve.
//
// Values are interpolated linearly between voxels, without the blur of other kernels: a maximum is that of the voxels.
// Between two planes of voxels such a field is a cubic polynomial along the ray. So a ray goes from plane to plane
// (Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing", 1987) with samples at each plane and between
// them: Simpson's rule with one is then exact for means, and two determine the polynomial with its extremes.
#import "density/cells.wgsl"
#import "density/slab_material.wgsl"

#option PROJECTION: a value of the ray is shown: the largest (1), the smallest (2) or the mean (3)
#option LIT: a maximum is shaded

// Distance between samples towards the front of a maximum, in voxels along the axis in which they are nearest.
const FRONT_STEP = 0.5;

// Share of a maximum that is left at the front of its material: as for the width at half height of a peak.
const FRONT_SHARE = 0.5;

// Sign by which the sought value is the largest.
fn sought_sign() -> f32 {
#if PROJECTION > 1
    return -1.0;
#else
    return 1.0;
#endif
}

// Value of a ray and the depth where it lies.
struct ProjectedValue {
    value: f32,
    depth: f32,
    // 0 if the ray meets no voxel that may be visible.
    weight: f32,
}

fn density_on_ray(ray: Ray, depth: f32) -> f32 {
    return linear_density(ray.origin + ray.direction * depth);
}

// Next plane of voxels along each axis from a point on.
fn next_planes(p: vec3f, is_backward: vec3<bool>) -> vec3f {
    return select(floor(p) + 1.0, ceil(p) - 1.0, is_backward);
}

// Depth beyond the cube of `empty` layers of cells around a cell (density/cells.wgsl, in depths instead of slabs).
fn depth_behind_cells(ray: Ray, inverse: vec3f, cell: vec3f, empty: i32) -> f32 {
    let middle = ((cell + 0.5) * CELL_EDGE - ray.origin) * inverse;
    let exits = middle + abs(inverse) * ((f32(empty) - 0.5) * CELL_EDGE);
    return min(min(exits.x, exits.y), exits.z);
}

// Place of the largest value of a cubic polynomial between 0 and 1, from its values at 0, 1/3, 2/3 and 1.
fn largest_place(f: vec4f) -> f32 {
    // Coefficients of u, u² and u³ (Lagrange).
    let linear = 0.5 * (-11.0 * f.x + 18.0 * f.y - 9.0 * f.z + 2.0 * f.w);
    let square = 4.5 * (2.0 * f.x - 5.0 * f.y + 4.0 * f.z - f.w);
    let cube = 4.5 * (-f.x + 3.0 * f.y - 3.0 * f.z + f.w);
    let end = select(0.0, 1.0, f.w > f.x);
    let discriminant = square * square - 3.0 * linear * cube;
    // The root at which the second derivative is negative, in the form that is exact for parabolas, too.
    let divisor = sqrt(max(discriminant, 0.0)) - square;
    let top = linear / select(divisor, 1e-20, abs(divisor) < 1e-20);
    let value = f.x + top * (linear + top * (square + top * cube));
    return select(end, top, discriminant >= 0.0 && top > 0.0 && top < 1.0 && value > max(f.x, f.w));
}

// Larger of the value found so far and the largest between two planes, given those at the planes.
fn with_extreme(found: ProjectedValue, ray: Ray, near: f32, far: f32, ends: vec2f) -> ProjectedValue {
    let between = vec2f(density_on_ray(ray, mix(near, far, 1.0 / 3.0)), density_on_ray(ray, mix(near, far, 2.0 / 3.0)));
    let depth = mix(near, far, largest_place(sought_sign() * vec4f(ends.x, between, ends.y)));
    // Filters with few bits make the polynomial inexact: the value is the field's own.
    let value = density_on_ray(ray, depth);
    if (found.weight == 0.0 || sought_sign() * value > sought_sign() * found.value) {
        return ProjectedValue(value, depth, 1.0);
    }
    return found;
}

// Sum of the densities found so far and of those between two planes.
fn with_mean(found: ProjectedValue, near: f32, far: f32, densities: vec3f) -> ProjectedValue {
    let length = far - near;
    let mean = (densities.x + 4.0 * densities.y + densities.z) / 6.0;
    return ProjectedValue(found.value + length * mean, found.depth, found.weight + length);
}

// Value of the ray within a span of depths.
fn projected_value(ray: Ray, span: vec2f) -> ProjectedValue {
    let parallel_to = abs(ray.direction) < vec3f(1e-12);
    let inverse = 1.0 / select(ray.direction, vec3f(1e-12), parallel_to);
    let is_backward = inverse < vec3f(0.0);
    let forward = select(vec3f(1.0), vec3f(-1.0), is_backward);
    var found = ProjectedValue(0.0, 0.5 * (span.x + span.y), 0.0);
    var near = span.x;
    var before = density_on_ray(ray, near);
    var planes = next_planes(ray.origin + ray.direction * near, is_backward);
    loop {
        if (near >= span.y) {
            break;
        }
        let meets = (planes - ray.origin) * inverse;
        let far = max(near, min(min(meets.x, meets.y), min(meets.z, span.y)));
        let middle = 0.5 * (near + far);
        let p = ray.origin + ray.direction * middle;
        var is_counted = true;
        var next = far;
#if PROJECTION > 2
        // Nothing is skipped.
#else
        let cell = floor(p / CELL_EDGE);
        let empty = cell_distances(distances, cell).x - grid.dilation;
        is_counted = empty <= 0;
        next = select(max(far, depth_behind_cells(ray, inverse, cell, empty)), far, is_counted);
#endif
        let behind = density_on_ray(ray, next);
#if MISSING
        is_counted = is_counted && presence_at(p, 0.0) >= 0.5;
#endif
        if (is_counted) {
#if PROJECTION > 2
            found = with_mean(found, near, far, vec3f(before, linear_density(p), behind));
#else
            found = with_extreme(found, ray, near, far, vec2f(before, behind));
#endif
        }
        let passed = next_planes(ray.origin + ray.direction * next, is_backward);
        planes = select(passed, select(planes, planes + forward, meets <= vec3f(far)), next == far);
        near = next;
        before = behind;
    }
#if PROJECTION > 2
    found.value /= max(found.weight, 1e-20);
#endif
    return found;
}

// Depth of the front of the material of a maximum: at the maximum itself density has no gradient along the ray, and
// noise would be its normal.
fn front_depth(ray: Ray, first: f32, found: ProjectedValue) -> f32 {
    let steepest = abs(ray.direction);
    let step = FRONT_STEP / max(max(steepest.x, steepest.y), max(steepest.z, 1e-12));
    let left = FRONT_SHARE * found.value;
    var depth = found.depth;
    var density = found.value;
    loop {
        let next = max(depth - step, first);
        let before = density_on_ray(ray, next);
        if (before < left) {
            return mix(next, depth, (left - before) / (density - before));
        }
        depth = next;
        density = before;
        if (next <= first) {
            break;
        }
    }
    return depth;
}

// Colour and transmittance of a ray that shows one value: that of the curve for the length of its opacity unit.
fn projection(ray: Ray) -> RayResult {
    let inside = span_within(eye.face_cut, ray);
    let first = eye.frame.first_depth;
    let span = clamp(inside, vec2f(first), vec2f(first + f32(eye.frame.slab_count) * eye.frame.slab));
    let found = projected_value(ray, span);
    let field = Field(found.value);
    let material = material_of(field);
    let passed = exp(-material.extinction * eye.shading.opacity_unit);
    if (found.weight == 0.0 || passed == 1.0) {
        return RayResult(vec3f(0.0), 1.0);
    }
#if LIT
    let depth = front_depth(ray, span.x, found);
#else
    let depth = found.depth;
#endif
    let p = ray.origin + ray.direction * depth;
    let level = kernel_level(eye.frame, depth);
    let slope = gradient_to_scene(eye.space, gradient_at(p, level));
    let light = shade_material(p, level, slope, presence_gradient(p, level), SlabSample(material, field, 1.0));
    return RayResult((1.0 - passed) * light, passed);
}
