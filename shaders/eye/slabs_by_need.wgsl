// Slabs along a ray that are as thin as they need to be: one that may make up much of what is seen along it is divided
// into quarters, because normals and light change within it. The slabs of the frame are the quarters.
#import "density/cells.wgsl"
#import "density/classify.wgsl"

// Parts into which a slab is divided; a power of two.
const THIN_SLABS = 4;

// A slab is divided that may make up more than this share of what is seen along the ray. Above, steep surfaces show
// a weave; below, it is dearer, and nothing looks better.
const MUCH = 0.125;

// The density is expected to change across a slab by this many times what its gradient in the middle says.
const CURVED = 1.25;

// What a ray shows between slabs of the frame, the first and the last inside.
fn slabs_by_need(ray: Ray, span: vec2f, inside: vec2i) -> Seen {
    let walk = walk_along(eye.frame, ray);
    let thick = f32(THIN_SLABS) * eye.frame.slab;
    var k = next_seen(walk, inside.x, inside.y);
    // How many slabs of the frame the next sample stands for, and where the one ends that is being divided.
    var width = THIN_SLABS;
    var end = 0;
    var color = vec3f(0.0);
    var t = 1.0;
    loop {
        if (k > inside.y) {
            break;
        }
        // Whatever was leapt over, thick slabs begin at multiples of their width.
        let start = k & ~(width - 1);
        let middle = f32(start) + 0.5 * f32(width - 1);
        let depth = depth_of(eye.frame, middle);
        let p = ray.origin + ray.direction * depth;
        let level = kernel_level(eye.frame, depth);
        let found = slab_seen(ray, span, middle, f32(width));
        let slope = volume_slope(p, level);
        // Asked once: software drivers run both of the branches that need it.
        let rising = presence_slope(p, level);
        var needed = width;
        if (width == THIN_SLABS) {
            let change = 0.5 * CURVED * thick * abs(dot(slope, ray.direction));
            let largest = largest_extinction(found.density - change, found.density + change);
            var share = t * (1.0 - exp(-largest * thick * ray.obliquity));
#if MISSING
#if PRECLASSIFY
            // Voxels that are classified are there by themselves.
#else
            // Where voxels are missing the density goes on beside the others, and little or nothing of it is there.
            if (share > MUCH) {
                let rise = 0.5 * CURVED * thick * abs(dot(rising, ray.direction));
                let there = min(found.there + rise, 1.0);
                share = t * (1.0 - exp(-there * largest * thick * ray.obliquity));
            }
#endif
#endif
            // So is what ends within the slab.
            let is_whole = start >= inside.x && start + THIN_SLABS - 1 <= inside.y;
            needed = select(1, width, is_whole && share <= MUCH);
            end = start + THIN_SLABS;
        }
        if (needed == width) {
            if (found.material.a > 0.0) {
                let passed = exp(-found.material.a * f32(width) * eye.frame.slab * ray.obliquity);
                color += t * (1.0 - passed) * lit_material(p, level, gradient_to_scene(eye.space, slope), rising, found);
                t *= passed;
            }
            k = start + width;
        }
        if (t < eye.dark) {
            break;
        }
        k = next_seen(walk, k, inside.y);
        width = select(needed, THIN_SLABS, k >= end);
        if (k > inside.y) {
            break;
        }
    }
    return Seen(color, t);
}
