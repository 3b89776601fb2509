// A baked transfer function: linear RGB and extinction per scene unit over densities 0 … 1.
const TABLE_SIZE = 1024u;

struct TransferTable {
    entries: array<vec4f, 1024>,
    // Where opacity rises with density, 1; where it falls, −1.
    sides: array<f32, 1024>,
    // For each power of two up to the table's size, largest extinctions over so many entries from each on.
    peaks: array<f32, 11264>,
    // Integral of extinction over densities from 0 to each entry's, with entries 1 apart.
    integrals: array<f32, 1024>,
}

@group(0) @binding(1) var<storage, read> table: TransferTable;

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
    return mix(table.entries[at.low], table.entries[at.low + 1u], at.fraction);
}

// The same without colour.
fn classified_extinction(density: f32) -> f32 {
    let at = table_entry(density);
    return mix(table.entries[at.low].a, table.entries[at.low + 1u].a, at.fraction);
}

// The entry next to a density, where one will do.
fn nearest_entry(density: f32) -> u32 {
    return u32(clamp(density, 0.0, 1.0) * f32(TABLE_SIZE - 1u) + 0.5);
}

// To which side of a surface opacity falls: 1 where density falls, −1 where it rises, and between them amid a change.
fn side_of(density: f32) -> f32 {
    return table.sides[nearest_entry(density)];
}

// The largest extinction of densities within a range.
fn largest_extinction(low: f32, high: f32) -> f32 {
    let range = clamp(vec2f(low, high), vec2f(0.0), vec2f(1.0)) * f32(TABLE_SIZE - 1u);
    let first = u32(range.x);
    let last = u32(ceil(range.y));
    // Two runs of as many entries as fit, one from either end.
    let power = firstLeadingBit(last - first + 1u);
    let run = power * TABLE_SIZE;
    return max(table.peaks[run + first], table.peaks[run + last + 1u - (1u << power)]);
}
