// Adaptive slabs along a ray: a slab that may contribute much of the visible light is divided into quarters, because
// normals and light vary within it. The slabs of the frame are the quarters.
#import "density/cells.wgsl"
#import "density/slab_material.wgsl"

// Number of parts into which a slab is divided; a power of two.
const THIN_SLABS = 4;

// Share of the visible light above which a slab is divided. Larger values show a weave on steep surfaces; smaller
// ones cost more without visible improvement.
const MAX_UNDIVIDED_SHARE = 0.125;

// Safety factor for the change of density across a slab, relative to the gradient at its middle.
const GRADIENT_SAFETY = 1.25;

// Colour and transmittance of a ray between two slabs of the frame, `inside.x` to `inside.y`.
fn adaptive_slabs(ray: Ray, span: vec2f, inside: vec2i) -> RayResult {
    let walk = cell_ray(eye.frame, ray);
    let thick = f32(THIN_SLABS) * eye.frame.slab;
    var k = next_visible_slab(walk, inside.x, inside.y);
    // Number of frame slabs in the next sample, and end of the slab that is being divided.
    var width = THIN_SLABS;
    var end = 0;
    var color = vec3f(0.0);
    var t = 1.0;
    loop {
        if (k > inside.y) {
            break;
        }
        // Thick slabs begin at multiples of their width, wherever skipping ended.
        let start = k & ~(width - 1);
        let middle = f32(start) + 0.5 * f32(width - 1);
        let depth = depth_of(eye.frame, middle);
        let p = ray.origin + ray.direction * depth;
        let level = kernel_level(eye.frame, depth);
        let found = visible_slab_sample(ray, span, middle, f32(width));
        let slope = volume_gradient(p, level);
        // Evaluated once: software drivers run both branches that need it.
        let rising = presence_gradient(p, level);
        var needed = width;
        if (width == THIN_SLABS) {
            let change = 0.5 * GRADIENT_SAFETY * thick * abs(dot(slope, ray.direction));
            let largest = largest_extinction(found.field.density - change, found.field.density + change);
            var share = t * (1.0 - exp(-largest * thick * ray.obliquity));
#if MISSING
#if PRECLASSIFY
            // Pre-classified materials already include presence.
#else
            // Beside missing voxels density continues, but little or no material is present.
            if (share > MAX_UNDIVIDED_SHARE) {
                let rise = 0.5 * GRADIENT_SAFETY * thick * abs(dot(rising, ray.direction));
                let presence = min(found.presence + rise, 1.0);
                share = t * (1.0 - exp(-presence * largest * thick * ray.obliquity));
            }
#endif
#endif
            // Slabs that extend beyond the volume are divided, too.
            let is_whole = start >= inside.x && start + THIN_SLABS - 1 <= inside.y;
            needed = select(1, width, is_whole && share <= MAX_UNDIVIDED_SHARE);
            end = start + THIN_SLABS;
        }
        if (needed == width) {
            if (found.material.extinction > 0.0) {
                let passed = exp(-found.material.extinction * f32(width) * eye.frame.slab * ray.obliquity);
                color += t * (1.0 - passed) * shade_material(p, level, gradient_to_scene(eye.space, slope), rising, found);
                t *= passed;
            }
            k = start + width;
        }
        if (t < eye.min_transmittance) {
            break;
        }
        k = next_visible_slab(walk, k, inside.y);
        width = select(needed, THIN_SLABS, k >= end);
        if (k > inside.y) {
            break;
        }
    }
    return RayResult(color, t);
}
