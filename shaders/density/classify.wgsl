// From densities to materials, before or after the kernel spreads them. Materials are linear colour and
// extinction.
#import "density/table.wgsl"
#import "density/volume.wgsl"

// PRECLASSIFY: voxels are classified, and then spread; else what is spread is classified.
#if PRECLASSIFY
const PRECLASSIFY = true;
#else
const PRECLASSIFY = false;
#endif

// Colours weighted by extinction, so that they can be summed.
fn associated(material: vec4f) -> vec4f {
    return vec4f(material.rgb * material.a, material.a);
}

// Σ over the 4³ neighbours of material × kernel, voxel by voxel: no filter knows the transfer function. Where voxels are
// missing others stand in for them, and the sum fades with what is there.
fn material_by_kernel(p: vec3f) -> vec4f {
    let cell = floor(p);
    let f = p - cell;
    let wx = kernel_weights(f.x);
    let wy = kernel_weights(f.y);
    let wz = kernel_weights(f.z);
    let last = vec3i(textureDimensions(density_texture)) - 1;
    var sum = vec4f(0.0);
    for (var z = 0; z < 4; z += 1) {
        for (var y = 0; y < 4; y += 1) {
            let weight = wy[y] * wz[z];
            for (var x = 0; x < 4; x += 1) {
                // Texels of padding, and beyond, are no voxels.
                let texel = vec3i(cell) + vec3i(x, y, z);
                let voxel = clamp(texel, vec3i(1), last - 1);
                let share = select(0.0, wx[x] * weight, MISSING || all(texel == voxel));
                sum += share * associated(classify(textureLoad(density_texture, voxel, 0).r));
            }
        }
    }
#if MISSING
    return sum * presence_at(p, 0.0);
#else
    return sum;
#endif
}

// A stretched kernel finds the blurred volume classified instead.
fn material_at(p: vec3f, level: f32) -> vec4f {
    if (!STRETCH || level <= 0.0) {
        return material_by_kernel(p);
    }
    let wide = max(level, 1.0);
    let blurred = associated(classify(pyramid(p, wide))) * presence_at(p, wide);
    if (level >= 1.0) {
        return blurred;
    }
    return mix(material_by_kernel(p), blurred, level);
}

// What a slab holds where a ray crosses it.
struct SlabSample {
    material: vec4f,
    // 0 where voxels are classified.
    density: f32,
}

fn slab_sample(frame: SheetFrame, ray: Ray, k: f32) -> SlabSample {
#if PRECLASSIFY
    return SlabSample(spread_material(frame, ray, k), 0.0);
#else
    let density = slab_density(frame, ray, k);
    let material = classify(density);
    return SlabSample(vec4f(material.rgb, material.a * slab_presence(frame, ray, k)), density);
#endif
}

// The material of classified voxels in slab k where the ray crosses it.
fn spread_material(frame: SheetFrame, ray: Ray, k: f32) -> vec4f {
    let depth = depth_of(frame, k);
    let offset = select(0.0, TWO_POINT_OFFSET * frame.slab, QUADRATURE == 2u);
    var sum = material_at(ray.origin + ray.direction * (depth - offset), kernel_level(frame, depth - offset));
    if (QUADRATURE == 2u) {
        sum += material_at(ray.origin + ray.direction * (depth + offset), kernel_level(frame, depth + offset));
        sum *= 0.5;
    }
    return vec4f(sum.rgb / max(sum.a, 1e-20), sum.a);
}

// Its extinction alone.
fn slab_extinction(frame: SheetFrame, ray: Ray, k: f32) -> f32 {
#if PRECLASSIFY
    return spread_material(frame, ray, k).a;
#else
    return classified_extinction(slab_density(frame, ray, k)) * slab_presence(frame, ray, k);
#endif
}
