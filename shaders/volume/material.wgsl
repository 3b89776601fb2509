// Material: turns what the field holds (volume/field.wgsl) into matter, by transfer functions. This file alone reads
// their tables (tests/shaders/voxel_access.rs).
#import "common/transmittance.wgsl"
#import "volume/field.wgsl"

#option TINTED: further layers tint the material of the first one

// Baked transfer function: linear RGB and extinction per scene unit over densities 0 … 1.
const TABLE_SIZE = 1024u;

struct TransferTable {
    entries: array<vec4f, 1024>,
    // Sign of the slope of opacity: 1 where opacity rises with density, −1 where it falls.
    sides: array<f32, 1024>,
    // Maximum extinction of 2^n entries from each entry on, for each power of two up to the table's size (sparse
    // table).
    peaks: array<f32, 11264>,
    // Integrals over densities from 0 to each entry's, with a spacing of 1 between entries: of colour × extinction in
    // rgb, of extinction in a.
    integrals: array<vec4f, 1024>,
}

@group(0) @binding(1) var<storage, read> table: TransferTable;
// Transfer function of light, where `table` is that of the eye.
@group(0) @binding(26) var<storage, read> lighting_table: TransferTable;
// Transfer function of the eye, where `table` is that of light.
@group(0) @binding(27) var<storage, read> look_table: TransferTable;

// Transfer functions of the layers, where voxels are composed of several fields.
@group(0) @binding(29) var<storage, read> layer_tables: array<TransferTable>;

// Optical depth of what is taken for empty: a thousandth of the smallest that 8 bits can show.
const EMPTY_OPTICAL_DEPTH = 4e-6;

// Matter at a point, or its mean over a slab. What it emits is not its own: a setting of the picture, the same
// everywhere.
struct Material {
    // Linear colour.
    color: vec3f,
    // Extinction per scene unit.
    extinction: f32,
}

// Position of a density in a table, in entries.
fn table_position(density: f32) -> f32 {
    return clamp(density, 0.0, 1.0) * f32(TABLE_SIZE - 1u);
}

struct TableEntry {
    low: u32,
    // Fraction of the way to the next entry.
    fraction: f32,
}

fn table_entry(density: f32) -> TableEntry {
    let at = table_position(density);
    let low = min(u32(at), TABLE_SIZE - 2u);
    return TableEntry(low, at - f32(low));
}

// Index of the entry nearest to a density.
fn nearest_entry(density: f32) -> u32 {
    return u32(table_position(density) + 0.5);
}

// Material of a field, without its presence.
fn material_of(field: Field) -> Material {
    let at = table_entry(field.density);
    let entry = mix(table.entries[at.low], table.entries[at.low + 1u], at.fraction);
    return Material(entry.rgb, entry.a);
}

// Extinction of a field, without colour and presence.
fn extinction_of(field: Field) -> f32 {
    let at = table_entry(field.density);
    return mix(table.entries[at.low].a, table.entries[at.low + 1u].a, at.fraction);
}

// Extinction of a field, from the nearest entry.
fn nearest_extinction(field: Field) -> f32 {
    return table.entries[nearest_entry(field.density)].a;
}

// Extinction of light for an entry of its table.
fn entry_extinction(entry: vec4f) -> Transmittance {
#if COLORED
    return entry.rgb * entry.a;
#else
    return entry.a;
#endif
}

// Extinction of a field for each colour of light that is followed, where `table` is that of light.
fn extinction_by_color(field: Field) -> Transmittance {
    let at = table_entry(field.density);
    return mix(entry_extinction(table.entries[at.low]), entry_extinction(table.entries[at.low + 1u]), Transmittance(at.fraction));
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

// Integral of extinction over densities from 0 to a position in the table.
fn extinction_integral(at: f32) -> f32 {
    let low = min(u32(at), TABLE_SIZE - 2u);
    return mix(table.integrals[low].a, table.integrals[low + 1u].a, at - f32(low));
}

// Distance of two positions in a table below which the mean over their entries is taken: the rounding of integrals of up
// to 1023 entries is then below 1/2000 of the largest extinction.
const MIN_INTEGRATED_DISTANCE = 0.125;

// Integral of extinction over densities up to a position in the table.
struct IntegralPlace {
    position: f32,
    integral: f32,
    // Mean over the entry of the position; with pre-classification, extinction there.
    mean: f32,
}

fn integral_place(density: f32) -> IntegralPlace {
    let at = table_position(density);
    let low = min(u32(at), TABLE_SIZE - 2u);
    let first = table.integrals[low].a;
    let mean = table.integrals[low + 1u].a - first;
    let integral = first + mean * (at - f32(low));
#if PRECLASSIFY
    // The mean over the first entry would be that of faint material, which empty space is not.
    return IntegralPlace(at, integral, extinction_of(Field(density)));
#else
    return IntegralPlace(at, integral, mean);
#endif
}

// Mean extinction over the densities between two.
fn mean_extinction(a: IntegralPlace, b: IntegralPlace) -> f32 {
    let distance = b.position - a.position;
    let is_near = abs(distance) < MIN_INTEGRATED_DISTANCE;
    return select((b.integral - a.integral) / select(distance, 1.0, is_near), 0.5 * (a.mean + b.mean), is_near);
}

// Side of a surface to which opacity falls: 1 where density falls, −1 where it rises; in between where it changes
// over. For pre-classified voxels, whose densities are opacities, always outwards.
fn side_of(field: Field) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
    return table.sides[nearest_entry(field.density)];
#endif
}

// Texel of a pyramid of pre-classified voxels: extinction relative to the table's maximum first, then colours times
// that, so that all channels can be summed.
fn preclassified_texel(material: Material) -> vec4f {
    // Maximum over all entries.
    let share = material.extinction / max(table.peaks[10u * TABLE_SIZE], 1e-20);
    return vec4f(share, material.color * share);
}

// Material of a mean of such texels. The table is that of relative extinction.
fn material_of_preclassified(texel: vec4f) -> Material {
    return Material(texel.gba / max(texel.r, 1e-20), extinction_of(Field(texel.r)));
}

// Extinction for each colour of light, from relative ones.
fn extinction_of_colors(met: vec3f) -> vec3f {
    return vec3f(extinction_of(Field(met.r)), extinction_of(Field(met.g)), extinction_of(Field(met.b)));
}

// Extinction at a point, times its presence.
fn pyramid_extinction(p: vec3f, level: f32) -> f32 {
#if PRECLASSIFY
    return extinction_of(Field(preclassified_at(p, level).r));
#else
    var extinction = extinction_of(pyramid_field(p, level));
    // Most points are empty; presence is only fetched for the others.
    if (extinction > 0.0) {
        extinction *= pyramid_presence(p, level);
    }
    return extinction;
#endif
}

// Linear colour that the eye sees at a point, where `table` is that of light.
fn look_color(p: vec3f, level: f32) -> vec3f {
#if PRECLASSIFY
    let found = look_texel(p, level);
    return clamp(found.gba / max(found.r, 1e-20), vec3f(0.0), vec3f(1.0));
#else
    let at = table_entry(pyramid_density(p, level));
    let color = mix(look_table.entries[at.low].rgb, look_table.entries[at.low + 1u].rgb, at.fraction);
#if TINTED
    // Without pre-classification the pyramid of the look is that of tints.
    return with_tint_texel(color, look_texel(p, level));
#else
    return color;
#endif
#endif
}

// Colour under a tint: its opacity, and its colour times that.
fn with_tint_texel(color: vec3f, tint: vec4f) -> vec3f {
    return color * (1.0 - tint.r) + tint.gba;
}

// Colour of material at a point under the tints of further layers.
fn tinted(color: vec3f, p: vec3f, level: f32) -> vec3f {
#if TINTED
    return with_tint_texel(color, tint_texel(p, level));
#else
    return color;
#endif
}

// Extinction of light for a density or a relative extinction, interpolated in the table.
fn interpolated_extinction(density: f32) -> Transmittance {
    let at = table_entry(density);
    return mix(entry_extinction(lighting_table.entries[at.low]), entry_extinction(lighting_table.entries[at.low + 1u]), Transmittance(at.fraction));
}

// Extinction of light.
fn lighting_extinction(met: LightingField) -> Transmittance {
#if PRECLASSIFY
#if COLORED
    return vec3f(interpolated_extinction(met.r).r, interpolated_extinction(met.g).r, interpolated_extinction(met.b).r);
#else
    return interpolated_extinction(met);
#endif
#else
    return interpolated_extinction(met.density);
#endif
}

// Integral of the extinction of light up to what the field holds at a point; with pre-classification and coloured
// shadows, extinction there.
struct LightIntegralPlace {
    position: f32,
    integral: Transmittance,
    mean: Transmittance,
}

fn integral_up_to(density: f32) -> LightIntegralPlace {
    let at = table_position(density);
    let low = min(u32(at), TABLE_SIZE - 2u);
#if COLORED
    let first = lighting_table.integrals[low].rgb;
    let mean = lighting_table.integrals[low + 1u].rgb - first;
#else
    let first = lighting_table.integrals[low].a;
    let mean = lighting_table.integrals[low + 1u].a - first;
#endif
    return LightIntegralPlace(at, first + mean * (at - f32(low)), mean);
}

fn light_integral_place(met: LightingField) -> LightIntegralPlace {
#if PRECLASSIFY
#if COLORED
    // Each colour has a place of its own in the table, which is a straight line.
    let extinction = lighting_extinction(met);
    return LightIntegralPlace(0.0, extinction, extinction);
#else
    var place = integral_up_to(met);
    place.mean = lighting_extinction(met);
    return place;
#endif
#else
    return integral_up_to(met.density);
#endif
}

// Mean extinction of light where the field changes linearly from one place to another.
fn mean_light_extinction(a: LightIntegralPlace, b: LightIntegralPlace) -> Transmittance {
    let distance = b.position - a.position;
    let is_near = abs(distance) < MIN_INTEGRATED_DISTANCE;
    if (is_near) {
        return 0.5 * (a.mean + b.mean);
    }
    return (b.integral - a.integral) / distance;
}

// Means over a range of densities in a layer's field: of colour × extinction in rgb, of extinction in a. Where the range
// is narrow, those at its middle.
fn layer_mean(layer: u32, low: f32, high: f32) -> vec4f {
    let a = table_position(low);
    let b = table_position(high);
    if (b - a < MIN_INTEGRATED_DISTANCE) {
        let at = table_entry(0.5 * (low + high));
        let entry = mix(layer_tables[layer].entries[at.low], layer_tables[layer].entries[at.low + 1u], at.fraction);
        return vec4f(entry.rgb * entry.a, entry.a);
    }
    return (layer_integral(layer, b) - layer_integral(layer, a)) / (b - a);
}

fn layer_integral(layer: u32, at: f32) -> vec4f {
    let low = min(u32(at), TABLE_SIZE - 2u);
    return mix(layer_tables[layer].integrals[low], layer_tables[layer].integrals[low + 1u], at - f32(low));
}
