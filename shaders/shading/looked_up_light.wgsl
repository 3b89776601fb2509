// Attenuation of shadowed lights for passes that cast no rays: looked up in the light volumes.
#import "shading/shade.wgsl"

fn attenuation_at(light: Light, volume: texture_3d<f32>, surface: Surface, towards: Towards) -> Left {
    return looked_up(light, volume, biased(surface, towards));
}
