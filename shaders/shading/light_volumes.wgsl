// Attenuation volumes of the shadowed lights, in their order, or the floor's maps.
@group(2) @binding(0) var attenuation_0: texture_3d<f32>;
@group(2) @binding(1) var attenuation_1: texture_3d<f32>;
@group(2) @binding(2) var attenuation_2: texture_3d<f32>;
@group(2) @binding(3) var attenuation_3: texture_3d<f32>;
@group(2) @binding(4) var attenuation_4: texture_3d<f32>;
@group(2) @binding(5) var attenuation_5: texture_3d<f32>;
@group(2) @binding(6) var attenuation_6: texture_3d<f32>;
@group(2) @binding(7) var attenuation_7: texture_3d<f32>;
