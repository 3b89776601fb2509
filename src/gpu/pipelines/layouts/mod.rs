//! Bind-group layouts of all compute shaders, by the names of the bindings in WGSL: numbers, kinds and sizes, group
//! by group. A test compares them with the shaders (`tests/shaders/bindings.rs`).

mod bounces;
mod light;
mod sky;

use super::binding::{Access, Format, Shape, Slot};
use super::uniforms;

/// Size of a lookup table in bytes: [`crate::model::LUT_SIZE`] times seventeen floats.
///
/// Four are the entry, one its side, eleven the maximum extinctions of runs, and one the integral of extinction up to
/// it.
const TABLE_BYTES: u64 = crate::model::LUT_SIZE as u64 * 17 * 4;

/// Size of a footprint table in bytes: 512 pairs of floats, as `scatter/footprint.wgsl` declares it.
const FOOTPRINT_TABLE_BYTES: u64 = 512 * 8;

const GRID: Slot = Slot::uniform::<uniforms::Grid>(0, "bound_grid");
const PYRAMID_TEXTURE: Slot = Slot::sampled(2, "pyramid_texture", Shape::Volume);
const CLAMPED: Slot = Slot::sampler(3, "clamped");
const NEAREST: Slot = Slot::sampler(4, "nearest");
const PRESENCE_TEXTURE: Slot = Slot::sampled(9, "presence_texture", Shape::Volume);

const LIGHTING_PYRAMID: Slot = Slot::sampled(10, "lighting_pyramid", Shape::Volume);

/// Density texture, with the pyramid for kernels that perspective stretches.
const VOLUME: &[Slot] = &[
    GRID,
    Slot::sampled(1, "density_texture", Shape::Volume),
    PYRAMID_TEXTURE,
    CLAMPED,
    NEAREST,
    PRESENCE_TEXTURE,
];

/// Density and pyramid as in [`VOLUME`], with the pyramid that near-field rays read.
const VOLUME_AND_LIGHTING: &[Slot] =
    &[VOLUME[0], VOLUME[1], VOLUME[2], VOLUME[3], VOLUME[4], VOLUME[5], LIGHTING_PYRAMID];

/// Pyramid without the density texture.
const PYRAMID: &[Slot] = &[GRID, PYRAMID_TEXTURE, CLAMPED, PRESENCE_TEXTURE];

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
const LIGHTS: &[Slot] = &[
    Slot::sampled(0, ATTENUATION[0], Shape::Volume),
    Slot::sampled(1, ATTENUATION[1], Shape::Volume),
    Slot::sampled(2, ATTENUATION[2], Shape::Volume),
    Slot::sampled(3, ATTENUATION[3], Shape::Volume),
    Slot::sampled(4, ATTENUATION[4], Shape::Volume),
    Slot::sampled(5, ATTENUATION[5], Shape::Volume),
    Slot::sampled(6, ATTENUATION[6], Shape::Volume),
    Slot::sampled(7, ATTENUATION[7], Shape::Volume),
];

/// Attenuation volumes as in [`LIGHTS`], with the volumes of sky visibility and scattered light.
const LIGHTS_AND_AROUND: &[Slot] = &[
    LIGHTS[0],
    LIGHTS[1],
    LIGHTS[2],
    LIGHTS[3],
    LIGHTS[4],
    LIGHTS[5],
    LIGHTS[6],
    LIGHTS[7],
    Slot::sampled(8, "sky_texture", Shape::Volume),
    Slot::sampled(9, "bounced_texture", Shape::Volume),
];

/// Bindings of the passes that resample a pyramid level.
const RESAMPLE: &[Slot] = &[
    Slot::sampled(0, "source", Shape::Volume),
    Slot::sampler(1, "clamped"),
    Slot::target(2, "level", Shape::Volume, Format::Storage),
    Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
    Slot::list(5, "bricks", 4, Access::Read),
];

/// Uniform of the eye and its lights.
const EYE: Slot = Slot::uniform::<uniforms::Eye>(0, "bound_eye");
const TABLE: Slot = Slot::list(1, "table", TABLE_BYTES, Access::Read);
const LIGHTING_TABLE: Slot = Slot::list(4, "lighting_table", TABLE_BYTES, Access::Read);
const GRADIENTS: Slot = Slot::sampled(6, "gradients", Shape::Volume);
const SCATTER: Slot = Slot::uniform::<uniforms::Scatter>(5, "bound_scatter");
const SHEETS: Slot = Slot::list(6, "sheets", 4, Access::ReadWrite);
const FOOTPRINT_TABLE: Slot = Slot::list(7, "footprint_table", FOOTPRINT_TABLE_BYTES, Access::Read);
const RAYS: Slot = Slot::list(8, "rays", 16, Access::ReadWrite);

/// Bindings of the display passes, which write `shown` with this format.
const fn display(shown: Format) -> [Slot; 4] {
    [
        Slot::uniform::<uniforms::Display>(0, "bound_display"),
        Slot::loaded(1, "picture", Shape::Picture),
        Slot::target(2, "shown", Shape::Picture, shown),
        Slot::loaded(3, "floor_light", Shape::Picture),
    ]
}

const DISPLAY: &[Slot] = &display(Format::Of(wgpu::TextureFormat::Rgba8Unorm));
const DISPLAY_DEEP: &[Slot] = &display(Format::Of(wgpu::TextureFormat::Rgba32Float));

/// Bind groups of a shader.
pub(crate) type Groups = &'static [&'static [Slot]];

/// Shaders with the bind groups of each.
pub(crate) type Layouts = &'static [(&'static str, Groups)];

/// Returns every compute shader with its bind groups.
pub(crate) fn layouts() -> impl Iterator<Item = &'static (&'static str, Groups)> {
    [OTHERS, bounces::LAYOUTS, light::LAYOUTS, sky::LAYOUTS].into_iter().flatten()
}

/// Layouts of all shaders but those of light, sky and scattered light.
const OTHERS: Layouts = &[
    (
        "eye/floor.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::Floor>(0, "bound_floor_disc"),
                TABLE,
                Slot::sampled(2, "distances", Shape::Volume),
                Slot::loaded(3, "picture", Shape::Picture),
                Slot::target(4, "floor_light", Shape::Picture, Format::Of(wgpu::TextureFormat::Rgba16Float)),
                Slot::sampled(5, "sky_map", Shape::Volume),
            ],
            VOLUME,
            LIGHTS,
        ],
    ),
    (
        "eye/gather.wgsl",
        &[
            &[
                EYE,
                TABLE,
                Slot::sampled(2, "distances", Shape::Volume),
                Slot::target(3, "picture", Shape::Picture, Format::Of(wgpu::TextureFormat::Rgba32Float)),
                LIGHTING_TABLE,
                Slot::sampled(5, "light_distances", Shape::Volume),
                GRADIENTS,
            ],
            VOLUME_AND_LIGHTING,
            LIGHTS_AND_AROUND,
        ],
    ),
    ("output/display.wgsl", &[DISPLAY]),
    ("output/display_deep.wgsl", &[DISPLAY_DEEP]),
    (
        "scatter/eye.wgsl",
        &[
            &[EYE, TABLE, Slot::integers(2, "distances", Shape::Volume), LIGHTING_TABLE, GRADIENTS],
            &[GRID, PYRAMID_TEXTURE, CLAMPED, SCATTER, SHEETS, RAYS, PRESENCE_TEXTURE, LIGHTING_PYRAMID],
            LIGHTS_AND_AROUND,
        ],
    ),
    (
        "scatter/footprints.wgsl",
        &[
            &[
                EYE,
                TABLE,
                Slot::list(3, "first_words", 4, Access::Read),
                Slot::list(4, "bricks", 8, Access::Read),
                Slot::list(5, "splats", 4, Access::ReadWrite),
                Slot::list(6, "voxels", 4, Access::Read),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED, SCATTER, FOOTPRINT_TABLE, RAYS, PRESENCE_TEXTURE],
            LIGHTS_AND_AROUND,
            &[Slot::uniform::<uniforms::Phase>(0, "bound_phase")],
        ],
    ),
    (
        "scatter/light.wgsl",
        &[
            &[
                Slot::uniform::<uniforms::March>(0, "bound_march"),
                TABLE,
                Slot::integers(2, "distances", Shape::Volume),
                Slot::list(3, "transmittance", 4, Access::ReadWrite),
                Slot::target(4, "ring", Shape::Sheets, Format::Ring),
                Slot::list(5, "deposits", 16, Access::ReadWrite),
            ],
            &[GRID, PYRAMID_TEXTURE, CLAMPED, SCATTER, SHEETS, PRESENCE_TEXTURE],
        ],
    ),
    (
        "scatter/normalise.wgsl",
        &[
            &[
                Slot::list(0, "bricks", 16, Access::Read),
                Slot::list(1, "light", 4, Access::Read),
                Slot::list(2, "weights", 4, Access::Read),
                Slot::target(3, "attenuation", Shape::Volume, Format::Target),
            ],
            &[SCATTER],
        ],
    ),
    (
        "scatter/resolve.wgsl",
        &[
            &[
                Slot::list(0, "rays", 16, Access::Read),
                Slot::target(1, "picture", Shape::Picture, Format::Of(wgpu::TextureFormat::Rgba32Float)),
            ],
            &[SCATTER],
        ],
    ),
    (
        "scatter/reverse.wgsl",
        &[
            &[
                Slot::integers(0, "distances", Shape::Volume),
                Slot::loaded(1, "ring", Shape::Sheets),
                Slot::list(2, "light", 4, Access::ReadWrite),
                Slot::list(3, "weights", 4, Access::ReadWrite),
            ],
            &[SCATTER, FOOTPRINT_TABLE],
        ],
    ),
    (
        "scatter/splat.wgsl",
        &[
            &[
                Slot::list(0, "bricks", 8, Access::Read),
                TABLE,
                Slot::list(2, "splats", 4, Access::ReadWrite),
                Slot::list(6, "voxels", 4, Access::Read),
            ],
            &[SCATTER, SHEETS, FOOTPRINT_TABLE],
        ],
    ),
    ("volume/downsample.wgsl", &[RESAMPLE]),
    (
        "volume/downsample_materials.wgsl",
        &[&[
            Slot::sampled(0, "source", Shape::Volume),
            Slot::sampler(1, "clamped"),
            Slot::target(2, "level", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
            Slot::list(5, "bricks", 4, Access::Read),
        ]],
    ),
    (
        "volume/downsample_present.wgsl",
        &[&[
            Slot::sampled(0, "source", Shape::Volume),
            Slot::sampler(1, "clamped"),
            Slot::target(2, "level", Shape::Volume, Format::Pair),
            Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
            Slot::list(5, "bricks", 4, Access::Read),
        ]],
    ),
    (
        "volume/gradients.wgsl",
        &[&[
            Slot::loaded(0, "source", Shape::Volume),
            Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
            Slot::target(4, "gradients", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            Slot::list(5, "bricks", 4, Access::Read),
        ]],
    ),
    (
        "volume/materials.wgsl",
        &[&[
            Slot::loaded(0, "source", Shape::Volume),
            TABLE,
            Slot::target(2, "level", Shape::Volume, Format::Of(wgpu::TextureFormat::Rgba16Float)),
            Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
            Slot::loaded(4, "presence_level", Shape::Volume),
            Slot::list(5, "bricks", 4, Access::Read),
        ]],
    ),
    ("volume/prefilter.wgsl", &[RESAMPLE]),
    (
        "volume/prefilter_present.wgsl",
        &[&[
            Slot::sampled(0, "source", Shape::Volume),
            Slot::sampler(1, "clamped"),
            Slot::target(2, "level", Shape::Volume, Format::Pair),
            Slot::uniform::<uniforms::Resample>(3, "bound_resample"),
            Slot::loaded(4, "presence_level", Shape::Volume),
            Slot::list(5, "bricks", 4, Access::Read),
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
    let group =
        |slots: &&'static [Slot]| slots.iter().map(|slot| (slot.name, slot.entry(storage, target))).collect();
    layouts().map(|(shader, groups)| (*shader, groups.iter().map(group).collect())).collect()
}
