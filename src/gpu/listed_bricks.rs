//! Dispatches over listed bricks, as `shaders/common/listed_bricks.wgsl` takes them apart.

use super::Context;

/// Bricks per row of a dispatch: two workgroups each, within the 65535 that all adapters allow.
const BRICKS_PER_ROW: u32 = 32768;

/// A brick's coordinates, ten bits each.
pub(super) fn packed([x, y, z]: [usize; 3]) -> u32 {
    x as u32 | (y as u32) << 10 | (z as u32) << 20
}

/// The list as a storage buffer.
pub(super) fn upload(context: &Context, bricks: &[u32]) -> wgpu::Buffer {
    context.buffer("listed_bricks", bricks, wgpu::BufferUsages::STORAGE)
}

/// Two workgroups for each of so many bricks.
pub(super) fn workgroups(listed: u32) -> [u32; 3] {
    [2 * listed.min(BRICKS_PER_ROW), listed.div_ceil(BRICKS_PER_ROW), 1]
}
