//! Command `chiaroscuro light-volume`: writes a light's attenuation volume, or a slice of it.

use std::path::PathBuf;

use clap::Args;

use super::CliError;
use super::output::{finish_output, open_destination};
use super::scene::SceneArgs;
use chiaroscuro_files::{check_extension, write_atomically};
use chiaroscuro_render::{
    AttenuationData, RenderOptions, Renderer, WorkOptions, export_slice, plan::RenderRequest,
};
use chiaroscuro_scene::LightStorage;
use chiaroscuro_volume_io::write::nrrd_of_blocks;

/// Arguments of `light-volume`.
#[derive(Debug, Args)]
pub(super) struct LightVolumeArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// File to write: NRRD (float32, 0 dark to 1 fully lit), or with --slice a PNG in false colours
    #[arg(short, long, value_name = "OUT.nrrd|OUT.png")]
    output: PathBuf,
    /// Write one slice alone, for instance z:40 (counted in voxels of the light volume)
    #[arg(long, value_name = "AXIS:INDEX", value_parser = parse_slice)]
    slice: Option<LightVolumeSlice>,
    /// Index of the light, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,
}

/// Slice of the light volume across one axis.
#[derive(Debug, Clone, Copy)]
struct LightVolumeSlice {
    /// Index of the axis: 0, 1 or 2 for x, y or z.
    axis: usize,
    /// Position along the axis, in voxels.
    index: usize,
}

/// Names of the index axes on the command line.
const AXES: [char; 3] = ['x', 'y', 'z'];

/// Parses a slice such as `z:40`.
fn parse_slice(text: &str) -> Result<LightVolumeSlice, String> {
    let parsed = text.split_once(':').and_then(|(axis, index)| {
        let axis = AXES.iter().position(|name| axis == name.to_string())?;
        Some(LightVolumeSlice { axis, index: index.parse().ok()? })
    });
    parsed.ok_or_else(|| format!("expected x, y or z and a number, as in z:40, found {text:?}"))
}

/// Fills and writes the attenuation volume of one light.
pub(super) fn run(args: &LightVolumeArgs) -> Result<(), CliError> {
    args.scene.keep_apart(&[&args.output])?;
    let output = open_destination(&args.output, if args.slice.is_some() { "png" } else { "nrrd" })?;
    let (loaded, context) = args.scene.load()?;
    let look = args.scene.look(&loaded)?;
    let mut renderer = Renderer::new(&context)?;
    let mut settings = look.settings(&mut renderer, &loaded)?;
    // In a combined volume, this light could not be separated.
    settings.shadows.storage = LightStorage::PerLight;
    let options = RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
    let size = [16, 16];
    renderer.draw(&loaded, &settings, size, &options)?;
    let lights = settings.lights.len();
    let request = RenderRequest { volume: loaded.id(), settings, size, preview_resolution: None };
    let attenuation = renderer.attenuation(&request, args.light)?.ok_or_else(|| {
        CliError::Usage(format!(
            "--light: light {} has no attenuation volume; expected one of the {lights} lights, counted from 0, that \
             is on and casts shadows, with shadows on (command line, --light)",
            args.light
        ))
    })?;
    match args.slice {
        None => {
            check_extension(
                output.path(),
                &["nrrd"],
                "light volumes are written as .nrrd, their slices as .png",
            )?;
            let AttenuationData { dims, divisor, values, .. } = &attenuation;
            let nrrd = nrrd_of_blocks(loaded.volume(), AttenuationData::CONTENT, *dims, *divisor, values);
            write_atomically(output.path(), &nrrd)?;
        }
        Some(LightVolumeSlice { axis, index }) => {
            let slice = attenuation.slice(axis, index).ok_or_else(|| {
                CliError::Usage(format!(
                    "--slice: there is no slice {index}: the light volume has {} slices along {}, counted from 0 \
                     (command line, --slice)",
                    attenuation.dims[axis], AXES[axis]
                ))
            })?;
            export_slice(&slice, output.path())?;
        }
    }
    finish_output(output)
}
