//! Dispatches over lists of bricks, decoded by `shaders/common/listed_bricks.wgsl`.

use crate::volume::VolumeContext;

/// Number of bricks or tiles per row of a dispatch over a list: with at most two workgroups each, a row is within the
/// 65535 workgroups that all adapters allow.
#[cfg_attr(not(feature = "testing"), expect(unreachable_pub, reason = "the tests of shaders reach it"))]
pub const LISTED_PER_ROW: u32 = 16384;

/// Packs the coordinates of a brick or cell into one word, ten bits each.
pub(crate) fn pack_coordinates([x, y, z]: [usize; 3]) -> u32 {
    x as u32 | (y as u32) << 10 | (z as u32) << 20
}

/// List entry: packed coordinates of a brick, and a 64-bit mask of its cells.
pub(crate) type BrickEntry = [u32; 4];

/// Builds the list entry of a brick and its cell mask.
pub(crate) fn brick_entry((brick, cells): ([usize; 3], u64)) -> BrickEntry {
    [pack_coordinates(brick), cells as u32, (cells >> 32) as u32, 0]
}

/// Uploads a list into a pooled storage buffer, which may be longer than the list.
pub(crate) fn upload_bricks(gpu: VolumeContext<'_>, bricks: &[BrickEntry]) -> wgpu::Buffer {
    gpu.storage("listed_bricks", bricks)
}

/// Binds a list at its exact length, for shaders that use `arrayLength`.
pub(crate) fn bind_exact_length<'a>(
    buffer: &'a wgpu::Buffer,
    bricks: &[BrickEntry],
) -> wgpu::BindingResource<'a> {
    let size = wgpu::BufferSize::new(size_of_val(bricks) as u64);
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
}

/// Returns the dispatch size for two workgroups per brick.
pub(crate) fn two_workgroups_per_brick(listed: u32) -> [u32; 3] {
    [2 * listed.min(LISTED_PER_ROW), listed.div_ceil(LISTED_PER_ROW), 1]
}

/// Returns the dispatch size for one workgroup per brick.
pub(crate) fn one_workgroup_per_brick(listed: u32) -> [u32; 3] {
    [listed.min(LISTED_PER_ROW), listed.div_ceil(LISTED_PER_ROW), 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dispatches_cover_their_lists_within_the_limits_of_all_adapters() {
        for listed in [1, LISTED_PER_ROW - 1, LISTED_PER_ROW, LISTED_PER_ROW + 1, 262_144, 2_097_152] {
            for (groups, per_brick) in
                [(two_workgroups_per_brick(listed), 2), (one_workgroup_per_brick(listed), 1)]
            {
                let [x, y, z] = groups;
                assert!(x <= 65535 && y <= 65535 && z == 1, "{listed}: {groups:?}");
                assert!(x * y >= listed * per_brick, "{listed}: {groups:?}");
                // Rows are full, as the shaders assume, or there is only one.
                assert!(y == 1 || x == LISTED_PER_ROW * per_brick, "{listed}: {groups:?}");
            }
        }
    }
}
