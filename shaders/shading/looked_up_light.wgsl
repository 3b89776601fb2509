// Attenuation of shadowed lights for passes that cast no rays: looked up in the light volumes.
#import "shading/shade.wgsl"

fn attenuation_at(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
    return lookup_attenuation(light, volume, biased_point(surface, towards));
}
