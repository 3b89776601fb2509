// Transmittance, 0 … 1, and extinction of light: a scalar, or red, green and blue where shadows are coloured. Tables
// of coloured extinction hold the share of the extinction for each colour of light in place of the material's colour.

#option COLORED: transmittance differs between red, green and blue light

#if COLORED
alias Transmittance = vec3f;
#else
alias Transmittance = f32;
#endif

fn stored_transmittance(texel: vec4f) -> Transmittance {
#if COLORED
    return texel.rgb;
#else
    return texel.r;
#endif
}

fn min_component(values: Transmittance) -> f32 {
#if COLORED
    return min(values.r, min(values.g, values.b));
#else
    return values;
#endif
}
