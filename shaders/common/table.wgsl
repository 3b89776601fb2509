// A baked transfer function: linear RGB and extinction per scene unit over densities 0 … 1.
const TABLE_SIZE = 1024u;

@group(0) @binding(1) var<storage, read> table: array<vec4f, 1024>;

fn classify(density: f32) -> vec4f {
    let at = clamp(density, 0.0, 1.0) * f32(TABLE_SIZE - 1u);
    let low = min(u32(at), TABLE_SIZE - 2u);
    return mix(table[low], table[low + 1u], at - f32(low));
}
