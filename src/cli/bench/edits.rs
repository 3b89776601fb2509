//! Benchmark of edits of a transfer function, and of a change of background.

use serde_json::Value;

use super::VolumeBenchmark;
use super::report::CaseTimings;
use crate::cli::CliError;
use chiaroscuro_scene::{CutShape, ShapeCut, SphereCut};

/// Displacement of all control points per edit, relative to the value range: enough to change the set of visible
/// cells.
pub(super) const EDIT_SHARE: f64 = 0.002;

/// Displacement of a cut per edit, in scene units: a voxel of 256.
const CUT_STEP: f64 = 2.0 / 256.0;

impl VolumeBenchmark<'_> {
    /// Measures small displacements of all control points, to and fro: tables, visible cells, light and picture are
    /// recomputed.
    pub(super) fn transfer_edit(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let mut samples = CaseTimings::default();
        let span = self.loaded.volume().shown_range().span();
        let before: u64 = self.renderer.light_rebuilds().iter().sum();
        for frame in self.alternating_frames() {
            let mut settings = self.settings.clone();
            let step = (frame % 7) as f64 - 3.0;
            for point in &mut settings.layer_mut().transfer.points {
                point.value += step * EDIT_SHARE * span;
            }
            self.alternate(frame, &settings, &mut samples)?;
        }
        let rebuilds = self.renderer.light_rebuilds().iter().sum::<u64>() - before;
        cases.push(self.case("tf-edit", &samples, rebuilds));
        Ok(())
    }

    /// Measures small displacements of a ball that is cut out of the middle of the volume: presence of voxels, visible
    /// cells, light and picture are recomputed.
    pub(super) fn cut_edit(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let mut samples = CaseTimings::default();
        let before: u64 = self.renderer.light_rebuilds().iter().sum();
        for frame in self.alternating_frames() {
            let mut settings = self.settings.clone();
            let center = [(frame % 7) as f64 * CUT_STEP, 0.0, 0.0];
            let shape = CutShape::Sphere(SphereCut { center, ..SphereCut::default() });
            settings.cuts.shapes = vec![ShapeCut { shape, ..ShapeCut::default() }];
            self.alternate(frame, &settings, &mut samples)?;
        }
        let rebuilds = self.renderer.light_rebuilds().iter().sum::<u64>() - before;
        cases.push(self.case("cut-edit", &samples, rebuilds));
        Ok(())
    }

    /// Measures changes of the background, which only the display pass reads.
    pub(super) fn background(&mut self, cases: &mut Vec<Value>) -> Result<(), CliError> {
        let mut samples = CaseTimings::default();
        for frame in self.alternating_frames() {
            let mut settings = self.settings.clone();
            settings.output.background.top = [frame as f32 / 2000.0; 3];
            self.alternate(frame, &settings, &mut samples)?;
        }
        cases.push(self.case("background", &samples, 0));
        Ok(())
    }
}
