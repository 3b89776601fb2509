//! Downsampling of volumes that exceed the adapter's memory or limits.

use glam::DVec3;

use crate::light::light_volume::attenuation_texture;
use crate::volume::{self, presence::PresenceTextures};
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{
    DataKind, Samples, Volume, VolumeError, VoxelType, block_counts, memory_budget_bytes,
};

/// Number of voxels up to which a volume is not tested: 256³ take 100 MiB with one light.
const UNTESTED_VOXELS: usize = 1 << 24;
/// Axis length up to which a volume is not tested: every adapter allows 2048 texels, padding included.
const UNTESTED_AXIS: usize = 2048 - MAX_PADDING;

/// Maximum number of texels beyond the voxels of an axis: a padding of four on each side, rounded up to a multiple of
/// eight.
const MAX_PADDING: usize = 16;

/// Maximum ratio of edge lengths, relative to the shortest, of axes that are averaged together. Slices of scans are
/// often thicker than pixels; averaging the pixels first loses less. Between 1 and 2.
const MAX_EDGE_RATIO: f64 = std::f64::consts::SQRT_2;

/// Returns the volume itself if the adapter can hold it with one light, else a downsampled one
/// ([`Volume::block_averaged`]) with the smallest sufficient power-of-two blocks.
///
/// # Errors
/// Returns an error if not even a small volume fits, or if the device is lost.
pub fn downsample_to_fit(context: &GpuContext, volume: Volume) -> Result<Volume, GpuError> {
    let block = smallest_fitting_block(volume.dims(), volume.spacing_mm().into(), |dims| {
        try_allocation(context, &volume, dims)
    })?;
    Ok(volume.block_averaged(block)?)
}

/// Returns the number of voxels along x, y and z to which a volume of `dims` voxels would be downsampled to fit the
/// adapter with one light.
///
/// The volume need not have been read. Missing voxels and labels, which take more memory, are only known when it has
/// been.
///
/// # Errors
/// Returns an error if not even a small volume fits, or if the device is lost.
pub fn downsampled_dims(
    context: &GpuContext,
    dims: [usize; 3],
    voxel_type: VoxelType,
) -> Result<[usize; 3], GpuError> {
    let stand_in = one_voxel_volume(voxel_type)?;
    let block = smallest_fitting_block(dims, [1.0; 3], |dims| try_allocation(context, &stand_in, dims))?;
    Ok(block_counts(dims, block))
}

/// Creates a volume of one voxel with a type of the same storage.
fn one_voxel_volume(voxel_type: VoxelType) -> Result<Volume, VolumeError> {
    let samples = match voxel_type {
        VoxelType::U8 | VoxelType::I8 => Samples::U8(vec![0]),
        _ => Samples::F32(vec![0.0]),
    };
    Volume::with_spacing("", [1; 3], DVec3::ONE, samples)
}

/// Returns the size in bytes, on the adapter, of a volume with one light: per voxel 2 for density, 2 and a seventh of
/// that for the pyramid, 2 for attenuation.
pub fn bytes_with_one_light(dims: [usize; 3]) -> u64 {
    dims.iter().fold(1u64, |all, &n| all.saturating_mul(n as u64)).saturating_mul(44) / 7
}

/// Returns the smallest block size with which the averaged volume passes `holds`.
fn smallest_fitting_block(
    all: [usize; 3],
    spacing_mm: [f64; 3],
    holds: impl Fn([usize; 3]) -> Result<(), GpuError>,
) -> Result<[usize; 3], GpuError> {
    let mut block = [1; 3];
    loop {
        let dims = block_counts(all, block);
        if dims.iter().product::<usize>() <= UNTESTED_VOXELS && dims.iter().all(|&n| n <= UNTESTED_AXIS) {
            return Ok(block);
        }
        let is_long = |n: usize, limit: u64| (n + MAX_PADDING) as u64 > limit;
        match holds(dims) {
            Ok(()) => return Ok(block),
            Err(GpuError::OverLimit { limit, .. }) if dims.iter().any(|&n| is_long(n, limit)) => {
                block = [0, 1, 2].map(|axis| block[axis] << u32::from(is_long(dims[axis], limit)));
            }
            Err(GpuError::OutOfMemory { .. } | GpuError::OverLimit { .. }) => {
                block = enlarge_block(block, dims, spacing_mm);
            }
            Err(other) => return Err(other),
        }
    }
}

/// Doubles the block size along the axes with the shortest edges.
fn enlarge_block(block: [usize; 3], dims: [usize; 3], spacing_mm: [f64; 3]) -> [usize; 3] {
    let edges = [0, 1, 2].map(|axis| {
        // An axis with a single voxel cannot be averaged.
        if dims[axis] > 1 { spacing_mm[axis] * block[axis] as f64 } else { f64::INFINITY }
    });
    let shortest = edges.into_iter().fold(f64::INFINITY, f64::min);
    [0, 1, 2].map(|axis| if edges[axis] <= MAX_EDGE_RATIO * shortest { 2 * block[axis] } else { block[axis] })
}

/// Tries to allocate the textures of a volume and of one light, and drops them again.
fn try_allocation(context: &GpuContext, like: &Volume, dims: [usize; 3]) -> Result<(), GpuError> {
    // Sevenths of bytes per voxel: 44 for density, pyramid and light, 32 for presence, 64 for classified labels.
    let of_missing = if like.has_absent_voxels() { 32 } else { 0 };
    let of_labels = if matches!(like.kind().kind, DataKind::LabelMap { .. }) { 64 } else { 0 };
    let voxels = dims.iter().fold(1u64, |all, &n| all.saturating_mul(n as u64));
    let bytes = voxels.saturating_mul(44 + of_missing + of_labels) / 7;
    // Software drivers commit memory when it is first written, and the system then kills the process.
    if context.is_software() && bytes > memory_budget_bytes() {
        return Err(GpuError::OutOfMemory { what: "the volume".to_owned(), mebibytes: bytes >> 20 });
    }
    let made = volume::density_texture(context, like, dims).and_then(|density| {
        let textures = (density, volume::pyramid_texture(context, dims)?);
        let presence = PresenceTextures::new(context, like, dims, true)?;
        Ok((textures, presence, attenuation_texture(context, dims, context.storage_format)?))
    });
    let held = made.map(drop);
    // Dropped textures, including those of a failed attempt, are only freed when the device is polled.
    let waited = context.wait();
    held.and(waited)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates an adapter with this many bytes, and with textures of `longest` texels along an axis.
    fn adapter(bytes: usize, longest: usize) -> impl Fn([usize; 3]) -> Result<(), GpuError> {
        move |dims| match dims.into_iter().find(|n| n + MAX_PADDING > longest) {
            Some(size) => Err(GpuError::OverLimit {
                what: "the volume".to_owned(),
                size: size as u64,
                limit: longest as u64,
                help: "",
            }),
            None if dims.iter().product::<usize>() * 2 > bytes => {
                Err(GpuError::OutOfMemory { what: "the volume".to_owned(), mebibytes: 0 })
            }
            None => Ok(()),
        }
    }

    fn block(dims: [usize; 3], spacing_mm: DVec3, bytes: usize, longest: usize) -> [usize; 3] {
        smallest_fitting_block(dims, spacing_mm.into(), adapter(bytes, longest)).unwrap()
    }

    #[test]
    fn voxels_are_averaged_until_they_fit() {
        assert_eq!(block([300; 3], DVec3::ONE, 60 << 20, 4096), [1; 3]);
        assert_eq!(block([300; 3], DVec3::ONE, 50 << 20, 4096), [2; 3]);
        assert_eq!(block([600, 600, 300], DVec3::ONE, 32 << 20, 4096), [2; 3]);
    }

    #[test]
    fn short_voxels_are_averaged_first() {
        assert_eq!(block([600, 600, 60], DVec3::new(1.0, 1.0, 4.0), 40 << 20, 4096), [2, 2, 1]);
        assert_eq!(block([2100, 2100, 1], DVec3::new(1.0, 1.0, 0.1), 0, 4096), [2, 2, 1]);
    }

    #[test]
    fn long_axes_alone_are_cut_where_the_adapter_has_a_longest() {
        assert_eq!(block([5000, 80, 80], DVec3::new(9.0, 1.0, 1.0), 1 << 30, 4096), [2, 1, 1]);
        assert_eq!(block([3000, 2, 2], DVec3::ONE, 1 << 30, 2048), [2, 1, 1]);
    }

    #[test]
    fn other_failures_are_passed_on() {
        let lost = |_| Err(GpuError::DeviceLost("gone".to_owned()));
        assert!(matches!(smallest_fitting_block([3000, 1, 1], [1.0; 3], lost), Err(GpuError::DeviceLost(_))));
    }
}
