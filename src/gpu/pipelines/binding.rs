//! Bindings by name: what a shader declares, and what is bound to it.

use crate::gpu::Context;
use crate::gpu::context::pair_format;

/// A binding of a shader: its number in its group, its name there, and what may be bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Slot {
    pub number: u32,
    pub name: &'static str,
    pub kind: Kind,
}

/// What may be bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Kind {
    /// A struct of so many bytes.
    Uniform(u64),
    /// A storage buffer of so many bytes at least.
    List(u64, Access),
    /// A texture that is read through a sampler.
    Sampled(Shape),
    /// A texture of floats whose texels are loaded.
    Loaded(Shape),
    /// A texture of unsigned integers.
    Integers(Shape),
    /// A texture that is written.
    Target(Shape, Format),
    Sampler,
}

/// What shaders do with a storage buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Access {
    Read,
    ReadWrite,
}

/// The format of the ring of sheets where single channels are stored in `storage`.
pub(crate) fn ring_format(storage: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match storage {
        wgpu::TextureFormat::R32Float => wgpu::TextureFormat::Rgba32Float,
        _ => wgpu::TextureFormat::Rgba16Float,
    }
}

/// How the texels of a texture lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Shape {
    /// In two dimensions.
    Picture,
    /// In layers of two dimensions.
    Sheets,
    /// In three dimensions.
    Volume,
}

/// Format of a texture that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Format {
    Of(wgpu::TextureFormat),
    /// That of single channels, as the adapter can store them.
    Storage,
    /// That of two such channels beside each other.
    Pair,
    /// The one that the pipeline is made for: that of a light volume, say.
    Target,
    /// That of the ring of sheets.
    Ring,
}

impl Slot {
    /// A uniform of the type that the host writes.
    pub(crate) const fn uniform<T>(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: Kind::Uniform(size_of::<T>() as u64) }
    }

    /// A storage buffer of so many bytes at least.
    pub(crate) const fn list(number: u32, name: &'static str, bytes: u64, access: Access) -> Self {
        Self { number, name, kind: Kind::List(bytes, access) }
    }

    /// A texture that is read through a sampler.
    pub(crate) const fn sampled(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Sampled(shape) }
    }

    /// A texture of floats whose texels are loaded.
    pub(crate) const fn loaded(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Loaded(shape) }
    }

    /// A texture of unsigned integers.
    pub(crate) const fn integers(number: u32, name: &'static str, shape: Shape) -> Self {
        Self { number, name, kind: Kind::Integers(shape) }
    }

    /// A texture that is written.
    pub(crate) const fn target(number: u32, name: &'static str, shape: Shape, format: Format) -> Self {
        Self { number, name, kind: Kind::Target(shape, format) }
    }

    /// A sampler.
    pub(crate) const fn sampler(number: u32, name: &'static str) -> Self {
        Self { number, name, kind: Kind::Sampler }
    }

    /// The entry of a layout, for targets of a format, where single channels are stored in `storage`.
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

/// A resource, and the name of the binding that it is for.
#[derive(Debug, Clone)]
pub(crate) struct Named<'a> {
    pub name: &'static str,
    pub resource: wgpu::BindingResource<'a>,
}

/// A whole buffer for a binding.
pub(crate) fn buffer<'a>(name: &'static str, buffer: &'a wgpu::Buffer) -> Named<'a> {
    Named { name, resource: buffer.as_entire_binding() }
}

/// A texture view for a binding.
pub(crate) fn view_of<'a>(name: &'static str, view: &'a wgpu::TextureView) -> Named<'a> {
    Named { name, resource: wgpu::BindingResource::TextureView(view) }
}

/// A sampler for a binding.
pub(crate) fn sampler<'a>(name: &'static str, sampler: &'a wgpu::Sampler) -> Named<'a> {
    Named { name, resource: wgpu::BindingResource::Sampler(sampler) }
}

/// A group of bindings of a pipeline.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub slots: &'static [Slot],
    pub layout: wgpu::BindGroupLayout,
}

impl Group {
    /// A group whose layout follows from its slots.
    pub(crate) fn new(context: &Context, slots: &'static [Slot], target: wgpu::TextureFormat) -> Self {
        let entries: Vec<_> = slots.iter().map(|slot| slot.entry(context.storage_format, target)).collect();
        let layout = context.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: slots.first().map(|slot| slot.name),
            entries: &entries,
        });
        Self { slots, layout }
    }

    /// What is bound under the numbers of its names. A name that the shader does not know gets a number that it
    /// does not know either, which the device refuses.
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

/// A compute pipeline, and what can be bound to it.
#[derive(Debug, Clone)]
pub(crate) struct Pipeline {
    pub raw: wgpu::ComputePipeline,
    pub groups: std::sync::Arc<[Group]>,
}
