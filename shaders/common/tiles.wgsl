// Pictures and sheets in tiles of 8 × 8 pixels, a workgroup each.

// The tile of a workgroup, row by row or, with a stride that has no common divisor with the number of rows,
// with neighbouring rows far apart: a software driver gives each of its threads a run of workgroups, and
// these runs should have the same share of what is costly.
fn tile_of(group: vec3u, rows: u32, stride: u32) -> vec2u {
    return vec2u(group.x, group.y * stride % rows);
}
