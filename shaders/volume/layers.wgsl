// Layers: matter of a voxel from several fields. Extinctions add up, and colours are their weighted mean; layers may also
// tint or gate the matter of those before them.
//
// A steep curve would turn voxels on or off as a whole, and surfaces into stairs. So a voxel has the mean matter of the
// densities within it: those of a linear field in a cube spread evenly, nearly, over a range as wide as its gradient is
// long, whose variance is the same: a twelfth of the sum of the squared differences across the cube.
#import "volume/material.wgsl"

struct LayerUniform {
    // LAYER_ADD, LAYER_TINT, LAYER_GATE or LAYER_NONE.
    blend: u32,
    // 1 if densities are classes of labels, which have no mean.
    is_label: u32,
    // Length to which opacities of tints and gates refer, in scene units.
    opacity_unit: f32,
    // Change of density per voxel from which on opacity is that of the curve; 0 leaves all opacities.
    edges: f32,
}

struct LayersUniform {
    // Number of layers.
    count: u32,
    // Largest sum of extinctions, per scene unit.
    largest: f32,
    pad0: u32,
    pad1: u32,
    layers: array<LayerUniform, 4>,
}

@group(0) @binding(6) var<uniform> bound_layers: LayersUniform;
var<private> layers: LayersUniform;

const LAYER_ADD = 0u;
const LAYER_TINT = 1u;
const LAYER_GATE = 2u;
const LAYER_NONE = 3u;

// Matter of a voxel as a texel of pre-classified voxels: extinction relative to the largest sum, and colour times that.
fn layered_material(voxel: vec3i) -> vec4f {
    let found = field_neighbourhood(voxel);
    // Colour × extinction, and extinction.
    var sum = vec4f(0.0);
    for (var i = 0u; i < layers.count; i += 1u) {
        let layer = layers.layers[i];
        let half_width = select(0.5 * found.slope[i], 0.0, layer.is_label == 1u);
        // Within the values around the voxel, by which empty bricks are known.
        let low = max(found.own[i] - half_width, found.lowest[i]);
        let high = min(found.own[i] + half_width, found.highest[i]);
        var matter = layer_mean(i, low, high) * select(0.0, 1.0, found.is_present[i]);
        if (layer.edges > 0.0) {
            matter *= smoothstep(0.5 * layer.edges, layer.edges, found.slope[i]);
        }
        let opacity = 1.0 - exp(-matter.a * layer.opacity_unit);
        if (layer.blend == LAYER_TINT) {
            let color = matter.rgb / max(matter.a, 1e-20);
            sum = vec4f(mix(sum.rgb, color * sum.a, opacity), sum.a);
        } else if (layer.blend == LAYER_GATE) {
            sum *= opacity;
        } else if (layer.blend == LAYER_ADD) {
            sum += matter;
        }
    }
    return vec4f(sum.a, sum.rgb) / max(layers.largest, 1e-20);
}
