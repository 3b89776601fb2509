// A baked transfer function: linear RGB and extinction per scene unit over densities 0 … 1.
const TABLE_SIZE = 1024u;

@group(0) @binding(1) var<storage, read> table: array<vec4f, 1024>;

struct TableEntry {
    low: u32,
    // Of the way to the next entry.
    fraction: f32,
}

fn table_entry(density: f32) -> TableEntry {
    let at = clamp(density, 0.0, 1.0) * f32(TABLE_SIZE - 1u);
    let low = min(u32(at), TABLE_SIZE - 2u);
    return TableEntry(low, at - f32(low));
}

fn classify(density: f32) -> vec4f {
    let at = table_entry(density);
    return mix(table[at.low], table[at.low + 1u], at.fraction);
}

// The same without colour.
fn classified_extinction(density: f32) -> f32 {
    let at = table_entry(density);
    return mix(table[at.low].a, table[at.low + 1u].a, at.fraction);
}
