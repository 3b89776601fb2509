// Layers: matter of a voxel from several fields. Extinctions add up, and colours are their weighted mean; layers may also
// tint or gate the matter of those before them.
//
// A steep curve would turn voxels on or off as a whole, and surfaces into stairs. So a voxel has the mean matter of the
// densities within it: those of a linear field in a cube spread evenly, nearly, over a range as wide as its gradient is
// long, whose variance is the same: a twelfth of the sum of the squared differences across the cube.
#import "common/srgb.wgsl"
#import "volume/material.wgsl"
#option MASK_BY_LAYER: a mask hides voxels of some layers

const MAX_MATERIALS = 8u;

// Material by value and change: a region of densities and of their changes per voxel, each with the positions at which
// its weight begins to rise, is 1, begins to fall, and is 0.
struct MaterialUniform {
    densities: vec4f,
    changes: vec4f,
    // Colour × opacity or extinction, and opacity or extinction, as tables have it.
    matter: vec4f,
}

struct LayerUniform {
    // LAYER_ADD, LAYER_TINT, LAYER_GATE or LAYER_NONE; LAYER_RED plus the number of a channel of colour.
    blend: u32,
    // 1 if densities are classes of labels, which have no mean.
    is_label: u32,
    // Length to which opacities of tints and gates refer, in scene units.
    opacity_unit: f32,
    // Change of density per voxel from which on opacity is that of the curve; 0 leaves all opacities. Of labels, any
    // other leaves the voxels beside another label.
    edges: f32,
    // Number of materials that take the place of the table.
    material_count: u32,
    // 1 if the layer stays where voxels are hidden, so that the mask is of each layer.
    ignores_cuts: u32,
    pad1: u32,
    pad2: u32,
    materials: array<MaterialUniform, MAX_MATERIALS>,
}

struct LayersUniform {
    // Number of layers.
    count: u32,
    // Largest sum of extinctions, per scene unit.
    largest: f32,
    // Edge of a voxel in scene units, over which tables and texels have opacities; 0 if they have extinctions.
    voxel: f32,
    pad0: u32,
    layers: array<LayerUniform, 4>,
}

@group(0) @binding(6) var<uniform> bound_layers: LayersUniform;
var<private> layers: LayersUniform;

// Length of densities below which integrals are not subtracted: rounding of f32 is then a thousandth of their difference.
const MIN_INTEGRATED_DENSITIES = 1e-4;

const LAYER_ADD = 0u;
const LAYER_TINT = 1u;
const LAYER_GATE = 2u;
const LAYER_NONE = 3u;
const LAYER_RED = 4u;

// Matter with the mean colour × opacity and opacity of a voxel's edge: between an opaque voxel and an empty one, half of
// the opacity is half, while half of the extinction would be opaque, too.
fn matter_of_mean(mean: vec4f) -> vec4f {
    // Differences of integrals may be rounded below 0. An opacity of 1 would have no extinction; the eye tells none above
    // 1 − 10⁻⁶ from it.
    let opacity = clamp(mean.a, 0.0, 1.0 - 1e-6);
    // Below it the logarithm is rounded more than the two differ.
    let is_faint = opacity < 1e-4;
    let depth_per_opacity = select(-log(1.0 - opacity) / select(opacity, 1.0, is_faint), 1.0, is_faint);
    return max(mean, vec4f(0.0)) * select(1.0, depth_per_opacity / max(layers.voxel, 1e-20), layers.voxel > 0.0);
}

// Texel of a pyramid for matter: extinction or opacity relative to the largest, and colour times that.
fn texel_of_matter(matter: vec4f) -> vec4f {
    let opacity = (1.0 - exp(-matter.a * layers.voxel)) / max(1.0 - exp(-layers.largest * layers.voxel), 1e-20);
    let share = select(matter.a / max(layers.largest, 1e-20), opacity, layers.voxel > 0.0);
    return vec4f(share, matter.rgb * (share / max(matter.a, 1e-20)));
}

// Integral of a ramp from 0 to 1 over two positions.
fn ramp_integral(ends: vec2f, at: f32) -> f32 {
    let within = clamp(at, ends.x, ends.y) - ends.x;
    return 0.5 * within * within / (ends.y - ends.x) + max(at - ends.y, 0.0);
}

// Mean weight of a region's densities from `low` to `high`.
fn mean_weight(ends: vec4f, low: f32, high: f32) -> f32 {
    let mid = 0.5 * (low + high);
    // Differences of integrals would be rounded away.
    if (high - low < MIN_INTEGRATED_DENSITIES) {
        return region_weight(ends, mid);
    }
    let rise = ramp_integral(ends.xy, high) - ramp_integral(ends.xy, low);
    return (rise - ramp_integral(ends.zw, high) + ramp_integral(ends.zw, low)) / (high - low);
}

fn region_weight(ends: vec4f, at: f32) -> f32 {
    let ramps = clamp((vec2f(at) - ends.xz) / (ends.yw - ends.xz), vec2f(0.0), vec2f(1.0));
    return ramps.x - ramps.y;
}

// Sum of the matter of a layer's materials, for densities from `low` to `high` and their change.
fn matter_of_materials(i: u32, low: f32, high: f32, change: f32) -> vec4f {
    var sum = vec4f(0.0);
    for (var at = 0u; at < layers.layers[i].material_count; at += 1u) {
        // Not from the copy, in which they would take drivers seconds to compile.
        let material = bound_layers.layers[i].materials[at];
        let weight = mean_weight(material.densities, low, high) * region_weight(material.changes, change);
        sum += matter_of_mean(weight * material.matter);
    }
    return sum;
}

// Matter of a layer around a voxel: colour × extinction, and extinction.
fn layer_matter(i: u32, found: FieldNeighbourhood) -> vec4f {
    let layer = layers.layers[i];
    let half_width = select(0.5 * found.slope[i], 0.0, layer.is_label == 1u);
    // Within the values around the voxel, by which empty bricks are known.
    let low = max(found.own[i] - half_width, found.lowest[i]);
    let high = min(found.own[i] + half_width, found.highest[i]);
    let is_present = select(0.0, 1.0, found.is_present[i]);
    var matter = vec4f(0.0);
    if (layer.material_count == 0u) {
        matter = is_present * matter_of_mean(layer_mean(i, low, high));
    } else {
        matter = is_present * matter_of_materials(i, low, high, found.slope[i]);
    }
    // Numbers of labels differ by anything: beside another label is an outline.
    let is_outline = select(0.0, 1.0, found.highest[i] > found.lowest[i]);
    if (layer.edges > 0.0) {
        let is_edge = smoothstep(0.5 * layer.edges, layer.edges, found.slope[i]);
        return matter * select(is_edge, is_outline, layer.is_label == 1u);
    }
    return matter;
}

// Opacity of matter over the length to which a layer's opacities refer.
fn layer_opacity(i: u32, matter: vec4f) -> f32 {
    return 1.0 - exp(-matter.a * layers.layers[i].opacity_unit);
}

// Mixture of a material, colour times weight and weight, with the colour of a tint.
fn with_tint(sum: vec4f, weight: f32, matter: vec4f, opacity: f32) -> vec4f {
    let color = matter.rgb / max(matter.a, 1e-20);
    return vec4f(mix(sum.rgb, color * weight, opacity), sum.a);
}

// Color with the channel of a layer replaced by the density at a voxel, times a weight, if the layer is of a channel and
// the voxel is there.
fn with_channel(color: vec3f, weight: f32, i: u32, found: FieldNeighbourhood) -> vec3f {
    let is_replaced = (vec3u(0u, 1u, 2u) + LAYER_RED == vec3u(layers.layers[i].blend)) & vec3<bool>(found.is_present[i]);
    return select(color, weight * linear_from_srgb(vec3f(found.own[i])), is_replaced);
}

// Tint of a voxel by all layers that tint: opacity, and colour times opacity.
//
// The surface of a labelled structure lies between its voxels and those beside them, so the tint of labels reaches one
// voxel further: to voxels without one, from the neighbour with the highest opacity.
fn voxel_tint(voxel: vec3i) -> vec4f {
    let found = field_neighbourhood(voxel);
    var tint = vec4f(0.0);
    for (var i = 0u; i < layers.count; i += 1u) {
        if (layers.layers[i].blend >= LAYER_RED) {
            let is_there = select(0.0, 1.0, found.is_present[i]);
            tint = vec4f(with_channel(tint.rgb, 1.0, i, found), max(tint.a, is_there));
            continue;
        }
        if (layers.layers[i].blend != LAYER_TINT) {
            continue;
        }
        var matter = layer_matter(i, found);
        let is_without = layer_mean(i, found.own[i], found.own[i]).a <= 0.0 || !found.is_present[i];
        if (layers.layers[i].is_label == 1u && is_without) {
            matter = densest_beside(i, voxel);
        }
        let opacity = layer_opacity(i, matter);
        tint = vec4f(with_tint(vec4f(tint.rgb, 0.0), 1.0, matter, opacity).rgb, mix(tint.a, 1.0, opacity));
    }
    return vec4f(tint.a, tint.rgb);
}

// Matter of labels with the largest extinction among the six voxels beside one.
fn densest_beside(i: u32, voxel: vec3i) -> vec4f {
    var densest = vec4f(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let step = vec3i(vec3u(axis) == vec3u(0u, 1u, 2u));
        for (var side = -1; side < 2; side += 2) {
            let beside = field_value(i, voxel + side * step);
            if (beside >= 0.0) {
                let matter = matter_of_mean(layer_mean(i, beside, beside));
                densest = select(densest, matter, matter.a > densest.a);
            }
        }
    }
    return densest;
}

// Matter of a voxel as a texel of pre-classified voxels.
fn layered_material(voxel: vec3i) -> vec4f {
    let found = field_neighbourhood(voxel);
#if MASK_BY_LAYER
    // The pyramid begins four voxels before the grid.
    let unmasked = presence_at_texel(vec3u(voxel + 4));
#else
    let unmasked = 1.0;
#endif
    // Colour × extinction, and extinction.
    var sum = vec4f(0.0);
    for (var i = 0u; i < layers.count; i += 1u) {
        let blend = layers.layers[i].blend;
        let matter = layer_matter(i, found) * select(unmasked, 1.0, layers.layers[i].ignores_cuts == 1u);
        let opacity = layer_opacity(i, matter);
        if (blend == LAYER_TINT) {
            sum = with_tint(sum, sum.a, matter, opacity);
        } else if (blend == LAYER_GATE) {
            sum *= opacity;
        } else if (blend == LAYER_ADD) {
            sum += matter;
        } else {
            sum = vec4f(with_channel(sum.rgb, sum.a, i, found), sum.a);
        }
    }
    return texel_of_matter(sum);
}
