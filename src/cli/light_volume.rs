//! `chiaroscuro light-volume`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneArgs;
use super::{CliError, print_line};
use crate::data::Volume;
use crate::gpu::{Attenuation, Context, RenderOptions, Renderer, write_atomically};
use crate::plan::Request;

/// Arguments of `light-volume`.
#[derive(Debug, Args)]
pub(super) struct LightVolumeArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// NRRD file to write: float32, 0 (dark) to 1 (fully lit)
    #[arg(short, long, value_name = "OUT.nrrd")]
    output: PathBuf,
    /// Which light, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,
}

/// Fills and writes one attenuation volume.
pub(super) fn run(args: &LightVolumeArgs) -> Result<(), CliError> {
    let loaded = args.scene.load()?;
    let look = args.scene.look(&loaded)?;
    let mut renderer = Renderer::new(&Context::headless()?)?;
    let settings = look.settings(&mut renderer, &loaded)?;
    let options = RenderOptions { fill_everything: true, ..RenderOptions::default() };
    let size = [16, 16];
    renderer.draw(&loaded.volume, &loaded.bricks, &settings, size, &options)?;
    let lights = settings.lights.len();
    let request = Request { volume: loaded.volume.content_id(), settings, size, coarse: None };
    let attenuation = renderer.attenuation(&request, args.light)?.ok_or_else(|| {
        CliError::Usage(format!(
            "--light: light {} has no attenuation volume: it must be one of {lights}, be on and cast shadows, and shadows must be on (command line, --light)",
            args.light
        ))
    })?;
    write_atomically(&args.output, &nrrd(&loaded.volume, &attenuation))?;
    print_line(&format!("{}", args.output.display()));
    Ok(())
}

/// The attenuation volume as an attached NRRD, in the place of the data (right-anterior-superior).
fn nrrd(volume: &Volume, attenuation: &Attenuation) -> Vec<u8> {
    let world = volume.world_from_index();
    let step = attenuation.divisor as f64;
    let vector = |v: glam::DVec3| format!("({},{},{})", v.x, v.y, v.z);
    let origin = world.transform_point3(glam::DVec3::splat(step / 2.0 - 0.5));
    let [nx, ny, nz] = attenuation.dims;
    let header = format!(
        "NRRD0005\ncontent: light attenuation\ntype: float\ndimension: 3\nspace: right-anterior-superior\n\
         sizes: {nx} {ny} {nz}\nspace directions: {} {} {}\nspace origin: {}\n\
         endian: little\nencoding: raw\n\n",
        vector(world.matrix3.x_axis * step),
        vector(world.matrix3.y_axis * step),
        vector(world.matrix3.z_axis * step),
        vector(origin),
    );
    let mut bytes = header.into_bytes();
    bytes.extend(attenuation.values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::load::{LoadControl, LoadOptions, load};
    use crate::data::synthetic::builtin;

    #[test]
    fn the_nrrd_can_be_read_back_in_its_place() {
        let volume = builtin("box", Some(16)).unwrap();
        let attenuation =
            Attenuation { dims: [8; 3], divisor: 2, values: (0..512).map(|i| i as f32 / 512.0).collect() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("light.nrrd");
        std::fs::write(&path, nrrd(&volume, &attenuation)).unwrap();
        let back = load(&path, &LoadOptions::default(), &LoadControl::new()).unwrap();
        assert_eq!(back.dims(), [8; 3]);
        assert_eq!(back.spacing_mm(), volume.spacing_mm() * 2.0);
        assert!((back.value(1, 0, 0) - 1.0 / 512.0).abs() < 1e-9);
        // The box around the voxels is the same.
        let corner = |volume: &Volume| volume.world_from_index().transform_point3(glam::DVec3::splat(-0.5));
        assert!((corner(&back) - corner(&volume)).length() < 1e-9);
    }
}
