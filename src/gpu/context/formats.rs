//! Formats of textures that go with each other.

/// The format of two channels beside each other where single ones are stored in `storage`.
pub(crate) fn pair_format(storage: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match storage {
        wgpu::TextureFormat::R32Float => wgpu::TextureFormat::Rg32Float,
        _ => wgpu::TextureFormat::Rg16Float,
    }
}
