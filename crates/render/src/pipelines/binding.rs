//! Shader bindings by name: declared slots, and the resources bound to them.

use crate::GpuContext;

/// Binding of a shader: its number in the group, its name in WGSL, and the kind of resource it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct BindingSlot {
    pub number: u32,
    pub name: &'static str,
    pub kind: BindingKind,
}

/// Kind of resource that a slot takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum BindingKind {
    /// Uniform buffer with a struct of this many bytes.
    Uniform(u64),
    /// Storage buffer of at least this many bytes.
    Storage(u64, BufferAccess),
    /// Float texture that is sampled with filtering.
    Sampled(TextureShape),
    /// Float texture whose texels are loaded without filtering.
    Loaded(TextureShape),
    /// Texture of unsigned integers.
    Uint(TextureShape),
    /// Storage texture that is written.
    StorageTexture(TextureShape, StorageFormat),
    Sampler,
}

/// Access of a shader to a storage buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum BufferAccess {
    Read,
    ReadWrite,
}

/// Returns the four-channel format of the ring of sheets, with the precision of the single-channel format `storage`.
pub(crate) fn ring_format(storage: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match storage {
        wgpu::TextureFormat::R32Float => wgpu::TextureFormat::Rgba32Float,
        _ => wgpu::TextureFormat::Rgba16Float,
    }
}

/// Dimensionality of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum TextureShape {
    /// Two-dimensional texture, one layer.
    D2,
    /// Array of two-dimensional layers.
    D2Array,
    /// Three-dimensional texture with filtering in depth.
    D3,
}

/// Format of a storage texture that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum StorageFormat {
    Fixed(wgpu::TextureFormat),
    /// Single-channel storage format of the adapter.
    Storage,
    /// Format passed when the pipeline is made, for example that of a light volume.
    Target,
    /// Four-channel format of the ring of sheets.
    Ring,
}

impl BindingSlot {
    /// Declares a uniform with the size of the host's struct `T`.
    pub(crate) const fn uniform<T>(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: BindingKind::Uniform(size_of::<T>() as u64) }
    }

    /// Declares a storage buffer of at least `bytes` bytes.
    pub(crate) const fn storage(number: u32, name: &'static str, bytes: u64, access: BufferAccess) -> Self {
        Self { number, name, kind: BindingKind::Storage(bytes, access) }
    }

    /// Declares a float texture that is sampled with filtering.
    pub(crate) const fn sampled_texture(number: u32, name: &'static str, shape: TextureShape) -> Self {
        Self { number, name, kind: BindingKind::Sampled(shape) }
    }

    /// Declares a float texture whose texels are loaded.
    pub(crate) const fn loaded_texture(number: u32, name: &'static str, shape: TextureShape) -> Self {
        Self { number, name, kind: BindingKind::Loaded(shape) }
    }

    /// Declares a texture of unsigned integers.
    pub(crate) const fn uint_texture(number: u32, name: &'static str, shape: TextureShape) -> Self {
        Self { number, name, kind: BindingKind::Uint(shape) }
    }

    /// Declares a storage texture that is written.
    pub(crate) const fn storage_texture(
        number: u32,
        name: &'static str,
        shape: TextureShape,
        format: StorageFormat,
    ) -> Self {
        Self { number, name, kind: BindingKind::StorageTexture(shape, format) }
    }

    /// Declares a sampler with linear filtering.
    pub(crate) const fn bind_sampler(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: BindingKind::Sampler }
    }

    /// Returns the entry of the bind-group layout. `storage` is the adapter's single-channel storage format, `target`
    /// the format of [`StorageFormat::Target`] textures.
    pub(crate) fn entry(
        self,
        storage: wgpu::TextureFormat,
        target: wgpu::TextureFormat,
    ) -> wgpu::BindGroupLayoutEntry {
        let buffer = |ty, bytes| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(bytes),
        };
        let texture = |shape: TextureShape, sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: shape.dimension(),
            multisampled: false,
        };
        let ty = match self.kind {
            BindingKind::Uniform(bytes) => buffer(wgpu::BufferBindingType::Uniform, bytes),
            BindingKind::Storage(bytes, access) => {
                buffer(wgpu::BufferBindingType::Storage { read_only: access == BufferAccess::Read }, bytes)
            }
            BindingKind::Sampled(shape) => {
                texture(shape, wgpu::TextureSampleType::Float { filterable: true })
            }
            BindingKind::Loaded(shape) => {
                texture(shape, wgpu::TextureSampleType::Float { filterable: false })
            }
            BindingKind::Uint(shape) => texture(shape, wgpu::TextureSampleType::Uint),
            BindingKind::StorageTexture(shape, format) => wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: match format {
                    StorageFormat::Fixed(format) => format,
                    StorageFormat::Storage => storage,
                    StorageFormat::Target => target,
                    StorageFormat::Ring => ring_format(storage),
                },
                view_dimension: shape.dimension(),
            },
            BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        };
        wgpu::BindGroupLayoutEntry {
            binding: self.number,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        }
    }
}

impl TextureShape {
    fn dimension(self) -> wgpu::TextureViewDimension {
        match self {
            Self::D2 => wgpu::TextureViewDimension::D2,
            Self::D2Array => wgpu::TextureViewDimension::D2Array,
            Self::D3 => wgpu::TextureViewDimension::D3,
        }
    }
}

/// Resource with the name of the binding that it is meant for.
#[derive(Debug, Clone)]
pub(crate) struct NamedResource<'a> {
    pub name: &'static str,
    pub resource: wgpu::BindingResource<'a>,
}

/// Binds a whole buffer to a name.
pub(crate) fn bind_buffer<'a>(name: &'static str, buffer: &'a wgpu::Buffer) -> NamedResource<'a> {
    NamedResource { name, resource: buffer.as_entire_binding() }
}

/// Binds a texture view to a name.
pub(crate) fn bind_view<'a>(name: &'static str, view: &'a wgpu::TextureView) -> NamedResource<'a> {
    NamedResource { name, resource: wgpu::BindingResource::TextureView(view) }
}

/// Binds a sampler to a name.
pub(crate) fn sampler<'a>(name: &'static str, sampler: &'a wgpu::Sampler) -> NamedResource<'a> {
    NamedResource { name, resource: wgpu::BindingResource::Sampler(sampler) }
}

/// Bind group declaration of a pipeline: slots and layout.
#[derive(Debug, Clone)]
pub(crate) struct BindingGroup {
    pub slots: &'static [BindingSlot],
    pub layout: wgpu::BindGroupLayout,
}

impl BindingGroup {
    /// Creates a group whose layout follows from its slots.
    pub(crate) fn new(
        context: &GpuContext,
        slots: &'static [BindingSlot],
        target: wgpu::TextureFormat,
    ) -> Self {
        let entries: Vec<_> = slots.iter().map(|slot| slot.entry(context.storage_format, target)).collect();
        let layout = context.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: slots.first().map(|slot| slot.name),
            entries: &entries,
        });
        Self { slots, layout }
    }

    /// Returns the bind-group entries for named resources. A name that the shader does not declare gets a binding
    /// number that does not exist, which the device rejects.
    pub(crate) fn entries<'a>(&self, named: &[NamedResource<'a>]) -> Vec<wgpu::BindGroupEntry<'a>> {
        let number = |name: &str| self.slots.iter().find(|slot| slot.name == name).map(|slot| slot.number);
        named
            .iter()
            .map(|NamedResource { name, resource }| wgpu::BindGroupEntry {
                binding: number(name).unwrap_or(u32::MAX),
                resource: resource.clone(),
            })
            .collect()
    }
}

/// Compute pipeline with the declarations of its bind groups.
#[derive(Debug, Clone)]
pub(crate) struct ShaderPipeline {
    pub raw: wgpu::ComputePipeline,
    pub groups: std::sync::Arc<[BindingGroup]>,
}
