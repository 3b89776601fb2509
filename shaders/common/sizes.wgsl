// Sizes that Rust counts on, too; tests/shaders/constants.rs compares them.

// Voxels along the edge of a brick (src/data/bricks.rs) and of a cell (src/data/cells.rs).
const BRICK_EDGE = 8;
const CELL_EDGE = 2;
// Bricks or tiles per row of a dispatch over a list (src/gpu/volume/listed_bricks.rs).
const LISTED_PER_ROW = 16384;
// Pixels along the edge of a tile, and where the row and the mark of the first lie in a listed tile
// (src/plan/geometry/march_tiles.rs).
const TILE_EDGE = 8;
const TILE_ROW_BIT = 15;
const TILE_FIRST_BIT = 31;
// Where the slice begins in an entry of a tile of rays that is one beyond the last (src/plan/geometry/sweep_tiles.rs).
const END_SLICE_BIT = 16;
