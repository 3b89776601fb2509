//! Shader bindings by name: declared slots, and the resources bound to them.

use crate::gpu::Context;
use crate::gpu::context::pair_format;

/// Binding of a shader: its number in the group, its name in WGSL, and the kind of resource it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Slot {
    pub number: u32,
    pub name: &'static str,
    pub kind: Kind,
}

/// Kind of resource that a slot takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Kind {
    /// Uniform buffer with a struct of this many bytes.
    Uniform(u64),
    /// Storage buffer of at least this many bytes.
    List(u64, Access),
    /// Float texture that is sampled with filtering.
    Sampled(Shape),
    /// Float texture whose texels are loaded without filtering.
    Loaded(Shape),
    /// Texture of unsigned integers.
    Integers(Shape),
    /// Storage texture that is written.
    Target(Shape, Format),
    Sampler,
}

/// Access of a shader to a storage buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Access {
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
pub(crate) enum Shape {
    /// Two-dimensional texture, one layer.
    Picture,
    /// Array of two-dimensional layers.
    Sheets,
    /// Three-dimensional texture with filtering in depth.
    Volume,
}

/// Format of a storage texture that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Format {
    Of(wgpu::TextureFormat),
    /// Single-channel storage format of the adapter.
    Storage,
    /// Two-channel format with the precision of the storage format.
    Pair,
    /// Format passed when the pipeline is made, for example that of a light volume.
    Target,
    /// Four-channel format of the ring of sheets.
    Ring,
}

impl Slot {
    /// Declares a uniform with the size of the host's struct `T`.
    pub(crate) const fn uniform<T>(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: Kind::Uniform(size_of::<T>() as u64) }
    }

    /// Declares a storage buffer of at least `bytes` bytes.
    pub(crate) const fn list(number: u32, name: &'static str, bytes: u64, access: Access) -> Self {
        Self { number, name, kind: Kind::List(bytes, access) }
    }

    /// Declares a float texture that is sampled with filtering.
    pub(crate) const fn sampled(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Sampled(shape) }
    }

    /// Declares a float texture whose texels are loaded.
    pub(crate) const fn loaded(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Loaded(shape) }
    }

    /// Declares a texture of unsigned integers.
    pub(crate) const fn integers(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Integers(shape) }
    }

    /// Declares a storage texture that is written.
    pub(crate) const fn target(number: u32, name: &'static str, shape: Shape, format: Format) -> Self {
        Self { number, name, kind: Kind::Target(shape, format) }
    }

    /// Declares a sampler with linear filtering.
    pub(crate) const fn sampler(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: Kind::Sampler }
    }

    /// Returns the entry of the bind-group layout. `storage` is the adapter's single-channel storage format, `target`
    /// the format of [`Format::Target`] textures.
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
        let texture = |shape: Shape, sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: shape.dimension(),
            multisampled: false,
        };
        let ty = match self.kind {
            Kind::Uniform(bytes) => buffer(wgpu::BufferBindingType::Uniform, bytes),
            Kind::List(bytes, access) => {
                buffer(wgpu::BufferBindingType::Storage { read_only: access == Access::Read }, bytes)
            }
            Kind::Sampled(shape) => texture(shape, wgpu::TextureSampleType::Float { filterable: true }),
            Kind::Loaded(shape) => texture(shape, wgpu::TextureSampleType::Float { filterable: false }),
            Kind::Integers(shape) => texture(shape, wgpu::TextureSampleType::Uint),
            Kind::Target(shape, format) => wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: match format {
                    Format::Of(format) => format,
                    Format::Storage => storage,
                    Format::Target => target,
                    Format::Pair => pair_format(storage),
                    Format::Ring => ring_format(storage),
                },
                view_dimension: shape.dimension(),
            },
            Kind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        };
        wgpu::BindGroupLayoutEntry {
            binding: self.number,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        }
    }
}

impl Shape {
    fn dimension(self) -> wgpu::TextureViewDimension {
        match self {
            Self::Picture => wgpu::TextureViewDimension::D2,
            Self::Sheets => wgpu::TextureViewDimension::D2Array,
            Self::Volume => wgpu::TextureViewDimension::D3,
        }
    }
}

/// Resource with the name of the binding that it is meant for.
#[derive(Debug, Clone)]
pub(crate) struct Named<'a> {
    pub name: &'static str,
    pub resource: wgpu::BindingResource<'a>,
}

/// Binds a whole buffer to a name.
pub(crate) fn buffer<'a>(name: &'static str, buffer: &'a wgpu::Buffer) -> Named<'a> {
    Named { name, resource: buffer.as_entire_binding() }
}

/// Binds a texture view to a name.
pub(crate) fn view_of<'a>(name: &'static str, view: &'a wgpu::TextureView) -> Named<'a> {
    Named { name, resource: wgpu::BindingResource::TextureView(view) }
}

/// Binds a sampler to a name.
pub(crate) fn sampler<'a>(name: &'static str, sampler: &'a wgpu::Sampler) -> Named<'a> {
    Named { name, resource: wgpu::BindingResource::Sampler(sampler) }
}

/// Bind group declaration of a pipeline: slots and layout.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub slots: &'static [Slot],
    pub layout: wgpu::BindGroupLayout,
}

impl Group {
    /// Creates a group whose layout follows from its slots.
    pub(crate) fn new(context: &Context, slots: &'static [Slot], target: wgpu::TextureFormat) -> Self {
        let entries: Vec<_> = slots.iter().map(|slot| slot.entry(context.storage_format, target)).collect();
        let layout = context.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: slots.first().map(|slot| slot.name),
            entries: &entries,
        });
        Self { slots, layout }
    }

    /// Returns the bind-group entries for named resources. A name that the shader does not declare gets a binding
    /// number that does not exist, which the device rejects.
    pub(crate) fn entries<'a>(&self, named: &[Named<'a>]) -> Vec<wgpu::BindGroupEntry<'a>> {
        let number = |name: &str| self.slots.iter().find(|slot| slot.name == name).map(|slot| slot.number);
        named
            .iter()
            .map(|Named { name, resource }| wgpu::BindGroupEntry {
                binding: number(name).unwrap_or(u32::MAX),
                resource: resource.clone(),
            })
            .collect()
    }
}

/// Compute pipeline with the declarations of its bind groups.
#[derive(Debug, Clone)]
pub(crate) struct Pipeline {
    pub raw: wgpu::ComputePipeline,
    pub groups: std::sync::Arc<[Group]>,
}
