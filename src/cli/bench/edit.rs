//! What an edit of a transfer function takes, another background, and loading a volume.

use std::path::Path;

use serde_json::{Value, json};

use super::report::{Samples, round};
use super::{Bench, WARM_UP, describe};
use crate::cli::CliError;
use crate::data::Dataset;
use crate::gpu::{Context, RenderOptions, Renderer, ShaderLibrary};

/// Share of the value range by which an edit moves all control points: enough for other cells to be seen.
const EDIT_SHARE: f64 = 0.002;

impl Bench<'_> {
    /// All control points move a little, to and fro: tables, visible cells, light and picture are made anew.
    pub(super) fn transfer_edit(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let mut samples = Samples::default();
        let span = self.loaded.volume().shown_range().span();
        let before: u64 = self.renderer.light_rebuilds().iter().sum();
        for frame in 0..WARM_UP + usize::from(self.args.frames) {
            let mut settings = self.settings.clone();
            let step = (frame % 7) as f64 - 3.0;
            for point in &mut settings.transfer.points {
                point.value += step * EDIT_SHARE * span;
            }
            self.frame(&settings, (frame >= WARM_UP).then_some(&mut samples))?;
        }
        let rebuilds = self.renderer.light_rebuilds().iter().sum::<u64>() - before;
        cases.push(self.case("tf-edit", &samples, rebuilds));
        Ok(())
    }

    /// The background changes, which the display pass alone reads.
    pub(super) fn background(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let mut samples = Samples::default();
        for frame in 0..WARM_UP + usize::from(self.args.frames) {
            let mut settings = self.settings.clone();
            settings.output.background.top = [frame as f32 / 2000.0; 3];
            self.frame(&settings, (frame >= WARM_UP).then_some(&mut samples))?;
        }
        cases.push(self.case("background", &samples, 0));
        Ok(())
    }

    /// From a file, or the numbers of a built-in volume, to its first picture at full quality, and the
    /// memory that it takes. Pipelines are there already.
    pub(super) fn load(
        &self,
        context: &Context,
        source: &Path,
        wants: impl Fn(&str) -> bool,
        cases: &mut Vec<Value>,
    ) -> Result<(), CliError> {
        let shaders = ShaderLibrary::new(context);
        let mut samples = Samples::default();
        let options = RenderOptions { timed: true, ..RenderOptions::default() };
        // Loading takes seconds: three are enough for a median.
        for frame in 0..=usize::from(self.args.frames).min(3) {
            let settings = &self.settings;
            let load = || {
                let loaded: Dataset = self.args.look.load(source, context)?;
                let mut renderer = Renderer::with_shaders(context, shaders.clone())?;
                renderer.draw(&loaded, settings, self.args.size, &options)?;
                let report = renderer.report().clone();
                Ok::<_, CliError>((report, renderer.gpu_bytes(), renderer.light_bytes()))
            };
            let mut bytes = (0, 0, 0);
            let mut timed = Samples::default();
            let keep = if frame == 0 { &mut timed } else { &mut samples };
            keep.time(|| {
                let (report, all, light) = load()?;
                bytes = (all, light, report.peak_gpu_bytes);
                Ok::<_, CliError>(report)
            })?;
            if frame == 0 && wants("memory") {
                let voxels = self.loaded.volume().voxel_count() as f64;
                let per_voxel = |bytes: u64| round(bytes as f64 / voxels);
                let (all, light, peak) = bytes;
                let volume = &self.loaded.volume();
                cases.push(json!({
                    "name": "memory",
                    "volume": volume.name(),
                    "dims": volume.dims(),
                    "gpu_bytes": all,
                    "peak_gpu_bytes": peak,
                    "bytes_per_voxel": { "all": per_voxel(all), "light": per_voxel(light), "peak": per_voxel(peak) },
                }));
                if !wants("load") {
                    return Ok(());
                }
            }
        }
        cases.push(describe("load", self.loaded, self.args.size, &self.settings, &samples, 1));
        Ok(())
    }
}
