// Sizes shared with Rust; tests/shaders/constants.rs compares them.

// Voxels along the edge of a brick (src/data/bricks.rs) and of a cell (src/data/cells.rs).
const BRICK_EDGE = 8;
const CELL_EDGE = 2;
// Bricks or tiles per row of a dispatch over a list (src/gpu/volume/brick_list.rs).
const LISTED_PER_ROW = 16384;
// Pixels along the edge of a tile, and in a list entry of a tile the bits where the row begins and that mark its
// first chunk (src/plan/geometry/march_tiles.rs).
const TILE_EDGE = 8;
const TILE_ROW_BIT = 15;
const TILE_FIRST_BIT = 31;
// Bit where the end of the slice range begins in the entry of a tile of rays (src/plan/geometry/sweep_tiles.rs).
const END_SLICE_BIT = 16;
