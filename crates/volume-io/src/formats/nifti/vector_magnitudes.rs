//! Magnitudes of vectors whose components are stored as separate volumes.

use super::super::LoadControl;
use super::super::content::FileContent;
use super::super::number::VoxelEncoding;
use super::super::samples::{BLOCK_BYTES, ReadFault, alloc_with_capacity, read_until_full};
use chiaroscuro_volume::{GridExtent, Samples};

/// Computes the magnitudes of vectors from the volumes of their components, which begin at the ascending byte offsets
/// `places`.
pub(super) fn read_magnitudes(
    content: &mut FileContent,
    stored: &VoxelEncoding,
    places: impl ExactSizeIterator<Item = u64>,
    (slope, intercept): (f64, f64),
    extent: GridExtent,
    control: &LoadControl,
) -> Result<Samples, ReadFault> {
    control.start(extent.bytes.saturating_mul(places.len() as u64));
    let mut lengths: Vec<f32> = alloc_with_capacity(extent.voxels)?;
    lengths.resize(extent.voxels, 0.0);
    let size = stored.number.bytes();
    let at_once = (BLOCK_BYTES / size).min(extent.voxels);
    let mut block = vec![0; at_once * size];
    for place in places {
        content.seek_forward(place, control)?;
        for (index, lengths) in lengths.chunks_mut(at_once).enumerate() {
            let bytes = &mut block[..lengths.len() * size];
            let got = read_until_full(content, bytes, control).map_err(ReadFault::into_decoder_fault)?;
            if got < bytes.len() {
                return Err(ReadFault::Short {
                    got: ((index * at_once + got / size) * size_of::<f32>()) as u64,
                });
            }
            for (length, number) in lengths.iter_mut().zip(bytes.chunks_exact(size)) {
                let component = stored.number.value(number, stored.endian) * slope + intercept;
                *length = (f64::from(*length).powi(2) + component.powi(2)).sqrt() as f32;
            }
            control.advance(size_of_val(lengths) as u64);
        }
    }
    Ok(Samples::F32(lengths))
}
