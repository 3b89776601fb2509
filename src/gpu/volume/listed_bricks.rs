//! Dispatches over listed bricks, as `shaders/common/listed_bricks.wgsl` takes them apart.

use crate::gpu::volume::Gpu;

/// Bricks or tiles per row of a dispatch over a list: at most two workgroups each, within the 65535 that all adapters
/// allow.
#[cfg_attr(not(feature = "testing"), expect(unreachable_pub, reason = "the tests of shaders reach it"))]
pub const LISTED_PER_ROW: u32 = 16384;

/// A brick's coordinates, ten bits each.
pub(crate) fn packed([x, y, z]: [usize; 3]) -> u32 {
    x as u32 | (y as u32) << 10 | (z as u32) << 20
}

/// An entry of a list: a brick's coordinates, and those of its cells that are meant.
pub(crate) type Listed = [u32; 4];

/// The entry of a brick and its cells.
pub(crate) fn listed((brick, cells): ([usize; 3], u64)) -> Listed {
    [packed(brick), cells as u32, (cells >> 32) as u32, 0]
}

/// The list as a storage buffer, which may be longer.
pub(crate) fn upload(gpu: Gpu<'_>, bricks: &[Listed]) -> wgpu::Buffer {
    gpu.list("listed_bricks", bricks)
}

/// Binds a list at its true length, for shaders that ask for it.
pub(crate) fn exactly<'a>(buffer: &'a wgpu::Buffer, bricks: &[Listed]) -> wgpu::BindingResource<'a> {
    let size = wgpu::BufferSize::new(size_of_val(bricks) as u64);
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
}

/// Two workgroups for each of so many bricks.
pub(crate) fn workgroups(listed: u32) -> [u32; 3] {
    [2 * listed.min(LISTED_PER_ROW), listed.div_ceil(LISTED_PER_ROW), 1]
}

/// A workgroup for each of so many bricks.
pub(crate) fn single_workgroups(listed: u32) -> [u32; 3] {
    [listed.min(LISTED_PER_ROW), listed.div_ceil(LISTED_PER_ROW), 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dispatches_cover_their_lists_within_the_limits_of_all_adapters() {
        for listed in [1, LISTED_PER_ROW - 1, LISTED_PER_ROW, LISTED_PER_ROW + 1, 262_144, 2_097_152] {
            for (groups, per_brick) in [(workgroups(listed), 2), (single_workgroups(listed), 1)] {
                let [x, y, z] = groups;
                assert!(x <= 65535 && y <= 65535 && z == 1, "{listed}: {groups:?}");
                assert!(x * y >= listed * per_brick, "{listed}: {groups:?}");
                // Rows are whole, as the shaders count on, or there is only one.
                assert!(y == 1 || x == LISTED_PER_ROW * per_brick, "{listed}: {groups:?}");
            }
        }
    }
}
