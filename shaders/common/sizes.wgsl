// Sizes shared with Rust; tests/shaders/constants.rs compares them.

// Voxels along the edge of a brick (crates/volume/src/occupancy/bricks.rs) and of a cell (crates/volume/src/occupancy/cells.rs).
const BRICK_EDGE = 8;
const CELL_EDGE = 2;
// Bricks or tiles per row of a dispatch over a list (crates/render/src/volume/brick_list.rs).
const LISTED_PER_ROW = 16384;
// Pixels along the edge of a tile, and in a list entry of a tile the bits where the row begins and that mark its
// first chunk (crates/render/src/plan/geometry/march_tiles.rs).
const TILE_EDGE = 8;
const TILE_ROW_BIT = 15;
const TILE_FIRST_BIT = 31;
// Bit where the end of the slice range begins in the entry of a tile of rays
// (crates/render/src/plan/geometry/sweep_tiles.rs).
const END_SLICE_BIT = 16;
