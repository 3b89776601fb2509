//! Bind-group layouts of all compute shaders, by the names of the bindings in WGSL: numbers, kinds and sizes, group
//! by group. A test compares them with the shaders (`tests/shaders/bindings.rs`).

mod light;
mod scattered_light;
mod sky;

use super::binding::{BindingSlot, BufferAccess, StorageFormat, TextureShape};
use super::uniforms;

/// Size of a lookup table in bytes: [`chiaroscuro_scene::LUT_SIZE`] times twenty floats.
///
/// Four are the entry, one its side, eleven the maximum extinctions of runs, and four the integrals up to it.
const TABLE_BYTES: u64 = chiaroscuro_scene::LUT_SIZE as u64 * 20 * 4;

/// Size of a footprint table in bytes: 512 pairs of floats, as `scatter/footprint.wgsl` declares it.
const FOOTPRINT_TABLE_BYTES: u64 = 512 * 8;

const GRID: BindingSlot = BindingSlot::uniform::<uniforms::GridUniform>(0, "bound_grid");
const PYRAMID_TEXTURE: BindingSlot = BindingSlot::sampled_texture(2, "pyramid_texture", TextureShape::D3);
const CLAMPED: BindingSlot = BindingSlot::bind_sampler(3, "clamped");
const NEAREST: BindingSlot = BindingSlot::bind_sampler(4, "nearest");
const PRESENCE_TEXTURE: BindingSlot = BindingSlot::sampled_texture(9, "presence_texture", TextureShape::D3);

const LIGHTING_PYRAMID: BindingSlot = BindingSlot::sampled_texture(10, "lighting_pyramid", TextureShape::D3);
const LIGHTING_PRESENCE: BindingSlot =
    BindingSlot::sampled_texture(12, "lighting_presence_texture", TextureShape::D3);
const TINT_PYRAMID: BindingSlot = BindingSlot::sampled_texture(11, "tint_pyramid", TextureShape::D3);

/// Density texture, with the pyramid for kernels that perspective stretches.
const VOLUME: &[BindingSlot] = &[
    GRID,
    BindingSlot::sampled_texture(1, "density_texture", TextureShape::D3),
    PYRAMID_TEXTURE,
    CLAMPED,
    NEAREST,
    PRESENCE_TEXTURE,
];

/// Density and pyramid as in [`VOLUME`], with the pyramid and the presence that rays to lights read, the pyramid of tints,
/// and pages of finer levels.
const VOLUME_AND_LIGHTING: &[BindingSlot] = &[
    VOLUME[0],
    VOLUME[1],
    VOLUME[2],
    VOLUME[3],
    VOLUME[4],
    VOLUME[5],
    LIGHTING_PYRAMID,
    TINT_PYRAMID,
    LIGHTING_PRESENCE,
    BindingSlot::uniform::<uniforms::PagesUniform>(13, "bound_pages"),
    BindingSlot::sampled_texture(14, "page_pool", TextureShape::D3),
    BindingSlot::storage(15, "page_table", 4, BufferAccess::Read),
];

/// Pyramid without the density texture.
const PYRAMID: &[BindingSlot] = &[GRID, PYRAMID_TEXTURE, CLAMPED, PRESENCE_TEXTURE];

/// Names of the light volumes, in the order of their lights.
pub(crate) const ATTENUATION: [&str; 8] = [
    "attenuation_0",
    "attenuation_1",
    "attenuation_2",
    "attenuation_3",
    "attenuation_4",
    "attenuation_5",
    "attenuation_6",
    "attenuation_7",
];

/// Attenuation volumes of up to eight lights.
const LIGHTS: &[BindingSlot] = &[
    BindingSlot::sampled_texture(0, ATTENUATION[0], TextureShape::D3),
    BindingSlot::sampled_texture(1, ATTENUATION[1], TextureShape::D3),
    BindingSlot::sampled_texture(2, ATTENUATION[2], TextureShape::D3),
    BindingSlot::sampled_texture(3, ATTENUATION[3], TextureShape::D3),
    BindingSlot::sampled_texture(4, ATTENUATION[4], TextureShape::D3),
    BindingSlot::sampled_texture(5, ATTENUATION[5], TextureShape::D3),
    BindingSlot::sampled_texture(6, ATTENUATION[6], TextureShape::D3),
    BindingSlot::sampled_texture(7, ATTENUATION[7], TextureShape::D3),
];

/// Attenuation volumes as in [`LIGHTS`], with the volumes of sky visibility and scattered light.
const LIGHTS_AND_AMBIENT: &[BindingSlot] = &[
    LIGHTS[0],
    LIGHTS[1],
    LIGHTS[2],
    LIGHTS[3],
    LIGHTS[4],
    LIGHTS[5],
    LIGHTS[6],
    LIGHTS[7],
    BindingSlot::sampled_texture(8, "sky_texture", TextureShape::D3),
    BindingSlot::sampled_texture(9, "bounced_texture", TextureShape::D3),
];

/// Bindings of the passes that resample a pyramid level.
const RESAMPLE: &[BindingSlot] = &[
    BindingSlot::sampled_texture(20, "source_texture", TextureShape::D3),
    BindingSlot::bind_sampler(21, "source_sampler"),
    BindingSlot::storage_texture(2, "level", TextureShape::D3, StorageFormat::Target),
    BindingSlot::uniform::<uniforms::PyramidLevelUniform>(3, "bound_resample"),
    BindingSlot::storage(5, "bricks", 4, BufferAccess::Read),
];

/// Uniform of the eye and its lights.
const EYE: BindingSlot = BindingSlot::uniform::<uniforms::EyeUniform>(0, "bound_eye");
const TABLE: BindingSlot = BindingSlot::storage(1, "table", TABLE_BYTES, BufferAccess::Read);
const LIGHTING_TABLE: BindingSlot =
    BindingSlot::storage(26, "lighting_table", TABLE_BYTES, BufferAccess::Read);
const GRADIENTS: BindingSlot = BindingSlot::sampled_texture(24, "gradients", TextureShape::D3);
/// Texture from whose texels a level of a pyramid is made, without filtering.
const SOURCE_TEXELS: BindingSlot = BindingSlot::loaded_texture(20, "source_texture", TextureShape::D3);
/// Presence at the texels of a level that is made.
const PRESENCE_LEVEL: BindingSlot = BindingSlot::loaded_texture(22, "presence_level", TextureShape::D3);
/// Voxels of the scattering engine.
const VOXELS: BindingSlot = BindingSlot::storage(25, "voxels", 4, BufferAccess::Read);
const SCATTER: BindingSlot = BindingSlot::uniform::<uniforms::ScatterSlabUniform>(5, "bound_scatter");
const SHEETS: BindingSlot = BindingSlot::storage(6, "sheets", 4, BufferAccess::ReadWrite);
const FOOTPRINT_TABLE: BindingSlot =
    BindingSlot::storage(7, "footprint_table", FOOTPRINT_TABLE_BYTES, BufferAccess::Read);
const RAYS: BindingSlot = BindingSlot::storage(8, "rays", 16, BufferAccess::ReadWrite);

/// Bindings of the display passes, which write `shown` with this format.
const fn display_slots(shown: StorageFormat) -> [BindingSlot; 4] {
    [
        BindingSlot::uniform::<uniforms::DisplayUniform>(0, "bound_display"),
        BindingSlot::loaded_texture(1, "picture", TextureShape::D2),
        BindingSlot::storage_texture(2, "shown", TextureShape::D2, shown),
        BindingSlot::loaded_texture(3, "floor_light", TextureShape::D2),
    ]
}

const DISPLAY: &[BindingSlot] = &display_slots(StorageFormat::Fixed(wgpu::TextureFormat::Rgba8Unorm));
const DISPLAY_DEEP: &[BindingSlot] = &display_slots(StorageFormat::Fixed(wgpu::TextureFormat::Rgba32Float));

/// Bind groups of a shader.
pub(crate) type GroupLayouts = &'static [&'static [BindingSlot]];

/// Shaders with the bind groups of each.
pub(crate) type ShaderLayouts = &'static [(&'static str, GroupLayouts)];

/// Returns every compute shader with its bind groups.
pub(crate) fn layouts() -> impl Iterator<Item = &'static (&'static str, GroupLayouts)> {
    [COMMON_LAYOUTS, scattered_light::LAYOUTS, light::LAYOUTS, sky::LAYOUTS].into_iter().flatten()
}

/// Layouts of all shaders but those of light, sky and scattered light.
const COMMON_LAYOUTS: ShaderLayouts = &[
    (
        "eye/edges.wgsl",
        &[&[
            BindingSlot::uniform::<uniforms::EdgesUniform>(0, "bound_edges"),
            BindingSlot::loaded_texture(1, "middles", TextureShape::D2),
            BindingSlot::storage_texture(
                2,
                "picture",
                TextureShape::D2,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba32Float),
            ),
            BindingSlot::storage(3, "edge_list", 4, BufferAccess::ReadWrite),
        ]],
    ),
    (
        "eye/eye_pass.wgsl",
        &[
            &[
                EYE,
                TABLE,
                BindingSlot::sampled_texture(2, "distances", TextureShape::D3),
                BindingSlot::storage_texture(
                    3,
                    "picture",
                    TextureShape::D2,
                    StorageFormat::Fixed(wgpu::TextureFormat::Rgba32Float),
                ),
                BindingSlot::storage(4, "edge_list", 4, BufferAccess::Read),
                LIGHTING_TABLE,
                BindingSlot::sampled_texture(5, "light_distances", TextureShape::D3),
                BindingSlot::uniform::<uniforms::PixelRayUniform>(6, "bound_pixel_ray"),
                BindingSlot::loaded_texture(7, "earlier", TextureShape::D2),
                GRADIENTS,
            ],
            VOLUME_AND_LIGHTING,
            LIGHTS_AND_AMBIENT,
        ],
    ),
    (
        "eye/floor.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::FloorUniform>(0, "bound_floor_disc"),
                TABLE,
                BindingSlot::sampled_texture(2, "distances", TextureShape::D3),
                BindingSlot::loaded_texture(3, "picture", TextureShape::D2),
                BindingSlot::storage_texture(
                    4,
                    "floor_light",
                    TextureShape::D2,
                    StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
                ),
                BindingSlot::sampled_texture(5, "sky_map", TextureShape::D3),
            ],
            VOLUME,
            LIGHTS,
        ],
    ),
    ("output/display.wgsl", &[DISPLAY]),
    ("output/display_deep.wgsl", &[DISPLAY_DEEP]),
    (
        "scatter/eye.wgsl",
        &[
            &[
                EYE,
                TABLE,
                BindingSlot::uint_texture(2, "distances", TextureShape::D3),
                LIGHTING_TABLE,
                GRADIENTS,
            ],
            &[
                GRID,
                PYRAMID_TEXTURE,
                CLAMPED,
                SCATTER,
                SHEETS,
                RAYS,
                PRESENCE_TEXTURE,
                LIGHTING_PYRAMID,
                TINT_PYRAMID,
                LIGHTING_PRESENCE,
            ],
            LIGHTS_AND_AMBIENT,
        ],
    ),
    (
        "scatter/footprints.wgsl",
        &[
            &[
                EYE,
                TABLE,
                BindingSlot::storage(3, "first_words", 4, BufferAccess::Read),
                BindingSlot::storage(4, "bricks", 8, BufferAccess::Read),
                BindingSlot::storage(5, "splats", 4, BufferAccess::ReadWrite),
                VOXELS,
            ],
            &[GRID, CLAMPED, SCATTER, FOOTPRINT_TABLE, RAYS, PRESENCE_TEXTURE, TINT_PYRAMID],
            LIGHTS_AND_AMBIENT,
            &[BindingSlot::uniform::<uniforms::FootprintPhaseUniform>(0, "bound_phase")],
        ],
    ),
    (
        "scatter/light.wgsl",
        &[
            &[
                BindingSlot::uniform::<uniforms::MarchUniform>(0, "bound_march"),
                TABLE,
                BindingSlot::uint_texture(2, "distances", TextureShape::D3),
                BindingSlot::storage(3, "transmittance", 4, BufferAccess::ReadWrite),
                BindingSlot::storage_texture(4, "ring", TextureShape::D2Array, StorageFormat::Ring),
                BindingSlot::storage(5, "deposits", 16, BufferAccess::ReadWrite),
            ],
            &[GRID, CLAMPED, SCATTER, SHEETS, PRESENCE_TEXTURE],
        ],
    ),
    (
        "scatter/normalise.wgsl",
        &[
            &[
                BindingSlot::storage(0, "bricks", 16, BufferAccess::Read),
                BindingSlot::storage(1, "light", 4, BufferAccess::Read),
                BindingSlot::storage(2, "weights", 4, BufferAccess::Read),
                BindingSlot::storage_texture(3, "attenuation", TextureShape::D3, StorageFormat::Target),
            ],
            &[SCATTER],
        ],
    ),
    (
        "scatter/resolve.wgsl",
        &[
            &[
                BindingSlot::storage(0, "rays", 16, BufferAccess::Read),
                BindingSlot::storage_texture(
                    1,
                    "picture",
                    TextureShape::D2,
                    StorageFormat::Fixed(wgpu::TextureFormat::Rgba32Float),
                ),
            ],
            &[SCATTER],
        ],
    ),
    (
        "scatter/reverse.wgsl",
        &[
            &[
                BindingSlot::uint_texture(0, "distances", TextureShape::D3),
                BindingSlot::loaded_texture(1, "ring", TextureShape::D2Array),
                BindingSlot::storage(2, "light", 4, BufferAccess::ReadWrite),
                BindingSlot::storage(3, "weights", 4, BufferAccess::ReadWrite),
            ],
            &[SCATTER, FOOTPRINT_TABLE],
        ],
    ),
    (
        "scatter/splat.wgsl",
        &[
            &[
                BindingSlot::storage(0, "bricks", 8, BufferAccess::Read),
                TABLE,
                BindingSlot::storage(2, "splats", 4, BufferAccess::ReadWrite),
                VOXELS,
            ],
            &[SCATTER, SHEETS, FOOTPRINT_TABLE],
        ],
    ),
    (
        "volume/composed_voxels.wgsl",
        &[&[
            BindingSlot::storage_texture(
                2,
                "level",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
            BindingSlot::uniform::<uniforms::PyramidLevelUniform>(3, "bound_resample"),
            BindingSlot::storage(5, "bricks", 4, BufferAccess::Read),
            BindingSlot::uniform::<uniforms::LayersUniform>(6, "bound_layers"),
            PRESENCE_LEVEL,
            BindingSlot::uint_texture(28, "field_texture", TextureShape::D3),
            BindingSlot::storage(29, "layer_tables", TABLE_BYTES, BufferAccess::Read),
        ]],
    ),
    ("volume/downsample.wgsl", &[RESAMPLE]),
    ("volume/prefilter.wgsl", &[RESAMPLE]),
    (
        "volume/gradients.wgsl",
        &[&[
            SOURCE_TEXELS,
            BindingSlot::uniform::<uniforms::PyramidLevelUniform>(3, "bound_resample"),
            BindingSlot::storage_texture(
                4,
                "gradient_level",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
            BindingSlot::storage(5, "bricks", 4, BufferAccess::Read),
        ]],
    ),
    (
        "volume/preclassified.wgsl",
        &[&[
            SOURCE_TEXELS,
            TABLE,
            BindingSlot::storage_texture(
                2,
                "level",
                TextureShape::D3,
                StorageFormat::Fixed(wgpu::TextureFormat::Rgba16Float),
            ),
            BindingSlot::uniform::<uniforms::PyramidLevelUniform>(3, "bound_resample"),
            PRESENCE_LEVEL,
            BindingSlot::storage(5, "bricks", 4, BufferAccess::Read),
        ]],
    ),
];

#[cfg(feature = "testing")]
/// Bindings of a compute shader: its name, and for each group the name and the layout entry of each binding.
pub type ShaderBindings = (&'static str, Vec<Vec<(&'static str, wgpu::BindGroupLayoutEntry)>>);

/// Returns the bindings of every compute shader. `storage` is the single-channel storage format, `target` the format
/// of target textures. A test compares them with the shaders.
#[cfg(feature = "testing")]
pub fn shader_bindings(storage: wgpu::TextureFormat, target: wgpu::TextureFormat) -> Vec<ShaderBindings> {
    let group = |slots: &&'static [BindingSlot]| {
        slots.iter().map(|slot| (slot.name, slot.entry(storage, target))).collect()
    };
    layouts().map(|(shader, groups)| (*shader, groups.iter().map(group).collect())).collect()
}
