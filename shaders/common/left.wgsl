// What is left of a light, 0 … 1, and what it meets: of all light alike or, where shadows are coloured, of red, green and
// blue light. Tables of what light meets hold the shares of the extinction that each colour meets, in place of colours.
#if COLORED
alias Left = vec3f;
#else
alias Left = f32;
#endif

fn stored_left(texel: vec4f) -> Left {
#if COLORED
    return texel.rgb;
#else
    return texel.r;
#endif
}

// The extinction that an entry of a table of what light meets stands for.
fn extinction_of(entry: vec4f) -> Left {
#if COLORED
    return entry.rgb * entry.a;
#else
    return entry.a;
#endif
}

fn least_of(values: Left) -> f32 {
#if COLORED
    return min(values.r, min(values.g, values.b));
#else
    return values;
#endif
}
