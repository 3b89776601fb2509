// Display pass with more than 8 bits per channel, or with linear light and no tone map.
#import "output/tone_map.wgsl"

@group(0) @binding(2) var shown: texture_storage_2d<rgba32float, write>;

// Writes linear, premultiplied light instead of display colours.
override LINEAR: bool = false;

fn linear_light(pixel: vec2u) -> vec4f {
    let light = pixel_light(pixel);
    let before_background = light + (1.0 - light.a) * vec4f(linear_from_srgb(background_at(pixel)), 1.0);
    return select(before_background, light, display.transparent != 0u);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    display = bound_display;
    if (any(id.xy >= textureDimensions(shown))) {
        return;
    }
    if (LINEAR) {
        textureStore(shown, id.xy, linear_light(id.xy));
    } else {
        textureStore(shown, id.xy, display_color(id.xy));
    }
}
