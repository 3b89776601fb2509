// Boundaries of the data, beyond which there is no material: faces of the grid, and missing voxels.

#option FACES: something is visible near the faces of the grid
// Other variants omit that code, which compiles faster. FACES > 1: the grid is so thin that a kernel may reach two
// opposite faces.

#option MISSING: voxels are missing, in whose place the pyramid continues the density of their neighbours
#if MISSING
const MISSING = true;
#else
const MISSING = false;
#endif
