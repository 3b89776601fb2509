// Largest number in 16-bit floats: larger ones become infinite, and products of infinity and zero NaN.
const MAX_HALF_FLOAT = 65504.0;

// Numbers above 0 with the 11 bits of 16-bit floats, rounded to the nearest. Some drivers cut bits off where they store
// them, which takes away light at every bounce.
fn rounded_to_half(numbers: vec4f) -> vec4f {
    return bitcast<vec4f>((bitcast<vec4u>(numbers) + 0x1000u) & vec4u(0xffffe000u));
}
