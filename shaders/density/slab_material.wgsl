// Material of slabs along a ray: the field averaged over a slab and then classified, or the mean of voxels that were
// classified before.
#import "density/slab_field.wgsl"
#import "volume/material.wgsl"

#if PRECLASSIFY
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
    material: Material,
    field: Field,
    // Presence, already included in the material's extinction; 1 where it was not evaluated.
    presence: f32,
}

fn slab_sample(frame: SheetFrameUniform, ray: Ray, k: f32) -> SlabSample {
#if PRECLASSIFY
    let found = preclassified_in_slab(frame, ray, k);
    return SlabSample(material_of_preclassified(found), Field(found.r), 1.0);
#else
    let field = slab_field(frame, ray, k);
    let material = material_of(field);
    var presence = 1.0;
#if MISSING
    // Most samples are empty; presence is only fetched for the others.
    if (material.extinction > 0.0) {
        presence = slab_presence(frame, ray, k);
    }
#else
    presence = slab_presence(frame, ray, k);
#endif
    return SlabSample(Material(material.color, material.extinction * presence), field, presence);
#endif
}

// Extinction of slab k, without colour.
fn slab_extinction(frame: SheetFrameUniform, ray: Ray, k: f32) -> f32 {
    return extinction_of(slab_field(frame, ray, k)) * slab_presence(frame, ray, k);
}
