//! Check of the bind group layouts: number, name, kind, format and size of every binding agree with the shaders, by
//! reflection.

use chiaroscuro_render::{SHADERS, shader_bindings};
use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, GlobalVariable, Handle, ImageClass, ImageDimension, Module, ScalarKind, TypeInner};
use wgpu::{
    BindGroupLayoutEntry, BindingType, BufferBindingType, SamplerBindingType, TextureFormat,
    TextureSampleType, TextureViewDimension,
};

use crate::sources::variants;

/// Formats of single-channel storage textures, and of light volumes.
const FORMATS: [(TextureFormat, TextureFormat); 3] = [
    (TextureFormat::R16Float, TextureFormat::R16Float),
    (TextureFormat::R16Float, TextureFormat::R8Unorm),
    (TextureFormat::R32Float, TextureFormat::R32Float),
];

/// Parses and validates a shader's source.
fn parse_shader(source: &str) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(source).expect("a shader");
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
    (module, info.expect("a valid shader"))
}

fn dimension(dim: ImageDimension, arrayed: bool) -> TextureViewDimension {
    match (dim, arrayed) {
        (ImageDimension::D2, false) => TextureViewDimension::D2,
        (ImageDimension::D2, true) => TextureViewDimension::D2Array,
        (ImageDimension::D3, false) => TextureViewDimension::D3,
        other => panic!("no pass binds images of {other:?}"),
    }
}

fn format(format: naga::StorageFormat) -> TextureFormat {
    match format {
        naga::StorageFormat::R8Unorm => TextureFormat::R8Unorm,
        naga::StorageFormat::R16Float => TextureFormat::R16Float,
        naga::StorageFormat::R32Float => TextureFormat::R32Float,
        naga::StorageFormat::Rg16Float => TextureFormat::Rg16Float,
        naga::StorageFormat::Rg32Float => TextureFormat::Rg32Float,
        naga::StorageFormat::Rgba8Unorm => TextureFormat::Rgba8Unorm,
        naga::StorageFormat::Rgba16Float => TextureFormat::Rgba16Float,
        naga::StorageFormat::Rgba32Float => TextureFormat::Rgba32Float,
        other => panic!("no pass writes {other:?}"),
    }
}

/// Binding type that a global variable declares.
fn declared_binding(module: &Module, variable: &GlobalVariable, is_sampled: bool) -> BindingType {
    let inner = &module.types[variable.ty].inner;
    let size = || wgpu::BufferSize::new(u64::from(inner.size(module.to_ctx())));
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: size() };
    match (variable.space, inner) {
        (AddressSpace::Uniform, _) => buffer(BufferBindingType::Uniform),
        (AddressSpace::Storage { access }, _) => {
            let read_only = !access.contains(naga::StorageAccess::STORE);
            buffer(BufferBindingType::Storage { read_only })
        }
        (_, TypeInner::Sampler { .. }) => BindingType::Sampler(SamplerBindingType::Filtering),
        (_, TypeInner::Image { dim, arrayed, class }) => match class {
            ImageClass::Sampled { kind, multi } => BindingType::Texture {
                sample_type: match kind {
                    ScalarKind::Float => TextureSampleType::Float { filterable: is_sampled },
                    ScalarKind::Uint => TextureSampleType::Uint,
                    other => panic!("no pass reads {other:?}"),
                },
                view_dimension: dimension(*dim, *arrayed),
                multisampled: *multi,
            },
            ImageClass::Storage { format: written, access } => {
                assert!(!access.contains(naga::StorageAccess::LOAD), "no pass reads what it writes");
                BindingType::StorageTexture {
                    access: wgpu::StorageTextureAccess::WriteOnly,
                    format: format(*written),
                    view_dimension: dimension(*dim, *arrayed),
                }
            }
            other => panic!("no pass binds {other:?}"),
        },
        other => panic!("no pass binds {other:?}"),
    }
}

/// Group, number, name and type of a binding.
type Binding = (u32, u32, String, BindingType);

/// Bindings that an entry point uses.
fn used_bindings(source: &str) -> Vec<Binding> {
    let (module, info) = parse_shader(source);
    assert_eq!(module.entry_points.len(), 1, "a shader has one entry point");
    let entry = info.get_entry_point(0);
    let is_sampled =
        |variable: Handle<GlobalVariable>| entry.sampling_set.iter().any(|pair| pair.image == variable);
    let mut used = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding.filter(|_| entry[handle] != GlobalUse::empty()) else {
            continue;
        };
        let name = variable.name.clone().unwrap_or_default();
        let kind = declared_binding(&module, variable, is_sampled(handle));
        used.push((binding.group, binding.binding, name, kind));
    }
    used
}

/// Bindings that any variant of a shader uses: a texture is filterable if any variant filters it.
fn used_bindings_of_variants(sources: &[(String, String)]) -> Vec<Binding> {
    let filtered = TextureSampleType::Float { filterable: true };
    let is_filtered =
        |ty: &BindingType| matches!(ty, BindingType::Texture { sample_type, .. } if *sample_type == filtered);
    let mut all: Vec<Binding> = Vec::new();
    for used in sources.iter().flat_map(|(_, source)| used_bindings(source)) {
        match all.iter_mut().find(|known| known.2 == used.2) {
            Some(known) if is_filtered(&used.3) => *known = used,
            Some(_) => {}
            None => all.push(used),
        }
    }
    all
}

/// Differences between the host's layout of a shader and the bindings of its variants.
fn differences(groups: &[Vec<(&'static str, BindGroupLayoutEntry)>], used: &[Binding]) -> Vec<String> {
    let mut bound = Vec::new();
    for (group, slots) in (0..).zip(groups) {
        bound.extend(slots.iter().map(|(name, slot)| (group, slot.binding, (*name).to_owned(), slot.ty)));
    }
    let missing = used.iter().filter(|used| !bound.contains(used)).map(|used| format!("declared: {used:?}"));
    let surplus = bound.iter().filter(|bound| !used.contains(bound)).map(|bound| format!("bound: {bound:?}"));
    missing.chain(surplus).collect()
}

#[test]
fn every_binding_of_every_entry_point_is_bound_as_it_is_declared() {
    for (storage, attenuation) in FORMATS {
        for (shader, groups) in shader_bindings(storage, attenuation) {
            let found =
                differences(&groups, &used_bindings_of_variants(&variants(shader, storage, attenuation)));
            assert!(found.is_empty(), "{shader} ({storage:?}, {attenuation:?}):\n{}", found.join("\n"));
        }
    }
}

#[test]
fn every_compute_shader_has_a_layout() {
    let (storage, _) = FORMATS[0];
    let layouts = shader_bindings(storage, storage);
    let has_layout = |name: &str| layouts.iter().any(|(shader, _)| *shader == name);
    for &(name, text) in SHADERS {
        assert_eq!(text.contains("@compute"), has_layout(name), "{name}");
    }
}

#[test]
fn wrong_layouts_are_noticed() {
    let (storage, _) = FORMATS[0];
    let (shader, groups) = shader_bindings(storage, storage)
        .into_iter()
        .find(|(shader, _)| *shader == "light/march.wgsl")
        .expect("the march has a layout");
    let used = used_bindings_of_variants(&variants(shader, storage, storage));
    type LayoutDamage = fn(&mut Vec<(&'static str, BindGroupLayoutEntry)>);
    let damages: [(&str, LayoutDamage); 5] = [
        ("a name", |group| group[1].0 = "tables"),
        ("a number", |group| group[2].1.binding = 9),
        ("a size", |group| {
            if let BindingType::Buffer { min_binding_size, .. } = &mut group[0].1.ty {
                *min_binding_size = wgpu::BufferSize::new(16);
            }
        }),
        ("a kind", |group| group[4].1.ty = group[0].1.ty),
        ("one less", |group| group.truncate(5)),
    ];
    assert!(differences(&groups, &used).is_empty());
    for (what, damage) in damages {
        let mut damaged = groups.clone();
        damage(&mut damaged[0]);
        assert!(!differences(&damaged, &used).is_empty(), "{what} is wrong");
    }
    let mut without = groups;
    without.pop();
    assert!(!differences(&without, &used).is_empty(), "a group is missing");
}
