// Baked transfer function: linear RGB and extinction per scene unit over densities 0 … 1.
const TABLE_SIZE = 1024u;

struct TransferTable {
    entries: array<vec4f, 1024>,
    // Sign of the slope of opacity: 1 where opacity rises with density, −1 where it falls.
    sides: array<f32, 1024>,
    // Maximum extinction of 2^n entries from each entry on, for each power of two up to the table's size (sparse
    // table).
    peaks: array<f32, 11264>,
    // Integral of extinction over densities from 0 to each entry's, with a spacing of 1 between entries.
    integrals: array<f32, 1024>,
}

@group(0) @binding(1) var<storage, read> table: TransferTable;

struct TableEntry {
    low: u32,
    // Fraction of the way to the next entry.
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

// Extinction of a density, without colour.
fn classified_extinction(density: f32) -> f32 {
    let at = table_entry(density);
    return mix(table.entries[at.low].a, table.entries[at.low + 1u].a, at.fraction);
}

// Index of the entry nearest to a density.
fn nearest_entry(density: f32) -> u32 {
    return u32(clamp(density, 0.0, 1.0) * f32(TABLE_SIZE - 1u) + 0.5);
}

// Side of a surface to which opacity falls: 1 where density falls, −1 where it rises; in between where it changes
// over.
fn side_of(density: f32) -> f32 {
    return table.sides[nearest_entry(density)];
}

// Maximum extinction of the densities in a range.
fn largest_extinction(low: f32, high: f32) -> f32 {
    let range = clamp(vec2f(low, high), vec2f(0.0), vec2f(1.0)) * f32(TABLE_SIZE - 1u);
    let first = u32(range.x);
    let last = u32(ceil(range.y));
    // Two overlapping runs of the largest power of two, one from either end.
    let power = firstLeadingBit(last - first + 1u);
    let run = power * TABLE_SIZE;
    return max(table.peaks[run + first], table.peaks[run + last + 1u - (1u << power)]);
}
