//! Surfaces of objects in scalar data: the value at which they begin, and how thin they are shown.

mod edge_sharpening;
pub(super) mod isosurfaces;
pub(super) mod threshold;

pub(super) use self::edge_sharpening::sharpen_edges;
