//! Command `chiaroscuro compare`: several looks of one scene side by side, and their distances.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::CliError;
use super::output::{print_line, warn_empty_picture};
use super::scene::{SceneArgs, parse_size};
use chiaroscuro_files::{check_extension, check_writable};
use chiaroscuro_media::export_png;
use chiaroscuro_render::{PictureDistance, RenderOptions, RenderedPicture, Renderer, is_empty_light};
use chiaroscuro_scene::ComparisonVariant;

/// Width of the gap between two pictures, in pixels.
const GAP: usize = 4;

/// Parser for the names of all variants that need no parameters.
fn variant_names() -> PossibleValuesParser {
    ComparisonVariant::WITHOUT_DATA.map(|variant| variant.name()).into()
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// PNG file to write
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Width and height of each picture in pixels
    #[arg(long, value_name = "WxH", default_value = "400x400", value_parser = parse_size)]
    size: [u32; 2],
    /// Looks to render, from left to right
    #[arg(long, value_parser = variant_names(), value_delimiter = ',', default_value = "off,splat")]
    looks: Vec<String>,
}

/// Renders the looks, writes them in one row, and prints the distance of each from the first.
pub(super) fn run(args: &CompareArgs) -> Result<(), CliError> {
    args.scene.keep_apart(&[&args.output])?;
    check_extension(&args.output, &["png"], "looks side by side are written as .png")?;
    check_writable(&args.output)?;
    let (loaded, context) = args.scene.load()?;
    let look = args.scene.look(&loaded)?;
    let mut renderer = Renderer::new(&context)?;
    let settings = look.settings(&mut renderer, &loaded)?;
    let mut pictures: Vec<RenderedPicture> = Vec::new();
    for name in &args.looks {
        let variant = ComparisonVariant::WITHOUT_DATA.into_iter().find(|variant| variant.name() == name);
        let settings = variant.unwrap_or(ComparisonVariant::Current).apply(&settings);
        let options = RenderOptions::default();
        let picture = renderer.render(&loaded, &settings, args.size, &options)?;
        let first = pictures.first().unwrap_or(&picture);
        let PictureDistance { rmse, max: largest } =
            PictureDistance::between_bytes(&first.display, &picture.display);
        print_line(&format!("{name:<12} RMSE {rmse:6.2} of 255, largest difference {largest}"))?;
        pictures.push(picture);
    }
    if pictures.iter().all(|picture| is_empty_light(&picture.linear)) {
        warn_empty_picture();
    }
    let row = side_by_side(&pictures);
    export_png(row.size, &row.display, true, None, &args.output)?;
    print_line(&format!("{}", args.output.display()))?;
    Ok(())
}

/// Places pictures of equal size in one row, with transparent gaps.
fn side_by_side(pictures: &[RenderedPicture]) -> RenderedPicture {
    let [width, height] = pictures.first().map_or([0, 0], |picture| picture.size.map(|n| n as usize));
    let whole = (width + GAP) * pictures.len() - GAP.min((width + GAP) * pictures.len());
    let mut shown = vec![0; whole * height * 4];
    for (at, picture) in pictures.iter().enumerate() {
        for (row, line) in picture.display.chunks_exact(width * 4).enumerate() {
            let start = (row * whole + at * (width + GAP)) * 4;
            shown[start..start + line.len()].copy_from_slice(line);
        }
    }
    RenderedPicture { size: [whole as u32, height as u32], linear: Vec::new(), display: shown }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_side_by_side() {
        let picture = |grey: u8| RenderedPicture { size: [2, 1], linear: Vec::new(), display: vec![grey; 8] };
        let row = side_by_side(&[picture(1), picture(2), picture(3)]);
        assert_eq!(row.size, [6 + 2 * GAP as u32, 1]);
        let texels: Vec<u8> = row.display.chunks_exact(4).map(|texel| texel[0]).collect();
        assert_eq!(texels, [1, 1, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 3, 3]);
    }
}
