// Classification: from density to material (linear colour and extinction), after or before reconstruction.
//
// PRECLASSIFY: voxels are classified before reconstruction. The pyramid then holds materials
// (volume/preclassified.wgsl), its first channel takes the place of density, and the table converts it to extinction.
#import "density/table.wgsl"
#import "density/volume.wgsl"

#if PRECLASSIFY
// Pre-classified material at a point, from the pyramid.
fn preclassified_at(p: vec3f, level: f32) -> vec4f {
    return textureSampleLevel(pyramid_texture, clamped, (p + 4.5) * grid.pyramid_scale, level);
}

// Pre-classified material averaged over slab k, where the ray crosses it.
fn preclassified_in_slab(frame: SheetFrameUniform, ray: Ray, k: f32) -> vec4f {
    let depth = depth_of(frame, k);
    if (QUADRATURE == 2u) {
        let near = depth - TWO_POINT_OFFSET * frame.slab;
        let far = depth + TWO_POINT_OFFSET * frame.slab;
        return 0.5 * (preclassified_at(ray.origin + ray.direction * near, kernel_level(frame, near))
            + preclassified_at(ray.origin + ray.direction * far, kernel_level(frame, far)));
    }
    return preclassified_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));
}
#endif

// Sample of a slab where a ray crosses it.
struct SlabSample {
    material: vec4f,
    density: f32,
    // Presence, already included in the material's extinction; 1 where it was not evaluated.
    presence: f32,
}

fn slab_sample(frame: SheetFrameUniform, ray: Ray, k: f32) -> SlabSample {
#if PRECLASSIFY
    let found = preclassified_in_slab(frame, ray, k);
    return SlabSample(vec4f(found.gba / max(found.r, 1e-20), classified_extinction(found.r)), found.r, 1.0);
#else
    let density = slab_density(frame, ray, k);
    let material = classify(density);
    var presence = 1.0;
#if MISSING
    // Most samples are empty; presence is only fetched for the others.
    if (material.a > 0.0) {
        presence = slab_presence(frame, ray, k);
    }
#else
    presence = slab_presence(frame, ray, k);
#endif
    return SlabSample(vec4f(material.rgb, material.a * presence), density, presence);
#endif
}

// Extinction of slab k, without colour.
fn slab_extinction(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    return classified_extinction(slab_density(frame, ray, k)) * slab_presence(frame, ray, k);
}
