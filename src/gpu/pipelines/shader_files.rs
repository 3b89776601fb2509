//! The text of every shader, embedded in the program.

/// Names and texts of files below `shaders/`.
macro_rules! shader_files {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../shaders/", $name)))),+]
    };
}

/// Every shader file: its path below `shaders/`, and its text.
#[cfg_attr(not(feature = "testing"), expect(unreachable_pub, reason = "the tests of shaders reach it"))]
pub const SHADERS: &[(&str, &str)] = shader_files![
    "common/listed_bricks.wgsl",
    "common/sizes.wgsl",
    "common/space.wgsl",
    "density/cells.wgsl",
    "density/classify.wgsl",
    "density/cut.wgsl",
    "density/gradient.wgsl",
    "density/kernel.wgsl",
    "density/kernel_gradient.wgsl",
    "density/lighting_density.wgsl",
    "density/presence.wgsl",
    "density/stored_gradient.wgsl",
    "density/stored_presence.wgsl",
    "density/table.wgsl",
    "density/volume.wgsl",
    "eye/floor.wgsl",
    "eye/gather.wgsl",
    "eye/slabs_by_need.wgsl",
    "light/backproject.wgsl",
    "light/clear_margin.wgsl",
    "light/combine.wgsl",
    "light/march.wgsl",
    "light/raycast.wgsl",
    "output/display.wgsl",
    "output/display_deep.wgsl",
    "output/painter.wgsl",
    "output/srgb.wgsl",
    "output/tone_map.wgsl",
    "output/window.wgsl",
    "scatter/eye.wgsl",
    "scatter/footprint.wgsl",
    "scatter/footprints.wgsl",
    "scatter/light.wgsl",
    "scatter/normalise.wgsl",
    "scatter/resolve.wgsl",
    "scatter/reverse.wgsl",
    "scatter/slab.wgsl",
    "scatter/splat.wgsl",
    "scatter/voxels.wgsl",
    "shading/lights.wgsl",
    "shading/looked_up_light.wgsl",
    "shading/near_light.wgsl",
    "shading/shade.wgsl",
    "shading/shadow_ray.wgsl",
    "sheets/march.wgsl",
    "sheets/sheet_frame.wgsl",
    "sheets/tiles.wgsl",
    "volume/downsample.wgsl",
    "volume/downsample_materials.wgsl",
    "volume/gradients.wgsl",
    "volume/halved.wgsl",
    "volume/levels.wgsl",
    "volume/materials.wgsl",
    "volume/prefilter.wgsl",
    "volume/resample.wgsl",
];
