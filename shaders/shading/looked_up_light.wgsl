// Shadowed lights for passes that cast no rays: what is left of one is in its light volume.
#import "shading/shade.wgsl"

fn attenuation_at(light: Light, volume: texture_3d<f32>, surface: Surface, towards: Towards) -> Left {
    return looked_up(light, volume, biased(surface, towards));
}
