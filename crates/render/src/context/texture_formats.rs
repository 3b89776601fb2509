//! Texture formats derived from the storage format.

/// Returns the two-channel format with the precision of the single-channel format `storage`.
pub(crate) fn pair_format(storage: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match storage {
        wgpu::TextureFormat::R32Float => wgpu::TextureFormat::Rg32Float,
        _ => wgpu::TextureFormat::Rg16Float,
    }
}
