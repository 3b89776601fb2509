// Extinction for near-field rays towards lights: one fetch from the pyramid. PRECLASSIFY: from the pyramid
// pre-classified for light, which is 0 where no voxel is.
#import "common/transmittance.wgsl"
#import "density/table.wgsl"
#import "density/volume.wgsl"

// Transfer function of light.
@group(0) @binding(4) var<storage, read> lighting_table: TransferTable;

#if PRECLASSIFY
@group(1) @binding(10) var lighting_pyramid: texture_3d<f32>;

// Extinction relative to the maximum, for each colour of light if shadows are coloured.
alias LightingValue = Transmittance;
#else
alias LightingValue = f32;
#endif

fn lighting_density(p: vec3f, level: f32) -> LightingValue {
#if PRECLASSIFY
    let texel = textureSampleLevel(lighting_pyramid, clamped, (p + 4.5) * grid.pyramid_scale, level);
#if COLORED
    return texel.gba;
#else
    return texel.r;
#endif
#else
    return pyramid(p, level);
#endif
}

fn lighting_presence(p: vec3f, level: f32) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
    return pyramid_presence(p, level);
#endif
}

// Extinction for a density or a relative extinction, interpolated in the table.
fn interpolated_extinction(density: f32) -> Transmittance {
    let at = table_entry(density);
    return mix(entry_extinction(lighting_table.entries[at.low]), entry_extinction(lighting_table.entries[at.low + 1u]), Transmittance(at.fraction));
}

fn lighting_extinction(met: LightingValue) -> Transmittance {
#if PRECLASSIFY
#if COLORED
    return vec3f(interpolated_extinction(met.r).r, interpolated_extinction(met.g).r, interpolated_extinction(met.b).r);
#else
    return interpolated_extinction(met);
#endif
#else
    return interpolated_extinction(met);
#endif
}

// Extinction from the nearest table entry, without interpolation.
fn nearest_lighting_extinction(met: LightingValue) -> Transmittance {
#if PRECLASSIFY
#if COLORED
    // Tables of relative extinction have no colours.
    return vec3f(
        lighting_table.entries[nearest_entry(met.r)].a,
        lighting_table.entries[nearest_entry(met.g)].a,
        lighting_table.entries[nearest_entry(met.b)].a,
    );
#else
    return lighting_table.entries[nearest_entry(met)].a;
#endif
#else
    return entry_extinction(lighting_table.entries[nearest_entry(met)]);
#endif
}
