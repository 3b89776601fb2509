// Display pass with 8 bits per channel.
#import "output/tone_map.wgsl"

@group(0) @binding(2) var shown: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    display = bound_display;
    if (any(id.xy >= textureDimensions(shown))) {
        return;
    }
    textureStore(shown, id.xy, display_color(id.xy));
}
