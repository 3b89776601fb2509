// Tiles of 8 × 8 pixels of pictures and sheets, one per workgroup.

// Pixel of an invocation within its tile. Eight consecutive invocations, a vector of a software driver, are 4 × 2
// pixels, whose rays are more coherent than those of a row.
fn in_tile(local: vec2u) -> vec2u {
    return vec2u((local.y & 1u) * 4u + (local.x & 3u), (local.y >> 1u) * 2u + (local.x >> 2u));
}

// Tile of a workgroup. A software driver gives each thread a contiguous run of workgroups: the rows of run b of
// `runs` are b, b + runs, b + 2 runs …, so that all threads work on neighbouring rows at any time, and share
// expensive rows evenly. With one run, rows are in order.
fn tile_of(group: vec3u, rows: u32, runs: u32) -> vec2u {
    let each = rows / runs;
    let longer = rows % runs;
    let of_longer = longer * (each + 1u);
    let is_longer = group.y < of_longer;
    let at = select(group.y - of_longer, group.y, is_longer);
    let length = max(select(each, each + 1u, is_longer), 1u);
    let run = at / length + select(longer, 0u, is_longer);
    return vec2u(group.x, at % length * runs + run);
}
