//! Volumes that an adapter cannot hold, with fewer voxels.

use glam::DVec3;

use crate::data::load::memory_budget_bytes;
use crate::data::{DataKind, Samples, Volume, VolumeError, VoxelType, reduced_dims};
use crate::gpu::light::volume::attenuation_texture;
use crate::gpu::volume::{self, presence::Presence};
use crate::gpu::{Context, GpuError};

/// Volumes of no more voxels are not tried out: 256³ take 100 MiB with one light.
const SMALL: usize = 1 << 24;
/// Volumes with longer axes are tried out: every adapter allows 2048 texels, which hold what lies around the grid, too.
const SHORT: usize = 2048 - BORDER;

/// Most texels of a texture beyond the voxels of an axis: four before and behind, and up to whole eights.
const BORDER: usize = 16;

/// Axes along which voxels are no longer than this, in shortest edges, are averaged together: scans have thicker
/// slices than pixels, and lose less if their pixels are averaged first. Between 1 and 2.
const ALIKE: f64 = std::f64::consts::SQRT_2;

/// The volume itself, if the adapter can hold it with one light, else with as few of its voxels averaged
/// ([`Volume::reduced`]) as needed, by powers of two.
///
/// # Errors
/// When not even a small volume can be held, or the device is lost.
pub fn fitted(context: &Context, volume: Volume) -> Result<Volume, GpuError> {
    let block =
        block_that_fits(volume.dims(), volume.spacing_mm().into(), |dims| holds(context, &volume, dims))?;
    volume.reduced(block).map_err(|err| GpuError::Refused(err.to_string()))
}

/// Voxels along x, y and z of what would be shown of a volume of so many: as many as the adapter can hold with one light.
///
/// The volume need not have been read. What is missing in it, and labels, which take more, show when it has been.
///
/// # Errors
/// When not even a small volume can be held, or the device is lost.
pub fn held_of(context: &Context, dims: [usize; 3], voxel_type: VoxelType) -> Result<[usize; 3], GpuError> {
    let stand_in = stand_in(voxel_type).map_err(|err| GpuError::Refused(err.to_string()))?;
    let block = block_that_fits(dims, [1.0; 3], |dims| holds(context, &stand_in, dims))?;
    Ok(reduced_dims(dims, block))
}

/// One voxel of a type.
fn stand_in(voxel_type: VoxelType) -> Result<Volume, VolumeError> {
    let samples = match voxel_type {
        VoxelType::U8 | VoxelType::I8 => Samples::U8(vec![0]),
        _ => Samples::F32(vec![0.0]),
    };
    Volume::with_spacing("", [1; 3], DVec3::ONE, samples)
}

/// Bytes on the adapter of a volume of so many voxels, with one light: density 2, pyramid 2 and a seventh, attenuation 2.
pub fn bytes_with_one_light(dims: [usize; 3]) -> u64 {
    dims.iter().fold(1u64, |all, &n| all.saturating_mul(n as u64)).saturating_mul(44) / 7
}

/// The smallest blocks of voxels that must become one each for `holds` to hold what is left.
fn block_that_fits(
    all: [usize; 3],
    spacing_mm: [f64; 3],
    holds: impl Fn([usize; 3]) -> Result<(), GpuError>,
) -> Result<[usize; 3], GpuError> {
    let mut block = [1; 3];
    loop {
        let dims = reduced_dims(all, block);
        if dims.iter().product::<usize>() <= SMALL && dims.iter().all(|&n| n <= SHORT) {
            return Ok(block);
        }
        let is_long = |n: usize, limit: u64| (n + BORDER) as u64 > limit;
        match holds(dims) {
            Ok(()) => return Ok(block),
            Err(GpuError::OverLimit { limit, .. }) if dims.iter().any(|&n| is_long(n, limit)) => {
                block = [0, 1, 2].map(|axis| block[axis] << u32::from(is_long(dims[axis], limit)));
            }
            Err(GpuError::OutOfMemory { .. } | GpuError::OverLimit { .. }) => {
                block = larger(block, dims, spacing_mm);
            }
            Err(other) => return Err(other),
        }
    }
}

/// Blocks twice as long along the axes whose voxels are short.
fn larger(block: [usize; 3], dims: [usize; 3], spacing_mm: [f64; 3]) -> [usize; 3] {
    let edges = [0, 1, 2].map(|axis| {
        // A single slice cannot be averaged.
        if dims[axis] > 1 { spacing_mm[axis] * block[axis] as f64 } else { f64::INFINITY }
    });
    let shortest = edges.into_iter().fold(f64::INFINITY, f64::min);
    [0, 1, 2].map(|axis| if edges[axis] <= ALIKE * shortest { 2 * block[axis] } else { block[axis] })
}

/// Makes the textures of such a volume and of one light, and gives them back.
fn holds(context: &Context, like: &Volume, dims: [usize; 3]) -> Result<(), GpuError> {
    // Sevenths of bytes per voxel: of density, pyramid and light 44, of what is there 48, of classified labels 64.
    let of_missing = if like.missing().is_some() { 48 } else { 0 };
    let of_labels = if matches!(like.kind().kind, DataKind::LabelMap { .. }) { 64 } else { 0 };
    let voxels = dims.iter().fold(1u64, |all, &n| all.saturating_mul(n as u64));
    let bytes = voxels.saturating_mul(44 + of_missing + of_labels) / 7;
    // A software driver takes memory when it is written to, and the system then ends the program.
    if context.is_software() && bytes > memory_budget_bytes() {
        return Err(GpuError::OutOfMemory { what: "the volume".to_owned(), mebibytes: bytes >> 20 });
    }
    let made = volume::textures(context, like, dims).and_then(|textures| {
        let presence = Presence::new(context, like, dims)?;
        Ok((textures, presence, attenuation_texture(context, dims, context.storage_format)?))
    });
    let held = made.map(drop);
    // What was dropped, of a failed attempt too, is given back when the device is looked after.
    let waited = context.wait();
    held.and(waited)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An adapter with so many bytes, and axes of so many voxels.
    fn adapter(bytes: usize, longest: usize) -> impl Fn([usize; 3]) -> Result<(), GpuError> {
        move |dims| match dims.into_iter().find(|n| n + BORDER > longest) {
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
        block_that_fits(dims, spacing_mm.into(), adapter(bytes, longest)).unwrap()
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
        let lost = |_| Err(GpuError::Lost("gone".to_owned()));
        assert!(matches!(block_that_fits([3000, 1, 1], [1.0; 3], lost), Err(GpuError::Lost(_))));
    }
}
