// Weights of an area light's points on a surface: each counts by its cosine to the surface's normal.
//
// Points are so placed that a surface facing the light takes the same from each. One with the normal n takes
// n·ω / l·ω of that, with the directions ω to a point and l to the centre; relative to the centre of the light this is
// 1 + n·o / n·l − l·o for a point at o from the centre, which is linear in o, and 1 on average.

// Change of weights with the offset of points from the centre of a light. `towards`: vector to the centre; `right` and
// `up`: vectors from there to the borders; `share`: degree to which there is a surface.
//
// All points have equal weights if the border of the light is near the horizon of the surface: the surface itself
// hides the points below its horizon.
fn weight_slope(towards: vec3f, right: vec3f, up: vec3f, normal: vec3f, share: f32) -> vec3f {
    let facing = dot(normal, towards);
    let divisor = select(min(facing, -1e-9), max(facing, 1e-9), facing >= 0.0);
    let slope = normal / divisor - towards / max(dot(towards, towards), 1e-9);
    let lowest = length(vec2f(dot(slope, right), dot(slope, up)));
    return slope * (share * (1.0 - smoothstep(0.6666667, 1.0, lowest)));
}
